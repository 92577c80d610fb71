//! The program that all processors run, a step at a time: what each reads and writes, and what it takes.
//!
//! A step's operations and the bits that it needs in between are those of running it once, on processors without any values: they
//! depend on the words' widths alone. Spheres are broadcast with the instructions, and take no memory.

use planes_rt::scene::Outline;
use planes_rt::widths::Widths;

use super::arithmetic::{self, Effort};

/// A value that a processor holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Value {
    /// The ray's origin, three components.
    Origin,
    /// Its direction, three components.
    Direction,
    /// Whether the pixel goes on, and whether it still looks for a sphere in this generation: two bits.
    Masks,
    /// |d|^2.
    A,
    /// o - c, three components.
    Offset,
    /// d . s.
    B,
    /// |s|^2 - r^2.
    C,
    /// b^2 - a c, twice as wide as a product.
    Difference,
    /// The same as its word holds it, without a sign.
    Determinant,
    /// Its root, without a sign.
    Root,
    /// -b - root.
    Numerator,
    /// t of this sphere.
    T,
    /// The least t so far.
    LeastT,
    /// Which sphere it is of; as many as there are for none.
    Nearest,
    /// The normal, three components.
    Normal,
    /// Of the angle to the light.
    Cosine,
    /// What was seen so far, three channels.
    Light,
    /// What of the light is still seen, three channels.
    Share,
    /// d . n.
    Along,
    /// |n|^2.
    Square,
    /// 2 d . n / |n|^2.
    Quotient,
}

/// What a program is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// The words.
    pub widths: Widths,
    /// Spheres of the scene.
    pub spheres: u32,
    /// How many of them a ray meets at most.
    pub generations: u32,
    /// Where a pixel ends.
    pub outline: Outline,
}

/// Bits of a colour's channel, of a share and of a cosine.
pub(super) const LIGHT_BITS: u32 = 12;

impl Shape {
    /// Bits of a value.
    #[must_use]
    pub fn bits(&self, value: Value) -> u32 {
        let widths = self.widths;
        match value {
            Value::Origin | Value::Direction | Value::Offset | Value::Normal => 3 * widths.coordinate(),
            Value::Masks => 2,
            Value::A | Value::B | Value::C | Value::Numerator | Value::T | Value::LeastT => widths.product(),
            Value::Along | Value::Square => widths.product(),
            // A unit of a short normal takes twice the direction.
            Value::Quotient => 2 * widths.coordinate() + 1,
            Value::Difference => 2 * widths.product(),
            Value::Determinant => widths.determinant(),
            Value::Root => widths.determinant().div_ceil(2),
            Value::Nearest => u32::BITS - self.spheres.leading_zeros(),
            Value::Cosine => LIGHT_BITS,
            Value::Light | Value::Share => 3 * LIGHT_BITS,
        }
    }
}

/// What a step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Operation {
    /// The tree that spans all processors leaves each the ray of its pixel (the machine works out what is linear in a pixel's place
    /// by itself); nothing is seen yet.
    CameraRay,
    /// |d|^2.
    A,
    /// No sphere yet, in this generation.
    Begin,
    /// o - c, for those that look for a sphere.
    Offset,
    /// d . s; disables those whose sphere is behind.
    B,
    /// |s|^2 - r^2.
    C,
    /// b^2 - a c; disables those that miss.
    Difference,
    /// Its word.
    Hold,
    /// Its root.
    Root,
    /// -b - root; disables those that are inside.
    Numerator,
    /// t.
    T,
    /// Disables those that met a nearer sphere; the others met this one.
    Nearer,
    /// Enables those that met this sphere.
    Enable,
    /// o + t d.
    Point,
    /// The point without the centre.
    Normal,
    /// The cosine to the light.
    Cosine,
    /// What is seen.
    Shade,
    /// What is still seen; those that see nothing any more are done.
    Mirror,
    /// Those that met no sphere see what is behind all, and are done.
    Background,
    /// d . n.
    Along,
    /// |n|^2.
    Square,
    /// 2 d . n / |n|^2.
    Quotient,
    /// d - 2 (d . n) n / |n|^2.
    Reflect,
    /// What was seen leaves for the frame buffer, which is not modelled.
    Show,
}

impl Operation {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CameraRay => "camera ray",
            Self::A => "a = d . d",
            Self::Begin => "least t = most",
            Self::Offset => "s = o - c",
            Self::B => "b = d . s",
            Self::C => "c = s . s - r^2",
            Self::Difference => "b^2 - a c",
            Self::Hold => "hold",
            Self::Root => "root",
            Self::Numerator => "-b - root",
            Self::T => "t",
            Self::Nearer => "nearer",
            Self::Enable => "enable where nearest",
            Self::Point => "point = o + t d",
            Self::Normal => "normal = point - c",
            Self::Cosine => "normal . light",
            Self::Shade => "shade",
            Self::Mirror => "mirror",
            Self::Background => "background",
            Self::Along => "d . n",
            Self::Square => "n . n",
            Self::Quotient => "2 d . n / n . n",
            Self::Reflect => "reflection",
            Self::Show => "picture",
        }
    }

    /// The values that it needs and those that it makes, or makes anew for some processors. `is_first` where no processor has a
    /// normal yet.
    const fn values(self, is_first: bool) -> (&'static [Value], &'static [Value]) {
        use Value::*;
        match self {
            Self::CameraRay => (&[], &[Origin, Direction, Light, Share, Masks]),
            Self::A => (&[Direction, Masks], &[A]),
            Self::Begin => (&[Masks], &[LeastT, Nearest, Masks]),
            Self::Offset => (&[Origin, Masks], &[Offset]),
            Self::B => (&[Direction, Offset], &[B]),
            Self::C => (&[Offset], &[C]),
            Self::Difference => (&[A, B, C], &[Difference]),
            Self::Hold => (&[Difference], &[Determinant]),
            Self::Root => (&[Determinant], &[Root]),
            Self::Numerator => (&[B, Root], &[Numerator]),
            Self::T => (&[Numerator, A], &[T]),
            Self::Nearer => (&[T, LeastT, Nearest], &[LeastT, Nearest]),
            Self::Enable => (&[Nearest, Masks], &[]),
            Self::Point => (&[Origin, Direction, LeastT], &[Origin]),
            Self::Normal if is_first => (&[Origin], &[Normal]),
            Self::Normal => (&[Origin, Normal], &[Normal]),
            Self::Cosine => (&[Normal], &[Cosine]),
            Self::Shade => (&[Cosine, Light, Share], &[Light]),
            Self::Mirror => (&[Share, Masks], &[Share, Masks]),
            Self::Background => (&[Light, Share, Nearest, Masks], &[Light, Masks]),
            Self::Along => (&[Direction, Normal, Masks], &[Along]),
            Self::Square => (&[Normal], &[Square]),
            Self::Quotient => (&[Along, Square], &[Quotient]),
            Self::Reflect => (&[Direction, Normal, Quotient], &[Direction]),
            Self::Show => (&[Light], &[]),
        }
    }
}

/// One step.
#[derive(Clone, Debug)]
pub struct Step {
    /// What it does.
    pub operation: Operation,
    /// The number of the sphere that it is about, where it is about one.
    pub sphere: usize,
    /// The values that it needs, with their bits.
    pub reads: Vec<(Value, u32)>,
    /// The values that it makes, or makes anew.
    pub writes: Vec<(Value, u32)>,
    /// Bits that it needs beside them.
    pub scratch: u32,
    /// Operations on single bits.
    pub bit_operations: u64,
}

/// The whole program of a region.
#[must_use]
pub fn program(shape: &Shape) -> Vec<Step> {
    let mut writer = Writer { shape: *shape, steps: Vec::new() };
    writer.step(Operation::CameraRay, 0);
    for _ in 0..shape.generations {
        writer.generation();
    }
    writer.step(Operation::Show, 0);
    writer.steps
}

const INTERSECT: [Operation; 9] = [
    Operation::Offset,
    Operation::B,
    Operation::C,
    Operation::Difference,
    Operation::Hold,
    Operation::Root,
    Operation::Numerator,
    Operation::T,
    Operation::Nearer,
];

const SHADE: [Operation; 5] =
    [Operation::Point, Operation::Normal, Operation::Cosine, Operation::Shade, Operation::Mirror];

const REFLECT: [Operation; 4] = [Operation::Along, Operation::Square, Operation::Quotient, Operation::Reflect];

struct Writer {
    shape: Shape,
    steps: Vec<Step>,
}

impl Writer {
    fn step(&mut self, operation: Operation, sphere: usize) {
        let shape = self.shape;
        let sized = |values: &[Value]| values.iter().map(|&value| (value, shape.bits(value))).collect();
        let (reads, writes) = operation.values(sphere == 0);
        let (reads, writes): (Vec<_>, Vec<_>) = (sized(reads), sized(writes));
        // What it takes depends on the operation and the widths alone, and most were written before.
        let known = self.steps.iter().find(|step| (step.operation, step.sphere == 0) == (operation, sphere == 0));
        let effort = known.map_or_else(
            || arithmetic::effort(operation, &shape, &reads, &writes),
            |step| Effort { scratch: step.scratch, bit_operations: step.bit_operations },
        );
        let Effort { scratch, bit_operations } = effort;
        self.steps.push(Step { operation, sphere, reads, writes, scratch, bit_operations });
    }

    fn all(&mut self, operations: &[Operation], sphere: usize) {
        operations.iter().for_each(|&operation| self.step(operation, sphere));
    }

    fn generation(&mut self) {
        self.all(&[Operation::A, Operation::Begin], 0);
        let spheres = self.shape.spheres as usize;
        match self.shape.outline {
            Outline::Literal => {
                for sphere in 0..spheres {
                    self.all(&INTERSECT, sphere);
                    self.all(&SHADE, sphere);
                    self.all(&REFLECT, sphere);
                }
                self.step(Operation::Background, 0);
            }
            Outline::Nearest => {
                (0..spheres).for_each(|sphere| self.all(&INTERSECT, sphere));
                for sphere in 0..spheres {
                    self.step(Operation::Enable, sphere);
                    self.all(&SHADE, sphere);
                }
                self.step(Operation::Background, 0);
                self.all(&REFLECT, 0);
            }
        }
    }
}
