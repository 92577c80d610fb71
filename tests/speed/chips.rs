//! What scenes take on chips, by kernel, by kind of ray and by part of the program, beside soft float in the same firmware:
//! the same scene, the same tree and the same tracing loop; what is exchanged is the arithmetic.

use std::fmt::Write;

use firmware_rt::board::Board;
use firmware_rt::hits::Way;
use host_tools::emulate::counter::{Counter, Counts};
use tests::chips::{Job, scene};

use crate::table::{table, thousands};

/// What others are compared with.
const FLOAT: &str = "f32";

/// What is measured: its name, the scene, its size, whether it is drawn quickly too, and the nearest hits alone.
const WORK: [(&str, &str, [u32; 2], Option<Way>); 5] = [
    ("camera rays of bench-1k, one by one", "bench-1k", [80, 64], Some(Way::Single)),
    ("camera rays of bench-1k, by tiles", "bench-1k", [160, 128], Some(Way::Tile)),
    ("bench-1k, whole pictures", "bench-1k", [48, 40], None),
    ("the built-in scene, whole pictures", "built-in", [48, 36], None),
    ("raystones, whole pictures", "raystones", [40, 20], None),
];

/// Whose pictures are taken apart.
const APART: (&str, [u32; 2]) = ("built-in", [48, 36]);

const KERNELS: [&str; 3] = ["exact14", "exact29", FLOAT];

/// One kernel's work on one board.
struct Row {
    work: &'static str,
    board: &'static str,
    kernel: &'static str,
    pixels: u64,
    counts: Counts,
}

/// All of it.
pub(crate) struct Chips {
    rows: Vec<Row>,
    /// By board and kernel.
    apart: Vec<(&'static str, &'static str, String)>,
}

pub(crate) fn measure(boards: &[(&'static Board, Counter)], quick: bool) -> Chips {
    let halved = |[width, height]: [u32; 2]| if quick { [width / 2, height / 2] } else { [width, height] };
    let (mut rows, mut apart) = (Vec::new(), Vec::new());
    for (board, counter) in boards {
        for (work, name, size, hits) in WORK {
            let size = halved(size);
            for kernel in KERNELS {
                let counts = Job::new(board, &scene(name, size), kernel, hits).counts(counter);
                rows.push(Row {
                    work,
                    board: board.name,
                    kernel,
                    pixels: size.map(u64::from).iter().product(),
                    counts,
                });
            }
        }
        for kernel in ["exact14", FLOAT] {
            let (name, size) = APART;
            let job = Job::new(board, &scene(name, halved(size)), kernel, None);
            let plain = job.counts(counter).instructions;
            apart.push((board.name, kernel, job.breakdown(counter, plain).table()));
        }
    }
    Chips { rows, apart }
}

impl Chips {
    pub(crate) fn text(&self) -> String {
        let mut text = String::from(
            "## Chips\n\nInstructions and cycles a pixel, and how many times fewer than soft float takes for the same rays of the \
             same scene (`f32`, by the compiler's own library, in the same firmware). Where camera rays go by tiles, those of \
             the exact kernels walk together. No faster library of soft float is to be had as a crate: `softfloat` and \
             `const_soft_float` are the compiler's own routines for use in constants, `simple-soft-float` and `minifloat` are \
             made to be read, and `softfloat-sys` is a C library for hosts.\n\n",
        );
        let head = ["", "board", "kernel", "instructions", "times fewer", "cycles, model"].map(String::from);
        let rows = self.rows.iter().map(|row| {
            let a_pixel = |count: u64| thousands(count.div_ceil(row.pixels));
            let is_its = |other: &&Row| (other.work, other.board, other.kernel) == (row.work, row.board, FLOAT);
            let float = self.rows.iter().find(is_its).map_or(0, |other| other.counts.instructions);
            let cycles = row.counts.cycles.iter().map(|(model, &cycles)| format!("{} ({model})", a_pixel(cycles)));
            vec![
                row.work.into(),
                row.board.into(),
                format!("`{}`", row.kernel),
                a_pixel(row.counts.instructions),
                format!("{:.1}", float as f64 / row.counts.instructions as f64),
                cycles.collect::<Vec<_>>().join(", "),
            ]
        });
        text += &table(&head, rows);
        text += "The built-in scene, by kind of ray and by part of the program:\n\n";
        for (board, kernel, table) in &self.apart {
            // A string takes text.
            let _ = write!(text, "`{kernel}` on {board}:\n\n```text\n{table}\n```\n\n");
        }
        text
    }
}
