//! The leaf threshold: how many triangles a leaf may have.

use host_tools::prepare::Options;
use host_tools::tree::TreeOptions;

use super::kernels::{self, Drawer, Entry};
use super::plot::Plot;
use super::scenes::Subject;
use super::text::{Verdict, ratio, table};
use super::{Setup, Study, TRIANGLES_MAX};

/// The thresholds.
const THRESHOLDS: [u32; 4] = [1, 4, 16, 64];

/// A kernel, over all scenes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// Its name.
    pub(crate) kernel: &'static str,
    /// Whether nothing may change.
    pub(crate) is_exact: bool,
    /// Pixels over 64 for each threshold.
    pub(crate) over_64: Vec<u64>,
    /// Pixels that are not as with a threshold of 1, in any bit, for each threshold.
    pub(crate) changed: Vec<u64>,
    /// The time over that of a threshold of 1, for each threshold.
    pub(crate) times: Vec<Option<f64>>,
}

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeafThreshold {
    /// The kernels.
    pub(crate) rows: Vec<Row>,
}

fn options(leaf_max: u32) -> Options {
    Options { tree: TreeOptions { leaf_max, leaf_always: true, ..TreeOptions::default() }, ..Options::default() }
}

fn row(entry: Entry, subjects: &[&Subject], rounds: usize) -> Row {
    let Entry { name: kernel, is_exact, drawer, .. } = entry;
    let none = vec![0; THRESHOLDS.len()];
    let mut row = Row { kernel, is_exact, over_64: none.clone(), changed: none, times: Vec::new() };
    let mut times = vec![Vec::new(); THRESHOLDS.len()];
    for subject in subjects {
        let mut first = None;
        let blobs = THRESHOLDS.map(|leaf_max| kernels::blob(kernel, &subject.model, &options(leaf_max)));
        for (place, blob) in blobs.iter().enumerate() {
            let picture = kernels::drawn(kernel, blob);
            row.over_64[place] += subject.over_64_of(&picture);
            let first = first.get_or_insert_with(|| picture.clone());
            row.changed[place] += picture.pixels().iter().zip(first.pixels()).filter(|(a, b)| a != b).count() as u64;
        }
        let drawers: Vec<Drawer<'_>> = blobs.iter().map(drawer).collect();
        for (times, time) in times.iter_mut().zip(kernels::times(&drawers, rounds)) {
            times.push(time);
        }
    }
    row.times = times.into_iter().map(kernels::geometric_mean).collect();
    row
}

impl LeafThreshold {
    fn row(&self, kernel: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.kernel == kernel)
    }
}

impl Study for LeafThreshold {
    const NAME: &'static str = "leaf-threshold";
    const TITLE: &'static str = "Leaf threshold";
    const CLAIM: &'static str = "\
The more triangles a leaf may have, the fewer boxes stand between a ray and its triangle. In the report's *conference* with C \
bits, 497 artifacts at a threshold of 1 become 111 at 64; in general larger leaves make fewer artifacts and take more time (4). \
An exact kernel's picture must not change at all: there the study would stop. Scenes of up to 100,000 triangles.";

    fn measure(setup: &Setup) -> Self {
        let subjects: Vec<&Subject> =
            setup.subjects.iter().filter(|subject| subject.model.triangles.len() <= TRIANGLES_MAX).collect();
        let rows: Vec<Row> = kernels::all().into_iter().map(|entry| row(entry, &subjects, setup.rounds)).collect();
        for row in rows.iter().filter(|row| row.is_exact) {
            assert!(row.changed.iter().all(|&changed| changed == 0), "{} depends on the tree", row.kernel);
        }
        Self { rows }
    }

    fn tables(&self) -> String {
        let mut head = vec!["kernel".to_owned()];
        head.extend(THRESHOLDS.map(|threshold| threshold.to_string()));
        let rows = |cells: fn(&Row) -> Vec<String>| {
            let rows = self.rows.iter().map(move |row| {
                let mut line = vec![format!("`{}`", row.kernel)];
                line.extend(cells(row));
                line
            });
            table(&head, rows)
        };
        format!(
            "Pixels over 64 by threshold, all scenes:\n\n{}Pixels that differ from those at 1, in any bit:\n\n{}Time over that \
             at 1, geometric mean over the scenes:\n\n{}",
            rows(|row| row.over_64.iter().map(u64::to_string).collect()),
            rows(|row| row.changed.iter().map(u64::to_string).collect()),
            rows(|row| row.times.iter().map(|&time| ratio(time)).collect()),
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let fewer = |claim: &'static str, kernel: &str| {
            let row = self.row(kernel)?;
            let (first, last) = (*row.over_64.first()?, *row.over_64.last()?);
            Some(Verdict { claim, holds: last < first, because: format!("{first} pixels over 64 at 1, {last} at 64") })
        };
        let slower = self.row("hanika-c").and_then(|row| {
            let last = (*row.times.last()?)?;
            Some(Verdict {
                claim: "larger leaves take more time",
                holds: last > 1.0,
                because: format!("`hanika-c` takes {last:.2} times as long at 64 as at 1"),
            })
        });
        let changed: u64 = self.rows.iter().filter(|row| row.is_exact).flat_map(|row| &row.changed).sum();
        let own = Verdict {
            claim: "the pictures of the exact kernels do not depend on the threshold",
            holds: changed == 0,
            because: format!("{changed} pixels change"),
        };
        let verdicts = [
            fewer("larger leaves make fewer artifacts with C bits", "hanika-c"),
            fewer("larger leaves make fewer artifacts with D bits", "hanika-cd"),
            slower,
            Some(own),
        ];
        verdicts.into_iter().flatten().collect()
    }

    fn plot(&self) -> Option<String> {
        let marks = THRESHOLDS.map(f64::from);
        let lines: Vec<(String, Vec<f64>)> = self
            .rows
            .iter()
            .map(|row| (row.kernel.to_owned(), row.over_64.iter().map(|&count| count as f64).collect()))
            .collect();
        let plot = Plot {
            title: "Pixels over 64 in all scenes, by leaf threshold",
            x: ("triangles in a leaf, at most", &marks),
            lines: &lines,
        };
        Some(plot.svg())
    }
}
