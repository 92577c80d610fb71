//! Cases on chips: by one firmware a board and kernel, which has what all of them need.

use std::fmt;
use std::time::Duration;

use core_rt::bvh::Waiting;
use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::{HanikaC, HanikaCd, HanikaCons};
use core_rt::kernel::Kernel;
use core_rt::whitted::Branch;
use firmware_rt::board::{BOARDS, Board};
use float_rt::{Float32, Float64};

use super::Case;
use super::cases::DEEPEST;
use super::host::{Done, options};
use super::row::{Figures, Outcome, Row};
use crate::emulate::counter::Counter;
use crate::emulate::elf::Elf;
use crate::emulate::firmware::Wanted;
use crate::emulate::machine::Machine as Emulator;
use crate::emulate::{EmulateError, Run, planes, room};
use crate::engine::{Engine, PLANES12};
use crate::model::{LightKind, Model, Projection, Sphere};
use crate::report::row::Machine;

/// How long one picture may take.
const LIMIT: Duration = Duration::from_secs(120);

/// Pixels of a tile of the firmware (`firmware_rt::run`, which hosts do not have).
const PIXELS: usize = 256;

/// RAM for variables that are not a scene's storage.
const OTHERS: usize = 512;

/// A board with the firmware of a kernel.
pub struct Chip {
    board: &'static Board,
    engine: &'static dyn Engine,
    elf: Elf,
    counter: Option<Counter>,
    /// From how many surfaces its rays may go on.
    depth: u32,
}

impl fmt::Debug for Chip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { board, engine, elf, .. } = self;
        f.debug_struct("Chip").field("board", &board.name).field("kernel", &engine.name()).field("elf", elf).finish()
    }
}

/// The board that a machine is.
#[must_use]
pub fn board(machine: Machine) -> Option<&'static Board> {
    let target = match machine {
        Machine::Host => return None,
        Machine::Rv32imac => "riscv32imac",
        Machine::Thumbv6m => "thumbv6m",
    };
    BOARDS.into_iter().find(|board| board.target.starts_with(target))
}

/// Whether chips have a kernel: `f64` has no firmware worth its time.
#[must_use]
pub fn has(engine: &dyn Engine) -> bool {
    engine.name() != "f64"
}

impl Chip {
    /// The firmware for all of the cases, built if need be, on the board of a machine.
    ///
    /// # Errors
    /// What is missing here to build or to emulate it.
    pub fn provide(board: &'static Board, engine: &'static dyn Engine, cases: &[Case]) -> Result<Self, EmulateError> {
        let emulator = Emulator::of(board)?;
        emulator.version()?;
        if engine.id() == PLANES12.id() {
            let elf = planes::provide(board)?;
            return Ok(Self { board, engine, elf, counter: Counter::provide(&emulator).ok(), depth: u32::MAX });
        }
        let depth = depth(engine.name(), board);
        let needing = union(cases, depth);
        // What it needs stands in its header, and a chip never sees it.
        let prepared = engine.prepare(&needing, &options(Some(1)));
        let prepared = prepared.map_err(|_| EmulateError::Damaged("the scene that needs everything has no blob"))?;
        let wanted = Wanted { board, blob: prepared.blob.bytes(), hits: None, count: false };
        Ok(Self { board, engine, elf: wanted.provide()?, counter: Counter::provide(&emulator).ok(), depth })
    }

    /// The kernel.
    #[must_use]
    pub fn engine(&self) -> &'static dyn Engine {
        self.engine
    }

    /// A case that the host has done by the same kernel.
    #[must_use]
    pub fn run(&self, machine: Machine, case: &Case, done: &Done) -> Row {
        let row = Row { machine, work: None, relative_work: None, ..done.row.clone() };
        let refused =
            |reason: String| Row { outcome: Outcome::Refused, measured: None, figures: None, reason, ..row.clone() };
        let Some(drawn) = &done.drawn else { return row };
        if !case.chips {
            return refused("it is for a host alone".into());
        }
        let bytes = drawn.blob.bytes();
        let place = planes::place(self.board, self.engine.id());
        if let Err(error) = room(self.board, place, bytes.len() as u64, || "a smaller scene".into()) {
            return refused(error.to_string());
        }
        let asked = self
            .engine
            .inspect(bytes)
            .map_or(0, |(header, _)| if header.needs.branches() { header.max_depth } else { 0 });
        if u32::from(asked) > self.depth {
            let bytes = storage(self.engine.name())[1];
            return refused(format!(
                "rays that go on from {asked} surfaces take {bytes} bytes each while they wait, and the RAM of {} is \
                 enough for {}",
                self.board.name, self.depth
            ));
        }
        let run =
            Run { board: self.board, elf: &self.elf, blob: Some(bytes), counter: self.counter.as_ref(), limit: LIMIT };
        match run.perform(&mut Vec::new()) {
            Err(error) => {
                Row { outcome: Outcome::Fail, measured: None, figures: None, reason: error.to_string(), ..row }
            }
            Ok(outcome) => {
                let crc = format!("{:08x}", outcome.picture.crc32());
                let work = outcome.counts.map(|counts| counts.instructions as f64 / drawn.rays.max(1) as f64);
                let is_same = outcome.picture == drawn.picture;
                let figures = row.figures.clone().map(|figures| Figures { image_crc32: crc, ..figures });
                let row = Row { work, figures, ..row };
                if is_same {
                    row
                } else {
                    Row { outcome: Outcome::Fail, reason: "its picture is not the host's".into(), ..row }
                }
            }
        }
    }
}

/// From how many surfaces rays may go on: as many as there is RAM for, of those that a case may ask for.
fn depth(kernel: &str, board: &Board) -> u32 {
    let [waiting, branch] = storage(kernel);
    // A traversal of the deepest tree, the ids and the bytes of a tile, and what is not counted here.
    let taken = 64 * waiting + PIXELS * (4 + 3) + OTHERS;
    let rays = (board.ram.length as usize).saturating_sub(taken) / branch;
    // Firmware has room for a multiple of four rays, one of which is taken up at once.
    ((rays / 4 * 4).saturating_sub(1) as u32).min(64)
}

/// The bytes of a node, and of a ray, that waits.
fn storage(kernel: &str) -> [usize; 2] {
    const fn of<K: Kernel>() -> [usize; 2] {
        [size_of::<Waiting<K>>(), size_of::<Branch<K>>()]
    }
    match kernel {
        "exact14" => of::<Exact14>(),
        "exact20" => of::<Exact20>(),
        "exact29" => of::<Exact29>(),
        "hanika-c" => of::<HanikaC>(),
        "hanika-cd" => of::<HanikaCd>(),
        "hanika-cons" => of::<HanikaCons>(),
        "f32" => of::<Float32>(),
        _ => of::<Float64>(),
    }
}

/// A scene that needs whatever any of the cases needs: their materials on the triangles of the deepest tree, their lights, a
/// sphere, parallel rays.
fn union(cases: &[Case], depth: u32) -> Model {
    let subjects: Vec<Model> = cases.iter().filter(|case| case.chips).map(|case| (case.subject)().model).collect();
    let mut whole =
        cases.iter().find(|case| case.name == DEEPEST).map_or_else(Model::default, |case| (case.subject)().model);
    whole.materials = subjects.iter().flat_map(|model| model.materials.clone()).collect();
    whole.lights = subjects.iter().flat_map(|model| model.lights.clone()).collect();
    // A light that is far away would take the grid's bits, and its place is nobody's need.
    for light in &mut whole.lights {
        if let LightKind::Point(place) = &mut light.kind {
            *place = whole.camera.position;
        }
    }
    let materials = whole.materials.len() as u32;
    let mut repeated = whole.triangles.clone();
    while (repeated.len() as u32) < materials {
        repeated.extend(whole.triangles.clone());
    }
    repeated.iter_mut().zip(0..).for_each(|(triangle, i)| triangle.material = i % materials);
    whole.triangles = repeated;
    if let Some(sphere) = subjects.iter().flat_map(|model| &model.spheres).next() {
        whole.spheres.push(Sphere { centre: whole.camera.look_at, radius: 0.5, ..*sphere });
    }
    if subjects.iter().any(|model| matches!(model.camera.projection, Projection::Orthographic { .. })) {
        whole.camera.projection = Projection::Orthographic { height: 1.0 };
    }
    whole.render.max_depth = depth;
    whole
}
