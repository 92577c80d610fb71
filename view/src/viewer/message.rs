//! What goes in and comes out.

use host_tools::compare::Comparison;
use host_tools::model::Camera;
use host_tools::picture::Picture;

use crate::chip::{Effort, Job};
use crate::judge::Case;
use crate::pad::Pad;
use crate::painter::{Drawn, Wish};

/// What a key does once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// The kernel of a place among [`KERNELS`](crate::kernels::KERNELS).
    Kernel(usize),
    /// To the chip's panel, and back.
    Chip,
    /// The next board.
    Board,
    /// Save the full picture.
    Save,
    /// Write the camera into the scene.
    WriteCamera,
    /// Back to the scene's camera.
    Home,
    /// More or less over the picture.
    Overlay,
    /// End.
    Quit,
}

/// What is to be done by others.
#[derive(Clone, Debug)]
pub enum Order {
    /// Draw.
    Draw(Wish),
    /// Compare with the reference.
    Judge(Case),
    /// Count a chip's instructions.
    Time(Job),
    /// Save a picture, drawn by a kernel.
    Save(Picture, &'static str),
    /// Write a camera into the scene.
    WriteCamera(Camera),
    /// Say why something is not done.
    Warn(String),
    /// End.
    Quit,
}

/// What has become of an order.
#[derive(Clone, Debug)]
pub enum Update {
    /// Of the wish of a number.
    Drawn(u64, Drawn),
    /// How far the picture of a wish is from the reference.
    Judged(u64, Box<Comparison>),
    /// What a chip takes for the picture of a wish.
    Timed(u64, Result<Effort, String>),
    /// How the gamepad stands.
    Pad(Pad),
    /// Something for the user.
    Said(String),
}

/// How one begins.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// The kernel's place among [`KERNELS`](crate::kernels::KERNELS), in the window and on the chip.
    pub kernels: [usize; 2],
    /// Width and height of the window, pixels.
    pub size: [u32; 2],
    /// The board's place among [`TARGETS`](crate::chip::TARGETS).
    pub board: usize,
    /// Width and height of its panel.
    pub panel: [u32; 2],
    /// Whether one begins with the panel.
    pub is_chip: bool,
}
