//! Epsilon: how far from a surface shadow rays begin.

use core_rt::arithmetic::Knobs;
use glam::DVec3;
use host_tools::model::{Light, LightKind, Model};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use tests::meshes;

use super::kernels::{self, Entry, SelfHits};
use super::scenes::mesh;
use super::text::{Verdict, table};
use super::{Setup, Study};

/// Grid units.
const EPSILONS: [u8; 16] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
/// What Hanika finds enough, and what the report does.
const HANIKA: u8 = 2;
const REPORT: u8 = 6;
/// The kernels that can be set so.
const SET: [&str; 3] = ["hanika-c", "hanika-cd", "hanika-cons"];
/// Those that cannot.
const FIXED: [&str; 3] = ["exact29", "exact20", "exact14"];

/// What a distance makes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Errors {
    /// Shadow rays that their own convex mesh blocks.
    pub(crate) self_hits: u64,
    /// Of so many.
    pub(crate) rays: u64,
    /// Pixels that are lit and must not be.
    pub(crate) leaks: u64,
    /// The farthest of them from the edge, grid units of the kernel.
    pub(crate) width: f64,
}

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Epsilon {
    /// For each epsilon, each kernel of [`SET`].
    pub(crate) set: Vec<[Errors; 3]>,
    /// Each kernel of [`FIXED`].
    pub(crate) fixed: [Errors; 3],
}

/// Two cones over one circle of so many points, 2^29 units across: convex, closed, and all slivers.
fn bicone(points: i64) -> Vec<[[i64; 3]; 3]> {
    let half = 1 << 28;
    let rim = |i: i64| {
        let angle = std::f64::consts::TAU * (i % points) as f64 / points as f64;
        let along = |c: f64| half + (c * (half - 1) as f64).round() as i64;
        [along(libm::cos(angle)), half, along(libm::sin(angle))]
    };
    let [below, above] = [half / 2, half + half / 2].map(|y| [half, y, half]);
    (0..points).flat_map(|i| [[rim(i + 1), rim(i), above], [rim(i), rim(i + 1), below]]).collect()
}

/// Convex closed meshes, seen from outside and lit from there by a near light, a grazing and a far one: spheres from coarse to
/// fine, a block, and two cones.
pub(crate) fn convex() -> Vec<Model> {
    let [eye, centre, near, grazing, far] =
        [[1.6, 1.3, 1.9], [0.5, 0.5, 0.5], [0.7, 1.3, 1.3], [-1.3, 0.9, 0.6], [0.1, 3.4, 2.6]].map(DVec3::from_array);
    let last = (1 << 29) - 1;
    let block = meshes::cuboid([0; 3], [last, last / 2, last / 3]);
    let spheres = [3, 12, 40].map(|n| meshes::sphere(29, n));
    let lit = |triangles: Vec<[[i64; 3]; 3]>| {
        let mut model = mesh(&triangles, f64::from(1 << 29), [eye, centre, near], 0.65);
        model.lights.extend([grazing, far].map(|place| Light::new(LightKind::Point(place), DVec3::ONE)));
        model
    };
    spheres.into_iter().chain([block, bicone(500)]).map(lit).collect()
}

/// Triangles of the room alone; the sheet's come after.
const ROOM: u32 = 12;
/// The edge at which the sheet meets the floor: this x, y = 0.
const EDGE: f64 = 0.5;
/// How far the camera is from the edge, and how much of what is there it sees, in grid units of the kernel.
const DISTANCE: f64 = 4096.0;
const WINDOW: f64 = 32.0;

/// A room in which a thin sheet leans over the floor at 30 degrees, the light behind it: in the concave edge between them the
/// floor is in shadow. The camera is in there too and sees the last grid units.
pub(crate) fn room(scale: f64) -> Model {
    let mut triangles = meshes::cuboid([0; 3], [1 << 20; 3]);
    let (foot, rise) = (1 << 19, 387_000 * 5773 / 10_000);
    let [a, b] = [1 << 17, 7 << 17].map(|z| [foot, 0, z]);
    let [c, d] = [1 << 17, 7 << 17].map(|z| [foot + 387_000, rise, z]);
    triangles.extend([[a, b, c], [c, b, d]]);
    let edge = DVec3::new(EDGE, 0.0, 0.5);
    let towards = DVec3::new(libm::cos(0.26), libm::sin(0.26), 0.0);
    let eye = edge + towards * (DISTANCE / scale);
    mesh(&triangles, f64::from(1 << 20), [eye, edge, DVec3::new(0.1, 0.9, 0.45)], WINDOW / DISTANCE)
}

/// Leaks, and the farthest from the edge, grid units: pixels of the floor that the reference finds in shadow, and that are lit.
pub(crate) fn leaks(model: &Model, picture: &Picture, scale: f64) -> (u64, f64) {
    let size = model.render.size;
    let reference = Reference::new(model);
    let (mut count, mut width) = (0, 0.0);
    for (pixel, _) in (0..).zip(picture.pixels()).filter(|(_, colour)| **colour != [0; 3]) {
        let (x, y) = (pixel % size[0], pixel / size[0]);
        let sample = reference.pixel(size, x, y);
        let Some(hit) = sample.hit.filter(|hit| hit.prim < ROOM && sample.lights == 0) else { continue };
        let (origin, direction) = reference.camera_ray(size, f64::from(x) + 0.5, f64::from(y) + 0.5);
        count += 1;
        width = f64::max(width, ((origin + direction * hit.t).x - EDGE) * scale);
    }
    (count, width)
}

fn errors(kernel: Entry, convex: &[Model], epsilon: Option<u8>, size: u32) -> Errors {
    let options = Options { knobs: Knobs { epsilon, ..Knobs::default() }, ..Options::default() };
    let own = convex.iter().map(|model| (kernel.self_hits)(&kernels::blob(kernel.name, model, &options)));
    let sum = own.fold(SelfHits::default(), SelfHits::plus);
    // Where the camera is does not change the grid, while it is in the room.
    let scale = kernels::scale(kernel.name, &room(f64::from(1 << 14)));
    let mut room = room(scale);
    room.render.size = [size; 2];
    let (leaks, width) = leaks(&room, &kernels::picture(kernel.name, &room, &options), scale);
    Errors { self_hits: sum.blocked, rays: sum.rays, leaks, width }
}

impl Epsilon {
    /// The least epsilon from which on a kernel of [`SET`] has no self-hit.
    fn enough(&self, kernel: usize) -> Option<u8> {
        let last_bad = self.set.iter().rposition(|errors| errors[kernel].self_hits > 0);
        EPSILONS.get(last_bad.map_or(0, |place| place + 1)).copied()
    }
}

impl Study for Epsilon {
    const NAME: &'static str = "epsilon";
    const TITLE: &'static str = "Epsilon";
    const CLAIM: &'static str = "\
Origins of secondary rays stand off their surface by epsilon along its normal; on a grid the same does for every scene. Hanika \
finds 2 units enough, the report 6 (4). A **self-hit** is a shadow ray that leaves a face of a convex closed mesh (three spheres, a \
block and two cones), seen from outside and turned to the light, and is blocked by that mesh; no primitive is passed over, as it would be \
in a picture. A **light leak** is a pixel of the floor that is lit though the reference finds it in shadow, in the last grid units \
of the concave edge between the floor and a thin sheet that leans over it at 30 degrees, with the light behind: too large an \
epsilon goes through the sheet. Width is how far from the edge there are leaks, in the kernel's grid units.";

    fn measure(setup: &Setup) -> Self {
        let mut convex = convex();
        for model in &mut convex {
            model.render.size = [setup.size / 2; 2];
        }
        let of = |name: &str, epsilon| errors(kernels::by_name(name), &convex, epsilon, setup.size / 2);
        Self {
            set: EPSILONS.iter().map(|&epsilon| SET.map(|name| of(name, Some(epsilon)))).collect(),
            fixed: FIXED.map(|name| of(name, None)),
        }
    }

    fn tables(&self) -> String {
        let mut head = vec!["epsilon".to_owned()];
        for kernel in SET {
            head.extend([format!("`{kernel}`: self-hits"), "leaks".into(), "width".into()]);
        }
        let cells =
            |errors: &Errors| [errors.self_hits.to_string(), errors.leaks.to_string(), format!("{:.0}", errors.width)];
        let rows = EPSILONS.iter().zip(&self.set).map(|(epsilon, kernels)| {
            [epsilon.to_string()].into_iter().chain(kernels.iter().flat_map(cells)).collect()
        });
        let fixed = FIXED
            .iter()
            .zip(&self.fixed)
            .map(|(kernel, errors)| [format!("`{kernel}`")].into_iter().chain(cells(errors)).collect());
        let rays = self.set.first().map_or(0, |kernels| kernels[1].rays);
        format!(
            "Of {rays} shadow rays of convex meshes (`hanika-cd`):\n\n{}The exact kernels' distance is fixed:\n\n{}",
            table(&head, rows),
            table(&["kernel", "self-hits", "leaks", "width"], fixed)
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let enough = [0, 1, 2].map(|kernel| self.enough(kernel));
        let shown = SET.iter().zip(enough).map(|(kernel, least)| match least {
            Some(least) => format!("`{kernel}` {least}"),
            None => format!("`{kernel}` more than {}", EPSILONS[EPSILONS.len() - 1]),
        });
        let because = format!("without any self-hit from: {}", shown.collect::<Vec<_>>().join(", "));
        let suffices = |epsilon: u8| enough[..2].iter().all(|least| least.is_some_and(|least| least <= epsilon));
        let exact: u64 = self.fixed.iter().map(|errors| errors.self_hits).sum();
        let widths = [self.set.first(), self.set.last()].map(|kernels| kernels.map_or(0.0, |kernels| kernels[1].width));
        vec![
            Verdict {
                claim: "an epsilon of 2 is enough, as Hanika finds",
                holds: suffices(HANIKA),
                because: because.clone(),
            },
            Verdict { claim: "an epsilon of 6 is enough, as the report finds", holds: suffices(REPORT), because },
            Verdict {
                claim: "a larger epsilon leaks more light",
                holds: widths[1] > widths[0],
                because: format!("`hanika-cd` to {:.0} units at 1, to {:.0} at 16", widths[0], widths[1]),
            },
            Verdict {
                claim: "the exact kernels' fixed distance is enough",
                holds: exact == 0,
                because: format!("{exact} self-hits"),
            },
        ]
    }
}
