//! `intray inspect`: what is in a scene, and what it takes.

use std::time::Duration;

use core_rt::arithmetic::Arithmetic;
use core_rt::blob::Header;
use firmware_rt::board::Board;
use firmware_rt::build::Traits;
use serde::Serialize;

use super::failure::{Failure, warn};
use super::input::SceneArguments;
use super::load::Scene;
use super::{board, output, progress};
use crate::emulate::costs::{self, Costs};
use crate::emulate::counter::Counter;
use crate::emulate::machine::Machine;
use crate::emulate::{EmulateError, firmware, room};
use crate::engine::Sizes;
use crate::model::Model;
use crate::needs::Asked;
use crate::prepare::Degenerates;

/// How long a run in QEMU may take.
const LIMIT: Duration = Duration::from_secs(600);

/// Count what is in a scene, and what it takes
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Say what each need costs on a board: builds its firmware several times, and counts in QEMU
    #[arg(long, value_parser = board::named())]
    board: Option<&'static Board>,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The answer.
#[derive(Debug, Serialize)]
struct Inspection {
    kernel: &'static str,
    grid_bits: u32,
    /// E, by how many bits edges are shifted to the left; of a kernel that leaves something to the scene.
    edge_shift: Option<u8>,
    /// Triangles that are rendered.
    triangles: u32,
    /// Triangles of the file that have no area on the grid.
    degenerate: u32,
    /// By cause; not known of a blob.
    degenerates: Option<Degenerates>,
    spheres: u32,
    nodes: u32,
    depth: u8,
    materials: u32,
    lights: u32,
    normals: u32,
    width: u16,
    height: u16,
    blob_bytes: u64,
    /// Nodes, triangles, vertices, spheres and ids, shading apart; of each triangle and sphere.
    bytes_per_triangle: f64,
    bytes: Sizes,
    needs: Vec<String>,
    /// Why the scene needs each of them, and what it costs.
    needs_explained: Vec<Explained>,
    /// What all of it costs on a board, if that was asked for.
    costs: Option<OnBoard>,
}

/// A need.
#[derive(Debug, Serialize)]
struct Explained {
    need: String,
    /// How many things ask for it; 0 where the picture as a whole does.
    count: u64,
    /// What these are; empty where the picture as a whole does.
    what: &'static str,
    /// Where they are materials: their names, or of a blob their numbers.
    materials: Vec<String>,
    /// Bytes of the blob that would not be there without it.
    data_bytes: u64,
    /// Bytes of code and constants that would not; none where no board was asked for.
    code_bytes: Option<i64>,
    /// Instructions of its routines and its rays.
    instructions: Option<u64>,
    /// Of all instructions.
    instructions_percent: Option<f64>,
}

/// A scene on a board.
#[derive(Debug, Serialize)]
struct OnBoard {
    board: &'static str,
    /// Checking and rendering: without start, log and wire.
    code_bytes: u64,
    instructions: Option<u64>,
    ram_bytes: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (scene, model) = arguments.scene.load_with_model()?;
    let (header, sizes) = scene.engine.inspect(scene.blob.bytes())?;
    let costs = arguments.board.map(|board| measured(arguments, board, &scene, &header)).transpose()?;
    let (asked, bearers) = scene.engine.asked(scene.blob.bytes())?;
    let named = |number: u32| {
        let name = model.as_ref().and_then(|model| material_of(model, *bearers.get(&number)?));
        name.map_or_else(|| format!("material {number}"), str::to_owned)
    };
    let explained = |asked: Asked| {
        let cost = costs.as_ref().and_then(|(_, costs)| costs.needs.iter().find(|cost| cost.need == asked.need));
        let all = costs.as_ref().and_then(|(_, costs)| costs.instructions);
        let instructions = cost.and_then(|cost| cost.instructions);
        Explained {
            need: asked.need.to_string(),
            count: asked.count,
            what: asked.what,
            materials: asked.materials.into_iter().map(named).collect(),
            data_bytes: asked.bytes,
            code_bytes: cost.map(|cost| cost.code_bytes),
            instructions,
            instructions_percent: instructions.zip(all).map(|(own, all)| 100.0 * own as f64 / all.max(1) as f64),
        }
    };
    let needs_explained = asked.into_iter().map(explained).collect();
    let counts = header.counts;
    let geometry = sizes.nodes + sizes.triangles + sizes.spheres + sizes.ids;
    let found = Inspection {
        kernel: scene.engine.name(),
        grid_bits: scene.engine.grid_bits(),
        // A kernel without knobs has zeros, and the others an epsilon.
        edge_shift: (header.arithmetic != Arithmetic::default()).then_some(header.arithmetic.edge_shift),
        triangles: counts.triangles,
        degenerate: header.file_triangles.saturating_sub(counts.triangles),
        degenerates: scene.degenerates,
        spheres: counts.spheres,
        nodes: counts.nodes,
        depth: header.depth,
        materials: counts.materials,
        lights: counts.lights,
        normals: counts.normals,
        width: header.size[0],
        height: header.size[1],
        blob_bytes: scene.blob.bytes().len() as u64,
        bytes_per_triangle: geometry as f64 / (f64::from(counts.triangles) + f64::from(counts.spheres)),
        bytes: sizes,
        needs: header.needs.iter().map(|need| need.to_string()).collect(),
        needs_explained,
        costs: costs.map(|(board, costs)| OnBoard {
            board: board.name,
            code_bytes: costs.code_bytes,
            instructions: costs.instructions,
            ram_bytes: costs.ram_bytes,
        }),
    };
    if arguments.json { output::json(&found) } else { output::line(&found.table()) }
}

/// The name of the material that a primitive of the file has; `None` where it has no name.
fn material_of(model: &Model, primitive: u32) -> Option<&str> {
    let index = primitive as usize;
    let number = match model.triangles.get(index) {
        Some(triangle) => triangle.material,
        None => model.spheres.get(index.checked_sub(model.triangles.len())?)?.material,
    };
    Some(model.materials.get(number as usize)?.name.as_str()).filter(|name| !name.is_empty())
}

/// What the needs cost on a board.
fn measured(
    arguments: &Arguments,
    board: &'static Board,
    scene: &Scene,
    header: &Header,
) -> Result<(&'static Board, Costs), Failure> {
    let failure = |error: EmulateError| match error {
        error if error.is_input() => Failure::input(format!("{}: {error}", arguments.scene.scene.display())),
        error => Failure::check(error.to_string()),
    };
    let machine = Machine::of(board)?;
    let bytes = scene.blob.bytes();
    firmware::check(board, &Traits::new(scene.engine.id(), header)).map_err(failure)?;
    let help = || "`intray emulate` says what".into();
    room(board, board.blob(scene.engine.id()), bytes.len() as u64, help).map_err(failure)?;
    machine.version().map_err(failure)?;
    let counter = Counter::provide(&machine);
    let counter = counter.inspect_err(|reason| warn(format_args!("instructions are not counted: {reason}"))).ok();
    let bar = progress::bar("measuring", header.needs.iter().count() as u64 + 3);
    let costs = costs::measure(board, bytes, header.needs, counter.as_ref(), LIMIT, &mut || bar.inc(1));
    bar.finish_and_clear();
    Ok((board, costs.map_err(failure)?))
}

impl Explained {
    /// "dielectric: one material, 3.1 KB of code, 14 % of the instructions", with the names.
    fn line(&self) -> String {
        let mut parts = Vec::new();
        if !self.what.is_empty() {
            let plural = if self.count == 1 { "" } else { "s" };
            let names =
                if self.materials.is_empty() { String::new() } else { format!(" ({})", self.materials.join(", ")) };
            parts.push(format!("{} {}{plural}{names}", self.count, self.what));
        }
        if self.data_bytes > 0 {
            parts.push(format!("{} bytes of data", self.data_bytes));
        }
        parts.extend(self.code_bytes.map(|bytes| format!("{bytes} bytes of code")));
        let percent = self.instructions_percent.filter(|&percent| percent > 0.0);
        parts.extend(percent.map(|percent| format!("{percent:.1} % of the instructions")));
        let separator = if parts.is_empty() { "" } else { ": " };
        format!("  {}{separator}{}", self.need, parts.join(", "))
    }
}

impl Inspection {
    fn table(&self) -> String {
        let edge_shift = self.edge_shift.map_or_else(String::new, |shift| format!(", edge shift {shift}"));
        let rows = [
            ("kernel", format!("{} ({}-bit grid{edge_shift})", self.kernel, self.grid_bits)),
            ("picture", format!("{}x{}", self.width, self.height)),
            ("triangles", format!("{} ({} degenerate ones left out)", self.triangles, self.degenerate)),
            ("spheres", self.spheres.to_string()),
            ("tree", format!("{} nodes, {} levels", self.nodes, self.depth)),
            ("shading", format!("{} materials, {} lights, {} normals", self.materials, self.lights, self.normals)),
            ("needs", self.needs.join(", ")),
            ("blob", format!("{} bytes", self.blob_bytes)),
            ("  nodes", format!("{} bytes", self.bytes.nodes)),
            ("  triangles", format!("{} bytes", self.bytes.triangles)),
            ("  spheres", format!("{} bytes", self.bytes.spheres)),
            ("  ids", format!("{} bytes", self.bytes.ids)),
            ("  normals", format!("{} bytes", self.bytes.normals)),
            ("  paint", format!("{} bytes, and {} of texels", self.bytes.paint, self.bytes.texels)),
            ("  shading", format!("{} bytes", self.bytes.shading)),
            ("a triangle", format!("{:.1} bytes of nodes, vertices and ids", self.bytes_per_triangle)),
        ];
        let shown = |name: &str| self.spheres > 0 || name.trim() != "spheres";
        let rows = rows.into_iter().filter(|(name, _)| shown(name));
        let mut lines: Vec<String> = rows.map(|(name, value)| format!("{name:<12} {value}")).collect();
        if let Some(OnBoard { board, code_bytes, instructions, ram_bytes }) = &self.costs {
            let instructions = instructions.map_or_else(String::new, |count| format!(", {count} instructions"));
            lines.push(format!("{board:<12} {code_bytes} bytes of code, {ram_bytes} of RAM{instructions}"));
        }
        lines.extend(self.needs_explained.iter().map(Explained::line));
        lines.join("\n")
    }
}
