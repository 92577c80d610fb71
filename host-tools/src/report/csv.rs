//! Rows as a flat table: a line each, a column for every figure, empty where there is none.

use super::row::{Cause, Causes, Cost, Instructions, Measured, Outcome, Point, Row, Time, name};

/// The columns, in order. `docs/REPORT.md` says what they are.
pub const COLUMNS: [&str; 62] = [
    "scene",
    "study",
    "machine",
    "kernel",
    "width",
    "height",
    "samples",
    "depth",
    "leaf",
    "grid_bits",
    "triangles",
    "c",
    "d",
    "e",
    "reference_samples",
    "outcome",
    "reason",
    "over_64",
    "over_4",
    "over_1",
    "max_abs",
    "mean_abs",
    "rmse",
    "psnr",
    "ssim",
    "flip",
    "holes",
    "holes_over_4",
    "holes_over_64",
    "visibility",
    "visibility_over_4",
    "visibility_over_64",
    "secondary",
    "secondary_over_4",
    "secondary_over_64",
    "shadow",
    "shadow_over_4",
    "shadow_over_64",
    "shading",
    "shading_over_4",
    "shading_over_64",
    "quantisation",
    "quantisation_over_4",
    "quantisation_over_64",
    "seconds",
    "ratio_least",
    "ratio_median",
    "ratio_greatest",
    "rounds",
    "instructions",
    "cycles_cortex_m0",
    "cycles_cortex_m0plus",
    "text_bytes",
    "ram_bytes",
    "blob_bytes",
    "primitives",
    "rays",
    "box_tests",
    "triangle_tests",
    "image_crc32",
    "picture",
    "truth",
];

/// A header line and a line for each row; RFC 4180, but for line ends of one character.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut text = COLUMNS.join(",");
    for row in rows {
        text.push('\n');
        text.push_str(&line(row));
    }
    text.push('\n');
    text
}

fn line(row: &Row) -> String {
    let mut cells = of_point(&row.point);
    match &row.outcome {
        Outcome::Measured(measured) => {
            cells.extend(["measured".into(), String::new()]);
            cells.extend(of_figures(measured));
        }
        Outcome::Failed(reason) => {
            cells.extend(["failed".into(), quoted(reason)]);
            cells.resize(COLUMNS.len(), String::new());
        }
    }
    cells.join(",")
}

/// Text that may have anything in it.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

fn shown<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

fn of_point(point: &Point) -> Vec<String> {
    let Point {
        scene,
        study,
        kernel,
        machine,
        size,
        samples,
        depth,
        leaf,
        grid_bits,
        triangles,
        knobs,
        reference_samples,
    } = point;
    let [c, d, e] = knobs.map(shown);
    let [width, height] = size.map(|side| side.to_string());
    let numbers = [shown(*leaf), shown(*grid_bits), shown(*triangles), c, d, e, shown(*reference_samples)];
    let point = [scene.clone(), name(study), name(machine), kernel.clone(), width, height];
    point.into_iter().chain([samples.to_string(), depth.to_string()]).chain(numbers).collect()
}

fn of_figures(measured: &Measured) -> Vec<String> {
    let Measured { error, causes, cost, .. } = measured;
    let Causes { holes, visibility, secondary, shadow, shading, quantisation } = causes;
    let mut cells = vec![
        error.over_64.to_string(),
        error.over_4.to_string(),
        error.over_1.to_string(),
        error.max_abs.to_string(),
        error.mean_abs.to_string(),
        error.rmse.to_string(),
        shown(error.psnr),
        error.ssim.to_string(),
        error.flip.to_string(),
    ];
    for Cause { pixels, over_4, over_64 } in [holes, visibility, secondary, shadow, shading, quantisation] {
        cells.extend([pixels, over_4, over_64].map(u64::to_string));
    }
    match cost {
        Cost::Time(Time { seconds, ratio, rounds }) => {
            cells.push(seconds.to_string());
            cells.extend(ratio.map(|ratio| ratio.to_string()));
            cells.push(rounds.to_string());
            cells.extend([const { String::new() }; 5]);
        }
        Cost::Instructions(Instructions { instructions, cycles, text_bytes, ram_bytes }) => {
            cells.extend([const { String::new() }; 5]);
            cells.push(instructions.to_string());
            cells.extend(["cortex-m0", "cortex-m0plus"].map(|model| shown(cycles.get(model))));
            cells.extend([text_bytes, ram_bytes].map(u64::to_string));
        }
    }
    let Measured { blob_bytes, primitives, rays, box_tests, triangle_tests, image_crc32, picture, truth, .. } =
        measured;
    cells.extend([blob_bytes, primitives, rays, box_tests, triangle_tests].map(u64::to_string));
    cells.extend([image_crc32, picture, truth].map(String::clone));
    cells
}
