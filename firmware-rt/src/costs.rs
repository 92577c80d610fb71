//! What single operations of shading cost: a program for a counter that watches from outside.
//!
//! Each operation of [`OPERATIONS`] is called [`CALLS`] times on varied inputs, each call between the marks of `window`, and
//! then as often something that answers at once. The difference is what the operation costs, with its operands loaded from
//! memory and its answer stored there.

/// The operations, in the order in which they are called: those of the 14-bit space, and those on textures and colours.
pub const OPERATIONS: [&str; 16] = [
    "normalise",
    "cosine",
    "reflect",
    "refract",
    "halfway",
    "lobe",
    "fresnel",
    "faded",
    "interpolate",
    "lift",
    "is_odd",
    "nearest texel",
    "four texels",
    "reflected",
    "encode sRGB",
    "encode linear",
];

/// Calls of each operation.
pub const CALLS: usize = 32;

#[cfg(target_os = "none")]
pub use on_chip::run;

#[cfg(target_os = "none")]
mod on_chip {
    use core::array::from_fn;
    use core::hint::black_box;

    use core_rt::colour::{Albedo, Colour, Radiance, Rgb16, Transfer};
    use core_rt::num::Triple;
    use core_rt::record::{Checker, Reach};
    use core_rt::space::{Grid14, Space};
    use core_rt::texture::Texture;

    use super::{CALLS, OPERATIONS};
    use crate::end::end;
    use crate::status::Status;
    use crate::transport::Link;
    use crate::window;

    type Unit = <Grid14 as Space>::Unit;
    type Point = <Grid14 as Space>::Point;
    type Fraction = <Grid14 as Space>::Fraction;

    /// Calls everything, and ends.
    pub fn run() -> ! {
        let _link = Link::start();
        let mut random = Random(1);
        CALLED.iter().for_each(|operation| operation(&mut random));
        end(Status::Done, || ())
    }

    const CALLED: [fn(&mut Random); OPERATIONS.len()] = [
        |random| {
            // Of every magnitude; the difference from a constant zero is none.
            let vectors = from_fn(|i| random.vector().map(|c| c >> (i * 3 / 4)));
            measured(vectors, |&v| Grid14::towards([0; 3], v), |_| None);
        },
        |random| {
            let units = from_fn(|_| [random.unit(), random.unit()]);
            measured(units, |&[a, b]| Grid14::cosine(a, b), |_| None);
        },
        |random| {
            let units = from_fn(|_| random.meeting());
            measured(units, |&[d, n]| Grid14::reflect(d, n), |&[d, _]| d);
        },
        |random| {
            // In and out of glass.
            let rays = from_fn(|i| (random.meeting(), if i % 2 == 0 { 178_956_970 } else { 402_653_184 }));
            measured(rays, |&([d, n], eta_q28)| Grid14::refract(d, n, eta_q28), |_| None);
        },
        |random| {
            let units = from_fn(|_| [random.unit(), random.unit()]);
            measured(units, |&[a, b]| Grid14::halfway(a, b), |_| None);
        },
        |random| {
            let lobes = from_fn(|i| {
                let a = random.unit();
                (a, if i % 4 == 0 { random.unit() } else { random.near(a) }, random.below(4096) as u16)
            });
            measured(lobes, |&(a, b, exponent_q2)| Grid14::lobe(a, b, exponent_q2), |_| Default::default());
        },
        |random| {
            let cosines = from_fn(|_| {
                let (a, b) = (random.unit(), random.unit());
                (Grid14::cosine(a, b).unwrap_or_default(), random.below(1 << 16) as u16)
            });
            measured(cosines, |&(cosine, r0)| Grid14::fresnel(cosine, r0), |_| Default::default());
        },
        |random| {
            let lights = from_fn(|_| {
                let reach =
                    Reach { mantissa: random.below(1 << 15) as u16 | 1 << 15, exponent: random.below(32) as i16 };
                (random.radiance(), random.point(), random.point(), reach)
            });
            measured(
                lights,
                |&(light, from, to, ref reach)| Grid14::faded(light, from, to, reach),
                |_| Radiance::default(),
            );
        },
        |random| {
            let corners = from_fn(|_| (random.smooth(), random.weights()));
            measured(corners, |&(normals, [u, v])| Grid14::interpolate(normals, u, v), |_| None);
        },
        |random| {
            let hits = from_fn(|_| (from_fn(|_| random.point()), random.smooth(), random.weights()));
            let range = [[0; 3], [(1 << 18) - 1; 3]];
            measured(
                hits,
                |&([point, a, b, c], normals, weights): &([Point; 4], _, _)| {
                    Grid14::lift(point, [a, b, c], normals, weights, range)
                },
                |&([point, ..], ..)| point,
            );
        },
        |random| {
            let places = from_fn(|i| {
                let checker = Checker {
                    step_q63: u64::from(random.next()) << 14,
                    start_q63: from_fn(|_| u64::from(random.next()) << 32),
                    other: [0; 3],
                    reserved: 0,
                };
                (random.point(), i % 3, checker)
            });
            measured(places, |(point, across, checker)| Grid14::is_odd(*point, *across, checker), |_| false);
        },
        |random| texels(random, false),
        |random| texels(random, true),
        |random| {
            let colours = from_fn(|_| (random.light(), random.albedo()));
            measured(colours, |(light, albedo)| light.reflected(albedo), |(light, _)| *light);
        },
        |random| {
            let colours = from_fn(|_| random.light());
            measured(colours, |light| light.encode(Transfer::Srgb), |_| [0; 3]);
        },
        |random| {
            let colours = from_fn(|_| random.light());
            measured(colours, |light| light.encode(Transfer::Linear), |_| [0; 3]);
        },
    ];

    /// Looks up in a texture of 4 by 4 texels.
    fn texels(random: &mut Random, bilinear: bool) {
        let bytes: [u8; 48] = from_fn(|_| random.below(256) as u8);
        let texture = black_box(Texture { first: 0, size: [4, 4], format: Texture::RGB888, reserved: 0 });
        let places = from_fn(|_| [random.below(1 << 30) as i32, random.below(1 << 30) as i32]);
        measured(places, |&place| texture.look_up(&bytes, place, bilinear), |_| None);
    }

    /// Calls an operation and something that answers at once, each between marks.
    fn measured<I, O>(inputs: [I; CALLS], operation: impl Fn(&I) -> O, nothing: impl Fn(&I) -> O) {
        inputs.iter().for_each(|input| between_marks(&operation, input));
        inputs.iter().for_each(|input| between_marks(&nothing, input));
    }

    #[inline(always)]
    fn between_marks<I, O>(operation: &impl Fn(&I) -> O, input: &I) {
        window::intray_window_begin();
        black_box(called(operation, black_box(input)));
        window::intray_window_end();
    }

    #[inline(never)]
    fn called<I, O>(operation: &impl Fn(&I) -> O, input: &I) -> O {
        operation(input)
    }

    /// Numbers that are the same on every chip (Marsaglia, "Xorshift RNGs", 2003).
    struct Random(u32);

    impl Random {
        fn next(&mut self) -> u32 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 17;
            self.0 ^= self.0 << 5;
            self.0
        }

        /// A number below `end`, at most 2^30.
        fn below(&mut self, end: u32) -> u32 {
            (self.next() >> 2) % end
        }

        /// A vector of up to 30 bits.
        fn vector(&mut self) -> Triple<i32> {
            from_fn(|_| self.next() as i32 >> 1)
        }

        /// A point of the grid, Q4.
        fn point(&mut self) -> Point {
            from_fn(|_| self.below(1 << 18) as i32)
        }

        fn unit(&mut self) -> Unit {
            loop {
                if let Some(unit) = Grid14::towards([0; 3], self.vector()) {
                    return unit;
                }
            }
        }

        /// A direction not far from another.
        fn near(&mut self, unit: Unit) -> Unit {
            let off = self.unit();
            Grid14::halfway(unit, off).and_then(|half| Grid14::halfway(unit, half)).unwrap_or(unit)
        }

        /// A direction, and a normal towards it.
        fn meeting(&mut self) -> [Unit; 2] {
            let (along, normal) = (self.unit(), self.unit());
            [along, if Grid14::aligned(along, normal) { Grid14::negate(normal) } else { normal }]
        }

        /// Normals of corners.
        fn smooth(&mut self) -> [Unit; 3] {
            let first = self.unit();
            [first, self.near(first), self.near(first)]
        }

        /// Weights that sum to at most 1.
        fn weights(&mut self) -> [Fraction; 2] {
            let u = self.below(1 << 14) as i16;
            [u, self.below((1 << 14) + 1 - u as u32) as i16].map(Fraction::from_bits)
        }

        fn albedo(&mut self) -> Albedo {
            from_fn(|_| self.next() as u16)
        }

        fn radiance(&mut self) -> Radiance {
            Radiance { mantissa: self.albedo(), exponent: self.below(4) as i16 - 2 }
        }

        fn light(&mut self) -> Rgb16 {
            Rgb16::constant(&Radiance { exponent: 0, ..self.radiance() })
        }
    }
}
