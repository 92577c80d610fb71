//! C against D: bits of reciprocals, and bits taken from differences.

use core_rt::arithmetic::Knobs;
use host_tools::prepare::Options;

use super::kernels::{self, Drawer};
use super::plot::Plot;
use super::text::{Verdict, ratio, table};
use super::{Setup, Study};

/// The values of C.
const C_BITS: [u8; 6] = [6, 9, 12, 15, 18, 21];
/// The values of C - D. Of 0 is `hanika-c`, of the others `hanika-cd`.
const UNUSED_BITS: [u8; 3] = [0, 3, 6];
/// C and D as the report has them: Hanika's, and refined.
const PLAIN: [u8; 2] = [12, 12];
const REFINED: [u8; 2] = [15, 9];

/// How many times as many rounds these two have, which are to be told apart by 2 %.
const DUEL: usize = 5;

/// One pair of C and D, over all scenes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cell {
    /// C and D.
    pub(crate) bits: [u8; 2],
    /// Pixels over 64 of each scene.
    pub(crate) over_64: Vec<u64>,
    /// The time of each scene, over that of C = 12.
    pub(crate) times: Vec<Option<f64>>,
}

impl Cell {
    fn total(&self) -> u64 {
        self.over_64.iter().sum()
    }
}

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CAndD {
    /// The scenes' names.
    pub(crate) scenes: Vec<String>,
    /// C and D of the report's refinement and of Hanika among them.
    pub(crate) cells: Vec<Cell>,
    /// The time of each scene with the refinement over that without, measured against each other alone.
    pub(crate) duels: Vec<Option<f64>>,
}

fn kernel([c_bits, d_bits]: [u8; 2]) -> (&'static str, Options) {
    let knobs = Knobs { c_bits: Some(c_bits), d_bits: Some(d_bits), ..Knobs::default() };
    (if c_bits == d_bits { "hanika-c" } else { "hanika-cd" }, Options { knobs, ..Options::default() })
}

impl CAndD {
    fn cell(&self, bits: [u8; 2]) -> Option<&Cell> {
        self.cells.iter().find(|cell| cell.bits == bits)
    }
}

impl Study for CAndD {
    const NAME: &'static str = "c-and-d";
    const TITLE: &'static str = "C against D";
    const CLAIM: &'static str = "\
The box test multiplies a difference, shifted to the right by D bits, by a reciprocal that has C bits more (2.3). Hanika's has \
D = C = 12. The report keeps C - D = 6 bits of the difference that the product has room for, if components of directions are \
taken to be at least 16 units, and finds C = 15, D = 9 the best; it costs less than 2 % of the time and makes fewer artifacts in \
every scene (3).";

    fn measure(setup: &Setup) -> Self {
        let pairs: Vec<[u8; 2]> = C_BITS
            .iter()
            .flat_map(|&c| UNUSED_BITS.iter().filter_map(move |&u| Some([c, c.checked_sub(u)?])))
            .collect();
        let mut cells: Vec<Cell> =
            pairs.iter().map(|&bits| Cell { bits, over_64: Vec::new(), times: Vec::new() }).collect();
        let [plain, refined] =
            [PLAIN, REFINED].map(|wanted| pairs.iter().position(|&bits| bits == wanted).expect("the grid has it"));
        let mut duels = Vec::new();
        for subject in &setup.subjects {
            let blobs: Vec<_> = pairs
                .iter()
                .map(|&bits| {
                    let (name, options) = kernel(bits);
                    (kernels::by_name(name), kernels::blob(name, &subject.model, &options))
                })
                .collect();
            let mut drawers: Vec<Drawer<'_>> = blobs.iter().map(|(entry, blob)| (entry.drawer)(blob)).collect();
            // The first is what the others are compared with.
            drawers.swap(0, plain);
            let mut times = kernels::times(&drawers, setup.rounds);
            times.swap(0, plain);
            for ((cell, time), (entry, blob)) in cells.iter_mut().zip(times).zip(&blobs) {
                cell.over_64.push(subject.over_64_of(&kernels::drawn(entry.name, blob)));
                cell.times.push(time);
            }
            drawers.swap(1, refined);
            duels.extend(kernels::times(&drawers[..2], DUEL * setup.rounds).pop());
        }
        Self { scenes: setup.subjects.iter().map(|subject| subject.name.clone()).collect(), cells, duels }
    }

    fn tables(&self) -> String {
        let shown = |bits: [u8; 2]| {
            let Some(cell) = self.cell(bits) else { return "-".into() };
            let figures = format!("{}, {}", cell.total(), ratio(kernels::geometric_mean(cell.times.iter().copied())));
            if bits == PLAIN || bits == REFINED { format!("**{figures}**") } else { figures }
        };
        let rows = C_BITS.map(|c| {
            let cells = UNUSED_BITS.iter().map(|&unused| c.checked_sub(unused).map_or("-".into(), |d| shown([c, d])));
            [c.to_string()].into_iter().chain(cells).collect()
        });
        let grid = table(&["C", "D = C", "D = C - 3", "D = C - 6"], rows);
        let [plain, refined] = [PLAIN, REFINED].map(|bits| self.cell(bits));
        let rows = self.scenes.iter().enumerate().map(|(scene, name)| {
            let over_64 = |cell: Option<&Cell>| cell.map_or("-".into(), |cell| cell.over_64[scene].to_string());
            let time = ratio(self.duels[scene]);
            vec![name.clone(), over_64(plain), over_64(refined), time]
        });
        format!(
            "Pixels over 64 in all scenes, and the time over that of C = D = 12 (geometric mean over the scenes):\n\n{grid}\
             Scene by scene, and the time of D bits over that of C bits, the two alone in {DUEL} times as many rounds:\n\n{}",
            table(&["scene", "C = 12, over 64", "C = 15, D = 9, over 64", "time"], rows)
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let (Some(plain), Some(refined)) = (self.cell(PLAIN), self.cell(REFINED)) else { return Vec::new() };
        let pairs = || plain.over_64.iter().zip(&refined.over_64);
        let fewer = pairs().filter(|(plain, refined)| refined < plain).count();
        let more = pairs().filter(|(plain, refined)| refined > plain).count();
        let blemished = pairs().filter(|(plain, _)| **plain > 0).count();
        let best = self.cells.iter().map(Cell::total).min().unwrap_or(0);
        let ties = self.cells.iter().filter(|cell| cell.total() == best).map(|cell| format!("{:?}", cell.bits));
        let mut verdicts = vec![
            Verdict {
                claim: "D bits reduce the artifacts of every scene that has some",
                holds: more == 0 && fewer == blemished && blemished > 0,
                because: format!(
                    "{} pixels over 64 become {}; fewer in {fewer} of the {blemished} scenes that have some, more in {more}",
                    plain.total(),
                    refined.total()
                ),
            },
            Verdict {
                claim: "no other pair of this grid has fewer than C = 15, D = 9",
                holds: refined.total() == best,
                because: format!(
                    "{} against {best} with [C, D] = {}",
                    refined.total(),
                    ties.collect::<Vec<_>>().join(", ")
                ),
            },
        ];
        verdicts.extend(kernels::geometric_mean(self.duels.iter().copied()).map(|time| Verdict {
            claim: "D bits cost less than 2 % of the time",
            holds: time < 1.02,
            because: format!("{:+.1} %, geometric mean over the scenes", (time - 1.0) * 100.0),
        }));
        verdicts
    }

    fn plot(&self) -> Option<String> {
        let marks = C_BITS.map(f64::from);
        let line = |unused: u8| {
            let total = |c: u8| c.checked_sub(unused).and_then(|d| self.cell([c, d])).map(|cell| cell.total() as f64);
            // Where C is too small for it, D is 0 already.
            let least =
                self.cell([unused.max(C_BITS[0]), unused.max(C_BITS[0]) - unused]).map(|cell| cell.total() as f64);
            (format!("C - D = {unused}"), C_BITS.iter().map(|&c| total(c).or(least).unwrap_or(0.0)).collect())
        };
        let lines: Vec<(String, Vec<f64>)> = UNUSED_BITS.iter().map(|&unused| line(unused)).collect();
        let plot = Plot {
            title: "Pixels over 64 in all scenes, by C, for the bits of the difference that are kept",
            x: ("C", &marks),
            lines: &lines,
        };
        Some(plot.svg())
    }
}
