//! How costs grow as a mesh is divided ever finer, and whether they grow faster than the logarithm of its triangles.

use std::collections::HashMap;
use std::hint::black_box;

use core_rt::bvh::{Intersect, Waiting};
use core_rt::exact::Exact29;
use core_rt::profile::Full;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::Stats;
use glam::DVec3;
use host_tools::model::{Camera, Light, LightKind, Model, Projection, Triangle};

/// Parts of an edge of the octahedron from which meshes are blown up: the number of triangles about doubles, from 128 to
/// 1,002,528.
pub const SIDES: [i32; 14] = [4, 6, 8, 11, 16, 22, 32, 45, 64, 90, 128, 181, 256, 354];

/// The triangles of the mesh whose cost others are shown as multiples of.
const BASE: usize = 968;

/// A cost by number of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Of what.
    pub name: String,
    /// Number of triangles, from few to many, and cost.
    pub points: Vec<(usize, f64)>,
}

impl Line {
    /// The costs in multiples of that at 968 triangles, or of the first where there is none.
    #[must_use]
    pub fn relative(&self) -> Vec<(usize, f64)> {
        let base = self.points.iter().find(|(triangles, _)| *triangles == BASE).or(self.points.first());
        let base = base.map_or(1.0, |&(_, cost)| cost);
        self.points.iter().map(|&(triangles, cost)| (triangles, cost / base)).collect()
    }

    /// What each doubling adds to the relative cost, in the coarser and in the finer half.
    ///
    /// # Panics
    /// If there are fewer than three points.
    #[must_use]
    pub fn steps(&self) -> [f64; 2] {
        let points = self.relative();
        let middle = points.len() / 2;
        assert!(middle > 0 && points.len() > 2, "too few points for two halves");
        let step =
            |[(few, least), (many, most)]: [(usize, f64); 2]| (most - least) / libm::log2(many as f64 / few as f64);
        [[points[0], points[middle]], [points[middle], points[points.len() - 1]]].map(step)
    }

    /// Whether a doubling adds no more in the finer half than in the coarser one: a cost that grows as the logarithm is a
    /// straight line over it, and one that grows as any power bends upwards.
    ///
    /// # Panics
    /// If there are fewer than three points.
    #[must_use]
    pub fn is_logarithmic(&self) -> bool {
        let [coarse, fine] = self.steps();
        fine <= coarse
    }
}

/// Finds the nearest hits of all camera rays of a scene, one by one.
#[inline(never)]
pub fn find(scene: &Scene<'_, Full<Exact29>>, stats: &mut impl Stats) {
    let mut stack = heapless::Vec::<Waiting<Exact29>, MAX_DEPTH>::new();
    let [width, height] = scene.frame.size;
    for place in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
        if let Some(ray) = scene.primary(&scene.camera, place[0], place[1]) {
            black_box(scene.bvh.closest(&ray, &mut stack, stats));
        }
    }
}

/// An octahedron, each face divided in `side` squared, blown up to a ball with bumps, that fills most of the view.
#[must_use]
pub fn mesh(side: i32) -> Model {
    let (mut positions, mut numbers, mut triangles) = (Vec::new(), HashMap::new(), Vec::new());
    let mut vertex = |place: [i32; 3]| -> u32 {
        *numbers.entry(place).or_insert_with(|| {
            let direction = DVec3::from_array(place.map(f64::from)).normalize();
            let [a, b, c] = [9.0 * direction.x, 7.0 * direction.y, 8.0 * direction.z].map(libm::sin);
            positions.push(direction * (1.0 + 0.1 * a * b * c));
            positions.len() as u32 - 1
        })
    };
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1 } else { -1 });
        let is_mirrored = signs.iter().product::<i32>() < 0;
        let mut put = |corners: [[i32; 2]; 3]| {
            let [a, b, c] = corners.map(|[i, j]| vertex([i * signs[0], j * signs[1], (side - i - j) * signs[2]]));
            let vertices = if is_mirrored { [a, c, b] } else { [a, b, c] };
            triangles.push(Triangle { vertices, normals: None, material: 0 });
        };
        for (i, j) in (0..side).flat_map(|i| (0..side - i).map(move |j| (i, j))) {
            put([[i, j], [i + 1, j], [i, j + 1]]);
            if i + j + 1 < side {
                put([[i + 1, j], [i + 1, j + 1], [i, j + 1]]);
            }
        }
    }
    let position = DVec3::new(0.9, 0.8, 3.3);
    Model {
        positions,
        triangles,
        camera: Camera {
            position,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.6 },
        },
        lights: vec![Light::new(LightKind::Point(position), DVec3::ONE)],
        ..Model::default()
    }
}
