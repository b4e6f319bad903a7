//! The promise: README's first program compiles and runs in a new project as it stands, on a stack of 128 KiB, and the example and the
//! crate's front page show the same lines. The guide lists its pages, and its recipe for RAM adds up. And the tables of tests/README.md
//! name tests that there are.

use std::fs;
use std::path::Path;
use std::process::Command;

use fixel::ListMemory;

const README: &str = include_str!("../README.md");
const EXAMPLE: &str = include_str!("../examples/hello_triangle.rs");
const FRONT_PAGE: &str = include_str!("../src/lib.rs");

/// The first block of Rust in README.
fn first_program() -> &'static str {
    let from = README.split_once("```rust\n").expect("README has a program").1;
    from.split_once("```").expect("the program ends").0
}

/// From the texture to the text on top: what draws, without what shows it.
fn drawing(text: &str, prefix: &str) -> Vec<String> {
    let lines = text.lines().map(|line| line.trim().trim_start_matches(prefix).trim());
    let wanted = lines
        .skip_while(|line| !line.starts_with("static CHECKS"))
        .filter(|line| !line.is_empty() && !line.starts_with('#') && !line.starts_with("fn main"));
    let mut taken = Vec::new();
    for line in wanted {
        taken.push(line.to_owned());
        if line.starts_with("Text::new") {
            return taken;
        }
    }
    panic!("the lines do not end with a text");
}

#[test]
fn the_example_and_the_front_page_show_the_lines_of_readme() {
    let program = EXAMPLE.find("use fixel").map(|start| &EXAMPLE[start..]).expect("the example uses fixel");
    assert_eq!(program, first_program());
    assert!(drawing(EXAMPLE, "").len() > 12);
    assert_eq!(drawing(EXAMPLE, ""), drawing(FRONT_PAGE, "//!"));
}

#[test]
fn readmes_first_program_runs_in_a_new_project_on_a_small_stack() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hello");
    fs::create_dir_all(project.join("src")).expect("a new project");
    // What `cargo new` and `cargo add` write, with this checkout for the published crate.
    let manifest = format!(
        "[package]\nname = \"hello\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\nfixel = {{ path = {root:?} }}\n\n[workspace]\n"
    );
    fs::write(project.join("Cargo.toml"), manifest).expect("a manifest");
    fs::write(project.join("src/main.rs"), first_program()).expect("a program");
    // The versions that are here already.
    fs::copy(root.join("Cargo.lock"), project.join("Cargo.lock")).expect("a lock file");
    let built = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--offline", "--target-dir", "target"])
        .current_dir(&project)
        .env_remove("RUSTFLAGS")
        .status();
    assert!(built.expect("cargo runs").success(), "README's program does not compile");
    // As little stack as some systems give, where a shell can ask for it.
    let program = if cfg!(unix) { "ulimit -s 128 && exec target/debug/hello" } else { "target/debug/hello" };
    let shell = if cfg!(unix) { ["sh", "-c"] } else { ["cmd", "/C"] };
    let ran =
        Command::new(shell[0]).args([shell[1], program]).current_dir(&project).output().expect("a shell");
    assert!(ran.status.success(), "README's program fails: {}", String::from_utf8_lossy(&ran.stderr));
    let shown = String::from_utf8(ran.stdout).expect("text");
    assert_eq!(shown.lines().count(), 32, "64 rows, two a line");
    // The white of the texture, the gold of the text.
    for color in ["38;2;255;251;255m", "38;2;255;215;0m"] {
        assert!(shown.contains(color), "{color:?} is not in the picture");
    }
}

/// The guide's pages, by name.
fn pages() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide");
    let paths = fs::read_dir(folder).expect("the guide").map(|entry| entry.expect("an entry").path());
    let read = |path: std::path::PathBuf| {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        (name, fs::read_to_string(path).expect("a page"))
    };
    paths.map(read).filter(|(name, _)| name != "guide").collect()
}

#[test]
fn the_guide_lists_its_pages_and_its_drawings_say_what_they_show() {
    let modules = include_str!("../src/guide.rs");
    let list = include_str!("../src/guide/guide.md");
    let mut drawings = 0;
    for (name, text) in pages() {
        assert!(
            modules.contains(&format!("guide/{name}.md\")]\npub mod {name} {{}}")),
            "{name} is no module"
        );
        assert!(list.contains(&format!("| [`{name}`] |")), "{name} is not in the list");
        for drawing in text.split("<svg").skip(1) {
            let (drawing, _) = drawing.split_once("</svg>").expect("a drawing ends");
            // An empty line would end it for Markdown.
            assert!(!drawing.contains("\n\n"), "{name}: a drawing has an empty line");
            let says = drawing.split_once("role=\"img\" aria-label=\"").map(|(_, label)| label);
            let label = says.and_then(|label| label.split('"').next()).unwrap_or_default();
            assert!(label.len() > 60, "{name}: a drawing does not say what it shows");
            drawings += 1;
        }
    }
    assert!(pages().len() >= 11 && drawings >= 10, "{drawings} drawings");
}

#[test]
fn the_recipe_for_ram_adds_up() {
    /// `ListMemory<V, T>`, where a length has so many bytes.
    const fn memory(v: usize, t: usize, length: usize) -> usize {
        16 * v + 8 * t + (2 * t).next_multiple_of(length) + 3 * length
    }
    // Of this machine. On a microcontroller a length has 4 bytes.
    let here = size_of::<usize>();
    assert_eq!(memory(546, 429, here), ListMemory::<546, 429>::BYTES);
    assert_eq!(memory(151, 133, here), ListMemory::<151, 133>::BYTES);
    let (_, page) = pages().into_iter().find(|(name, _)| name == "memory").expect("the page");
    let numbers = |cell: &str| -> Vec<usize> {
        let digits = |c: char| !c.is_ascii_digit();
        cell.split([',', '×']).filter_map(|part| part.replace(digits, "").parse().ok()).collect()
    };
    let mut rows = 0;
    for line in page.lines().skip_while(|line| !line.contains("bytes without the stack")).skip(2) {
        let cells: Vec<_> = line.split('|').map(str::trim).collect();
        let [_, screen, height, buffers, capacity, bytes, _] = cells[..] else { break };
        let (screen, buffers) = (numbers(screen), numbers(buffers));
        let bands = screen[0] * numbers(height)[0] * 2 * (buffers[0] + buffers[1]);
        let list = match numbers(capacity)[..] {
            [v, t, n] => memory(v, t, 4) + 32 + 148 * n,
            _ => 0,
        };
        assert_eq!(numbers(bytes), [bands + list], "{line}");
        rows += 1;
    }
    assert_eq!(rows, 6);

    // What was counted for the scene of two of these rows, and for how much longer a frame takes in low bands.
    let counted: Vec<_> = include_str!("../examples/firmware/bands.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(' ').collect::<Vec<_>>())
        .collect();
    let of = |rows: &str, column: usize| -> usize {
        let line = counted.iter().find(|line| line[0] == rows).expect("a line of bands.txt");
        line[column].parse().expect("a number")
    };
    let spaced = |bytes: usize| format!("{} {:03}", bytes / 1000, bytes % 1000);
    for rows in ["16", "8"] {
        let row = format!("| 240 × 320 | {rows} | 1, 1 | 546, 429, 3 | {} |", spaced(of(rows, 1)));
        assert!(page.contains(&row), "the page has no {row}");
    }
    let longer = ["64", "32", "16", "8", "4"]
        .map(|rows| format!("{} %", (of(rows, 2) * 1000 / of("whole", 2) - 1000 + 5) / 10));
    let row = format!("| longer by | 0 | {} |", longer.join(" | "));
    assert!(page.contains(&row), "the page has no {row}");
}

#[test]
fn the_tables_name_tests_that_there_are() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for line in include_str!("README.md").lines().filter(|line| line.starts_with('|')) {
        for name in line.split('`').skip(1).step_by(2) {
            let Some((file, function)) = name.split_once("::") else { continue };
            let file = if file.contains('/') { format!("{file}.rs") } else { format!("tests/{file}.rs") };
            let text =
                std::fs::read_to_string(root.join(&file)).unwrap_or_else(|_| panic!("{name}: no {file}"));
            assert!(text.contains(&format!("fn {function}(")), "{name}: {file} has no such test");
            count += 1;
        }
    }
    println!("{count} tests are named");
    assert!(count > 120);
}
