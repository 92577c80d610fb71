//! The scenes that are studied.

use std::path::Path;

use glam::DVec3;
use host_tools::compare::difference;
use host_tools::import;
use host_tools::model::{Camera, Light, LightKind, Material, Model, Projection, RenderSettings, Transfer, Triangle};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use tests::{meshes, shared};

use super::kernels;

/// Models that are not part of the project.
const SHARED: [(&str, &str); 6] = [
    ("suzanne", "suzanne/suzanne.obj"),
    ("teapot", "teapot/teapot.obj"),
    ("cornell-box", "cornell-box/scene.toml"),
    ("sponza", "sponza-dabrovic/scene.toml"),
    ("bunny", "bunny/bunny_smooth.obj"),
    ("coffee", "coffee/coffee.obj"),
];

/// A scene, and its picture by the kernel `f64`.
pub(crate) struct Subject {
    /// Its name in tables.
    pub(crate) name: String,
    /// The scene, at the studies' size.
    pub(crate) model: Model,
    /// What others are compared with.
    pub(crate) truth: Picture,
}

impl Subject {
    /// A square picture of a model.
    pub(crate) fn new(name: impl Into<String>, mut model: Model, size: u32) -> Self {
        model.render.size = [size; 2];
        let truth = kernels::picture("f64", &model, &Options::default());
        Self { name: name.into(), model, truth }
    }

    /// Pixels over 64 of a kernel's picture.
    pub(crate) fn over_64(&self, kernel: &str, options: &Options) -> u64 {
        self.over_64_of(&kernels::picture(kernel, &self.model, options))
    }

    /// Pixels over 64 of a picture.
    pub(crate) fn over_64_of(&self, picture: &Picture) -> u64 {
        over_64(picture, &self.truth)
    }

    /// Pixels over 64 of `f64` and `exact29` against the independent reference.
    pub(crate) fn over_64_of_reference(&self) -> [u64; 2] {
        let size = self.model.render.size;
        let (pixels, _) = Reference::new(&self.model).render(size, &|_| {});
        let reference = Picture::from_fn(size[0], size[1], |x, y| pixels[(y * size[0] + x) as usize]);
        let exact = kernels::picture("exact29", &self.model, &Options::default());
        [&self.truth, &exact].map(|picture| over_64(picture, &reference))
    }
}

/// The 2009 report's count.
fn over_64(a: &Picture, b: &Picture) -> u64 {
    let gray = difference(a, b).expect("pictures of one size");
    gray.pixels().iter().filter(|pixel| pixel[0] > 64).count() as u64
}

/// The project's own scenes.
pub(crate) fn own(size: u32) -> Vec<Subject> {
    let mut golden = tests::scenes::all().into_iter();
    let (_, demo) = golden.find(|(name, _)| *name == "demo").expect("the built-in scene");
    let bench = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/bench-1k/scene.toml");
    let bench = import::load(&bench).expect("the performance scene").model;
    let all = [
        ("demo", demo),
        ("bench-1k", bench),
        ("inside", tests::scenes::inside(32)),
        ("columns", columns()),
        ("spheres", spheres()),
    ];
    all.into_iter().map(|(name, model)| Subject::new(name, model, size)).collect()
}

/// The shared scenes, and the names of those that are absent.
pub(crate) fn shared(size: u32) -> (Vec<Subject>, Vec<&'static str>) {
    let (mut there, mut absent) = (Vec::new(), Vec::new());
    for (name, path) in SHARED {
        match shared::scene(path) {
            Some(path) => there.push(Subject::new(name, import::load(&path).expect("a real model").model, size)),
            None => absent.push(name),
        }
    }
    (there, absent)
}

/// A white mesh of integers over `scale`, seen from a point and lit from another.
pub(crate) fn mesh(triangles: &[[[i64; 3]; 3]], scale: f64, [eye, look_at, light]: [DVec3; 3], fov_y: f64) -> Model {
    let positions = triangles.iter().flatten().map(|v| DVec3::from_array(v.map(|c| c as f64)) / scale).collect();
    let triangle = |i: u32| Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], normals: None, material: 0 };
    Model {
        positions,
        triangles: (0..triangles.len() as u32).map(triangle).collect(),
        materials: vec![Material { name: "white".into(), colour: DVec3::ONE, ..Material::default() }],
        lights: vec![Light::new(LightKind::Point(light), DVec3::ONE)],
        camera: Camera { position: eye, look_at, up: DVec3::Y, projection: Projection::Perspective { fov_y } },
        render: RenderSettings { size: [64; 2], transfer: Transfer::Linear, ..RenderSettings::default() },
        ..Model::default()
    }
}

/// A closed axis-parallel block whose faces are cut into n x n cells of two triangles.
fn block(low: [i64; 3], high: [i64; 3], n: i64) -> Vec<[[i64; 3]; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [low, high] {
            let point = |i: i64, j: i64| {
                let mut point = side;
                point[p] = low[p] + (high[p] - low[p]) * i / n;
                point[q] = low[q] + (high[q] - low[q]) * j / n;
                point
            };
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i, j + 1), point(i + 1, j + 1)];
                triangles.extend(if side == low { [[a, c, b], [b, c, d]] } else { [[a, b, c], [c, b, d]] });
            }
        }
    }
    triangles
}

/// Closed columns on a plate, all axis-parallel: the seams that the report saw at a door's frame.
pub(crate) fn columns() -> Model {
    let mut triangles = block([0, -700, 0], [100_000, 0, 100_000], 24);
    for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
        let [x, z] = [5_003 + 12_007 * i, 4_001 + 12_011 * j];
        triangles.extend(block([x, 0, z], [x + 4_999, 30_011 + 1_013 * ((3 * i + 5 * j) % 7), z + 5_003], 7));
    }
    let places = [[1.32, 0.6, 1.51], [0.45, 0.1, 0.47], [0.3, 1.4, 1.2]].map(DVec3::from_array);
    mesh(&triangles, 100_000.0, places, 0.6)
}

/// Closed spheres in the air, each of a thousand triangles.
pub(crate) fn spheres() -> Model {
    let sphere = meshes::sphere(20, 12);
    let mut triangles = Vec::new();
    for place in 0..27 {
        let [i, j, k] = [place % 3, place / 3 % 3, place / 9];
        let shift = [i * 1_300_000 + 31_001 * k, j * 1_270_000 + 57_007 * i, k * 1_290_000 + 43_003 * j];
        triangles.extend(sphere.iter().map(|t| t.map(|v| [0, 1, 2].map(|axis| v[axis] + shift[axis]))));
    }
    let places = [[6.2, 4.8, 8.4], [1.9, 1.85, 1.9], [1.0, 7.0, 6.0]].map(DVec3::from_array);
    mesh(&triangles, 1e6, places, 0.6)
}
