//! What each step does to the bits of a processor.
//!
//! Nothing here knows how the kernel computes: sums, products, quotients and roots are made a bit at a time, in the places that the
//! plan gives them. That the values are the kernel's, bit for bit, is tested.

use std::collections::BTreeMap;

use planes_rt::colour::{Cosine, LIGHT_MAX, PART_BITS, SHARE_BITS, SHARE_ONE};
use planes_rt::scene::{Outline, Scene, Sphere};
use planes_rt::widths::Widths;

use super::processors::Operand::{Constant, Raised, Signed, Unsigned};
use super::processors::{Mask, Operand, Processors};
use super::program::{LIGHT_BITS, Operation, Shape, Value};

/// Where values are, bit by bit.
pub type Places = BTreeMap<Value, Vec<usize>>;

/// What a step takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Bits beside its values.
    pub scratch: u32,
    /// Operations on single bits.
    pub bit_operations: u64,
}

/// What is sent to all processors with a step's instructions.
#[derive(Clone, Copy, Debug)]
pub struct Broadcast {
    shape: Shape,
    number: usize,
    sphere: Sphere,
    light: [i16; 3],
    background: [u16; 3],
}

impl Broadcast {
    /// For a step about a sphere of a scene.
    #[must_use]
    pub fn new(scene: &Scene<'_>, shape: &Shape, number: usize) -> Self {
        let sphere = scene.spheres().get(number).copied().unwrap_or_default();
        Self { shape: *shape, number, sphere, light: scene.light(), background: scene.background() }
    }
}

/// What a step takes, by running it where all is zero.
#[must_use]
pub(super) fn effort(operation: Operation, shape: &Shape, reads: &[(Value, u32)], writes: &[(Value, u32)]) -> Effort {
    let mut used = 0;
    let values: BTreeMap<Value, u32> = reads.iter().chain(writes).copied().collect();
    let places = values.into_iter().map(|(value, bits)| {
        let from = used;
        used += bits as usize;
        (value, (from..used).collect())
    });
    let places: Places = places.collect();
    // More than any step asks for.
    let room: Vec<usize> = (used..used + 512).collect();
    let mut processors = Processors::new(used + room.len(), 0);
    let sphere = Sphere { radius: 1, ..Sphere::default() };
    let broadcast = Broadcast { shape: *shape, number: 0, sphere, light: [0; 3], background: [0; 3] };
    let mut run =
        Run { processors: &mut processors, places: &places, scratch: &room, taken: 0, most_taken: 0, broadcast };
    run.enable(operation);
    run.perform(operation, &|_| ([0; 3], [0; 3]));
    // The text's root asks for as many bits in between as its operand has, and its result.
    let asked = match operation {
        Operation::Root => 2 * shape.widths.determinant() - shape.bits(Value::Root),
        _ => 0,
    };
    Effort { scratch: (run.most_taken as u32).max(asked), bit_operations: processors.operations }
}

/// Runs a step on values in their places. `rays` are those of the processors' pixels.
///
/// The answer is which processors were enabled when it began to work.
pub fn perform(
    operation: Operation,
    processors: &mut Processors,
    places: &Places,
    scratch: &[usize],
    broadcast: Broadcast,
    rays: &impl Fn(usize) -> ([i16; 3], [i16; 3]),
) -> Mask {
    let mut run = Run { processors, places, scratch, taken: 0, most_taken: 0, broadcast };
    run.enable(operation);
    let enabled = run.processors.enabled;
    run.perform(operation, rays);
    enabled
}

struct Run<'a> {
    processors: &'a mut Processors,
    places: &'a Places,
    scratch: &'a [usize],
    /// Bits of the scratch that are in use, and the most that were.
    taken: usize,
    most_taken: usize,
    broadcast: Broadcast,
}

impl<'a> Run<'a> {
    /// The places of a value.
    fn of(&self, value: Value) -> &'a [usize] {
        self.places.get(&value).map_or(&[], Vec::as_slice)
    }

    /// One of the three parts of a value.
    fn part(&self, value: Value, axis: usize) -> &'a [usize] {
        let places = self.of(value);
        places.chunks(places.len().div_ceil(3).max(1)).nth(axis).unwrap_or_default()
    }

    /// One of the two masks: whether the pixel goes on, and whether it looks for a sphere.
    fn mask(&self, number: usize) -> &'a [usize] {
        self.of(Value::Masks).get(number..=number).unwrap_or_default()
    }

    /// Bits for the step alone.
    fn take(&mut self, bits: u32) -> &'a [usize] {
        let from = self.taken;
        self.taken += bits as usize;
        self.most_taken = self.most_taken.max(self.taken);
        self.scratch.get(from..self.taken).unwrap_or_default()
    }

    fn widths(&self) -> Widths {
        self.broadcast.shape.widths
    }

    /// Sets the enable register, for steps that do not go on with what it has.
    fn enable(&mut self, operation: Operation) {
        let mask = match operation {
            Operation::CameraRay => {
                self.processors.enabled = Mask::ALL;
                return;
            }
            Operation::A | Operation::Begin | Operation::Enable | Operation::Background => 0,
            Operation::Along if self.broadcast.shape.outline == Outline::Nearest => 0,
            Operation::Offset => 1,
            _ => return,
        };
        self.processors.enabled = self.processors.any(self.mask(mask));
        let sphere = match operation {
            Operation::Enable => self.broadcast.number,
            Operation::Background => self.broadcast.shape.spheres as usize,
            _ => return,
        };
        let is_it = self.processors.equal(self.of(Value::Nearest), sphere as i64);
        self.keep(is_it);
    }

    /// Leaves enabled only those of a mask.
    fn keep(&mut self, mask: Mask) {
        self.processors.enabled = self.processors.enabled & mask;
    }

    fn perform(&mut self, operation: Operation, rays: &impl Fn(usize) -> ([i16; 3], [i16; 3])) {
        use Value::{A, Along, B, C, Direction, Normal, Offset, Origin, Root, Square};
        match operation {
            Operation::CameraRay => self.camera_ray(rays),
            Operation::A => self.product(A, [Direction, Direction]),
            Operation::Begin => self.begin(),
            Operation::Offset => self.without_centre(Origin, Offset),
            Operation::B => {
                self.product(B, [Direction, Offset]);
                self.keep(self.processors.negative(self.of(B)));
            }
            Operation::C => self.product(C, [Offset, Offset]),
            Operation::Difference => self.determinant(),
            Operation::Hold => self.hold(),
            Operation::Root => {
                let rest = self.take(self.broadcast.shape.bits(Root) + 2);
                self.processors.root(self.of(Root), rest, self.of(Value::Determinant));
            }
            Operation::Numerator => self.numerator(),
            Operation::T => self.parameter(),
            Operation::Nearer => self.nearer(),
            // All that they do is done to the enable register, and outside.
            Operation::Enable | Operation::Show => (),
            Operation::Point => self.point(),
            Operation::Normal => self.without_centre(Origin, Normal),
            Operation::Cosine => self.cosine(),
            Operation::Shade => self.shade(),
            Operation::Mirror => self.mirror(),
            Operation::Background => self.background(),
            Operation::Along => self.product(Along, [Direction, Normal]),
            Operation::Square => self.product(Square, [Normal, Normal]),
            Operation::Quotient => self.quotient(),
            Operation::Reflect => self.reflect(),
        }
    }

    fn camera_ray(&mut self, rays: &impl Fn(usize) -> ([i16; 3], [i16; 3])) {
        for axis in 0..3 {
            self.processors.load(self.part(Value::Origin, axis), |processor| rays(processor).0[axis].into());
            self.processors.load(self.part(Value::Direction, axis), |processor| rays(processor).1[axis].into());
            self.processors.copy(self.part(Value::Light, axis), Constant(0));
            self.processors.copy(self.part(Value::Share, axis), Constant(SHARE_ONE.into()));
        }
        self.processors.copy(self.of(Value::Masks), Constant(-1));
    }

    /// Of those that go on, which are enabled: the mask of those that look for a sphere is written for all.
    fn begin(&mut self) {
        self.processors.copy(self.of(Value::LeastT), Constant(self.widths().product_max().into()));
        self.processors.copy(self.of(Value::Nearest), Constant(self.broadcast.shape.spheres.into()));
        let alive = self.processors.enabled;
        self.processors.enabled = Mask::ALL;
        for &place in self.mask(1) {
            self.processors.write(place, alive);
        }
        self.processors.enabled = alive;
    }

    /// A sum of three products of components, held in a word; c is less by the radius squared.
    fn product(&mut self, to: Value, [a, b]: [Value; 2]) {
        let sum = self.dot(a, |run, axis| Signed(run.part(b, axis)));
        if to == Value::C {
            let radius = i64::from(self.broadcast.sphere.radius);
            self.processors.subtract(sum, Signed(sum), Constant(radius * radius));
        }
        self.hold_product(sum);
        self.processors.copy(self.of(to), Signed(sum));
    }

    /// A sum of three products of components: 3 2^(2c - 2) at most, and a sign.
    fn dot(&mut self, a: Value, b: impl Fn(&Self, usize) -> Operand<'a>) -> &'a [usize] {
        let coordinate = self.widths().coordinate();
        let sum = self.take(2 * coordinate + 1);
        self.processors.copy(sum, Constant(0));
        for axis in 0..3 {
            let factor = (b(self, axis), coordinate as usize);
            self.processors.multiply(sum, Signed(self.part(a, axis)), factor, false);
        }
        sum
    }

    /// A sum of products as its word holds it.
    fn hold_product(&mut self, sum: &[usize]) {
        let bits = self.widths().product() as usize;
        if bits < sum.len() {
            self.processors.saturate(sum, bits);
        }
    }

    /// A place without the sphere's centre.
    fn without_centre(&mut self, from: Value, to: Value) {
        let bits = self.widths().coordinate();
        let sum = self.take(bits + 1);
        for axis in 0..3 {
            let centre = Constant(self.broadcast.sphere.centre[axis].into());
            self.processors.subtract(sum, Signed(self.part(from, axis)), centre);
            self.processors.saturate(sum, bits as usize);
            self.processors.copy(self.part(to, axis), Signed(sum));
        }
    }

    fn determinant(&mut self) {
        let bits = self.widths().product() as usize;
        let [a, b, c] = [Value::A, Value::B, Value::C].map(|value| self.of(value));
        let difference = self.of(Value::Difference);
        self.processors.copy(difference, Constant(0));
        self.processors.multiply(difference, Signed(b), (Signed(b), bits), false);
        self.processors.multiply(difference, Signed(c), (Signed(a), bits), true);
        self.keep(!self.processors.negative(difference));
    }

    fn hold(&mut self) {
        let (difference, word) = (self.of(Value::Difference), self.of(Value::Determinant));
        let most = Constant(self.widths().determinant_max());
        let width = difference.len().max(word.len()) + 1;
        let beyond = self.processors.less(most, Unsigned(difference), width);
        self.processors.copy(word, Unsigned(difference));
        self.processors.under(beyond, |processors| processors.copy(word, most));
    }

    fn numerator(&mut self) {
        let (b, root) = (self.of(Value::B), self.of(Value::Root));
        let sum = self.take(b.len().max(root.len()) as u32 + 2);
        self.processors.subtract(sum, Constant(0), Signed(b));
        self.processors.subtract(sum, Signed(sum), Unsigned(root));
        self.keep(!self.processors.negative(sum));
        self.processors.copy(self.of(Value::Numerator), Signed(sum));
    }

    fn parameter(&mut self) {
        let (bits, fraction) = (self.widths().product(), self.widths().t_fraction());
        let (quotient, rest) = (self.take(bits - 1 + fraction), self.take(bits + 1));
        let dividend = Raised(self.of(Value::Numerator), fraction as usize);
        self.processors.divide(quotient, rest, dividend, self.of(Value::A));
        self.processors.at_most(quotient, self.widths().product_max().into());
        self.processors.copy(self.of(Value::T), Unsigned(quotient));
    }

    fn nearer(&mut self) {
        let (t, least) = (self.of(Value::T), self.of(Value::LeastT));
        let is_farther = self.processors.less(Signed(least), Signed(t), t.len() + 1);
        self.keep(!is_farther);
        self.processors.copy(least, Signed(t));
        self.processors.copy(self.of(Value::Nearest), Constant(self.broadcast.number as i64));
    }

    fn point(&mut self) {
        let widths = self.widths();
        let (bits, fraction) = (widths.coordinate(), widths.t_fraction());
        let t = (Signed(self.of(Value::LeastT)), widths.product() as usize);
        let sum = self.take(bits + widths.product().max(fraction) + 2);
        let whole = sum.get(fraction as usize..).unwrap_or_default();
        for axis in 0..3 {
            let origin = self.part(Value::Origin, axis);
            self.processors.copy(sum, Constant((1 << fraction) >> 1));
            self.processors.multiply(sum, Signed(self.part(Value::Direction, axis)), t, false);
            self.processors.add(whole, Signed(whole), Signed(origin));
            self.processors.saturate(whole, bits as usize);
            self.processors.copy(origin, Signed(whole));
        }
    }

    /// The words of a sphere's cosine are the same for all radii, so that all spheres take as long.
    fn cosine(&mut self) {
        let light = self.broadcast.light;
        let sum = self.dot(Value::Normal, |_, axis| Constant(light[axis].into()));
        self.hold_product(sum);
        let is_behind = self.processors.negative(sum);
        self.processors.under(is_behind, |processors| processors.copy(sum, Constant(0)));
        let cosine = Cosine::new(self.broadcast.sphere.radius.into(), self.widths());
        let (part, product) = (self.take(PART_BITS + 1), self.take(2 * PART_BITS + 2));
        let cut = Unsigned(sum.get(cosine.shift() as usize..).unwrap_or_default());
        let brightest = Constant(1 << PART_BITS);
        let is_beyond = self.processors.less(brightest, cut, sum.len().max(PART_BITS as usize) + 2);
        self.processors.copy(part, cut);
        self.processors.under(is_beyond, |processors| processors.copy(part, brightest));
        self.processors.copy(product, Constant(0));
        let reciprocal = (Constant(cosine.reciprocal().into()), PART_BITS as usize + 1);
        self.processors.multiply(product, Unsigned(part), reciprocal, false);
        let cut = Unsigned(product.get(cosine.last_shift() as usize..).unwrap_or_default());
        let is_beyond = self.processors.less(Constant(SHARE_ONE.into()), cut, product.len() + 1);
        let to = self.of(Value::Cosine);
        self.processors.copy(to, cut);
        self.processors.under(is_beyond, |processors| processors.copy(to, Constant(SHARE_ONE.into())));
    }

    /// A share of light, or of a share.
    fn share_of(&mut self, of: Operand<'a>, share: Operand<'a>) -> &'a [usize] {
        let sum = self.take(2 * LIGHT_BITS + 1);
        self.processors.copy(sum, Constant(1 << (SHARE_BITS - 1)));
        // A constant has a sign.
        self.processors.multiply(sum, of, (share, LIGHT_BITS as usize + 1), false);
        sum.get(SHARE_BITS as usize..).unwrap_or_default()
    }

    /// Adds to a channel what of some light is still seen.
    fn see(&mut self, channel: usize, sent: Operand<'a>) {
        let light = self.part(Value::Light, channel);
        let seen = self.share_of(Unsigned(self.part(Value::Share, channel)), sent);
        self.processors.add(seen, Unsigned(seen), Unsigned(light));
        self.processors.at_most(seen, LIGHT_MAX.into());
        self.processors.copy(light, Unsigned(seen));
    }

    fn shade(&mut self) {
        let surface = self.broadcast.sphere.surface;
        for channel in 0..3 {
            let sent = self.share_of(Unsigned(self.of(Value::Cosine)), Constant(surface.lit[channel].into()));
            self.processors.add(sent, Unsigned(sent), Constant(surface.own[channel].into()));
            self.processors.at_most(sent, LIGHT_MAX.into());
            self.see(channel, Unsigned(sent));
            self.taken = 0;
        }
    }

    fn mirror(&mut self) {
        let surface = self.broadcast.sphere.surface;
        for channel in 0..3 {
            let share = self.part(Value::Share, channel);
            let left = self.share_of(Unsigned(share), Constant(surface.mirror[channel].into()));
            self.processors.copy(share, Unsigned(left));
            self.taken = 0;
        }
        let sees = self.processors.any(self.of(Value::Share));
        let looks = match self.broadcast.shape.outline {
            // The pixel is disabled for what is left of the generation.
            Outline::Literal => self.mask(1),
            Outline::Nearest => &[],
        };
        for &place in self.mask(0) {
            self.processors.write(place, sees);
        }
        for &place in looks {
            self.processors.write(place, Mask::NONE);
        }
    }

    fn background(&mut self) {
        for (channel, background) in self.broadcast.background.into_iter().enumerate() {
            self.see(channel, Constant(background.into()));
            self.taken = 0;
        }
        for &place in self.mask(0) {
            self.processors.write(place, Mask::NONE);
        }
    }

    /// Of a normal without length d . n is zero, and so is what becomes of the quotient, whose digits are ones.
    fn quotient(&mut self) {
        let (along, to) = (self.of(Value::Along), self.of(Value::Quotient));
        let widths = self.widths();
        let (product, raised) = (widths.product(), widths.coordinate());
        let (quotient, rest, magnitude) = (self.take(product - 1 + raised), self.take(product + 1), self.take(product));
        let is_negative = self.processors.negative(along);
        self.processors.copy(magnitude, Signed(along));
        self.processors.under(is_negative, |processors| processors.subtract(magnitude, Constant(0), Signed(along)));
        self.processors.divide(quotient, rest, Raised(magnitude, raised as usize), self.of(Value::Square));
        self.processors.copy(to, Unsigned(quotient));
        self.processors.under(is_negative, |processors| processors.subtract(to, Constant(0), Signed(to)));
    }

    fn reflect(&mut self) {
        let widths = self.widths();
        let bits = widths.coordinate();
        let quotient = (Signed(self.of(Value::Quotient)), self.broadcast.shape.bits(Value::Quotient) as usize);
        let sum = self.take(3 * bits + 2);
        let turn = sum.get(bits as usize - 1..).unwrap_or_default();
        for axis in 0..3 {
            let direction = self.part(Value::Direction, axis);
            self.processors.copy(sum, Constant((1 << (bits - 1)) >> 1));
            self.processors.multiply(sum, Signed(self.part(Value::Normal, axis)), quotient, false);
            self.processors.subtract(turn, Signed(direction), Signed(turn));
            self.processors.saturate(turn, bits as usize);
            self.processors.copy(direction, Signed(turn));
        }
    }
}
