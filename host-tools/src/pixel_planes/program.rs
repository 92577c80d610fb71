//! The program that all processors run, a step at a time: what it reads and writes, and how many operations on single bits it
//! takes.
//!
//! Adding or comparing n bits takes n operations, a product n m, a quotient as many as its dividend's bits times its divisor's, a
//! root half its bits times as many digits. Spheres are broadcast with the instructions, and take no memory.

use planes_rt::scene::Outline;
use planes_rt::widths::Widths;

/// A value that a processor holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Value {
    /// The ray's origin, three components.
    Origin,
    /// Its direction, three components.
    Direction,
    /// Whether the pixel goes on, and whether it takes part now: two bits.
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
    /// The same as its word holds it.
    Determinant,
    /// Its root.
    Root,
    /// -b - root.
    Numerator,
    /// t of this sphere.
    T,
    /// The least t so far.
    LeastT,
    /// Which sphere it is of.
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
const LIGHT_BITS: u32 = 12;

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

/// One step.
#[derive(Clone, Debug)]
pub struct Step {
    /// What it does.
    pub name: &'static str,
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
    writer.start();
    for _ in 0..shape.generations {
        writer.generation();
    }
    writer.steps
}

struct Writer {
    shape: Shape,
    steps: Vec<Step>,
}

impl Writer {
    fn step(&mut self, name: &'static str, reads: &[Value], writes: &[Value], scratch: u32, bit_operations: u32) {
        let sized = |values: &[Value]| values.iter().map(|&value| (value, self.shape.bits(value))).collect();
        let (mut reads, writes): (Vec<_>, Vec<_>) = (sized(reads), sized(writes));
        reads.push((Value::Masks, self.shape.bits(Value::Masks)));
        self.steps.push(Step { name, reads, writes, scratch, bit_operations: bit_operations.into() });
    }

    fn start(&mut self) {
        let component = self.shape.widths.coordinate();
        let of_a_pixel = [Value::Origin, Value::Direction, Value::Light, Value::Share, Value::Masks];
        self.step("camera ray", &[], &of_a_pixel, component, 6 * component);
        // Nothing is held before.
        if let Some(first) = self.steps.first_mut() {
            first.reads.clear();
        }
    }

    fn generation(&mut self) {
        let (coordinate, product) = (self.shape.widths.coordinate(), self.shape.widths.product());
        self.step("a = d . d", &[Value::Direction], &[Value::A], 0, 3 * coordinate * coordinate + product);
        self.step("least t = most", &[], &[Value::LeastT, Value::Nearest], 0, product);
        for _ in 0..self.shape.spheres {
            self.intersect();
            if self.shape.outline == Outline::Literal {
                self.shade();
                self.reflect();
            }
        }
        if self.shape.outline == Outline::Nearest {
            for _ in 0..self.shape.spheres {
                let number = self.shape.bits(Value::Nearest);
                self.step("enable where nearest", &[Value::Nearest], &[Value::Masks], 0, number);
                self.shade();
            }
            self.reflect();
        }
        let light = 3 * LIGHT_BITS * (LIGHT_BITS + 1);
        let background = [Value::Light, Value::Share, Value::Nearest];
        self.step("background", &background, &[Value::Light, Value::Masks], 2 * LIGHT_BITS, light);
    }

    fn intersect(&mut self) {
        let widths = self.shape.widths;
        let (coordinate, product) = (widths.coordinate(), widths.product());
        let dot = 3 * coordinate * coordinate + product;
        let masks = Value::Masks;
        self.step("s = o - c", &[Value::Origin], &[Value::Offset], 0, 3 * coordinate);
        self.step("b = d . s", &[Value::Direction, Value::Offset], &[Value::B], 0, dot);
        self.step("c = s . s - r^2", &[Value::Offset], &[Value::C], 0, dot + product);
        let factors = [Value::A, Value::B, Value::C];
        self.step("b^2 - a c", &factors, &[Value::Difference, masks], 0, 2 * product * product);
        self.step("hold", &[Value::Difference], &[Value::Determinant], 0, widths.determinant());
        // The root asks for as many bits for input, output and in between.
        let (determinant, root) = (widths.determinant(), widths.determinant().div_ceil(2));
        let between = 2 * determinant - root;
        self.step("root", &[Value::Determinant], &[Value::Root], between, root * (root + 2));
        self.step("-b - root", &[Value::B, Value::Root], &[Value::Numerator, masks], 0, product);
        let dividend = product + widths.t_fraction();
        self.step("t", &[Value::Numerator, Value::A], &[Value::T], dividend, dividend * product);
        let compared = [Value::T, Value::LeastT, Value::Nearest];
        self.step("nearer", &compared, &[Value::LeastT, Value::Nearest, masks], 0, 2 * product);
    }

    fn shade(&mut self) {
        let (coordinate, product) = (self.shape.widths.coordinate(), self.shape.widths.product());
        let along = coordinate + product;
        let ray = [Value::Origin, Value::Direction, Value::LeastT];
        self.step("point = o + t d", &ray, &[Value::Origin], along, 3 * (coordinate * product + coordinate));
        self.step("normal = point - c", &[Value::Origin], &[Value::Normal], 0, 3 * coordinate);
        let brightness = 3 * coordinate * coordinate + product + product * LIGHT_BITS;
        self.step("normal . light", &[Value::Normal], &[Value::Cosine], product, brightness);
        let light = 3 * (2 * LIGHT_BITS * LIGHT_BITS + LIGHT_BITS);
        let seen = [Value::Cosine, Value::Light, Value::Share];
        self.step("shade", &seen, &[Value::Light], 2 * LIGHT_BITS, light);
        let share = 3 * LIGHT_BITS * LIGHT_BITS;
        self.step("mirror", &[Value::Share], &[Value::Share, Value::Masks], 2 * LIGHT_BITS, share);
    }

    fn reflect(&mut self) {
        let (coordinate, product) = (self.shape.widths.coordinate(), self.shape.widths.product());
        let dot = 3 * coordinate * coordinate + product;
        self.step("d . n", &[Value::Direction, Value::Normal], &[Value::Along], 0, dot);
        self.step("n . n", &[Value::Normal], &[Value::Square], 0, dot);
        let dividend = product + coordinate;
        let quotient = [Value::Along, Value::Square];
        self.step("2 d . n / n . n", &quotient, &[Value::Quotient], dividend, dividend * product);
        let turned = [Value::Direction, Value::Normal, Value::Quotient];
        let bits = self.shape.bits(Value::Quotient);
        self.step("reflection", &turned, &[Value::Direction], bits + coordinate, 3 * (bits * coordinate + coordinate));
    }
}
