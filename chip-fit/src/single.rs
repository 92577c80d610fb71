//! One chip, in full, for a person.

use crate::cli::Asked;
use crate::database::Kind;
use crate::fit::{Judged, Margin, Time};

/// The answer for a chip.
pub(crate) fn text(asked: &Asked, judged: &Judged<'_>) -> String {
    let Judged { chip, kind, margin, time } = *judged;
    let need = asked.needs.iter().find(|need| Some(need.isa) == chip.isa());
    // A chip that nothing is linked for is refused before.
    let (Some(need), Some(margin)) = (need, margin) else { return String::new() };
    let verdict = if margin.fits() { "fits" } else { "does not fit" };
    let stack = if need.stack_is_measured { "stack at its deepest" } else { "reserved for the stack" };
    let mut lines = vec![
        format!("{} {verdict} {} ({}, {})", headline(asked), chip.name, chip.family, chip.core()),
        format!(
            "flash {:>9} of {:>9} bytes, {}: {} of code and {} of scene",
            need.flash(),
            chip.flash,
            left(margin.flash),
            need.text_bytes,
            need.scene_bytes
        ),
        format!(
            "RAM   {:>9} of {:>9} bytes, {}: {} of variables and {} of {stack}",
            need.ram(),
            chip.ram,
            left(margin.ram),
            need.static_bytes,
            need.stack_bytes
        ),
    ];
    lines.push(match (time, chip.known, need.instructions) {
        (Some(time), Some(row), Some(instructions)) => format!(
            "about {} s a frame at {} MHz: {instructions} instructions, {}",
            seconds(time),
            row.clock_mhz,
            model(time)
        ),
        (_, None, Some(instructions)) => {
            format!("{instructions} instructions a frame; its clock is not in the table, so there are no seconds")
        }
        _ => "seconds a frame: not counted".into(),
    });
    lines.extend(remarks(judged));
    if !margin.fits() {
        lines.push(format!("what would help: {}", asked.help(need, chip, margin)));
    }
    if kind == Kind::Float {
        lines.push("it has an FPU: this works, and leaves it idle".into());
    }
    lines.join("\n")
}

/// What a scene is, in a few words.
pub(crate) fn headline(asked: &Asked) -> String {
    let [width, height] = asked.header.size;
    format!("{} at {width}x{height} by {}", asked.name, asked.scene.engine.name())
}

/// Seconds, to three digits.
pub(crate) fn seconds(time: Time) -> String {
    let Time { seconds, .. } = time;
    let places = match seconds {
        ..10.0 => 2,
        ..100.0 => 1,
        _ => 0,
    };
    format!("{seconds:.places$}")
}

/// Where the cycles come from.
fn model(time: Time) -> String {
    match time.cycle_model {
        Some(model) => format!("cycles modelled as a {model}'s without wait states"),
        None => "a cycle each, which is the least".into(),
    }
}

fn left(margin: i64) -> String {
    match margin {
        ..0 => format!("{} too many", margin.unsigned_abs()),
        _ => format!("{margin} left"),
    }
}

/// What is to be known besides.
fn remarks(judged: &Judged<'_>) -> Vec<String> {
    let mut remarks = Vec::new();
    if judged.kind == Kind::Unknown {
        remarks.push(format!(
            "whether its core ({}) has an FPU is not in the table; the firmware does without, and is the same",
            judged.chip.core()
        ));
    }
    if judged.chip.known.is_some_and(|row| row.flash_is_apart) {
        remarks
            .push("its flash is a chip of its own: the database has the addresses for it, the board its size".into());
    }
    remarks
}

/// What is missing, in words.
pub(crate) fn missing(margin: Margin) -> String {
    let of = |margin: i64, what: &str| (margin < 0).then(|| format!("{} bytes of {what}", margin.unsigned_abs()));
    [of(margin.flash, "flash"), of(margin.ram, "RAM")].into_iter().flatten().collect::<Vec<_>>().join(" and ")
}
