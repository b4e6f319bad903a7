//! The promises, a file each, in one program: what they share is compiled once.
//!
//! `cargo test coverage::` runs those of one file.

mod common;
mod reference;

mod assets;
mod attributes;
mod band;
mod bands;
mod compile;
mod coverage;
mod decoded;
mod depth;
mod direct;
mod displays;
mod dma;
mod docs;
mod extremes;
mod fog;
mod formats;
mod house;
mod materials;
mod probe;
mod robustness;
mod surfaces;
mod transform;
mod transparency;
mod views;
mod yardstick;

/// One that is missing above would not be run, and nobody would see it.
#[test]
fn every_file_is_in_the_program() {
    let program = include_str!("promises.rs");
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let files = std::fs::read_dir(folder).expect("the tests are where they were compiled");
    let paths = files.map(|file| file.expect("a file").path());
    let names = paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| path.file_stem().and_then(|name| name.to_str()).expect("a name").to_owned());
    let others: Vec<_> = names.filter(|name| name != "promises").collect();
    assert!(others.len() > 16);
    for name in others {
        assert!(program.lines().any(|line| line == format!("mod {name};")), "tests/{name}.rs is not run");
    }
}
