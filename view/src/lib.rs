//! A window to move in: a scene by any kernel, or as a chip's panel would show it.
//!
//! What can be tested without a window is apart from it. [`viewer`] decides: events and times go in, orders come out. It has
//! [`walk`], the camera's motion; [`kernels`], which there are; [`keys`] and [`pad`], what asks for it; [`canvas`], the picture as far as it is drawn;
//! [`overlay`], what is written over it. Orders are carried out beside the window's thread: [`painter`] draws, on the stages that
//! [`stock`] keeps, with samples of paths that add up in `film`; [`judge`] compares with the reference, [`chip`] counts instructions. [`scene_file`] writes the camera
//! back. [`window`] is the window, [`measure`] how fast all of it is.

pub mod canvas;
pub mod chip;
pub mod cli;
pub mod desk;
mod film;
pub mod frame;
pub mod judge;
pub mod kernels;
pub mod keys;
pub mod measure;
pub mod overlay;
pub mod pad;
pub mod painter;
pub mod scene_file;
pub mod staff;
pub mod stock;
pub mod viewer;
pub mod walk;
pub mod window;
