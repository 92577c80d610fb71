//! The light that reaches a camera by paths, one a sample, which go on at random (Kajiya, "The Rendering Equation", 1986).
//!
//! At each surface a path adds what that sends of its own and of the lights, which are asked at every one, and goes on in one
//! direction: strewn about the normal, mirrored, or through. Which, is by chance in proportion to how much of it there is, and
//! the path's share of the pixel grows by as much as others are left out. Matt surfaces send it to a random point of the sphere
//! that the unit normal ends in the middle of: as often as the cosine is large, so that what is seen there counts as it is.
//!
//! Where in the pixel a sample is, and where it goes, depend on pixel, sample and surface alone: samples can be summed in any
//! parts and order. They are whole numbers then, in Q16, clamped to 1 as all samples are.

use core::convert::Infallible;
use core::ops::Range;

use crate::albedo::albedo;
use crate::bvh::{Intersect, Stack};
use crate::colour::{Albedo, Colour, WHITE, product};
use crate::kernel::Kernel;
use crate::num::BitLength;
use crate::onward::{self, background};
use crate::profile::{Need, Profile};
use crate::random::{Sample, below};
use crate::render::{RenderError, Tile};
use crate::samples::Place;
use crate::scene::{Frame, Scene};
use crate::shade::{ColourOf, RayOf, Shaded, shade};
use crate::stats::{RayKind, Stats};

/// The sum of samples of a pixel: red, green, blue in Q16.16. Up to 65,535 samples of at most 1 fit.
pub type Sum = [u32; 3];

/// Adds samples, by their numbers, of each pixel of a tile to sums, row by row. Whatever the ranges are that samples are added in,
/// the sums are those of one range. The tile must lie in the picture; to a scene without paths nothing is added.
///
/// # Errors
/// Where the stack is shallower than the scene's tree, or there are fewer sums than pixels.
pub fn add_samples<P: Profile>(
    scene: &Scene<'_, P>,
    tile: Tile,
    samples: Range<u16>,
    stack: &mut Stack<P::Kernel>,
    sums: &mut [Sum],
    stats: &mut impl Stats,
) -> Result<(), RenderError<Infallible>> {
    let needed = usize::from(scene.frame.depth);
    if stack.capacity() < needed {
        return Err(RenderError::Stack { capacity: stack.capacity(), needed });
    }
    let (capacity, needed) = (sums.len(), tile.pixels());
    if capacity < needed {
        return Err(RenderError::Tile { capacity, needed });
    }
    if scene.follows_paths() {
        for (sum, pixel) in sums.iter_mut().zip(tile.places()) {
            add(scene, pixel, samples.clone(), stack, sum, stats);
        }
    }
    Ok(())
}

/// Writes the pixels of a tile whose sums are of so many samples, row by row, in the format of the scene's header, as far as there
/// are sums and room. The tile must lie in the picture.
pub fn show<P: Profile>(scene: &Scene<'_, P>, tile: Tile, sums: &[Sum], samples: u16, pixels: &mut [u8]) {
    let Frame { format, transfer, .. } = scene.frame;
    for ((&sum, place), pixel) in sums.iter().zip(tile.places()).zip(pixels.chunks_exact_mut(format.bytes())) {
        format.put(mean::<P>(sum, samples), transfer, place, pixel);
    }
}

/// The mean of so many samples.
#[inline]
pub(crate) fn mean<P: Profile>(sum: Sum, samples: u16) -> ColourOf<P> {
    ColourOf::<P>::from_q16(sum).mean(samples)
}

/// Adds samples of a pixel to its sum.
pub(crate) fn add<P: Profile>(
    scene: &Scene<'_, P>,
    pixel: [u16; 2],
    samples: Range<u16>,
    stack: &mut Stack<P::Kernel>,
    sum: &mut Sum,
    stats: &mut impl Stats,
) {
    for number in samples {
        let sample = Sample { pixel, number };
        let [right, down, ..] = sample.numbers(0);
        let place = Place { right_q16: (right >> 16) as u16, down_q16: (down >> 16) as u16 };
        let [x, y] = pixel;
        stats.ray(RayKind::Primary);
        let seen = match scene.primary(&scene.camera.through(place), x, y) {
            Some(ray) => gathered(scene, ray, sample, stack, stats),
            None => Colour::constant(&scene.frame.background[0]),
        };
        for (sum, light) in sum.iter_mut().zip(seen.to_q16()) {
            *sum = sum.saturating_add(light);
        }
    }
}

/// What a path gathers that begins with a ray.
fn gathered<P: Profile>(
    scene: &Scene<'_, P>,
    mut ray: RayOf<P>,
    sample: Sample,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> ColourOf<P> {
    let (mut total, mut share) = (ColourOf::<P>::default(), Share::WHOLE);
    let mut surfaces = 0;
    loop {
        let hit = scene.hits().closest(&ray, stack, stats);
        stats.surface(|| scene.bvh.id(hit));
        let Some(shaded) = shade(scene, &ray, hit, stack, stats) else {
            stats.next();
            return total.plus(share.of(background(scene, &ray)));
        };
        total = total.plus(share.of(shaded.colour));
        let mut next = None;
        if surfaces < scene.frame.max_depth {
            surfaces += 1;
            next = onward(scene, &ray, hit, &shaded, share, sample.numbers(surfaces.into()));
        }
        if let Some((.., kind)) = next {
            stats.ray(kind);
        }
        stats.next();
        let Some((taken, left, _)) = next else { return total };
        (ray, share) = (taken, left);
    }
}

/// The ray that goes on from a surface, its share and its kind: to one that is diffusely reflected it is a reflection.
fn onward<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    shaded: &Shaded<'_, P>,
    share: Share,
    [choice, height, turn, _]: [u32; 4],
) -> Option<(RayOf<P>, Share, RayKind)> {
    let diffuse = albedo(scene, hit, scene.material(hit)?, &shaded.surface);
    let along = P::Kernel::heading(ray);
    let lustre = shaded.lustre.filter(|_| P::NEEDS.branches());
    let bent = lustre.and_then(|lustre| onward::bent(shaded, lustre, along));
    let [mut mirror, pass] = lustre.map_or([[0; 3]; 2], |lustre| onward::shares(shaded, lustre, bent));
    if !P::NEEDS.has(Need::Reflection) {
        mirror = [0; 3];
    }
    let (way, share) = share.chosen(&[diffuse, mirror, pass], choice)?;
    let (direction, kind) = match (way, lustre, bent) {
        (Way::Mirrored, Some(lustre), _) => {
            (onward::mirrored(shaded, lustre, along, || [height, turn])?, RayKind::Reflection)
        }
        (Way::Through, _, Some(bent)) => (bent, RayKind::Refraction),
        _ => (onward::strewn(shaded, shaded.normal, u16::MAX, [height, turn]), RayKind::Reflection),
    };
    let next = match kind {
        RayKind::Refraction => onward::passing(scene, shaded, direction, hit),
        _ => onward::leaving(scene, shaded, direction, hit),
    };
    Some((next?, share, kind))
}

/// One of the ways in which a path goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Diffuse,
    Mirrored,
    Through,
}

/// The share of a pixel that a path stands for: one for all the ways that it might have gone, so that it may be above 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Share {
    part: Albedo,
    /// The part is doubled so many times: not at all where it is below a half, and at most 15.
    doublings: u32,
}

impl Share {
    const WHOLE: Self = Self { part: WHITE, doublings: 0 };

    /// The light that it lets through.
    fn of<C: Colour>(self, light: C) -> C {
        let light = light.reflected(&self.part);
        if self.doublings == 0 { light } else { light.doubled(self.doublings) }
    }

    /// One of three ways, of these albedos, by a random number, and the share that it has: as likely as its strongest channel
    /// is strong, and stronger by as much as others together are. `None` where all are black, or nothing is left.
    ///
    /// Each channel is within a unit of the albedo's 65535 and of the share's.
    fn chosen(self, albedos: &[Albedo; 3], number: u32) -> Option<(Way, Self)> {
        let [d, m, t] = albedos.map(|[r, g, b]| u32::from(r.max(g).max(b)));
        let sum = d + m + t; // below 2^18
        let pick = below(number, sum);
        let (way, strongest, albedo) = if pick < d {
            (Way::Diffuse, d, &albedos[0])
        } else if pick < d + m {
            (Way::Mirrored, m, &albedos[1])
        } else {
            (Way::Through, t, &albedos[2])
        };
        let (mut factor, mut doublings) = (*albedo, self.doublings);
        if strongest != sum {
            // Of a sum of 17 or 18 bits the upper 16, rounded, so 2^16 at most; an albedo times that is below 2^32 - 2^16.
            let halvings = sum.bit_length().saturating_sub(16);
            let sum = (sum + (1 << halvings >> 1)) >> halvings;
            doublings += halvings;
            let scaled = |c: u16| (u32::from(c) * sum + strongest / 2).checked_div(strongest).unwrap_or_default();
            factor = factor.map(|c| scaled(c).min(u16::MAX.into()) as u16);
        }
        let mut part = product(&self.part, &factor);
        while doublings > 0 && part.iter().all(|&c| c < 1 << 15) {
            part = part.map(|c| c << 1);
            doublings -= 1;
        }
        (part != [0; 3]).then_some((way, Self { part, doublings: doublings.min(15) }))
    }
}
