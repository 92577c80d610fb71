//! `intray inspect`: what is in a scene, and what it takes.

use core_rt::arithmetic::Arithmetic;
use serde::Serialize;

use super::failure::Failure;
use super::input::SceneArguments;
use super::output;
use crate::engine::Sizes;
use crate::prepare::Degenerates;

/// Count what is in a scene, and what it takes
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

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
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = arguments.scene.load()?;
    let (header, sizes) = scene.engine.inspect(scene.blob.bytes())?;
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
    };
    if arguments.json { output::json(&found) } else { output::line(&found.table()) }
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
        rows.map(|(name, value)| format!("{name:<12} {value}")).collect::<Vec<_>>().join("\n")
    }
}
