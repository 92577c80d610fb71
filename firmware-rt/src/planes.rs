//! Spheres by the tracer of 1994: the picture, a tile after the other, each by tiles of lanes in lockstep.

use core_rt::colour::Transfer;
use core_rt::exact::Exact14;
use core_rt::format::Format;
use core_rt::kernel::Kernel;
use core_rt::render::Tile;
use planes_rt::colour::{Light, encode};
use planes_rt::lanes;
use planes_rt::pixel;
use planes_rt::scene::Scene;
use zerocopy::IntoBytes;

use crate::board::Board;
use crate::frame::{Begin, Report, TileHead};
use crate::run::{PIXELS, TILE, blob};
use crate::stack;
use crate::status::Status;
use crate::transport::{Error, Link, Wire};
use crate::window::{intray_window_begin, intray_window_end};

/// Lanes of a tile in lockstep: side by side, and in rows. There is nothing to gain from more where words are worked on one by one,
/// and lanes wait for each other: on a Cortex-M0 the pixels of `scenes/planes` take 2,443 instructions by 4, 3,045 by 8 and 3,349
/// by 16.
const ACROSS: u16 = 2;
const DOWN: u16 = 2;
const LANES: usize = ACROSS as usize * DOWN as usize;

/// The bytes of a tile.
const BYTES: usize = 3 * PIXELS;

/// Draws the blob in its place; the status to end with. The stack was painted.
pub fn run(board: &'static Board) -> Status {
    let link = Link::start();
    // The linker script is that of firmware for the default blob, and so is the place.
    let blob = blob(board.blob(Exact14::ID));
    let (scene, transfer) = match planes_rt::blob::read(blob) {
        Ok(read) => read,
        Err(_) => {
            defmt::error!("the blob was refused: it is not one of planes12, or is damaged");
            return Status::Refused;
        }
    };
    defmt::info!("{=str}: {=usize} spheres for planes12", board.name, scene.spheres().len());
    match link.open().and_then(|wire| drawn(&scene, transfer, wire, board)) {
        Ok(()) => Status::Done,
        Err(_) => {
            defmt::error!("the host does not take what is sent");
            Status::Wire
        }
    }
}

fn drawn(scene: &Scene<'_>, transfer: Transfer, mut wire: Wire, board: &Board) -> Result<(), Error> {
    let [width, height] = scene.settings().size;
    wire.send(Begin::KIND, &[Begin { width, height, format: Format::Rgb888.number() }.as_bytes()])?;
    let mut bytes = [0; BYTES];
    for tile in Tile::of([width, height], [TILE; 2]) {
        intray_window_begin();
        if scene.is_plain() {
            draw(scene, transfer, tile, &mut bytes);
        } else {
            draw_sampled(scene, transfer, tile, &mut bytes);
        }
        intray_window_end();
        let head = TileHead { x: tile.x, y: tile.y, width: tile.width, height: tile.height };
        let pixels = bytes.get(..3 * tile.pixels()).unwrap_or_default();
        wire.send(TileHead::KIND, &[head.as_bytes(), pixels])?;
    }
    // SAFETY: the stack's memory is what the board says, by the linker script that is made from it.
    let stack_bytes = unsafe { stack::deepest(board.stack) };
    let report = Report { stack_bytes, ..Report::default() };
    defmt::info!("{=u16}x{=u16} pixels, {=u32} bytes of stack", width, height, stack_bytes);
    wire.send(Report::KIND, &[report.as_bytes()])
}

/// Draws one tile. Lanes beyond it are traced for nothing.
#[inline(never)]
fn draw(scene: &Scene<'_>, transfer: Transfer, tile: Tile, bytes: &mut [u8; BYTES]) {
    fill(transfer, tile, bytes, |pixels| lanes::trace(scene, pixels));
}

/// The same of any other scene, pixel by pixel: lanes have the same light, and a second copy of theirs would cost the
/// first one a tenth of its speed.
#[inline(never)]
fn draw_sampled(scene: &Scene<'_>, transfer: Transfer, tile: Tile, bytes: &mut [u8; BYTES]) {
    fill(transfer, tile, bytes, |pixels| pixels.map(|pixel| pixel::trace(scene, pixel)));
}

#[inline(always)]
fn fill(transfer: Transfer, tile: Tile, bytes: &mut [u8; BYTES], trace: impl Fn(&[[u16; 2]; LANES]) -> [Light; LANES]) {
    for top in (0..tile.height).step_by(DOWN.into()) {
        for left in (0..tile.width).step_by(ACROSS.into()) {
            let places: [[u16; 2]; LANES] =
                core::array::from_fn(|lane| [left + lane as u16 % ACROSS, top + lane as u16 / ACROSS]);
            let lights = trace(&places.map(|[x, y]| [tile.x + x, tile.y + y]));
            for ([x, y], light) in places.into_iter().zip(lights) {
                let first = 3 * (usize::from(y) * usize::from(tile.width) + usize::from(x));
                if x < tile.width
                    && y < tile.height
                    && let Some(pixel) = bytes.get_mut(first..first + 3)
                {
                    pixel.copy_from_slice(&encode(light, transfer));
                }
            }
        }
    }
}
