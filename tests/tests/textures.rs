//! Textures and colours of vertices by every kernel, against the f64 reference.

use std::path::Path;

use host_tools::compare::{Comparison, compare};
use host_tools::engine::ENGINES;
use host_tools::import;
use host_tools::model::{Filter, Model};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;

fn gallery() -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery/textures/scene.toml");
    import::load(&path).expect("a scene of the gallery").model
}

fn truth(model: &Model) -> Picture {
    let [width, height] = model.render.size;
    let (pixels, _) = Reference::new(model).render([width, height], &|_| {});
    Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize])
}

#[test]
fn the_gallery() {
    let mut model = gallery();
    for filter in [Filter::Nearest, Filter::Bilinear] {
        model.render.filter = filter;
        for size in [[256, 256], [160, 128], [1024, 1024]] {
            model.render.size = size;
            let truth = truth(&model);
            let shown = |picture: &Picture, name: &str| {
                picture.write_png(Path::new(&format!("/tmp/t-{filter:?}-{}-{name}.png", size[0]))).unwrap();
            };
            shown(&truth, "ref");
            for engine in ENGINES {
                let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
                let rendered = engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made");
                shown(&rendered.picture, engine.name());
                let apart: Comparison = compare(&rendered.picture, &truth).expect("one size");
                println!(
                    "{filter:?} {size:?} {}: over 64 {}, over 4 {}, over 1 {}, psnr {:.1}; {} bytes",
                    engine.name(),
                    apart.over_64,
                    apart.over_4,
                    apart.over_1,
                    apart.psnr.unwrap_or(99.0),
                    blob.bytes().len(),
                );
            }
        }
    }
}
