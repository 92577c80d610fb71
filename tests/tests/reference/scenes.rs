//! The scenes of the project that are made of everything: they are what they say, and raystones is what a direct
//! implementation of its facts makes of it.

use std::path::{Path, PathBuf};

use glam::DVec3;
use host_tools::import;
use host_tools::model::{MaterialKind, Model};
use host_tools::reference::Reference;

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name).join("scene.toml")
}

fn imported(name: &str) -> Model {
    let imported = import::load(&scene(name)).unwrap();
    assert_eq!(imported.warnings, [], "{name}");
    imported.model
}

#[test]
fn the_gallery_has_every_kind_of_surface_and_nothing_is_lost_in_the_dark() {
    let mut kinds = Vec::new();
    for name in ["materials", "spheres", "mirrors", "glass"] {
        let mut model = imported(&format!("gallery/{name}"));
        assert_eq!((model.render.size, model.render.max_depth), ([1024, 1024], 10));
        kinds.extend(model.materials.iter().map(|material| material.kind));
        model.render.size = [64, 64];
        let (pixels, hits) = Reference::new(&model).render([64, 64], &|_| ());
        let dark = pixels.iter().filter(|pixel| pixel.iter().all(|&byte| byte < 8)).count();
        assert!(dark < 64, "{name}: {dark}");
        assert!(hits.iter().flatten().count() > 1500, "{name}");
    }
    for kind in [MaterialKind::Lambert, MaterialKind::Metal, MaterialKind::Dielectric, MaterialKind::Mirror] {
        assert!(kinds.contains(&kind), "{kind:?}");
    }
}

/// Centre, radius, index, weights, colour, exponent.
type Ball = ([f64; 3], f64, f64, [f64; 4], [f64; 3], f64);

const BALLS: [Ball; 4] = [
    ([-3.0, 0.0, -16.0], 2.0, 1.0, [0.6, 0.3, 0.1, 0.0], [0.4, 0.4, 0.3], 50.0),
    ([-1.0, -1.5, -12.0], 2.0, 1.5, [0.0, 0.5, 0.1, 0.8], [0.6, 0.7, 0.8], 125.0),
    ([1.5, -0.5, -18.0], 3.0, 1.0, [0.9, 0.1, 0.0, 0.0], [0.3, 0.1, 0.1], 10.0),
    ([7.0, 5.0, -18.0], 4.0, 1.0, [0.0, 10.0, 0.8, 0.0], [1.0, 1.0, 1.0], 142.0),
];

const LAMPS: [([f64; 3], f64); 3] = [([-20.0, 20.0, 20.0], 1.5), ([30.0, 50.0, -25.0], 1.8), ([30.0, 20.0, 30.0], 1.7)];

/// Distance, normal towards the viewer, and the ball's row in the table, or none for the floor.
fn nearest(origin: DVec3, direction: DVec3) -> Option<(f64, DVec3, Option<&'static Ball>)> {
    let mut found: Option<(f64, DVec3, Option<&Ball>)> = None;
    let floor = (-4.0 - origin.y) / direction.y;
    let point = origin + direction * floor;
    if floor > 1e-9 && point.x.abs() < 10.0 && point.z > -30.0 && point.z < -10.0 {
        found = Some((floor, DVec3::Y * -direction.y.signum(), None));
    }
    for ball in &BALLS {
        let centre = DVec3::from(ball.0);
        let along = (centre - origin).dot(direction);
        let aside = (origin + direction * along - centre).length_squared();
        if aside > ball.1 * ball.1 {
            continue;
        }
        let half = (ball.1 * ball.1 - aside).sqrt();
        for distance in [along - half, along + half] {
            if distance > 1e-9 && found.is_none_or(|(least, ..)| distance < least) {
                let normal = (origin + direction * distance - centre) / ball.1;
                let normal = if distance == along - half { normal } else { -normal };
                found = Some((distance, normal, Some(ball)));
            }
        }
    }
    found
}

/// The facts of the scene, one after the other.
fn raystones(origin: DVec3, d: DVec3, depth: u32) -> DVec3 {
    let Some((distance, n, ball)) = nearest(origin, d).filter(|_| depth <= 2) else {
        return (d.y + 1.0) / 2.0 * DVec3::new(0.2, 0.7, 1.3);
    };
    let p = origin + d * distance;
    let inside = ball.is_some_and(|ball| p.distance(DVec3::from(ball.0)) > origin.distance(DVec3::from(ball.0)));
    let ([diffuse, specular, reflected, refracted], colour, exponent, ior) = match ball {
        Some(&(_, _, ior, weights, colour, exponent)) => (weights, DVec3::from(colour), exponent, ior),
        None => {
            let is_even =
                ((p.x / 2.0 + 1.0 / 1024.0).floor() + (p.z / 2.0 + 1.0 / 1024.0).floor()).rem_euclid(2.0) == 0.0;
            let colour = if is_even { DVec3::splat(0.3) } else { DVec3::new(0.3, 0.2, 0.1) };
            ([1.0, 0.0, 0.0, 0.0], colour, 1.0, 1.0)
        }
    };
    let mirrored = |v: DVec3| v - 2.0 * n * v.dot(n);
    let [mut matt, mut shiny] = [0.0; 2];
    for (place, intensity) in LAMPS {
        let way = DVec3::from(place) - p;
        let l = way.normalize();
        let is_lit = l.dot(n) > 0.0 && nearest(p + n * 1e-9, l).is_none_or(|(first, ..)| first > way.length());
        if is_lit {
            matt += intensity * l.dot(n);
            shiny += intensity * mirrored(-l).dot(-d).max(0.0).powf(exponent);
        }
    }
    let mut sum = diffuse * matt * colour + DVec3::splat(specular * shiny);
    if reflected > 0.0 {
        sum += reflected * raystones(p + n * 1e-9, mirrored(d), depth + 1);
    }
    if refracted > 0.0 {
        let eta = if inside { ior } else { 1.0 / ior };
        let cosine = -d.dot(n);
        let below = 1.0 - eta * eta * (1.0 - cosine * cosine);
        let through = eta * d + (eta * cosine - below.sqrt()) * n;
        sum += refracted * raystones(p - n * 1e-9, through, depth + 1);
    }
    sum
}

#[test]
fn raystones_is_what_its_facts_make_of_it() {
    let mut model = imported("raystones");
    let differences = |model: &Model| {
        let tracer = Reference::new(model);
        let half = libm::tan(std::f64::consts::FRAC_PI_6);
        let differs = |&(x, y): &(u32, u32)| {
            let right = (f64::from(x) + 0.5 - 80.0) * half / 64.0;
            let up = (64.0 - f64::from(y) - 0.5) * half / 64.0;
            let expected = raystones(DVec3::ZERO, DVec3::new(right, up, -1.0).normalize(), 0);
            (tracer.pixel([160, 128], x, y).colour - expected).abs().max_element() > 1e-5
        };
        (0..128).flat_map(|y| (0..160).map(move |x| (x, y))).filter(differs).count()
    };
    let found = differences(&model);
    // Where a highlight or the edge of a shadow is steep, rays that start 1e-9 apart may differ.
    assert!(found <= 4, "{found} of 20480 pixels");
    model.spheres[1].radius += 1e-3;
    assert!(differences(&model) > 100, "the comparison must see a radius");
}
