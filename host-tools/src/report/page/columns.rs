//! The columns of a study's table.

use std::collections::BTreeSet;

use crate::report::row::{Cost, Instructions, Measured, Point, Row, Time, name};

use super::context::{drawn, settings};
use super::cost::machine_name;
use super::metric::{percent, pixel_count};
use super::number::{grouped, significant};
use super::summary::duration;
use super::table::{Cell, Column};

fn count(value: u64) -> Cell {
    Cell::Number(grouped(value), value as f64)
}

fn figure(value: f64) -> Cell {
    Cell::Number(significant(value), value)
}

fn fixed(value: f64, digits: usize) -> Cell {
    Cell::Number(format!("{value:.digits$}"), value)
}

/// The least magnitude that a share of pixels can have has as many digits as the picture needs.
fn share(pixels: u64, point: &Point) -> Cell {
    figure(percent(pixels, point))
}

fn a_ray(value: u64, measured: &Measured) -> Cell {
    if measured.rays == 0 { Cell::Empty } else { figure(value as f64 / measured.rays as f64) }
}

/// A title, what it means, and how a cell is made.
type Given<F = OfPoint> = (&'static str, &'static str, F);

type OfPoint = fn(&Point, &Measured) -> Cell;
type OfTime = fn(&Time) -> Cell;
type OfWork = fn(&Instructions) -> Cell;

const ERRORS: [Given; 8] = [
    ("over 64, %", "pixels whose gray difference exceeds 64", |point, measured| share(measured.error.over_64, point)),
    ("over 4, %", "pixels whose gray difference exceeds 4", |point, measured| share(measured.error.over_4, point)),
    ("over 1, %", "pixels whose gray difference exceeds 1", |point, measured| share(measured.error.over_1, point)),
    ("max", "the greatest difference of a channel, of 255", |_, measured| count(u64::from(measured.error.max_abs))),
    ("RMSE", "the root of the mean squared difference of a channel", |_, measured| fixed(measured.error.rmse, 3)),
    ("PSNR, dB", "20 log10(255 / RMSE)", |_, measured| match measured.error.psnr {
        Some(psnr) => fixed(psnr, 2),
        None => Cell::Number("equal".into(), f64::INFINITY),
    }),
    ("SSIM", "mean structural similarity of the luma", |_, measured| fixed(measured.error.ssim, 6)),
    ("FLIP", "mean LDR-FLIP, 0 to 1", |_, measured| fixed(measured.error.flip, 6)),
];

const TIMES: [Given<OfTime>; 4] = [
    ("time", "the median round, one thread", |time| Cell::Number(duration(time.seconds), time.seconds)),
    ("× f32's", "the median ratio to the time of f32 in the same round", |time| fixed(time.ratio[1], 3)),
    ("least to greatest", "that ratio's spread over the rounds", |time| {
        Cell::Number(format!("{:.3} to {:.3}", time.ratio[0], time.ratio[2]), time.ratio[2] - time.ratio[0])
    }),
    ("rounds", "how often it was drawn", |time| count(u64::from(time.rounds))),
];

const WORK: [Given; 2] = [
    ("instr. a ray", "instructions over all rays", |_, measured| match &measured.cost {
        Cost::Instructions(work) => a_ray(work.instructions, measured),
        Cost::Time(_) => Cell::Empty,
    }),
    ("instr. a pixel", "instructions over the pixels of the picture", |point, measured| match &measured.cost {
        Cost::Instructions(work) => figure(work.instructions as f64 / pixel_count(point) as f64),
        Cost::Time(_) => Cell::Empty,
    }),
];

const MEMORY: [Given<OfWork>; 3] = [
    ("instructions", "from the first camera ray of each tile to its last pixel", |work| count(work.instructions)),
    ("code, B", "code and constants", |work| count(work.text_bytes)),
    ("RAM, B", "variables and the stack at its deepest", |work| count(work.ram_bytes)),
];

const SCENE: [Given; 6] = [
    ("blob, B", "the scene as it is stored", |_, measured| count(measured.blob_bytes)),
    ("primitives", "triangles and spheres in the blob", |_, measured| count(measured.primitives)),
    ("rays", "all rays", |_, measured| count(measured.rays)),
    ("box tests a ray", "", |_, measured| a_ray(measured.box_tests, measured)),
    ("triangle tests a ray", "spheres' too", |_, measured| a_ray(measured.triangle_tests, measured)),
    ("CRC-32", "of the picture's RGB888 bytes; the same on all machines", |_, measured| {
        Cell::Word(measured.image_crc32.clone())
    }),
];

/// The columns for rows that were drawn, and what all of them have in common.
pub(super) fn columns(rows: &[&Row]) -> (Vec<Column>, String) {
    let rows = drawn(rows);
    let column = |title: &str, hint, cell: &dyn Fn(&Point, &Measured) -> Cell| Column {
        title: title.into(),
        hint,
        cells: rows.iter().map(|(point, measured)| cell(point, measured)).collect(),
    };
    let mut columns = vec![
        column("scene", "", &|point, _| Cell::Word(point.scene.clone())),
        column("machine", "", &|point, _| Cell::Word(name(&point.machine))),
        column("kernel", "", &|point, _| Cell::Word(point.kernel.clone())),
    ];
    let mut common = Vec::new();
    for setting_name in ["size", "samples", "depth", "c", "d", "e", "leaf", "grid", "triangles"] {
        let setting = |point: &Point| settings(point).into_iter().find(|set| set.0 == setting_name).map(|set| set.1);
        let all: BTreeSet<Option<String>> = rows.iter().map(|(point, _)| setting(point)).collect();
        if all.len() > 1 {
            let hint = if setting_name == "triangles" { "what the mesh is decimated to" } else { "" };
            columns.push(column(setting_name, hint, &|point, _| {
                let number = |text: &String| text.parse().unwrap_or(pixel_count(point) as f64);
                setting(point).map_or(Cell::Empty, |text| Cell::Number(text.clone(), number(&text)))
            }));
        } else if let Some(Some(value)) = all.first() {
            common.push(format!("{setting_name} {value}"));
        }
    }
    columns.extend(ERRORS.iter().map(|given| column(given.0, given.1, &given.2)));
    columns.extend(TIMES.iter().map(|(title, hint, cell)| {
        column(title, hint, &|_, measured| match &measured.cost {
            Cost::Time(time) => cell(time),
            Cost::Instructions(_) => Cell::Empty,
        })
    }));
    columns.extend(WORK.iter().map(|given| column(given.0, given.1, &given.2)));
    let work = |cell: &dyn Fn(&Instructions) -> Cell, measured: &Measured| match &measured.cost {
        Cost::Instructions(work) => cell(work),
        Cost::Time(_) => Cell::Empty,
    };
    for (title, hint, cell) in &MEMORY {
        columns.push(column(title, hint, &|_, measured| work(cell, measured)));
    }
    let models: BTreeSet<&String> = rows
        .iter()
        .filter_map(|(_, measured)| match &measured.cost {
            Cost::Instructions(work) => Some(work.cycles.keys()),
            Cost::Time(_) => None,
        })
        .flatten()
        .collect();
    for model in models {
        let hint = "cycles as this model has them, not measured";
        columns.push(column(&format!("cycles, model {model}"), hint, &|_, measured| {
            work(&|work| work.cycles.get(model).map_or(Cell::Empty, |&cycles| count(cycles)), measured)
        }));
    }
    columns.extend(SCENE.iter().map(|given| column(given.0, given.1, &given.2)));
    (columns, common.join(", "))
}

/// The table of all kernels over all scenes.
pub(super) fn overview(rows: &[super::overview::Overview]) -> Vec<Column> {
    use super::overview::Overview;
    let column = |title: &str, hint, cell: &dyn Fn(&Overview) -> Cell| Column {
        title: title.into(),
        hint,
        cells: rows.iter().map(cell).collect(),
    };
    let of = |values: Option<[f64; 2]>, index: usize| values.map_or(Cell::Empty, |values| figure(values[index]));
    vec![
        column("machine", "", &|row| Cell::Word(machine_name(row.machine).into())),
        column("kernel", "", &|row| Cell::Word(row.kernel.clone())),
        column("drawn", "of the scenes that were tried", &|row| {
            Cell::Number(format!("{} of {}", row.drawn.0, row.drawn.1), row.drawn.0 as f64)
        }),
        column("speed, × f32", "geometric mean of how many times as fast as f32 it is", &|row| {
            row.speed.map_or(Cell::Empty, |speed| Cell::Number(format!("{:.2}", speed[1]), speed[1]))
        }),
        column("least to greatest", "over the scenes", &|row| {
            let text = |speed: [f64; 3]| format!("{:.2} to {:.2}", speed[0], speed[2]);
            row.speed.map_or(Cell::Empty, |speed| Cell::Number(text(speed), speed[0]))
        }),
        column("over 64, %: median", "of the scenes", &|row| of(row.over_64, 0)),
        column("most", "of any scene", &|row| of(row.over_64, 1)),
        column("over 4, %: median", "of the scenes", &|row| of(row.over_4, 0)),
        column("most", "of any scene", &|row| of(row.over_4, 1)),
    ]
}
