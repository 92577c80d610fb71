//! The README's picture and figures are what the program makes. `INTRAY_BLESS=1` renews them.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use host_tools::compare::compare;
use host_tools::engine::ENGINES;
use host_tools::import::{self, Embedded};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use host_tools::{builtin, files};

const BEGIN: &str = "<!-- generated: figures -->\n";
const END: &str = "<!-- end of generated -->\n";

fn root(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

/// The text with what stands between the marks replaced.
fn replaced(text: &str, figures: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}{figures}{END}{after}"))
}

#[test]
fn the_readme_shows_what_the_program_makes() {
    let mut model = import::load_from(&Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model;
    let mut table = String::from(
        "| kernel | picture | blob, bytes | over 1 | over 4 | over 64 | PSNR, dB |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let mut shown = None;
    for size in [[640, 480], [160, 128]] {
        model.render.size = size;
        let [width, height] = size;
        let (pixels, _) = Reference::new(&model).render(size, &|_| {});
        let truth = Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize]);
        for engine in ENGINES {
            let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
            let picture = engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture;
            let apart = compare(&picture, &truth).expect("one size");
            let (name, bytes, psnr) = (engine.name(), blob.bytes().len(), apart.psnr.unwrap_or(f64::INFINITY));
            writeln!(
                table,
                "| `{name}` | {width}x{height} | {bytes} | {} | {} | {} | {psnr:.1} |",
                apart.over_1, apart.over_4, apart.over_64
            )
            .expect("a string takes text");
            shown.get_or_insert(picture);
        }
    }

    let shown = shown.expect("there are kernels");
    let readme = String::from_utf8(files::read(&root("README.md")).expect("a README")).expect("it is text");
    let expected = replaced(&readme, &table).expect("the README has the marks");
    if std::env::var_os("INTRAY_BLESS").is_some() {
        files::write_atomically(&root("README.md"), expected.as_bytes()).expect("it can be written");
        shown.write_png(&root("docs/demo.png")).expect("it can be written");
    }
    let stored = Picture::read_png(&root("docs/demo.png")).expect("the README's picture");
    assert!(stored == shown, "docs/demo.png is not what the program renders; INTRAY_BLESS=1 renews it");
    assert!(
        readme == expected || std::env::var_os("INTRAY_BLESS").is_some(),
        "README.md: INTRAY_BLESS=1 renews the figures"
    );
}

#[test]
fn marks_are_needed_and_stale_figures_are_seen() {
    assert_eq!(replaced("no marks", "x"), None);
    let text = format!("a\n{BEGIN}old\n{END}b\n");
    assert_eq!(replaced(&text, "new\n").as_deref(), Some(format!("a\n{BEGIN}new\n{END}b\n").as_str()));
}
