//! Highlights, mirrors and glass by every kernel, against the f64 reference.

use host_tools::compare::compare;
use host_tools::engine::ENGINES;
use host_tools::import;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;

#[test]
fn the_gallery() {
    let sizes: Vec<u32> =
        std::env::var("SIZES").map_or(vec![256, 160], |s| s.split(',').map(|s| s.parse().unwrap()).collect());
    for scene in ["materials", "glass", "mirrors"] {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/gallery/{scene}/scene.toml"));
        let mut model = import::load(&path).expect("a scene of the gallery").model;
        model.spheres.clear();
        model.render.samples = 1;
        for &size in &sizes {
            let size = if size == 160 { [160, 128] } else { [size; 2] };
            model.render.size = size;
            let [width, height] = size;
            let (pixels, _) = Reference::new(&model).render(size, &|_| {});
            let truth = Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize]);
            truth.write_png(std::path::Path::new(&format!("/tmp/w-{scene}-{width}-ref.png"))).unwrap();
            for engine in ENGINES {
                if !["exact29", "exact14", "hanika-cons", "hanika-cd", "f32"].contains(&engine.name()) {
                    continue;
                }
                let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
                let rendered = engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made");
                let apart = compare(&rendered.picture, &truth).expect("one size");
                rendered
                    .picture
                    .write_png(std::path::Path::new(&format!("/tmp/w-{scene}-{width}-{}.png", engine.name())))
                    .unwrap();
                println!(
                    "{scene} {width} {}: over 64 {}, over 4 {}, over 1 {}, psnr {:.1}; {:?}",
                    engine.name(),
                    apart.over_64,
                    apart.over_4,
                    apart.over_1,
                    apart.psnr.unwrap_or(99.0),
                    rendered.counts
                );
            }
        }
    }
}
