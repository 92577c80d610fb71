//! Whole pictures.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use host_tools::model::{LightKind, Transfer};
use host_tools::reference::{Reference, encode};

use crate::{BACKGROUND, cuboid, model, sphere};

#[test]
fn pictures_do_not_depend_on_the_unit_of_length() {
    let picture = |scale: f64| {
        let offset = DVec3::new(0.31, 0.17, 1.5);
        let mut corners = sphere(12);
        let plate = cuboid([0, 0, 0], [900_000, 300_000, 1_000_000]);
        corners.extend(plate.iter().map(|triangle| triangle.map(|corner| corner * 3.0)));
        for corner in corners.iter_mut().flatten() {
            *corner = (*corner + offset) * scale;
        }
        let lamp = DVec3::new(3.0, 4.0, 2.0) * scale;
        let mut scene = model(&corners, &[LightKind::Point(lamp)]);
        scene.camera.position *= scale;
        let (bytes, hits) = Reference::new(&scene).render([96, 64], &|_| ());
        let prims: Vec<_> = hits.iter().map(|hit| hit.map(|hit| hit.prim)).collect();
        (bytes, prims)
    };
    let unit = picture(1.0);
    assert!(unit.1.iter().flatten().count() > 1000);
    for scale in [1e-6, 1e6, 1e-30, 1e30] {
        assert!(picture(scale) == unit, "at {scale}");
    }
}

#[test]
fn a_picture_is_its_pixels_row_by_row() {
    let mut scene = model(&sphere(4), &[LightKind::Point(DVec3::new(2.0, 3.0, 5.0))]);
    for transfer in [Transfer::Srgb, Transfer::Linear] {
        scene.render.transfer = transfer;
        let tracer = Reference::new(&scene);
        let (size, done) = ([40, 30], AtomicU64::new(0));
        let (bytes, hits) = tracer.render(size, &|pixels| {
            done.fetch_add(pixels, Ordering::Relaxed);
        });
        assert_eq!((done.into_inner(), bytes.len(), hits.len()), (1200, 1200, 1200));
        for (i, (&rgb, &hit)) in bytes.iter().zip(&hits).enumerate() {
            let sample = tracer.pixel(size, i as u32 % 40, i as u32 / 40);
            assert_eq!((rgb, hit), (encode(sample.colour, transfer), sample.hit));
        }
        assert_eq!(bytes[0], encode(BACKGROUND, transfer));
        assert!(hits.iter().flatten().count() > 10);
    }
}
