//! Without a command: the built-in scene, and how far it is from f64.

use std::path::Path;

use super::failure::Failure;
use super::load::Scene;
use super::{output, progress, render};
use crate::compare::compare;
use crate::engine::ENGINES;
use crate::files;
use crate::import::{self, Embedded};
use crate::picture::Picture;
use crate::prepare::Options;
use crate::reference::Reference;
use crate::{builtin, model::Model};

const OUTPUT: &str = "out/demo.png";

pub(super) fn run() -> Result<(), Failure> {
    create_folder(Path::new(OUTPUT))?;
    files::check_writable(Path::new(OUTPUT))?;
    let model = import::load_from(&Embedded(builtin::FILES), "scene.toml")?.model;
    let [width, height] = model.render.size;
    let reference = reference(&model);

    let mut rows = Vec::new();
    for engine in ENGINES {
        let prepared = engine.prepare(&model, &Options::default())?;
        let scene = Scene { engine, blob: prepared.blob, degenerates: Some(prepared.degenerates), choice: None };
        let picture = render::picture(&scene, false)?.picture;
        let apart = compare(&picture, &reference)?;
        rows.push(format!(
            "  {:<8} {:>8} {:>8} {:>8} {:>10.1} {:>12}",
            engine.name(),
            apart.over_1,
            apart.over_4,
            apart.over_64,
            apart.psnr.unwrap_or(f64::INFINITY),
            scene.blob.bytes().len(),
        ));
        if engine.id() == ENGINES[0].id() {
            picture.write_png(Path::new(OUTPUT))?;
        }
    }

    output::line(&format!(
        "{OUTPUT}: {} triangles at {width}x{height}, by {} and integers alone\n\n\
         Of {} pixels, so many differ from an independent f64 tracer:\n\
         \x20          over 1/255    over 4  over 64  PSNR in dB   blob bytes\n\
         {}\n\n\
         What to try next:\n\
         \x20 intray render SCENE -o out.png      your own .obj, or a scene.toml with camera and lights\n\
         \x20 intray inspect SCENE                what is in it, and what it takes\n\
         \x20 intray prep SCENE -o scene.blob     the bytes that a chip renders from\n\
         \x20 intray --help                       everything else (from the sources: cargo run --release -- --help)",
        model.triangles.len(),
        ENGINES[0].name(),
        u64::from(width) * u64::from(height),
        rows.join("\n"),
    ))
}

fn reference(model: &Model) -> Picture {
    let [width, height] = model.render.size;
    let bar = progress::bar("reference", u64::from(width) * u64::from(height));
    let picture = Reference::new(model).picture(&|pixels| bar.inc(pixels));
    bar.finish_and_clear();
    picture
}

fn create_folder(file: &Path) -> Result<(), Failure> {
    let Some(folder) = file.parent() else { return Ok(()) };
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::input(format!("{}: cannot make this folder: {error}", folder.display())))
}
