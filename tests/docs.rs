//! The dozen lines stand in three places: the example that is run, the crate's front page, and README. And the tables of
//! tests/README.md name tests that there are.

/// From the first to the last of the dozen lines, without what only one of the places has.
fn dozen_lines(text: &str, prefix: &str) -> Vec<String> {
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
fn the_example_the_front_page_and_readme_show_the_same_lines() {
    let example = dozen_lines(include_str!("../examples/hello_triangle.rs"), "");
    assert!(example.len() > 12);
    assert_eq!(example, dozen_lines(include_str!("../src/lib.rs"), "//!"), "crate documentation");
    assert_eq!(example, dozen_lines(include_str!("../README.md"), ""), "README");
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
