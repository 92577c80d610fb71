//! Seams: rays that slip through a closed mesh.

use std::collections::HashMap;

use core_rt::kernel::NONE;
use glam::DVec3;
use host_tools::model::Model;
use host_tools::prepare::Options;
use host_tools::reference::Reference;

use super::kernels;
use super::scenes::{Subject, columns, spheres};
use super::text::{Verdict, table};
use super::{Setup, Study};

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Seams {
    /// The meshes' names.
    pub(crate) meshes: Vec<String>,
    /// A kernel's name, and its holes in each mesh.
    pub(crate) rows: Vec<(&'static str, Vec<u64>)>,
    /// Scenes that are not closed, and how many of their edges are not met by a triangle from either side.
    pub(crate) open: Vec<(String, usize)>,
}

/// Where a vertex is: equal places have equal keys.
fn key(position: DVec3) -> [u64; 3] {
    // Zero has two signs.
    (position + 0.0).to_array().map(f64::to_bits)
}

/// Edges that are not met by as many triangles in one direction as in the other: none in a closed mesh.
pub(crate) fn open_edges(model: &Model) -> usize {
    let mut edges: HashMap<[[u64; 3]; 2], i64> = HashMap::new();
    for triangle in &model.triangles {
        let [a, b, c] = triangle.vertices.map(|v| key(model.positions[v as usize]));
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from, to]).or_default() += 1;
            *edges.entry([to, from]).or_default() -= 1;
        }
    }
    edges.values().filter(|&&surplus| surplus > 0).count()
}

/// Whether two triangles of a model share a corner's place.
fn touch(model: &Model, a: u32, b: u32) -> bool {
    let corners = |prim: u32| model.triangles[prim as usize].vertices.map(|v| model.positions[v as usize]);
    a == b || corners(a).iter().any(|corner| corners(b).contains(corner))
}

/// Half the side of the square, in pixels, in which the reference must see one surface for a pixel to be none of an outline's.
const APART: f64 = 0.5;

/// Pixels that see through the surface: what the kernel sees does not touch what the reference sees there, which is one
/// surface as far as half a pixel around.
pub(crate) fn holes(model: &Model, seen: &[u32]) -> u64 {
    let reference = Reference::new(model);
    let size = model.render.size;
    let sees = |x: f64, y: f64| {
        let (origin, direction) = reference.camera_ray(size, x, y);
        reference.nearest(origin, direction).map(|hit| hit.prim)
    };
    let is_hole = |pixel: u32, found: u32| {
        let (x, y) = (f64::from(pixel % size[0]) + 0.5, f64::from(pixel / size[0]) + 0.5);
        let Some(right) = sees(x, y) else { return false };
        if found != NONE && touch(model, found, right) {
            return false;
        }
        let around = [(-APART, -APART), (APART, -APART), (-APART, APART), (APART, APART)];
        around.iter().all(|(dx, dy)| sees(x + dx, y + dy).is_some_and(|prim| touch(model, prim, right)))
    };
    (0..).zip(seen).filter(|&(pixel, &found)| is_hole(pixel, found)).count() as u64
}

impl Seams {
    fn total(&self, kernel: &str) -> u64 {
        self.rows.iter().filter(|(name, _)| *name == kernel).flat_map(|(_, holes)| holes).sum()
    }
}

impl Study for Seams {
    const NAME: &'static str = "seams";
    const TITLE: &'static str = "Seams";
    const CLAIM: &'static str = "\
Now and then a ray misses both of two triangles that share an edge, along axis-parallel ones above all; the report blames the box \
test, and D bits make it rarer (4). Counted in closed meshes: pixels in which a kernel sees nothing, or a triangle that does not \
touch the one that the reference sees, where the reference sees one surface as far as half a pixel \
around: what a coarse grid moves is no hole.";

    fn measure(setup: &Setup) -> Self {
        let mut models: Vec<(String, Model)> =
            [3, 17, 64, 128].iter().map(|&n| (format!("inside of {}", 8 * n * n), tests::scenes::inside(n))).collect();
        models.extend([("columns".into(), columns()), ("spheres".into(), spheres())]);
        let mut open = Vec::new();
        for Subject { name, model, .. } in &setup.subjects {
            match open_edges(model) {
                _ if models.iter().any(|(there, _)| there == name) || name == "inside" => {}
                0 => models.push((name.clone(), model.clone())),
                edges => open.push((name.clone(), edges)),
            }
        }
        for (_, model) in &mut models {
            model.render.size = [setup.size; 2];
        }
        let row = |entry: kernels::Entry| {
            let count = |(_, model): &(String, Model)| {
                holes(model, &(entry.seen)(&kernels::blob(entry.name, model, &Options::default())))
            };
            (entry.name, models.iter().map(count).collect())
        };
        let rows = kernels::all().into_iter().map(row).collect();
        Self { meshes: models.into_iter().map(|(name, _)| name).collect(), rows, open }
    }

    fn tables(&self) -> String {
        let mut head = vec!["kernel".to_owned()];
        head.extend(self.meshes.iter().cloned());
        let rows = self.rows.iter().map(|(kernel, holes)| {
            [format!("`{kernel}`")].into_iter().chain(holes.iter().map(u64::to_string)).collect()
        });
        let text = table(&head, rows);
        let open = self.open.iter().map(|(name, edges)| format!("{name} ({edges} open edges)")).collect::<Vec<_>>();
        let open = if open.is_empty() { "none".into() } else { open.join(", ") };
        format!(
            "{text}*Inside of n* is a sphere of n triangles, seen from its centre. Not closed, and left out: {open}.\n\n"
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let [plain, refined, cons, exact] =
            ["hanika-c", "hanika-cd", "hanika-cons", "exact29"].map(|kernel| self.total(kernel));
        vec![
            Verdict {
                claim: "there are seams with C bits, and fewer with D bits",
                holds: plain > 0 && refined < plain,
                because: format!("{plain} holes with C bits, {refined} with D bits"),
            },
            Verdict {
                claim: "it is the box test that makes most of them",
                holds: plain > 0 && 2 * cons < plain,
                because: format!(
                    "`hanika-cons` has the same triangles behind boxes that lose nothing, and {cons} holes"
                ),
            },
            Verdict { claim: "`exact29` has none", holds: exact == 0, because: format!("{exact} holes") },
        ]
    }
}
