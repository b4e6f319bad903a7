//! `fixel-bake`: models and pictures for fixel, on the command line.

use clap::Parser;
use fixel_bake::{Bake, BakeError, ByteOrder, Picture, view, write_binaries, write_module};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Makes meshes, textures and materials for fixel of models (OBJ, glTF, GLB) and pictures (PNG, JPEG, BMP, TGA).
#[derive(Debug, Parser)]
#[command(version)]
#[expect(clippy::struct_excessive_bools, reason = "they are switches")]
struct Arguments {
    /// Models and pictures.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Where to write; without it nothing is written, only looked at.
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Write files for `Mesh::from_bytes` and `Texture::from_bytes` in place of modules of Rust.
    #[arg(long)]
    binary: bool,
    /// … for machines whose words have the upper byte first.
    #[arg(long, requires = "binary")]
    big_endian: bool,
    /// Write a picture of each model, too: a PNG of 240 × 240.
    #[arg(long, requires = "out")]
    picture: bool,
    /// Put the middle of the model at its origin.
    #[arg(long)]
    center: bool,
    /// World units a model unit.
    #[arg(long, value_name = "LENGTH")]
    unit: Option<f64>,
    /// World units that the longest side of the model is long.
    #[arg(long, value_name = "LENGTH", conflicts_with = "unit")]
    size: Option<f64>,
    /// Triangles that meet at more degrees have an edge between them, where normals are computed.
    #[arg(long, value_name = "DEGREES", default_value_t = 40.0)]
    crease: f64,
    /// The longest side of textures.
    #[arg(long, value_name = "TEXELS", default_value_t = 128, value_parser = clap::value_parser!(u32).range(1..=1024))]
    longest_side: u32,
    /// Materials on which no light falls.
    #[arg(long)]
    unlit: bool,
    /// A mesh for each object, not only for each material.
    #[arg(long)]
    by_object: bool,
    /// Search longer for a good order of triangles.
    #[arg(long)]
    thorough: bool,
    /// Make warnings errors.
    #[arg(long)]
    strict: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut failed = 0;
    for path in &arguments.files {
        if let Err(error) = one(path, &arguments) {
            eprintln!("error: {error}");
            failed += 1;
        }
    }
    if failed > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn one(path: &Path, arguments: &Arguments) -> Result<(), BakeError> {
    let order = if arguments.big_endian { ByteOrder::Big } else { ByteOrder::Little };
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if matches!(ending.as_str(), "png" | "jpg" | "jpeg" | "bmp" | "tga") {
        let picture = Picture::new(path).longest_side(arguments.longest_side);
        let baked = match &arguments.out {
            Some(folder) if arguments.binary => picture.write_binaries(folder, order)?,
            Some(folder) => picture.write(folder)?,
            None => picture.bake()?,
        };
        let ([width, height], size) = (baked.source, baked.size());
        let mask = if baked.mask.is_some() { ", with a mask" } else { "" };
        println!(
            "{}: {width} × {height} → {} × {} texels{mask}, {} B of flash",
            path.display(),
            size.width,
            size.height,
            baked.flash()
        );
        return Ok(());
    }
    let mut bake = Bake::new(path).crease(arguments.crease).longest_side(arguments.longest_side);
    type Switch = fn(Bake) -> Bake;
    let switches: [(bool, Switch); 5] = [
        (arguments.center, Bake::center),
        (arguments.unlit, Bake::unlit),
        (arguments.by_object, Bake::by_object),
        (arguments.thorough, Bake::thorough),
        (arguments.strict, Bake::strict),
    ];
    for (_, switch) in switches.into_iter().filter(|(is_on, _)| *is_on) {
        bake = switch(bake);
    }
    if let Some(unit) = arguments.unit {
        bake = bake.unit(unit);
    }
    if let Some(size) = arguments.size {
        bake = bake.size(size);
    }
    // It hides itself where nobody looks, and where the work is done at once.
    let bar = ProgressBar::new(1);
    if let Ok(style) = ProgressStyle::with_template("{msg:9} {wide_bar} {pos}/{len} {eta}") {
        bar.set_style(style);
    }
    let baked = bake.bake_with(&mut |work, done, all| {
        bar.set_message(work.to_owned());
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let baked = baked?;
    for warning in &baked.warnings {
        eprintln!("warning: {warning}");
    }
    println!("{}\n{baked}", path.display());
    if let Some(folder) = &arguments.out {
        let mut paths = if arguments.binary {
            write_binaries(&baked, folder, order)?
        } else {
            write_module(&baked, folder)?
        };
        if arguments.picture {
            let path = folder.join(format!("{}.png", baked.name));
            let (picture, _) = view::draw(&baked, 240, [30.0, 20.0]);
            let saved = picture.save(&path);
            saved.map_err(|error| BakeError::Write {
                path: path.clone(),
                source: std::io::Error::other(error),
            })?;
            paths.push(path);
        }
        paths.iter().for_each(|path| println!("  wrote            {}", path.display()));
    }
    Ok(())
}
