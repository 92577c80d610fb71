//! The tree of rays behind a pixel, as a loop (Whitted, "An Improved Illumination Model for Shaded Display", 1980).
//!
//! A surface that both mirrors and lets through makes two rays of one. The loop goes on with the mirror image and leaves
//! the other waiting, with the share of the pixel that it is for: at most one waits for each surface that a ray goes on
//! from, so that the storage is known when a firmware is linked. A share that no pixel would show is dropped. Where rays
//! may go on no more, the background is seen.

use heapless::VecView;

use crate::bvh::{Intersect, Stack};
use crate::colour::{Albedo, Colour, WHITE, product};
use crate::kernel::Kernel;
use crate::onward::{self, background};
use crate::profile::{Need, Profile};
use crate::random::Sample;
use crate::record::Lustre;
use crate::scene::Scene;
use crate::shade::{ColourOf, RayOf, Shaded, sent, shade};
use crate::stats::{RayKind, Stats};

/// Shares below 2^-10 are dropped: a white light of radiance 1 would add a quarter of a gray level.
const LEAST: u16 = 1 << 6;

/// A ray that waits, the share of the pixel that it is for, and how many surfaces it has behind it.
pub type Branch<K> = (<K as Kernel>::Ray, Albedo, u8);

/// Rays that wait. One more than the surfaces that a ray may go on from is enough.
pub type Branches<K> = VecView<Branch<K>>;

/// A ray that goes on from a surface, its share and its kind.
type GoesOn<P> = Option<(RayOf<P>, Albedo, RayKind)>;

/// What a sample's ray sees whose nearest hit is known. Where a surface is rough, chance has a say once a surface.
pub(crate) fn radiance<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    sample: Sample,
    stack: &mut Stack<P::Kernel>,
    branches: &mut Branches<P::Kernel>,
    stats: &mut impl Stats,
) -> ColourOf<P> {
    // That of no hit is none: it is past the end.
    stats.surface(|| scene.bvh.id(hit));
    // A constant to the compiler itself: of what cannot be reached no instruction is made, to be removed or merged later.
    if const { !P::NEEDS.branches() } {
        return sent(scene, ray, hit, stack, stats).unwrap_or_else(|| background(scene, ray));
    }
    let mut total = ColourOf::<P>::default();
    let (mut ray, mut share, mut depth, mut hit) = (ray, WHITE, 0, hit);
    let mut taken;
    let mut surfaces = 0;
    if P::NEEDS.has(Need::Bounces) {
        branches.clear();
    }
    loop {
        if let Some(shaded) = shade(scene, ray, hit, stack, stats) {
            total = total.plus(shaded.colour.reflected(&share));
            if let Some(lustre) = shaded.lustre {
                let numbers = || {
                    let [_, height, turn, _] = sample.numbers(surfaces);
                    [height, turn]
                };
                let onward = go_on(scene, ray, hit, &shaded, lustre, &share, numbers);
                for (next, share, kind) in onward.into_iter().flatten() {
                    if P::NEEDS.has(Need::Bounces) && depth < scene.frame.max_depth {
                        stats.ray(kind);
                        // There is room for one a level, and the one that is taken up again at once.
                        let _ = branches.push((next, share, depth + 1));
                    } else {
                        total = total.plus(background(scene, &next).reflected(&share));
                    }
                }
            }
        } else {
            total = total.plus(background(scene, ray).reflected(&share));
        }
        stats.next();
        if !P::NEEDS.has(Need::Bounces) {
            return total;
        }
        let Some(next) = branches.pop() else { return total };
        (taken, share, depth) = next;
        ray = &taken;
        surfaces += 1;
        hit = scene.hits().closest(ray, stack, stats);
        stats.surface(|| scene.bvh.id(hit));
    }
}

/// The rays that go on from a surface: the one that passes it, and the mirrored one.
fn go_on<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    shaded: &Shaded<'_, P>,
    lustre: &Lustre,
    share: &Albedo,
    numbers: impl FnOnce() -> [u32; 2],
) -> [GoesOn<P>; 2] {
    let along = P::Kernel::heading(ray);
    let bent = onward::bent(shaded, lustre, along);
    let [mirror, pass] = onward::shares(shaded, lustre, bent);
    let seen =
        |colour: &Albedo| Some(product(share, colour)).filter(|share| share.iter().any(|&channel| channel >= LEAST));
    let passing = bent.and_then(|direction| {
        let share = seen(&pass)?;
        Some((onward::passing(scene, shaded, direction, hit)?, share, RayKind::Refraction))
    });
    let mirrored = if P::NEEDS.has(Need::Reflection) && mirror != [0; 3] {
        seen(&mirror).and_then(|share| {
            let direction = onward::mirrored(shaded, lustre, along, numbers)?;
            Some((onward::leaving(scene, shaded, direction, hit)?, share, RayKind::Reflection))
        })
    } else {
        None
    };
    [passing, mirrored]
}
