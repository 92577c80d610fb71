//! The edge shift: fixed, or the scene's.

use core_rt::arithmetic::Knobs;
use core_rt::hanika::HanikaCd;
use host_tools::grid::Grid;
use host_tools::model::Model;
use host_tools::prepare::Options;

use super::plot::Plot;
use super::text::{Verdict, table};
use super::{Setup, Study};

const KERNEL: &str = "hanika-cd";
/// The fixed values.
const SHIFTS: [u8; 16] = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18];
/// Hanika's.
const HANIKA: u8 = 10;
/// Within which the report's scenes are.
const REPORT: [u8; 2] = [3, 12];

/// A scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    /// Its name.
    pub(crate) scene: String,
    /// Pixels over 64 for each fixed value.
    pub(crate) fixed: Vec<u64>,
    /// The scene's own value.
    pub(crate) own: u8,
    /// Pixels over 64 with it.
    pub(crate) own_over_64: u64,
    /// The triangle that forces it.
    pub(crate) forced_by: Thinnest,
}

/// The triangle whose edges are longest for its normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Thinnest {
    /// Its place in the file.
    pub(crate) prim: u32,
    /// The largest component of an edge along p or q, grid units.
    pub(crate) edge: u64,
    /// The largest component of the normal, N_r: twice the area of the projection.
    pub(crate) normal: u64,
}

impl Thinnest {
    /// The largest E for which `edge * 2^E` is at most `normal`.
    pub(crate) fn edge_shift(self) -> u8 {
        (0..=29).rev().find(|e| self.edge << e <= self.normal).unwrap_or(0)
    }
}

/// The triangle that forces the edge shift: the greatest edge over N_r, by cross products of fractions.
pub(crate) fn thinnest(model: &Model) -> Option<Thinnest> {
    let grid = Grid::fit::<HanikaCd>(model).ok()?;
    let mut worst: Option<Thinnest> = None;
    for (prim, [a, b, c]) in (0..).zip(grid.snap(model).iter()) {
        let edge = |to: [i32; 3]| [0, 1, 2].map(|axis| i64::from(to[axis]) - i64::from(a[axis]));
        let (e1, e2) = (edge(b), edge(c));
        let normal = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (e1[j] * e2[k] - e1[k] * e2[j]).unsigned_abs()
        });
        let Some(r) = (0..3).rev().max_by_key(|&axis| normal[axis]).filter(|&r| normal[r] > 0) else { continue };
        let along =
            |e: [i64; 3]| (0..3).filter(|&axis| axis != r).map(|axis| e[axis].unsigned_abs()).max().unwrap_or(0);
        let found = Thinnest { prim, edge: along(e1).max(along(e2)), normal: normal[r] };
        let product = |a: u64, b: u64| u128::from(a) * u128::from(b);
        if worst.is_none_or(|w| product(found.edge, w.normal) > product(w.edge, found.normal)) {
            worst = Some(found);
        }
    }
    worst
}

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct EdgeShift {
    /// The scenes.
    pub(crate) rows: Vec<Row>,
}

fn options(edge_shift: Option<u8>) -> Options {
    Options { knobs: Knobs { edge_shift, ..Knobs::default() }, ..Options::default() }
}

impl Study for EdgeShift {
    const NAME: &'static str = "edge-shift";
    const TITLE: &'static str = "Edge shift";
    const CLAIM: &'static str = "\
Edges over N_r are shifted to the left by E bits, and clamped, before they become fixed-point numbers (2.2). Hanika finds E = 10 \
enough; the report's scenes want 3 to 12, so it takes the greatest E with which nothing of a scene is clamped. Measured with \
`hanika-cd`. The triangle that forces a scene's E is that of the longest edge for its N_r, both in grid units.";

    fn measure(setup: &Setup) -> Self {
        let row = |subject: &super::scenes::Subject| {
            let forced_by = thinnest(&subject.model).expect("a scene has triangles");
            let over_64 = |shift| subject.over_64(KERNEL, &options(shift));
            Row {
                scene: subject.name.clone(),
                fixed: SHIFTS.iter().map(|&shift| over_64(Some(shift))).collect(),
                own: forced_by.edge_shift(),
                own_over_64: over_64(None),
                forced_by,
            }
        };
        Self { rows: setup.subjects.iter().map(row).collect() }
    }

    fn tables(&self) -> String {
        let mut head = vec!["scene".to_owned()];
        head.extend(SHIFTS.map(|shift| shift.to_string()));
        head.push("the scene's".into());
        let rows = self.rows.iter().map(|row| {
            let mut line = vec![row.scene.clone()];
            line.extend(row.fixed.iter().map(u64::to_string));
            line.push(format!("{} (E = {})", row.own_over_64, row.own));
            line
        });
        let forced = self.rows.iter().map(|row| {
            let Thinnest { prim, edge, normal } = row.forced_by;
            vec![row.scene.clone(), row.own.to_string(), prim.to_string(), edge.to_string(), normal.to_string()]
        });
        format!(
            "Pixels over 64 by E:\n\n{}What forces a scene's own E:\n\n{}",
            table(&head, rows),
            table(&["scene", "E", "triangle", "longest edge", "N_r"], forced)
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let own = |pick: fn(u8, u8) -> u8| self.rows.iter().map(|row| row.own).reduce(pick).unwrap_or(0);
        let (least, most) = (own(u8::min), own(u8::max));
        let at_hanika = |row: &Row| SHIFTS.iter().zip(&row.fixed).find(|(e, _)| **e == HANIKA).map_or(0, |(_, &n)| n);
        let spoilt: Vec<&str> =
            self.rows.iter().filter(|row| at_hanika(row) > row.own_over_64).map(|row| row.scene.as_str()).collect();
        let best = |row: &Row| row.fixed.iter().copied().min().unwrap_or(0);
        let beaten: Vec<&str> =
            self.rows.iter().filter(|row| best(row) < row.own_over_64).map(|row| row.scene.as_str()).collect();
        let names = |names: &[&str]| if names.is_empty() { "none".into() } else { names.join(", ") };
        vec![
            Verdict {
                claim: "E = 10 shows errors that the scene's own E does not",
                holds: !spoilt.is_empty(),
                because: format!("more pixels over 64 in: {}", names(&spoilt)),
            },
            Verdict {
                claim: "scenes want an E of 3 to 12",
                holds: least >= REPORT[0] && most <= REPORT[1],
                because: format!("here {least} to {most}"),
            },
            Verdict {
                claim: "a scene's own E is as good as any fixed one",
                holds: beaten.is_empty(),
                because: format!("some other has fewer pixels over 64 in: {}", names(&beaten)),
            },
        ]
    }

    fn plot(&self) -> Option<String> {
        let marks = SHIFTS.map(f64::from);
        let line = |row: &Row| {
            let values = row.fixed.iter().map(|&count| count as f64).collect();
            (format!("{} (own E: {})", row.scene, row.own), values)
        };
        let lines: Vec<(String, Vec<f64>)> =
            self.rows.iter().filter(|row| row.fixed.iter().any(|&count| count > 1)).map(line).collect();
        let plot =
            Plot { title: "Pixels over 64 by edge shift, of scenes that have some", x: ("E", &marks), lines: &lines };
        Some(plot.svg())
    }
}
