//! The kernels `f32` and `f64`: the pipeline of [`core_rt`] in floating point, for comparison only.
//!
//! The same blob, camera, tree, traversal, shading and tiles; what is exchanged is the arithmetic, by implementing
//! [`Kernel`](core_rt::kernel::Kernel) and [`Space`](core_rt::space::Space) over [`Real`]. So what differs between two
//! pictures, or between two counts of instructions, is the arithmetic's.
//!
//! Nothing here is integer tracing in disguise: it is the textbook's float tracer (slabs with reciprocals, Möller and
//! Trumbore, stand-off along the normal), with rounding where such a tracer rounds. A nearest hit is the nearest *as
//! computed*; unlike the exact kernels' it has no proof.
//!
//! # The same bits everywhere
//! Only `+ - * /`, comparisons and conversions of IEEE 754, which hardware and soft float round alike, and the functions
//! of [`libm`], on a PC too. Nothing is fused.
#![no_std]
#![forbid(unsafe_code)]

mod boxes;
mod colour;
mod format;
mod kernel;
mod ray;
mod real;
mod record;
mod space;
mod sphere;
mod triangle;
mod vector;

pub use colour::RgbF;
pub use format::Format;
pub use kernel::Float;
pub use ray::Ray;
pub use real::Real;
pub use record::{
    Node32, Node64, NodeRecord, Sphere32, Sphere64, SphereRecord, Triangle32, Triangle64, TriangleRecord,
};
pub use space::FloatSpace;

/// Single precision on a 24-bit grid: what rounding coordinates to `f32` would keep of them.
pub type Float32 = Float<f32>;

/// Double precision on the grid of `exact29`.
pub type Float64 = Float<f64>;
