//! What a kernel promises, by its arithmetic: in units of its grid, in gray levels, and in radians.
//!
//! - Vertices, eyes and lights are rounded to the grid: each is off by at most half a unit an axis, sqrt(3)/2 in all.
//! - Rays leave a surface from a point that is off it, and off the true one, by what `docs/EXACTNESS.md` (5) has.
//! - Unit vectors are off by what the table of `docs/SHADING.md` has, and bytes by what its second table has.
//! - `hanika-*`: hits are off their triangle by up to 9 units but for the rounding of edges, rays start 4 units above a
//!   surface. Edges have no useful bound on slivers, and the report's own box tests lose hits: what it promises there is
//!   that few pixels show it. It counts artifacts, and calls hundreds in 2^20 pixels few; here a pixel in a thousand may stray.
//! - `f32`: its rays start 8 units of 2^-24 of the scene above a surface; a hit is off by the five roundings of
//!   `float_rt::format`, 9 units at most. Its edges are decided with an error too, so that a pixel in a thousand may stray.
//! - Of rays that look for trouble, through vertices and along edges, the exact kernels lose none. The others decide edges with
//!   an error, and promise nothing of a ray that goes through one: those that stray are counted, and not judged.
//! - `planes12`: normals are as good as their spheres are large, and there are no shadows. Nothing is promised of its pictures but
//!   that all machines draw the same; pixels that stray are counted.

/// sqrt(3)/2: the farthest that rounding to a grid moves a point, grid units.
const ROUNDED: f64 = 0.866_025_403_784_438_6;

/// A gray level and a half of rounding on either side are less than two.
const SHADED: f64 = 1.0;

/// What is promised of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Promise {
    /// How far a camera's ray and the surface that it meets are off, together, grid units.
    pub seen: f64,
    /// How far a ray between surfaces and lights is off, grid units, where a case's leverage is 1.
    pub between: f64,
    /// Bits of the largest component of a direction.
    pub direction_bits: u32,
    /// The largest error of a unit vector, radians.
    pub turn: f64,
    /// The most by which a byte is off the reference's, for the arithmetic of colours alone.
    pub levels: f64,
    /// The share of pixels that may stray.
    pub strays: f64,
    /// Whether rays that look for trouble are decided exactly.
    pub edges: bool,
}

impl Promise {
    /// Of a kernel by its name; that of the narrowest for one that is not known.
    #[must_use]
    pub fn of(kernel: &str) -> Self {
        let wide = Self {
            seen: 2.0 * ROUNDED,
            between: ROUNDED + 0.88 + 1.0,
            direction_bits: 31,
            turn: 3.0 / (1 << 30) as f64,
            levels: SHADED,
            strays: 0.0,
            edges: true,
        };
        match kernel {
            "exact29" => wide,
            "exact20" => Self { direction_bits: 21, ..wide },
            "hanika-c" | "hanika-cd" | "hanika-cons" => Self {
                seen: 2.0 * ROUNDED + 9.0,
                between: ROUNDED + 9.0 + 4.0,
                turn: 20_000.0 / (1 << 30) as f64,
                strays: 1e-3,
                edges: false,
                ..wide
            },
            "f32" => Self {
                seen: 2.0 * ROUNDED + 9.0,
                between: ROUNDED + 9.0 + 8.0,
                direction_bits: 24,
                turn: 5.0 / (1 << 24) as f64,
                strays: 1e-3,
                edges: false,
                ..wide
            },
            "planes12" => Self { strays: 1.0, edges: false, ..wide },
            "f64" => Self { between: ROUNDED, edges: false, ..wide },
            _ => Self {
                seen: 2.0 * ROUNDED,
                between: ROUNDED + 1.36 + 1.5,
                direction_bits: 13,
                turn: 6.0 / (1 << 14) as f64,
                // 2.093 beyond the half that rounding takes, on either side.
                levels: 3.0,
                ..wide
            },
        }
    }
}
