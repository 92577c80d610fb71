//! Whatever model the importer may hand on, `prepare` refuses or makes a blob that the device's own check accepts, and that
//! renders.

use glam::DVec3;
use host_tools::engine::ENGINES;
use host_tools::grid::LEAST_BITS;
use host_tools::model::{
    Camera, Light, LightKind, Material, Model, Projection, RenderSettings, Sphere, Transfer, Triangle,
};
use host_tools::prepare::Options;
use host_tools::tree::TreeOptions;
use proptest::prelude::*;

fn point() -> impl Strategy<Value = DVec3> {
    // Plain, coincident, tiny and huge coordinates, and exact ties.
    let coordinate = prop_oneof![-10.0..10.0, Just(0.0), Just(1.0), -1e-9..1e-9, -1e9..1e9];
    [coordinate.clone(), coordinate.clone(), coordinate].prop_map(DVec3::from_array)
}

fn direction() -> impl Strategy<Value = DVec3> {
    point().prop_filter("a direction is not zero", |v| v.length_squared() > 0.0)
}

fn colour() -> impl Strategy<Value = DVec3> {
    [0.0..1.0, 0.0..1.0, 0.0..1.0].prop_map(DVec3::from_array)
}

fn light() -> impl Strategy<Value = Light> {
    let kind = prop_oneof![point().prop_map(LightKind::Point), direction().prop_map(LightKind::Directional)];
    (kind, colour(), -40..40)
        .prop_map(|(kind, colour, exponent)| Light::new(kind, colour * libm::exp2(f64::from(exponent))))
}

fn model() -> impl Strategy<Value = Model> {
    let parts = (
        prop::collection::vec(point(), 3..40),
        prop::collection::vec(direction().prop_map(DVec3::normalize), 1..6),
        prop::collection::vec((colour(), colour()), 1..5),
    );
    parts.prop_flat_map(|(positions, normals, materials)| {
        let corners = |count: usize| [0..count as u32, 0..count as u32, 0..count as u32];
        let triangle = (corners(positions.len()), prop::option::of(corners(normals.len())), 0..materials.len() as u32)
            .prop_map(|(vertices, normals, material)| Triangle { vertices, normals, material });
        let camera = (point(), direction(), direction(), 0.001..3.1)
            .prop_map(|(position, forward, up, fov_y)| Camera {
                position,
                look_at: position + forward,
                up,
                projection: Projection::Perspective { fov_y },
            })
            .prop_filter("the importer refuses a view without a frame", has_frame);
        let transfer = prop_oneof![Just(Transfer::Srgb), Just(Transfer::Linear)];
        let render = ([1u32..40, 1u32..40], colour(), transfer).prop_map(|(size, ambient, transfer)| RenderSettings {
            size,
            ambient,
            transfer,
            ..RenderSettings::default()
        });
        let lights = prop::collection::vec(light(), 0..4);
        let triangles = prop::collection::vec(triangle, 0..60);
        // From what no grid can tell from a point to what leaves no room for the rest.
        let radius = (1.0..2.0, -40..40).prop_map(|(mantissa, exponent)| mantissa * libm::exp2(f64::from(exponent)));
        let sphere = (point(), radius, 0..materials.len() as u32).prop_map(|(centre, radius, material)| Sphere {
            centre,
            radius,
            material,
        });
        let spheres = prop::collection::vec(sphere, 0..12);
        let primitives = (triangles, spheres).prop_filter("the importer refuses nothing", |(triangles, spheres)| {
            !(triangles.is_empty() && spheres.is_empty())
        });
        (primitives, lights, camera, colour(), render).prop_map(
            move |((triangles, spheres), lights, camera, background, render)| {
                let material =
                    |&(colour, emission): &(DVec3, DVec3)| Material { colour, emission, ..Material::default() };
                Model {
                    positions: positions.clone(),
                    normals: normals.clone(),
                    triangles,
                    spheres,
                    materials: materials.iter().map(material).collect(),
                    lights,
                    camera,
                    background: background.into(),
                    render,
                    ..Model::default()
                }
            },
        )
    })
}

/// Whether the view is not along its own up.
fn has_frame(camera: &Camera) -> bool {
    let forward = camera.look_at - camera.position;
    forward.normalize_or_zero().cross(camera.up.normalize_or_zero()).length_squared() > 1e-12
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn what_is_prepared_is_accepted_and_renders(
        model in model(),
        leaf_max in 1u32..=64,
        leaf_always: bool,
        grid_bits in prop::option::of(LEAST_BITS..=29),
    ) {
        let tree = TreeOptions { leaf_max, leaf_always, ..TreeOptions::default() };
        for engine in ENGINES {
            let grid_bits = grid_bits.map(|bits| bits.min(engine.grid_bits()));
            let options = Options { tree, grid_bits, ..Options::default() };
            let Ok(prepared) = engine.prepare(&model, &options) else { continue };
            prop_assert!(prepared.grid.bits(&model) <= grid_bits.unwrap_or(engine.grid_bits()));
            let (header, _) = engine.inspect(prepared.blob.bytes()).map_err(|e| TestCaseError::fail(e.to_string()))?;
            prop_assert_eq!(header.counts.triangles + prepared.degenerates.total(), model.triangles.len() as u32);
            prop_assert_eq!(header.counts.spheres + prepared.degenerates.spheres, model.spheres.len() as u32);
            let rendered = engine.render(prepared.blob.bytes(), [16, 16], &|_| {});
            prop_assert!(rendered.is_ok());
        }
    }
}
