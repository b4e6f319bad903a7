//! The promise: data flows one way. A room of the house (a folder of `src`, or a file beside them) uses only rooms below it, and
//! no files use each other in a circle.
//!
//! An arrow is what a `use`, or a path that begins with `crate`, `super` or `self`, names: the file that defines it, re-exports
//! followed. `lib.rs` and every `mod.rs` only hand names on, which is checked too. Tests are no part of the house.
//!
//! `cargo test house -- --nocapture` prints the rooms and what each takes from which.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up: a room may use those before it.
const ROOMS: [&str; 8] = ["num", "math", "scene", "frame", "geometry", "raster", "shade", "draw"];

/// A stage is a file of at most so many lines, tests not counted.
const LONGEST: usize = 400;

struct File {
    /// `["raster", "setup"]`; of a `mod.rs` its folder, of `lib.rs` nothing.
    module: Vec<String>,
    /// The text without comments and tests.
    code: String,
    lines: usize,
    head: String,
    /// `lib.rs` or a `mod.rs`.
    is_face: bool,
}

fn files() -> Vec<File> {
    fn walk(folder: &Path, to: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("src can be read") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                walk(&path, to);
            } else if path.extension().is_some_and(|ending| ending == "rs")
                && path.file_stem() != Some("tests".as_ref())
            {
                to.push(path);
            }
        }
    }
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    walk(&src, &mut paths);
    paths.sort();
    paths
        .iter()
        .map(|path| {
            let text = fs::read_to_string(path).expect("a source file");
            let stage = text.split("\n#[cfg(test)]").next().unwrap_or_default();
            let code: Vec<_> =
                stage.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
            let relative = path.strip_prefix(&src).expect("a path in src").with_extension("");
            let mut module: Vec<_> =
                relative.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            let is_face = module.last().is_some_and(|last| last == "mod" || last == "lib");
            if is_face {
                module.pop();
            }
            let head = text.lines().next().unwrap_or_default().to_owned();
            File { module, code: code.join("\n"), lines: stage.lines().count(), head, is_face }
        })
        .collect()
}

/// The paths of a `use` tree.
fn expand(tree: &str, before: &[String], to: &mut Vec<Vec<String>>) {
    let parts = |text: &str| -> Vec<String> {
        text.split("::")
            .map(|part| part.split(" as ").next().unwrap_or_default().trim().to_owned())
            .filter(|part| !part.is_empty())
            .collect()
    };
    let Some((path, list)) = tree.split_once('{') else {
        return to.push([before, &parts(tree)[..]].concat());
    };
    let before = [before, &parts(path)[..]].concat();
    let list = &list[..list.rfind('}').unwrap_or(list.len())];
    let (mut depth, mut start) = (0, 0);
    for (at, character) in list.char_indices().chain([(list.len(), ',')]) {
        match character {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !list[start..at].trim().is_empty() {
                    expand(&list[start..at], &before, to);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// `(is it pub, its tree)` of each `use`.
fn uses(code: &str) -> Vec<(bool, String)> {
    code.split(';')
        .filter_map(|statement| {
            let at = statement
                .rfind("use ")
                .filter(|at| !statement[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_'))?;
            let before = statement[..at].rsplit('\n').next().unwrap_or_default().trim();
            let is_use = before.is_empty() || before.starts_with("pub");
            is_use.then(|| (before.starts_with("pub"), statement[at + 4..].to_owned()))
        })
        .collect()
}

/// All paths in a file that begin with `crate`, `super` or `self`.
fn paths(file: &File) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for (_, tree) in uses(&file.code) {
        expand(&tree, &[], &mut found);
    }
    let mut rest = file.code.clone();
    for (_, tree) in uses(&file.code) {
        rest = rest.replace(&tree, "");
    }
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in rest.match_indices(start) {
            let path: String =
                rest[at..].chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
            expand(&path, &[], &mut found);
        }
    }
    found
}

struct House {
    files: Vec<File>,
    by_module: BTreeMap<Vec<String>, usize>,
    /// What a module hands on, by name: from where.
    exports: BTreeMap<(Vec<String>, String), Vec<String>>,
}

impl House {
    fn new() -> Self {
        let files = files();
        let by_module = files.iter().enumerate().map(|(index, file)| (file.module.clone(), index)).collect();
        let mut exports = BTreeMap::new();
        for file in &files {
            for (_, tree) in uses(&file.code).into_iter().filter(|(is_pub, _)| *is_pub) {
                let mut handed_on = Vec::new();
                expand(&tree, &[], &mut handed_on);
                for path in handed_on {
                    let name = path.last().cloned().unwrap_or_default();
                    exports.insert((file.module.clone(), name), path);
                }
            }
        }
        Self { files, by_module, exports }
    }

    /// The file that defines what a path in a module names; none outside the crate.
    fn resolve(&self, path: &[String], here: &[String], depth: usize) -> Option<usize> {
        assert!(depth < 20, "{path:?} in {here:?} is handed on in a circle");
        let (mut at, mut path) = (here.to_vec(), path);
        match path.first()?.as_str() {
            "crate" => (at, path) = (Vec::new(), &path[1..]),
            "super" | "self" => {
                while let Some(first @ ("super" | "self")) = path.first().map(String::as_str) {
                    if first == "super" {
                        at.pop();
                    }
                    path = &path[1..];
                }
            }
            first => {
                let child = [&at[..], &[first.to_owned()]].concat();
                if !self.by_module.contains_key(&child)
                    && !self.exports.contains_key(&(at.clone(), first.to_owned()))
                {
                    return None;
                }
            }
        }
        while let Some(name) = path.first() {
            let child = [&at[..], std::slice::from_ref(name)].concat();
            if self.by_module.contains_key(&child) {
                (at, path) = (child, &path[1..]);
            } else if let Some(from) = self.exports.get(&(at.clone(), name.clone())) {
                return self.resolve(&[&from[..], &path[1..]].concat(), &at, depth + 1);
            } else {
                break;
            }
        }
        self.by_module.get(&at).copied()
    }

    /// For each file the files that it uses, and the names.
    fn arrows(&self) -> Vec<BTreeMap<usize, BTreeSet<String>>> {
        let arrows_of = |(index, file): (usize, &File)| {
            let mut arrows = BTreeMap::<_, BTreeSet<_>>::new();
            for path in paths(file) {
                let to = self.resolve(&path, &file.module, 0);
                if let Some(to) =
                    to.filter(|to| *to != index && !self.files[*to].module.is_empty() && !file.is_face)
                {
                    arrows.entry(to).or_default().insert(path.last().cloned().unwrap_or_default());
                }
            }
            arrows
        };
        self.files.iter().enumerate().map(arrows_of).collect()
    }

    fn name(&self, file: usize) -> String {
        self.files[file].module.join("/")
    }

    fn room(&self, file: usize) -> usize {
        let room = self.files[file].module.first().expect("not lib.rs");
        ROOMS.iter().position(|name| name == room).unwrap_or_else(|| panic!("{room} is no room of the house"))
    }
}

#[test]
fn rooms_use_only_those_below_and_files_stand_in_no_circle() {
    let house = House::new();
    let arrows = house.arrows();
    let mut between = BTreeMap::<_, BTreeMap<_, BTreeSet<_>>>::new();
    for (from, to) in arrows.iter().enumerate().flat_map(|(from, to)| to.keys().map(move |to| (from, *to))) {
        let (room, used) = (house.room(from), house.room(to));
        let names = &arrows[from][&to];
        assert!(
            used <= room,
            "{} uses {} of {}, which is above it",
            house.name(from),
            Vec::from_iter(names).len(),
            house.name(to)
        );
        if used < room {
            between.entry(room).or_default().entry(used).or_default().extend(names.iter().cloned());
        }
    }
    for (number, room) in ROOMS.iter().enumerate().rev() {
        let own: Vec<_> = house
            .files
            .iter()
            .filter(|file| file.module.first().is_some_and(|first| first == room))
            .collect();
        let lines: usize = own.iter().map(|file| file.lines).sum();
        println!("{room}: {} files, {lines} lines", own.len());
        for (used, names) in between.get(&number).into_iter().flatten() {
            println!("    {}: {}", ROOMS[*used], Vec::from_iter(names.iter().map(String::as_str)).join(", "));
        }
    }
    // What uses nothing that is left, or is used by nothing that is left, stands in no circle.
    let mut left: BTreeSet<_> = (0..house.files.len()).collect();
    loop {
        let uses = |file: &usize, other: &usize| arrows[*file].contains_key(other);
        let free: Vec<_> = left
            .iter()
            .copied()
            .filter(|file| {
                !left.iter().any(|other| uses(file, other)) || !left.iter().any(|other| uses(other, file))
            })
            .collect();
        if free.is_empty() {
            break;
        }
        free.iter().for_each(|file| assert!(left.remove(file)));
    }
    let circle: Vec<_> = left.iter().map(|file| house.name(*file)).collect();
    assert!(circle.is_empty(), "in a circle, or between two: {circle:?}");
    let count: usize = arrows.iter().map(BTreeMap::len).sum();
    assert!(count > 100, "only {count} arrows were found: is this test blind?");
}

#[test]
fn files_are_short_begin_with_a_head_and_faces_only_hand_names_on() {
    for file in files() {
        let name = file.module.join("/");
        assert!(file.head.starts_with("//! "), "{name} does not begin with what it is");
        assert!(file.lines <= LONGEST, "{name} has {} lines", file.lines);
        let is_glob =
            |tree: &String| tree.trim_end().ends_with('*') || tree.contains("*,") || tree.contains("*}");
        assert!(!uses(&file.code).iter().any(|(_, tree)| is_glob(tree)), "{name} imports a glob");
        assert!(
            !file.module.iter().any(|part| part == "target"),
            "{name}: tools take a folder `target` for build output"
        );
        if file.is_face {
            let defines = ["fn ", "struct ", "enum ", "trait ", "impl ", "impl<", "static ", "const "];
            let found = file.code.lines().find(|line| {
                defines.iter().any(|word| {
                    line.trim_start_matches("pub ").trim_start_matches("pub(crate) ").starts_with(word)
                })
            });
            // Where README's code is tested from.
            let found = found.filter(|line| *line != "struct Readme;");
            assert!(found.is_none(), "{name}/mod.rs defines something: {found:?}");
        }
    }
}
