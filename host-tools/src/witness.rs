//! Why two pictures differ: what the rays behind each pixel saw.
//!
//! A tracer tells of every ray which surface it sees, and of every surface which lights reach it. Both go into digests, one
//! for camera rays, one for rays that go on from surfaces, one for lights, which are equal where the same was seen. A
//! ray has a place in the tree of rays, and the digests are sums over places, so that tracers may take them in any order.

use core_rt::kernel::NONE;
use core_rt::stats::{Counts, RayKind, Stats};

/// What the rays behind a pixel saw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seen {
    /// The first camera ray's surface, by its number in the file, spheres after all triangles; [`NONE`] for the background.
    pub first: u32,
    /// The surfaces that camera rays see.
    pub camera: u64,
    /// Those that mirrored rays and rays through surfaces see.
    pub secondary: u64,
    /// The lights that reach any of them.
    pub shadows: u64,
}

impl Default for Seen {
    fn default() -> Self {
        Self { first: NONE, camera: 0, secondary: 0, shadows: 0 }
    }
}

/// A ray's place in the tree of rays behind a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    key: u64,
    is_first: bool,
    is_camera: bool,
}

impl Place {
    /// The camera ray of a sample, by its number.
    pub(crate) fn camera(sample: u32) -> Self {
        Self { key: mix(u64::from(sample)), is_first: sample == 0, is_camera: true }
    }

    /// The ray mirrored by the surface that this one sees.
    pub(crate) fn mirrored(self) -> Self {
        self.onward(1)
    }

    /// The ray through it.
    pub(crate) fn refracted(self) -> Self {
        self.onward(2)
    }

    fn onward(self, way: u64) -> Self {
        Self { key: mix(self.key ^ way), is_first: false, is_camera: false }
    }
}

impl Seen {
    /// A ray sees a surface, or [`NONE`].
    pub(crate) fn surface(&mut self, place: Place, id: u32) {
        if place.is_first {
            self.first = id;
        }
        let digest = if place.is_camera { &mut self.camera } else { &mut self.secondary };
        *digest = digest.wrapping_add(mix(place.key ^ u64::from(id) << 8));
    }

    /// A light, by its number, reaches the surface that a ray sees.
    pub(crate) fn light(&mut self, place: Place, number: u32) {
        self.shadows = self.shadows.wrapping_add(mix(place.key ^ u64::from(number) << 8 ^ 1));
    }
}

/// The finaliser of splitmix64: G. Steele, D. Lea and C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA
/// 2014.
pub(crate) fn mix(key: u64) -> u64 {
    let mut z = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Listens to the integer core while it draws a tile.
#[derive(Clone, Debug)]
pub(crate) struct Witness {
    samples: u32,
    /// Camera rays so far.
    rays: u32,
    /// The ray that is followed.
    place: Place,
    /// Those that wait, as the core has them.
    waiting: Vec<Place>,
    /// What each pixel saw, in the order in which they are drawn.
    pub(crate) pixels: Vec<Seen>,
    pub(crate) counts: Counts,
}

impl Witness {
    /// Of pictures with so many samples a pixel.
    pub(crate) fn new(samples: u32) -> Self {
        let place = Place::camera(0);
        Self { samples, rays: 0, place, waiting: Vec::new(), pixels: Vec::new(), counts: Counts::default() }
    }

    /// The pixel that is being drawn.
    fn pixel(&mut self) -> Option<&mut Seen> {
        self.pixels.last_mut()
    }
}

impl Stats for Witness {
    fn boxes(&mut self, count: u32) {
        self.counts.boxes(count);
    }

    fn triangle(&mut self) {
        self.counts.triangle();
    }

    fn sphere(&mut self) {
        self.counts.sphere();
    }

    fn ray(&mut self, kind: RayKind) {
        self.counts.ray(kind);
        match kind {
            RayKind::Primary => {
                let sample = self.rays % self.samples;
                if sample == 0 {
                    self.pixels.push(Seen::default());
                }
                self.rays += 1;
                self.place = Place::camera(sample);
                self.waiting.clear();
            }
            RayKind::Reflection => self.waiting.push(self.place.mirrored()),
            RayKind::Refraction => self.waiting.push(self.place.refracted()),
            RayKind::Shadow => {}
        }
    }

    fn next(&mut self) {
        if let Some(place) = self.waiting.pop() {
            self.place = place;
        }
    }

    fn surface(&mut self, id: impl FnOnce() -> u32) {
        let place = self.place;
        if let Some(pixel) = self.pixel() {
            pixel.surface(place, id());
        }
    }

    fn light(&mut self, number: u32) {
        let place = self.place;
        if let Some(pixel) = self.pixel() {
            pixel.light(place, number);
        }
    }
}
