//! Textures and colours of vertices by every kernel, against the f64 reference.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use host_tools::compare::{Comparison, compare};
use host_tools::engine::{self, ENGINES};
use host_tools::import;
use host_tools::model::{Background, Camera, Filter, Material, Model, Projection, RenderSettings, Texture, Triangle};
use host_tools::picture::Picture;
use host_tools::prepare::{Options, unplaced};
use host_tools::reference::Reference;
use tests::random::SplitMix64;

fn gallery(size: [u32; 2], filter: Filter) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery/textures/scene.toml");
    let mut model = import::load(&path).expect("a scene of the gallery").model;
    (model.render.size, model.render.filter) = (size, filter);
    model
}

fn truth(model: &Model) -> Picture {
    Reference::new(model).picture(&|_| {})
}

fn rendered(model: &Model, kernel: &str) -> Picture {
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    let blob = engine.prepare(model, &Options::default()).expect("it fits").blob;
    engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

fn apart(model: &Model, kernel: &str, truth: &Picture) -> Comparison {
    compare(&rendered(model, kernel), truth).expect("one size")
}

/// Pixels over 64 and over 4, of a thousand, and decibels, that a kernel's picture may be off by; with the nearest texel an
/// edge of each is a step that falls into one pixel or its neighbour.
fn allowed(kernel: &str, filter: Filter) -> (f64, f64, f64) {
    match (kernel, filter) {
        ("exact14", Filter::Nearest) => (6.0, 40.0, 32.0),
        ("exact14", Filter::Bilinear) => (1.0, 100.0, 42.0),
        (_, Filter::Nearest) => (0.1, 0.5, 50.0),
        (_, Filter::Bilinear) => (0.1, 0.2, 50.0),
    }
}

#[test]
fn the_gallery_by_every_kernel() {
    for filter in [Filter::Nearest, Filter::Bilinear] {
        for size in [[256, 256], [160, 128]] {
            let model = gallery(size, filter);
            let truth = truth(&model);
            for engine in ENGINES {
                let found = apart(&model, engine.name(), &truth);
                let per_mille = |count: u64| count as f64 * 1000.0 / f64::from(size[0] * size[1]);
                let (over_64, over_4) = (per_mille(found.over_64), per_mille(found.over_4));
                let psnr = found.psnr.unwrap_or(f64::INFINITY);
                let told = format!(
                    "{filter:?} {size:?} {}: over 64 {}, over 4 {}, over 1 {}, {psnr:.1} dB",
                    engine.name(),
                    found.over_64,
                    found.over_4,
                    found.over_1
                );
                println!("{told}");
                let (most_64, most_4, least) = allowed(engine.name(), filter);
                assert!(over_64 <= most_64 && over_4 <= most_4 && psnr >= least, "{told}");
            }
        }
    }
}

#[test]
fn a_picture_without_its_paint_is_told() {
    let model = gallery([160, 128], Filter::Bilinear);
    let truth = truth(&model);
    let over_4 = |change: &dyn Fn(&mut Model)| {
        let mut other = model.clone();
        change(&mut other);
        apart(&other, "exact29", &truth).over_4
    };
    let all = 160 * 128;
    assert!(over_4(&|m| m.uvs.clear()) > all / 2);
    assert!(over_4(&|m| m.colours.clear()) > all / 50);
    assert!(over_4(&|m| m.render.filter = Filter::Nearest) > all / 10);
    let upside_down = |m: &mut Model| m.uvs.iter_mut().flatten().flatten().for_each(|uv| uv.y = -uv.y);
    assert!(over_4(&upside_down) > all / 10);
}

/// A ground of so many repeats of a texture, seen at a grazing angle.
fn ground(side: [u32; 2], repeats: f64, filter: Filter) -> Model {
    let mut random = SplitMix64(5);
    let texels = (0..side[0] * side[1]).map(|_| [0; 3].map(|_| random.below(256) as u8)).collect();
    let material = Material { texture: Some(Arc::new(Texture { size: side, texels })), ..Material::default() };
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let uv = |x: f64, y: f64| DVec2::new(x * repeats - 0.3, y * repeats + 0.7);
    let triangle = |vertices| Triangle { vertices, normals: None, material: 0 };
    Model {
        positions: vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)],
        triangles: vec![triangle([0, 1, 2]), triangle([0, 2, 3])],
        uvs: vec![Some([uv(0.0, 0.0), uv(1.0, 0.0), uv(1.0, 1.0)]), Some([uv(0.0, 0.0), uv(1.0, 1.0), uv(0.0, 1.0)])],
        materials: vec![material],
        camera: Camera {
            position: DVec3::new(0.1, 0.12, 1.1),
            look_at: DVec3::new(0.0, -0.1, 0.0),
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.9 },
        },
        background: Background::Colour(DVec3::new(0.0, 0.0, 1.0)),
        render: RenderSettings { size: [128, 96], ambient: DVec3::ONE, filter, ..RenderSettings::default() },
        ..Model::default()
    }
}

/// Any size, up to the most repeats.
#[test]
fn odd_sizes_and_many_repeats() {
    for side in [[1, 1], [3, 5], [4096, 1], [1, 7], [127, 63]] {
        // Over so many texels the rounding of coordinates shows: what is seen is noise by then.
        let most = (200_000.0 / f64::from(side[0])).min(1000.0);
        for repeats in [0.01, 1.0, 37.5, most] {
            let model = ground(side, repeats, Filter::Bilinear);
            assert_eq!(unplaced(&model), None);
            let truth = truth(&model);
            for kernel in ["exact29", "f64", "hanika-cons"] {
                let found = apart(&model, kernel, &truth);
                let told = format!("{side:?} {repeats} {kernel}: over 64 {}, over 4 {}", found.over_64, found.over_4);
                println!("{told}");
                assert!(found.over_64 <= 2 && found.over_4 <= 10, "{told}");
            }
        }
    }
}

#[test]
fn more_repeats_than_a_blob_holds_are_said() {
    let model = ground([2, 2], 1023.0, Filter::Nearest);
    let expected = "triangles with over 1022 repeats of their texture, drawn without it: 2";
    assert_eq!(unplaced(&model).as_deref(), Some(expected));
    let [first, ..] = rendered(&model, "exact29").pixels()[96 / 2 * 128..] else { panic!("pixels") };
    assert!(first.iter().all(|&channel| channel == 231), "0.8 of white light: {first:?}");
}
