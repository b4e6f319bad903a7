//! Every library draws what fixel draws: the pictures are in `target/tmp/pictures`.

use fixel_peers::libraries::LIBRARIES;
use fixel_peers::library::Library;
use fixel_peers::picture::Picture;
use fixel_peers::scene::{SCENES, Scene, Surface};
use std::fs;
use std::path::Path;

#[test]
fn every_picture_is_fixels() {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    fs::create_dir_all(&directory).expect("the target directory can be written");
    let mut failures = Vec::new();
    println!("{:24}{:12}{:>8}{:>10}{:>10}", "library", "scene", "pixels", "coverage", "colour");
    for scene in &SCENES {
        let mut ours = None;
        for library in LIBRARIES {
            let Ok(mut painter) = library.painter(scene) else { continue };
            let picture = Picture::new(&mut *painter);
            let file = format!("{}-{}.png", scene.name, library.name());
            picture.save(&directory.join(file)).expect("as above");
            let ours = ours.get_or_insert_with(|| picture.clone());
            let difference = picture.difference(ours);
            println!(
                "{:24}{:12}{:8}{:+9.2} %{:8.2} %",
                library.name(),
                scene.name,
                picture.covered(),
                difference.coverage * 100.0,
                difference.color * 100.0
            );
            if difference.coverage.abs() > 0.03 || difference.color > tolerance(library, scene) {
                failures.push((library.name(), scene.name, difference));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// The largest mean difference of colours to fixel's, as a share of white.
fn tolerance(library: &dyn Library, scene: &Scene) -> f32 {
    match (library.name(), scene.surface) {
        // Large triangles show how its textures bend; that they are the right way round s3_tex shows.
        ("embedded-3dgfx", Surface::Textured) => 0.16,
        // Less ambient light.
        ("embedded-3dgfx", Surface::Lit) => 0.055,
        // And texels in light are cut, where fixel rounds them: half a step of 5 bits, 1.6 %.
        ("embedded-3dgfx", Surface::TexturedLit) => 0.06,
        _ => 0.03,
    }
}
