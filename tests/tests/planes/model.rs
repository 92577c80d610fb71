//! Models in the tracer's words: what is refused, what is said, and how far the picture is from the reference.

use glam::DVec3;
use host_tools::compare::compare;
use host_tools::model::{Background, Light, LightKind, Material, MaterialKind, Model, Projection, Sphere, Triangle};
use host_tools::planes::scene::{Options, Planes, PlanesError};
use host_tools::planes::trace::Tracer;
use host_tools::planes::{Way, light, picture};
use host_tools::reference::Reference;
use host_tools::trace::Trace;
use planes_rt::widths::Widths;
use planes_simd::Lockstep;

/// Two spheres that hide nothing of the light from each other.
fn model() -> Model {
    let lambert = |colour| Material { colour, ..Material::default() };
    let mirror = Material {
        kind: MaterialKind::Mirror,
        colour: DVec3::splat(0.9),
        weights: Some([0.0, 0.0, 1.0, 0.0]),
        ..Material::default()
    };
    let mut model = Model {
        materials: vec![lambert(DVec3::new(0.9, 0.3, 0.1)), mirror],
        spheres: vec![
            Sphere { centre: DVec3::new(-1.2, 0.0, 0.0), radius: 1.0, material: 0 },
            Sphere { centre: DVec3::new(1.2, 0.0, 0.0), radius: 1.0, material: 1 },
        ],
        lights: vec![Light::new(LightKind::Directional(DVec3::new(0.0, -1.0, -2.0)), DVec3::ONE)],
        background: Background::Colour(DVec3::new(0.1, 0.2, 0.4)),
        ..Model::default()
    };
    model.camera.position = DVec3::new(0.0, 0.0, 6.0);
    model.render.size = [96, 64];
    model.render.ambient = DVec3::splat(0.05);
    model
}

/// Pixels off by more than 64 of 255, and the mean difference.
fn apart(model: &Model, widths: Widths) -> (u64, f64) {
    let longest = widths.coordinate_max().min(2047) as u16;
    let planes = Planes::new(model, &Options { widths, direction: longest, ..Options::default() }).unwrap();
    assert_eq!(planes.warnings, [""; 0]);
    let scene = planes.scene().unwrap();
    let by = |way| picture(&scene, &light(&scene, way, &|_| ()), model.render.transfer);
    let shown = by(Way::Lanes(Lockstep::detected()));
    assert_eq!(shown, by(Way::Pixels));
    let apart = compare(&shown, &Reference::new(model).picture(&|_| ())).unwrap();
    (apart.over_64, apart.mean_abs)
}

#[test]
fn wide_words_show_what_the_reference_shows() {
    let wide = Widths::new(15, 31, 58, 10).unwrap();
    let mut model = model();
    for projection in [Projection::Perspective { fov_y: 0.7 }, Projection::Orthographic { height: 3.0 }] {
        model.camera.projection = projection;
        let (wrong, mean) = apart(&model, wide);
        assert!(wrong <= 12 && mean < 0.3, "{projection:?}: {wrong} pixels, mean {mean}");
        // And few words do not: the measure can fail.
        let (wrong, _) = apart(&model, Widths::new(7, 24, 36, 2).unwrap());
        assert!(wrong > 100, "{projection:?}: {wrong}");
    }
}

#[test]
fn what_it_does_not_know_is_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Model)| {
        let mut model = model();
        change(&mut model);
        Planes::new(&model, &Options::default()).map(drop)
    };
    let triangle = Triangle { vertices: [0; 3], normals: None, material: 0 };
    assert_eq!(refused(&|_| ()), Ok(()));
    let error = refused(&|model| model.triangles = vec![triangle; 7]).unwrap_err();
    assert_eq!(error, PlanesError::Triangles(7));
    assert!(error.to_string().contains("7 triangles") && error.to_string().contains("--kernel exact29"), "{error}");
    assert_eq!(refused(&|model| model.spheres.clear()), Err(PlanesError::Empty));
    let glass = |model: &mut Model| {
        model.materials[1] = Material { name: "glass".into(), kind: MaterialKind::Dielectric, ..Material::default() };
    };
    assert_eq!(refused(&glass), Err(PlanesError::Refracts("glass".into())));
    // Glass that nothing is made of hinders nothing.
    let unused = |model: &mut Model| {
        glass(model);
        model.spheres.truncate(1);
    };
    assert_eq!(refused(&unused), Ok(()));
    for direction in [0, 2048] {
        let error = Planes::new(&model(), &Options { direction, ..Options::default() }).unwrap_err();
        assert!(error.to_string().contains("lengths of 1 to 2047"), "{error}");
    }
}

#[test]
fn what_is_shown_plainer_is_said() {
    let warnings = |change: &dyn Fn(&mut Model), direction| {
        let mut model = model();
        change(&mut model);
        Planes::new(&model, &Options { direction, ..Options::default() }).unwrap().warnings.join("\n")
    };
    assert_eq!(warnings(&|_| (), 511), "");
    assert!(warnings(&|model| model.lights.push(model.lights[0]), 511).contains("one light, and the scene 2"));
    assert!(warnings(&|model| model.lights[0].kind = LightKind::Point(DVec3::Y), 511).contains("parallel light"));
    let sky = Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE };
    assert!(warnings(&|model| model.background = sky, 511).contains("one colour"));
    assert!(warnings(&|_| (), 2047).contains("saturates"));
}

#[test]
fn rays_of_one_s_own_meet_what_the_reference_meets_from_anywhere() {
    let model = model();
    let planes = Planes::new(&model, &Options::default()).unwrap();
    let tracer = Tracer::new(planes.scene().unwrap(), planes.place());
    let reference = Reference::new(&model);
    let (mut met, mut apart) = (0, 0);
    for step in 0..400 {
        let target = DVec3::new(f64::from(step % 20) / 4.0 - 2.5, f64::from(step / 20) / 8.0 - 1.25, 0.0);
        let direction = (target - model.camera.position) * 1e-3;
        // Far beyond what components hold, too.
        for back in [0.0, 3.0, 1e6] {
            let origin = model.camera.position - direction * (1e3 * back);
            let found = tracer.nearest(origin, direction);
            let expected = reference.nearest(origin, direction);
            match (found, expected) {
                (Some(found), Some(expected)) if found.prim == expected.prim => {
                    // Along a sphere's edge, half a unit of 511 across is much more in depth.
                    let off = (found.t - expected.t).abs() * direction.length();
                    assert!(off < 0.3, "{target} {back}: {} and {}", found.t, expected.t);
                    met += 1;
                }
                (None, None) => (),
                _ => apart += 1,
            }
        }
    }
    assert!(met > 500 && apart < met / 20, "{met} {apart}");
    assert_eq!(tracer.nearest(DVec3::splat(1e9), DVec3::X), None);
    assert_eq!(tracer.nearest(model.camera.position, DVec3::ZERO), None);
    assert_eq!(tracer.nearest(DVec3::NAN, DVec3::X), None);
}
