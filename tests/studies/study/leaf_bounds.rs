//! Larger boxes of leaves.

use core_rt::hanika::HanikaC;
use core_rt::kernel::{Bounds, Kernel};
use host_tools::grid::Grid;
use host_tools::model::{LightKind, Model};
use host_tools::prepare::Options;
use host_tools::tree::{Growth, TreeOptions};

use super::text::{Verdict, table};
use super::{Setup, Study, TRIANGLES_MAX};

/// By how many grid units, of 2^29, boxes are larger on every side.
const GROWTHS: [i32; 12] = [0, 1, 2, 4, 8, 16, 64, 256, 1024, 4096, 16384, 65536];

const KERNELS: [&str; 4] = ["hanika-c", "hanika-cd", "hanika-cons", "exact29"];

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LeafBounds {
    /// Pixels over 64 in all scenes, for each growth, of each kernel.
    pub(crate) over_64: Vec<[u64; 4]>,
}

/// Where boxes may be for a scene to be accepted: on the grid, and in reach of the camera and of the lights.
fn room(model: &Model) -> Bounds {
    let grid = Grid::fit::<HanikaC>(model).expect("every kernel holds the studies' scenes");
    let lights = model.lights.iter().filter_map(|light| match light.kind {
        LightKind::Point(position) => Some(position),
        LightKind::Directional(_) => None,
    });
    let whole = Bounds { low: [HanikaC::MARGIN; 3], high: [(1 << HanikaC::GRID_BITS) - 1 - HanikaC::MARGIN; 3] };
    lights.chain([model.camera.position]).map(|origin| grid.place(origin)).fold(whole, |room, origin| Bounds {
        low: [0, 1, 2].map(|axis| room.low[axis].max(origin[axis].saturating_sub(HanikaC::SPAN))),
        high: [0, 1, 2].map(|axis| room.high[axis].min(origin[axis].saturating_add(HanikaC::SPAN))),
    })
}

/// The scene's options with larger boxes of leaves of one triangle, as the report's are.
pub(crate) fn options(model: &Model, by: i32) -> Options {
    let leaf_growth = Some(Growth { by, within: room(model) });
    Options {
        tree: TreeOptions { leaf_max: 1, leaf_always: true, leaf_growth, ..TreeOptions::default() },
        ..Options::default()
    }
}

impl Study for LeafBounds {
    const NAME: &'static str = "leaf-bounds";
    const TITLE: &'static str = "Larger bounds of leaves";
    const CLAIM: &'static str = "\
Artificially larger bounds of leaves reduce the artifacts dramatically, and so do D bits; so it is the box test that makes most of \
them (3 and 4). The report does not say by how much bounds grew. Here the boxes of leaves of one triangle grow by so many units \
of the 29-bit grid on every side, though not beyond the grid; those above them hold them. With C = 12 differences are rounded \
to multiples of 4096 units. Scenes of up to 100,000 triangles.";

    fn measure(setup: &Setup) -> Self {
        let mut over_64 = vec![[0; KERNELS.len()]; GROWTHS.len()];
        for subject in setup.subjects.iter().filter(|subject| subject.model.triangles.len() <= TRIANGLES_MAX) {
            for (sums, by) in over_64.iter_mut().zip(GROWTHS) {
                for (sum, kernel) in sums.iter_mut().zip(&KERNELS[..2]) {
                    *sum += subject.over_64(kernel, &options(&subject.model, by));
                }
            }
            // What loses no hit: once tells all.
            for (place, kernel) in KERNELS.iter().enumerate().skip(2) {
                let same = subject.over_64(kernel, &options(&subject.model, 0));
                over_64.iter_mut().for_each(|sums| sums[place] += same);
            }
        }
        Self { over_64 }
    }

    fn tables(&self) -> String {
        let mut head = vec!["grown by".to_owned()];
        head.extend(KERNELS[..2].iter().map(|kernel| format!("`{kernel}`, over 64")));
        let rows = GROWTHS
            .iter()
            .zip(&self.over_64)
            .map(|(by, sums)| [by.to_string()].into_iter().chain(sums[..2].iter().map(u64::to_string)).collect());
        let text = table(&head, rows);
        let [.., cons, exact] = self.over_64.first().copied().unwrap_or_default();
        format!("{text}Without growth, `hanika-cons` has {cons} and `exact29` {exact}, whose boxes lose nothing.\n\n")
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let Some(&[plain, refined, cons, _]) = self.over_64.first() else { return Vec::new() };
        let halves = |kernel: usize, before: u64| {
            let enough = GROWTHS.iter().zip(&self.over_64).find(|(_, sums)| 2 * sums[kernel] <= before);
            let least = self.over_64.iter().map(|sums| sums[kernel]).min().unwrap_or(0);
            let from = enough.map_or("none halves them".into(), |(by, _)| format!("{by} units halve them"));
            (enough.is_some() && before > 0, format!("{before} pixels over 64 become {least} at best; {from}"))
        };
        let (plain_holds, plain_because) = halves(0, plain);
        let (refined_holds, refined_because) = halves(1, refined);
        vec![
            Verdict {
                claim: "larger bounds of leaves remove most artifacts with C bits",
                holds: plain_holds,
                because: plain_because,
            },
            Verdict {
                claim: "larger bounds of leaves remove most artifacts with D bits",
                holds: refined_holds,
                because: refined_because,
            },
            Verdict {
                claim: "it is the box test that makes most of them",
                holds: 2 * cons <= plain && plain > 0,
                because: format!("behind boxes that lose nothing, {cons} of the {plain} with C bits remain"),
            },
        ]
    }
}
