//! From a model to a blob: grid, degenerates, tree, records, header, checksum.
//!
//! Whatever the device will use is made by the device's own integer code; f64 ends at the grid.

mod camera;
mod examiner;
mod header;
mod layers;
mod layout;
mod loss;
mod lustre;
mod paint;
mod shared;
mod survey;

pub use examiner::Examiner;
pub(crate) use header::transfer;
pub use layout::Blob;
pub use loss::{Keeper, Loss, losses};
pub use paint::unplaced;

pub(crate) use camera::camera;
pub(crate) use header::light;

use shared::Shared;

use core_rt::arithmetic::Knobs;
use core_rt::bvh::Child;
use core_rt::kernel::{Bounds, Kernel};
use core_rt::profile::Prefer;
use core_rt::record::Material;
use core_rt::sphere::Ball;
use thiserror::Error;

use crate::grid::{Grid, GridError, LEAST_BITS, Snapped};
use crate::model::Model;
use crate::planes::scene::PlanesError;
use crate::textures::Texels;
use crate::tree::{self, Tree, TreeOptions};

/// How a scene is prepared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The tree.
    pub tree: TreeOptions,
    /// What is asked of the kernel's arithmetic.
    pub knobs: Knobs,
    /// The bits of the grid, from [`LEAST_BITS`] to the kernel's own; `None` for those.
    pub grid_bits: Option<u32>,
    /// How texels are stored; `None` for the way that suits the output.
    pub texels: Option<Texels>,
    /// What a chip has less of: with [`Prefer::Speed`] triangles have a record each, with all that its test wants; with
    /// [`Prefer::Size`] corners among shared vertices, of which records are made whenever they are tested. Pictures are the same.
    pub prefer: Prefer,
}

/// The tree that suits what a chip has less of. Of `exact14` on bench-1k, bytes of nodes a triangle and instructions a ray on a
/// Cortex-M0 with records, by the cost of a triangle: 0.8: 8.8, 2,564; 1.0: 11.7, 2,454; 1.2: 14.0, 2,385; 2.0: 18.0, 2,334;
/// 3.0: 27.1, 2,360. Hosts do not feel it.
#[must_use]
pub fn tree_for(prefer: Prefer) -> TreeOptions {
    match prefer {
        Prefer::Speed => TreeOptions::default(),
        Prefer::Size => TreeOptions { triangle_cost: 1.0, ..TreeOptions::default() },
    }
}

/// Why a scene cannot be prepared for a kernel.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum PrepareError {
    /// No grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Nothing for the tracer of 1994.
    #[error(transparent)]
    Planes(#[from] PlanesError),
    /// Nothing is left.
    #[error(
        "none of {} on the {bits}-bit grid of {kernel}, so nothing is left to render; {}",
        what_there_was(*.triangles, *.spheres),
        advice(*.keeper)
    )]
    AllDegenerate {
        /// How many triangles there were.
        triangles: usize,
        /// How many spheres there were.
        spheres: usize,
        /// The grid's bits.
        bits: u32,
        /// The kernel's name.
        kernel: &'static str,
        /// A kernel that keeps some.
        keeper: Option<Keeper>,
    },
    /// More triangles and spheres than a tree can refer to.
    #[error("the scene has {found} triangles and spheres, and a blob holds at most {most}")]
    TooManyTriangles {
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: u32,
    },
    /// More materials than a triangle's record can refer to.
    #[error("the scene uses {found} materials, and {kernel} holds at most {most}; exact29 holds more")]
    TooManyMaterials {
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: u32,
        /// The kernel's name.
        kernel: &'static str,
    },
    /// A grid of more bits than the kernel has, or of too few.
    #[error("a grid of {asked} bits; {kernel} has grids of {LEAST_BITS} to {most}")]
    GridBits {
        /// What is asked for.
        asked: u32,
        /// The kernel's own.
        most: u32,
        /// The kernel's name.
        kernel: &'static str,
    },
    /// The kernel has not the knobs that are asked for, or not in that range.
    #[error("{kernel} cannot be set so: {ranges}")]
    Knobs {
        /// What it has.
        ranges: &'static str,
        /// The kernel's name.
        kernel: &'static str,
    },
    /// The blob would not fit its size field.
    #[error("the blob would be {bytes} bytes long, and the format ends at 4 GiB")]
    TooLarge {
        /// How long it would be.
        bytes: u64,
    },
}

/// What is too small for a grid.
fn what_there_was(triangles: usize, spheres: usize) -> String {
    match (triangles, spheres) {
        (_, 0) => format!("{triangles} triangles has an area"),
        (0, _) => format!("{spheres} spheres has a size"),
        _ => format!("{triangles} triangles and {spheres} spheres has a size"),
    }
}

/// What to do where a kernel's grid keeps no triangle.
fn advice(keeper: Option<Keeper>) -> String {
    let closer = "bring the camera and the lights closer to them, or make the lights directional";
    match keeper {
        None => format!("check the vertices, or {closer}"),
        Some(Keeper { kernel, kept }) => format!("{kernel} keeps {kept} of them, or {closer}"),
    }
}

/// What has no size on the grid: triangles without an area, by cause (the columns of the 2009 report's Table 2 are their sum),
/// and spheres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Degenerates {
    /// Two corners are one.
    pub zero_edge: u32,
    /// Three corners are in one line.
    pub zero_area: u32,
    /// Spheres whose radius is less than [`Kernel::RADIUS_MIN`].
    pub spheres: u32,
}

impl Degenerates {
    /// All triangles of them.
    #[must_use]
    pub const fn total(self) -> u32 {
        self.zero_edge + self.zero_area
    }
}

/// A scene, ready for a kernel.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The blob.
    pub blob: Blob,
    /// What was left out.
    pub degenerates: Degenerates,
    /// The grid.
    pub grid: Grid,
}

/// The grid that a kernel has for a model, of as many bits as [`Options::grid_bits`] says.
///
/// # Errors
/// Where it has none.
pub fn grid<K: Kernel>(model: &Model, grid_bits: Option<u32>) -> Result<Grid, PrepareError> {
    let asked = grid_bits.unwrap_or(K::GRID_BITS);
    if !(LEAST_BITS..=K::GRID_BITS).contains(&asked) {
        return Err(PrepareError::GridBits { asked, most: K::GRID_BITS, kernel: K::NAME });
    }
    Ok(Grid::fit_to::<K>(model, asked)?)
}

/// Prepares a model for a kernel.
///
/// # Errors
/// Where the kernel cannot hold the scene.
pub fn prepare<K: Kernel>(model: &Model, options: &Options) -> Result<Prepared, PrepareError> {
    let primitives = model.triangles.len() + model.spheres.len();
    if primitives >= Child::INDEX_END as usize {
        return Err(PrepareError::TooManyTriangles { found: primitives, most: Child::INDEX_END - 1 });
    }
    let (used, materials) = used_materials(model);
    if used.len() > K::MATERIALS_MAX as usize + 1 {
        return Err(PrepareError::TooManyMaterials { found: used.len(), most: K::MATERIALS_MAX + 1, kernel: K::NAME });
    }
    let grid = grid::<K>(model, options.grid_bits)?;
    let snapped = grid.snap(model);
    let (ids, mut degenerates) = with_area(&snapped);
    let balls = with_room::<K>(model, &grid, &mut degenerates);
    if ids.is_empty() && balls.is_empty() {
        return Err(PrepareError::AllDegenerate {
            triangles: model.triangles.len(),
            spheres: model.spheres.len(),
            bits: options.grid_bits.unwrap_or(K::GRID_BITS),
            kernel: K::NAME,
            keeper: loss::keeps_some(options.grid_bits.unwrap_or(K::GRID_BITS), model),
        });
    }
    let Tree { root, nodes, order, depth } = tree::build_mixed(
        ids.iter().map(|&id| Bounds::of(&snapped.corners(id))),
        balls.iter().map(|(_, ball)| ball.bounds()),
        options.tree,
    );
    let (ids, balls) = in_order(ids, balls, order);
    let refused = || PrepareError::Knobs { ranges: K::KNOBS, kernel: K::NAME };
    let arithmetic = K::settle(&options.knobs, ids.iter().map(|&id| snapped.corners(id))).ok_or_else(refused)?;
    let settings = K::settings(&arithmetic).ok_or_else(refused)?;
    let number = |&id: &u32| materials[model.triangles[id as usize].material as usize];
    // What does not fit is not among `balls`.
    let sphere = |&(number, ball): &(u32, Ball)| {
        let material = materials[model.spheres[number as usize].material as usize];
        K::sphere(&ball, material).expect("a sphere that the grid and the kernel hold")
    };
    let sphere_ids: Vec<u32> = balls.iter().map(|&(number, _)| model.triangles.len() as u32 + number).collect();
    let (mut lustres, mut checkers) = (Vec::new(), Vec::new());
    let textured = used.clone();
    let used: Vec<Material> = used
        .iter()
        .map(|&m| {
            let material = &model.materials[m as usize];
            let lustre = shared(&mut lustres, lustre::lustre(material));
            header::material(material, lustre, shared(&mut checkers, header::checker(material, &grid)))
        })
        .collect();
    let share = || Shared::of(ids.iter().map(|&id| (snapped.corners(id), number(&id))));
    let shared = (options.prefer == Prefer::Size).then(share);
    // A few triangles that share nothing are smaller as they are.
    let shared = shared.filter(|shared| shared.bytes::<K>(used.len()) < ids.len() * size_of::<K::Triangle>());
    let have_records = shared.is_none() && balls.is_empty();
    let material_bits = if have_records { room_for_ids::<K>(model.triangles.len(), used.len()) } else { None };
    // Corners are on the grid and have area, and materials were counted: `triangle` has no reason left to refuse.
    let triangle = |&id: &u32| {
        let beside = material_bits.map_or(0, |bits| id << bits);
        K::triangle(settings, &snapped.corners(id), beside | number(&id))
            .expect("a triangle that the grid and the kernel hold")
    };
    let with_record = if shared.is_some() { [].as_slice() } else { &ids };
    let blob = layout::write::<K>(
        model,
        &grid,
        layout::Parts {
            root,
            depth,
            arithmetic,
            material_bits,
            nodes: nodes.into_iter().map(|node| K::node(node.boxes, node.children)),
            triangles: with_record.iter().map(triangle),
            shared,
            spheres: balls.iter().map(sphere),
            ids: &ids,
            sphere_ids: &sphere_ids,
            materials: &used,
            lustres: &lustres,
            checkers: &checkers,
            paint: paint::paint(
                model,
                &ids,
                &textured,
                options.texels.unwrap_or_else(|| Texels::of(model.render.format)),
            ),
        },
    )?;
    Ok(Prepared { blob, degenerates, grid })
}

/// The triangles and the spheres in the order of the tree, for the memory of those in their old one.
fn in_order(ids: Vec<u32>, balls: Vec<(u32, Ball)>, mut order: Vec<u32>) -> (Vec<u32>, Vec<(u32, Ball)>) {
    let of_spheres = order.split_off(ids.len());
    let balls = of_spheres.iter().map(|&place| balls[place as usize - ids.len()]).collect();
    order.iter_mut().for_each(|place| *place = ids[*place as usize]);
    (order, balls)
}

/// The bits of a record's material number that materials take, where triangles' ids have room beside them: these then take no
/// bytes of their own.
fn room_for_ids<K: Kernel>(triangles: usize, materials: usize) -> Option<u8> {
    let bits = |count: usize| u64::BITS - (count.saturating_sub(1) as u64).leading_zeros();
    let [id, material] = [bits(triangles), bits(materials)];
    (id + material <= K::MATERIALS_MAX.trailing_ones()).then_some(material as u8)
}

/// The number of a record and 1, which is added where there is none like it; 0 for none. Materials often share one.
fn shared<T: PartialEq>(records: &mut Vec<T>, record: Option<T>) -> u16 {
    record.map_or(0, |record| {
        let place = records.iter().position(|known| *known == record).unwrap_or_else(|| {
            records.push(record);
            records.len() - 1
        });
        place as u16 + 1
    })
}

/// The materials that triangles and spheres refer to, and the new number of each old one.
fn used_materials(model: &Model) -> (Vec<u32>, Vec<u32>) {
    let mut numbers = vec![u32::MAX; model.materials.len()];
    let mut used = Vec::new();
    let triangles = model.triangles.iter().map(|triangle| triangle.material);
    for material in triangles.chain(model.spheres.iter().map(|sphere| sphere.material)) {
        let number = &mut numbers[material as usize];
        if *number == u32::MAX {
            *number = used.len() as u32;
            used.push(material);
        }
    }
    (used, numbers)
}

/// The ids of triangles with area on the grid, and the count of the others.
fn with_area(snapped: &Snapped<'_>) -> (Vec<u32>, Degenerates) {
    let mut degenerates = Degenerates::default();
    let mut ids = Vec::with_capacity(snapped.len());
    for (id, corners) in (0..).zip(snapped.iter()) {
        let [a, b, c] = corners;
        if survey::has_area(corners) {
            ids.push(id);
        } else if a == b || b == c || c == a {
            degenerates.zero_edge += 1;
        } else {
            degenerates.zero_area += 1;
        }
    }
    (ids, degenerates)
}

/// The spheres that a kernel can hold, by their number in the file; the others are counted.
fn with_room<K: Kernel>(model: &Model, grid: &Grid, degenerates: &mut Degenerates) -> Vec<(u32, Ball)> {
    let all = (0..).zip(model.spheres.iter().map(|sphere| grid.ball(sphere)));
    let kept: Vec<(u32, Ball)> = all.filter(|(_, ball)| ball.fits::<K>()).collect();
    degenerates.spheres = (model.spheres.len() - kept.len()) as u32;
    kept
}
