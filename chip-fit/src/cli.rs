//! The command line of `intray fit`.

use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use core_rt::blob::Header;
use firmware_rt::build::Traits;
use host_tools::cli::{Failure, Scene, SceneArguments, output, progress, smaller, warn};
use host_tools::emulate::firmware;
use host_tools::emulate::{EmulateError, Observer};
use host_tools::engine::Sizes;
use indicatif::ProgressBar;
use serde::Serialize;

use crate::core::Isa;
use crate::database::{self, Chip, Kind};
use crate::fit::{Judged, Margin, Time};
use crate::need::{self, Need};
use crate::{listing, single};

/// Say which chips a scene fits, and by how much it misses others.
///
/// Sizes come from a link of the scene's firmware, seconds from its instructions in an emulator, by a model of the core's
/// cycles.
#[derive(Debug, Parser)]
#[command(name = "intray fit", bin_name = "intray fit", version)]
struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// One chip, in full
    #[arg(long, value_name = "NAME")]
    chip: Option<String>,

    /// Stop the emulator after so long
    #[arg(long, value_name = "SECONDS", default_value_t = 600, value_parser = clap::value_parser!(u64).range(1..))]
    timeout: u64,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A scene, and what it takes.
#[derive(Debug)]
pub(crate) struct Asked {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) header: Header,
    pub(crate) sizes: Sizes,
    pub(crate) needs: Vec<Need>,
}

impl Asked {
    /// What would make it fit a chip that it misses, in words.
    pub(crate) fn help(&self, need: &Need, chip: &Chip, margin: Margin) -> String {
        let needs = self.header.needs;
        let shallow = (needs.branches() && self.header.max_depth > 0).then_some("`--depth 0`");
        let narrow = (self.scene.engine.name() != "exact14").then_some("the kernel exact14");
        let gray = (needs.pixel_bytes() > 1).then_some("`--format gray8`");
        let or = |means: &[Option<&str>]| means.iter().flatten().copied().collect::<Vec<_>>().join(" or ");
        let mut help = Vec::new();
        let room = need.room(chip.flash);
        if margin.flash < 0 && room > 0 {
            help.push(smaller(&self.scene, &self.header, &self.sizes, room));
        } else if margin.flash < 0 {
            help.push(match or(&[shallow, narrow]) {
                means if means.is_empty() => "nothing, as the code alone is larger than the flash".into(),
                means => format!("less code, which alone is larger than the flash, by {means}"),
            });
        }
        if margin.ram < 0 {
            help.push(match or(&[shallow, narrow, gray]) {
                means if means.is_empty() => "nothing, as variables and stack are the least that there are".into(),
                means => format!("less RAM by {means}"),
            });
        }
        help.retain(|means| !means.is_empty());
        help.join("; ")
    }
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report<'a> {
    scene: &'a str,
    kernel: &'static str,
    width: u16,
    height: u16,
    needs: Vec<NeedReport<'a>>,
    /// Chips without an FPU that it fits.
    fits: usize,
    /// Chips without an FPU that it does not.
    misses: usize,
    /// Chips that may have an FPU.
    unknown: usize,
    chips: Vec<ChipReport<'a>>,
}

#[derive(Debug, Serialize)]
struct NeedReport<'a> {
    #[serde(flatten)]
    need: &'a Need,
    flash_bytes: u64,
    ram_bytes: u64,
}

#[derive(Debug, Serialize)]
struct ChipReport<'a> {
    name: &'a str,
    family: &'a str,
    core: String,
    kind: Kind,
    isa: Option<Isa>,
    clock_mhz: Option<u32>,
    flash_bytes: u64,
    /// Whether these are addresses for another chip, and not bytes.
    flash_is_apart: bool,
    ram_bytes: u64,
    /// Whether there is enough memory, whatever its core.
    fits: Option<bool>,
    #[serde(flatten)]
    margin: Option<Margin>,
    #[serde(flatten)]
    time: Option<Time>,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
}

/// Runs the command that the process was called with.
#[must_use]
pub fn run() -> ExitCode {
    match answer(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

fn answer(arguments: &Arguments) -> Result<(), Failure> {
    let chips = database::chips();
    let asked_chip = arguments.chip.as_deref().map(|name| chip(&chips, name)).transpose()?;
    let isas: Vec<Isa> =
        Isa::ALL.into_iter().filter(|&isa| asked_chip.is_none_or(|chip| chip.isa() == Some(isa))).collect();
    let asked = asked(arguments, &isas, asked_chip)?;
    if let Some(chip) = asked_chip {
        let judged = Judged::new(chip, &asked.needs);
        if arguments.json {
            output::json(&report(&asked, &[judged]))?;
        } else {
            output::line(&single::text(&asked, &judged))?;
        }
        return match judged.margin.filter(|margin| !margin.fits()) {
            None => Ok(()),
            Some(margin) => {
                Err(Failure::check(format!("{} has {} too few for it", chip.name, single::missing(margin))))
            }
        };
    }
    let judged: Vec<Judged<'_>> = chips.iter().map(|chip| Judged::new(chip, &asked.needs)).collect();
    if arguments.json { output::json(&report(&asked, &judged)) } else { output::line(&listing::text(&asked, &judged)) }
}

/// The chip of a name, if a scene can be held against it.
fn chip<'a>(chips: &'a [Chip], name: &str) -> Result<&'a Chip, Failure> {
    let chip = database::find(chips, name).map_err(|nearest| {
        Failure::input(format!("no chip is called {name}; the nearest are {}", nearest.join(", ")))
    })?;
    match chip.kind() {
        Kind::Foreign => Err(Failure::input(format!(
            "{}: there is no firmware for its core ({}); there is some for thumbv6m and rv32imac",
            chip.name,
            chip.core()
        ))),
        Kind::Unmapped => {
            Err(Failure::input(format!("{}: its flash and RAM are not known; name the chip exactly", chip.name)))
        }
        Kind::Integer | Kind::Float | Kind::Unknown => Ok(chip),
    }
}

/// Reads the scene, and finds what it takes; a blob that is larger than the chip that was asked for is refused at once.
fn asked(arguments: &Arguments, isas: &[Isa], chip: Option<&Chip>) -> Result<Asked, Failure> {
    let scene = arguments.scene.load_for_chip()?;
    let (header, sizes) = scene.engine.inspect(scene.blob.bytes())?;
    let name = arguments.scene.scene.display().to_string();
    let failure = |error: EmulateError| match error {
        error if error.is_input() => Failure::input(format!("{name}: {error}")),
        error => Failure::check(error.to_string()),
    };
    let bytes = scene.blob.bytes().len() as u64;
    if let Some(chip) = chip.filter(|chip| bytes > chip.flash) {
        return Err(Failure::input(format!(
            "{name}: the blob has {bytes} bytes, and {} has {} of flash: {} too many, without its code. What would help: {}",
            chip.name,
            chip.flash,
            bytes - chip.flash,
            smaller(&scene, &header, &sizes, chip.flash)
        )));
    }
    let traits = Traits::new(scene.engine.id(), &header);
    for board in isas.iter().flat_map(|isa| isa.boards()) {
        firmware::check(board, &traits).map_err(failure)?;
    }
    let limit = Duration::from_secs(arguments.timeout);
    let mut needs = Vec::new();
    for &isa in isas {
        let pixels = header.size.map(u64::from).iter().product();
        let mut shown = Shown(progress::bar(isa.name(), pixels));
        let measured = need::measure(isa, scene.blob.bytes(), scene.engine.id(), limit, &mut shown);
        shown.0.finish_and_clear();
        let measured = measured.map_err(failure)?;
        measured.notes.iter().for_each(warn);
        needs.push(measured.need);
    }
    Ok(Asked { name, scene, header, sizes, needs })
}

/// Shows how far a picture is.
struct Shown(ProgressBar);

impl Observer for Shown {
    fn log(&mut self, _: &str) {}

    fn pixels(&mut self, count: u64) {
        self.0.inc(count);
    }
}

fn report<'a>(asked: &'a Asked, judged: &[Judged<'a>]) -> Report<'a> {
    let count = |is: &dyn Fn(&Judged<'_>) -> bool| judged.iter().filter(|judged| is(judged)).count();
    let [width, height] = asked.header.size;
    let needs = asked.needs.iter();
    Report {
        scene: &asked.name,
        kernel: asked.scene.engine.name(),
        width,
        height,
        needs: needs.map(|need| NeedReport { need, flash_bytes: need.flash(), ram_bytes: need.ram() }).collect(),
        fits: count(&|judged| judged.fits()),
        misses: count(&|judged| judged.misses()),
        unknown: count(&|judged| judged.kind == Kind::Unknown),
        chips: judged.iter().map(|chip| chip_report(asked, chip)).collect(),
    }
}

fn chip_report<'a>(asked: &Asked, judged: &Judged<'a>) -> ChipReport<'a> {
    let Judged { chip, kind, margin, time } = *judged;
    let need = asked.needs.iter().find(|need| Some(need.isa) == chip.isa());
    let missed = need.zip(margin).filter(|(_, margin)| !margin.fits());
    ChipReport {
        name: &chip.name,
        family: &chip.family,
        core: chip.core(),
        kind,
        isa: chip.isa(),
        clock_mhz: chip.known.map(|row| row.clock_mhz),
        flash_bytes: chip.flash,
        flash_is_apart: chip.known.is_some_and(|row| row.flash_is_apart),
        ram_bytes: chip.ram,
        fits: margin.map(Margin::fits),
        margin,
        time,
        help: missed.map(|(need, margin)| asked.help(need, chip, margin)),
    }
}
