//! What the firmware of every board does: check the blob in its place, render it tile by tile, send, report.

use core_rt::blob::{BlobError, PREFIX_SIZE, Prefix};
use core_rt::bvh::Waiting;
use core_rt::kernel::Kernel;
use core_rt::profile::{Needs, Profile};
use core_rt::render::{Tile, Workspace, render_tile};
use core_rt::scene::Scene;
use core_rt::stats::{Counts, NoStats, Stats};
use core_rt::whitted::Branch;
use zerocopy::{FromBytes, IntoBytes};

use crate::board::{Board, Region};
use crate::frame::{Begin, Report, TileHead};
use crate::hits::{self, HITS_FORMAT, Way};
use crate::marks::Marks;
use crate::refusal::Refusal;
use crate::status::Status;
use crate::transport::{Error, Link, Wire};
use crate::{by_hand, stack, window};

/// Pixels a side of a tile.
pub const TILE: u16 = 16;

/// Pixels of a tile.
pub const PIXELS: usize = TILE as usize * TILE as usize;

/// The bytes that a tile's pixels take, under a profile and for what is drawn.
#[must_use]
pub const fn tile_bytes(needs: Needs, draw: Draw) -> usize {
    match draw {
        Draw::Picture | Draw::ByHand => PIXELS * needs.pixel_bytes(),
        Draw::Hits(_) => PIXELS * HITS_FORMAT.bytes(),
    }
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Draw {
    /// The picture.
    Picture,
    /// The nearest hits alone.
    Hits(Way),
    /// The picture of the smallest profile, by a loop for it alone.
    ByHand,
}

/// What a firmware was built for; `build` emits the one there is.
pub trait Firmware {
    /// What the scene may need.
    type Profile: Profile;
    /// Where everything lies.
    const BOARD: &'static Board;
    /// What is drawn.
    const DRAW: Draw;
    /// Whether work is counted; it then takes longer.
    const COUNT: bool;
    /// Whether the kinds of ray are marked; it then takes a little longer.
    const MARKS: bool;
}

/// All that rendering stores, for trees of at most `DEPTH` levels, pixels of which `BRANCHES` rays may wait, and tiles of at
/// most `BYTES`.
#[derive(Debug)]
pub struct Storage<K: Kernel, const DEPTH: usize, const BRANCHES: usize, const BYTES: usize> {
    stack: heapless::Vec<Waiting<K>, DEPTH>,
    branches: heapless::Vec<Branch<K>, BRANCHES>,
    hits: [u32; PIXELS],
    pixels: [u8; BYTES],
}

impl<K: Kernel, const DEPTH: usize, const BRANCHES: usize, const BYTES: usize> Storage<K, DEPTH, BRANCHES, BYTES> {
    /// Nothing yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { stack: heapless::Vec::new(), branches: heapless::Vec::new(), hits: [0; PIXELS], pixels: [0; BYTES] }
    }
}

impl<K: Kernel, const DEPTH: usize, const BRANCHES: usize, const BYTES: usize> Default
    for Storage<K, DEPTH, BRANCHES, BYTES>
{
    fn default() -> Self {
        Self::new()
    }
}

/// Renders the blob in its place; the status to end with. The stack was painted.
pub fn run<F: Firmware, const DEPTH: usize, const BRANCHES: usize, const BYTES: usize>(
    storage: &mut Storage<<F::Profile as Profile>::Kernel, DEPTH, BRANCHES, BYTES>,
) -> Status {
    let Storage { stack, branches, hits, pixels } = storage;
    let mut workspace = Workspace { stack, branches, hits, pixels };
    if F::COUNT {
        let mut counts = Counts::default();
        rendered::<F, _>(&mut workspace, &mut counts, |counts| *counts)
    } else if F::MARKS {
        rendered::<F, _>(&mut workspace, &mut Marks, |_| Counts::default())
    } else {
        rendered::<F, _>(&mut workspace, &mut NoStats, |_| Counts::default())
    }
}

type KernelOf<F> = <<F as Firmware>::Profile as Profile>::Kernel;

fn rendered<F: Firmware, S: Stats>(
    workspace: &mut Workspace<'_, KernelOf<F>>,
    stats: &mut S,
    counts: fn(&S) -> Counts,
) -> Status {
    let link = Link::start();
    let blob = blob(F::BOARD.blob(KernelOf::<F>::ID));
    defmt::info!("{=str}: a blob of {=usize} bytes for {=str}", F::BOARD.name, blob.len(), KernelOf::<F>::NAME);
    // Matched by reference: a scene is not small, and the stack would have it twice.
    let scene = checked::<F::Profile>(blob);
    let scene = match &scene {
        Ok(scene) => scene,
        Err(error) => {
            defmt::error!("the blob was refused: {}", Refusal(error));
            return Status::Refused;
        }
    };
    let capacity = workspace.stack.capacity();
    if capacity < usize::from(scene.frame.depth) {
        defmt::error!("the tree has {=u8} levels, and this firmware is for {=usize}", scene.frame.depth, capacity);
        return Status::Storage;
    }
    let room = workspace.branches.capacity();
    if room < scene.branches() {
        defmt::error!(
            "{=usize} rays of a pixel may wait, and this firmware has room for {=usize}",
            scene.branches(),
            room
        );
        return Status::Storage;
    }
    match link.open().and_then(|wire| drawn::<F, S>(scene, wire, workspace, stats, counts)) {
        Ok(()) => Status::Done,
        Err(_) => {
            defmt::error!("the host does not take what is sent");
            Status::Wire
        }
    }
}

/// Apart, so that the stack that the check takes is free again for the drawing.
#[inline(never)]
fn checked<P: Profile>(blob: &[u8]) -> Result<Scene<'_, P>, BlobError> {
    Scene::new_checked(blob)
}

/// Draws every tile and sends it.
fn drawn<F: Firmware, S: Stats>(
    scene: &Scene<'_, F::Profile>,
    mut wire: Wire,
    workspace: &mut Workspace<'_, KernelOf<F>>,
    stats: &mut S,
    counts: fn(&S) -> Counts,
) -> Result<(), Error> {
    let [width, height] = scene.frame.size;
    let format = match F::DRAW {
        Draw::Picture | Draw::ByHand => scene.frame.format,
        Draw::Hits(_) => HITS_FORMAT,
    };
    wire.send(Begin::KIND, &[Begin { width, height, format: format.number() }.as_bytes()])?;
    for tile in Tile::of(scene.frame.size, [TILE; 2]) {
        let pixels = draw::<F>(scene, tile, workspace, stats);
        let head = TileHead { x: tile.x, y: tile.y, width: tile.width, height: tile.height };
        wire.send(TileHead::KIND, &[head.as_bytes(), pixels])?;
    }
    let counts = counts(stats);
    // SAFETY: the stack's memory is what the board says, by the linker script that is made from it.
    let stack_bytes = unsafe { stack::deepest(F::BOARD.stack) };
    let report = Report {
        stack_bytes,
        counted: F::COUNT.into(),
        primary_rays: counts.primary_rays,
        shadow_rays: counts.shadow_rays,
        reflection_rays: counts.reflection_rays,
        refraction_rays: counts.refraction_rays,
        box_tests: counts.box_tests,
        triangle_tests: counts.triangle_tests,
    };
    defmt::info!("{=u16}x{=u16} pixels, {=u32} bytes of stack", width, height, stack_bytes);
    wire.send(Report::KIND, &[report.as_bytes()])
}

/// Draws one tile. What is between the marks is what is measured.
#[inline(never)]
fn draw<'w, F: Firmware>(
    scene: &Scene<'_, F::Profile>,
    tile: Tile,
    workspace: &'w mut Workspace<'_, KernelOf<F>>,
    stats: &mut impl Stats,
) -> &'w [u8] {
    let count = tile.pixels().min(PIXELS);
    let mut bytes = count * HITS_FORMAT.bytes();
    window::intray_window_begin();
    match F::DRAW {
        Draw::Picture => {
            // The storage has room for the scene and for every tile: there is no error left.
            bytes = render_tile(scene, tile, workspace, stats).map_or(0, <[u8]>::len);
        }
        Draw::ByHand => bytes = by_hand::draw(scene, tile, workspace),
        Draw::Hits(way) => {
            let hits = workspace.hits.get_mut(..count).unwrap_or_default();
            hits::find(scene, tile, way, hits, workspace.pixels, workspace.stack, stats);
        }
    }
    window::intray_window_end();
    if let Draw::Hits(_) = F::DRAW {
        hits::paint(scene, workspace.hits, workspace.pixels);
    }
    workspace.pixels.get(..bytes).unwrap_or_default()
}

/// The blob in its place, as long as it says, or as long as there is room.
pub(crate) fn blob(place: Region) -> &'static [u8] {
    let first = core::ptr::without_provenance::<u8>(place.start as usize);
    // SAFETY: flash, which is mapped whether or not anything was put into it, and which nothing writes to.
    let room = unsafe { core::slice::from_raw_parts(first, place.length as usize) };
    let length = match Prefix::read_from_prefix(room) {
        Ok((prefix, _)) => (prefix.total_size as usize).clamp(PREFIX_SIZE, room.len()),
        Err(_) => PREFIX_SIZE,
    };
    room.get(..length).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core_rt::profile::Need;

    #[test]
    fn a_tile_takes_what_its_format_takes() {
        let bytes = |format, draw| tile_bytes(Needs::NONE.with(format, true).with(Need::Shadows, true), draw);
        let formats = [Need::Rgb888, Need::Rgb565, Need::Gray8];
        assert_eq!(formats.map(|format| bytes(format, Draw::Picture)), [768, 512, 256]);
        // Triangles' numbers are always painted in colour.
        assert_eq!(formats.map(|format| bytes(format, Draw::Hits(Way::Tile))), [768; 3]);
        assert_eq!(tile_bytes(Needs::ALL, Draw::Picture), 768);
    }
}
