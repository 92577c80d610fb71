//! Pictures of spheres by every kernel beside those of the f64 reference: matt, mirrors, glass; among triangles and alone; from
//! outside and from within.

use std::path::Path;

use glam::DVec3;
use host_tools::compare::compare;
use host_tools::engine::ENGINES;
use host_tools::import::{self, Embedded};
use host_tools::model::{Background, Falloff, MaterialKind, Model};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;

/// The gallery's scene of spheres with what this is about and nothing else.
fn gallery() -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery/spheres/scene.toml");
    let mut model = import::load(&path).expect("a scene of the gallery").model;
    model.background = Background::Colour(DVec3::new(0.3, 0.4, 0.5));
    model.render.samples = 1;
    for light in &mut model.lights {
        light.falloff = Falloff::None;
    }
    for material in &mut model.materials {
        (material.checker, material.tinted_shadow) = (None, false);
        if material.kind == MaterialKind::Metal {
            material.weights = Some([0.0, 1.0, 1.0, 0.0]);
        }
    }
    model
}

/// No triangle: three spheres on one that is hundreds of times as large.
const ALONE: &str = "[camera]\nposition = [0, 1, 6]\nlook_at = [0, 0.6, 0]\n[[light]]\nposition = [3, 5, 4]\n\
    [[sphere]]\ncentre = [0, -100, 0]\nradius = 100\nmaterial = 'ground'\n\
    [[sphere]]\ncentre = [0, 1, 0]\nradius = 1\nmaterial = 'glass'\n\
    [[sphere]]\ncentre = [1.8, 0.7, -1]\nradius = 0.7\nmaterial = 'steel'\n\
    [[sphere]]\ncentre = [-1.5, 0.4, 1]\nradius = 0.4\nmaterial = 'red'\n\
    [material.ground]\ncolour = [0.5, 0.6, 0.4]\n[material.glass]\nkind = 'dielectric'\nior = 1.5\n\
    [material.steel]\nkind = 'mirror'\ncolour = [0.8, 0.82, 0.85]\n[material.red]\ncolour = [0.7, 0.1, 0.1]\n\
    [background]\ncolour = [0.3, 0.4, 0.6]\n";

/// The eye and the light in a hollow mirror with a bubble of glass and a ball in it: rays that leave a sphere inwards, and meet it
/// again, as often as they may. What leaked out would see the background.
const HOLLOW: &str = "[camera]\nposition = [0, 0, 3]\nlook_at = [0.2, 0, 0]\nfov_y = 70\n[[light]]\nposition = [1, 2, 2]\n\
    [[sphere]]\ncentre = [0, 0, 0]\nradius = 4\nmaterial = 'mirror'\n\
    [[sphere]]\ncentre = [-0.8, 0, 0]\nradius = 0.8\nmaterial = 'glass'\n\
    [[sphere]]\ncentre = [1.2, -0.3, -1]\nradius = 0.9\nmaterial = 'red'\n\
    [material.mirror]\ncolour = [0.9, 0.9, 0.9]\nweights = [0.2, 0, 0.8, 0]\n\
    [material.glass]\nkind = 'dielectric'\nior = 1.5\n[material.red]\ncolour = [0.7, 0.1, 0.1]\n\
    [background]\ncolour = [0, 1, 0]\n[render]\nmax_depth = 6\n";

fn of(toml: &str) -> Model {
    import::load_from(&Embedded(&[("s.toml", toml.as_bytes())]), "s.toml").expect("a good scene").model
}

/// The most pixels of a thousand that may be off by over 64 and over 4 gray levels, summed over the channels: by the kernel's
/// name, or by the beginning of it.
type Bounds = [(&'static str, [f64; 2]); 4];

#[track_caller]
fn agrees(name: &str, mut model: Model, bounds: Bounds) {
    model.render.size = [256, 256];
    let (pixels, _) = Reference::new(&model).render(model.render.size, &|_| {});
    let truth = Picture::from_fn(256, 256, |x, y| pixels[(y * 256 + x) as usize]);
    for engine in ENGINES {
        let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
        let rendered = engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made");
        let apart = compare(&rendered.picture, &truth).expect("one size");
        let share = [apart.over_64, apart.over_4].map(|count| count as f64 * 1000.0 / 65_536.0);
        println!("{name}, {}: {share:.2?} of a thousand", engine.name());
        if let Some(folder) = std::env::var_os("INTRAY_PICTURES") {
            let path = Path::new(&folder).join(format!("{name}-{}.png", engine.name()));
            rendered.picture.write_png(&path).expect("a folder for pictures");
        }
        let (_, bound) = bounds.iter().find(|(start, _)| engine.name().starts_with(start)).expect("a bound for each");
        assert!(share[0] <= bound[0] && share[1] <= bound[1], "{name}, {}: {share:.2?}", engine.name());
    }
}

#[test]
fn among_triangles() {
    agrees(
        "gallery",
        gallery(),
        [("exact14", [0.9, 3.2]), ("exact", [0.1; 2]), ("hanika", [0.03; 2]), ("f", [0.03; 2])],
    );
}

#[test]
fn alone() {
    agrees(
        "alone",
        of(ALONE),
        [("exact14", [3.5, 30.0]), ("exact", [0.1, 0.3]), ("hanika", [0.03; 2]), ("f", [0.05; 2])],
    );
}

#[test]
fn in_a_hollow_mirror() {
    agrees(
        "hollow",
        of(HOLLOW),
        [("exact14", [1.0, 4.8]), ("exact", [0.05; 2]), ("hanika", [0.03; 2]), ("f", [0.05; 2])],
    );
}
