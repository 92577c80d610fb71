//! The tree of rays behind a pixel, as a loop (Whitted, "An Improved Illumination Model for Shaded Display", 1980).
//!
//! A surface that both mirrors and lets through makes two rays of one. The loop goes on with the mirror image and leaves
//! the other waiting, with the share of the pixel that it is for: at most one waits for each surface that a ray goes on
//! from, so that the storage is known when a firmware is linked. A share that no pixel would show is dropped. Where rays
//! may go on no more, the background is seen.

use heapless::VecView;

use crate::bvh::{Intersect, Stack};
use crate::colour::{Albedo, Colour, product};
use crate::kernel::{Kernel, Surface};
use crate::profile::{Need, Profile};
use crate::record::Lustre;
use crate::scene::Scene;
use crate::shade::{ColourOf, RayOf, Shaded, SpaceOf, shade};
use crate::space::{Scalar, Space};
use crate::stats::{RayKind, Stats};

/// All of a pixel.
const WHOLE: Albedo = [u16::MAX; 3];

/// Shares below 2^-10 are dropped: a white light of radiance 1 would add a quarter of a gray level.
const LEAST: u16 = 1 << 6;

/// A ray that waits, the share of the pixel that it is for, and how many surfaces it has behind it.
pub type Branch<K> = (<K as Kernel>::Ray, Albedo, u8);

/// Rays that wait. One more than the surfaces that a ray may go on from is enough.
pub type Branches<K> = VecView<Branch<K>>;

/// A ray that goes on from a surface, its share and its kind.
type GoesOn<P> = Option<(RayOf<P>, Albedo, RayKind)>;

/// What a ray sees whose nearest hit is known.
pub(crate) fn radiance<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    branches: &mut Branches<P::Kernel>,
    stats: &mut impl Stats,
) -> ColourOf<P> {
    let background = || Colour::constant(&scene.header.background);
    if !P::NEEDS.branches() {
        return shade(scene, ray, hit, stack, stats).map_or_else(background, |shaded| shaded.colour);
    }
    let mut total = ColourOf::<P>::default();
    let (mut ray, mut share, mut depth, mut hit) = (*ray, WHOLE, 0, hit);
    branches.clear();
    loop {
        let shaded = shade(scene, &ray, hit, stack, stats);
        let colour = shaded.as_ref().map_or_else(background, |shaded| shaded.colour);
        total = total.plus(colour.reflected(&share));
        let onward = shaded.map_or([None, None], |shaded| go_on(scene, &ray, hit, &shaded, &share));
        for (next, share, kind) in onward.into_iter().flatten() {
            if depth < scene.header.max_depth {
                stats.ray(kind);
                // There is room for one a level, and the one that is taken up again at once.
                let _ = branches.push((next, share, depth + 1));
            } else {
                total = total.plus(background().reflected(&share));
            }
        }
        let Some(next) = branches.pop() else { return total };
        (ray, share, depth) = next;
        hit = scene.bvh.closest(&ray, stack, stats);
    }
}

/// The rays that go on from a surface: the one that passes it, and the mirrored one.
fn go_on<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    shaded: &Shaded<'_, P>,
    share: &Albedo,
) -> [GoesOn<P>; 2] {
    let Some(lustre) = shaded.lustre else { return [None, None] };
    let along = P::Kernel::heading(ray);
    let (surface, normal) = (&shaded.surface, shaded.normal);
    let bent = if P::NEEDS.has(Need::Refraction) && lustre.refracted != [0; 3] {
        SpaceOf::<P>::refract(along, normal, lustre.eta_q28[usize::from(!surface.front)])
    } else {
        None
    };
    let outside = if surface.front {
        SpaceOf::<P>::cosine(SpaceOf::<P>::negate(along), normal)
    } else {
        bent.map(|(_, behind)| behind)
    };
    let [mirror, pass] = shares::<SpaceOf<P>>(lustre, bent.is_some(), outside);
    let leave = |from: &Surface<SpaceOf<P>>, direction, colour: &Albedo, kind| -> GoesOn<P> {
        let share = product(share, colour);
        let is_seen = share.iter().any(|&channel| channel >= LEAST);
        let ray = is_seen.then(|| P::Kernel::leaving(scene.settings, from, direction, hit))??;
        Some((ray, share, kind))
    };
    let passing = bent.and_then(|(direction, _)| {
        let behind = Surface { normal: SpaceOf::<P>::negate(surface.normal), ..*surface };
        leave(&behind, direction, &pass, RayKind::Refraction)
    });
    let mirrored = if P::NEEDS.has(Need::Reflection) {
        // A normal between corners can mirror into the surface; its own never does.
        let direction = SpaceOf::<P>::reflect(along, normal);
        let direction = if SpaceOf::<P>::aligned(direction, surface.normal) {
            direction
        } else {
            SpaceOf::<P>::reflect(along, surface.normal)
        };
        leave(surface, direction, &mirror, RayKind::Reflection)
    } else {
        None
    };
    [passing, mirrored]
}

/// What is reflected and what passes, for the cosine on the thinner side. Where nothing can pass, all that would is
/// reflected.
fn shares<S: Space>(lustre: &Lustre, passes: bool, outside: Option<Scalar<S>>) -> [Albedo; 2] {
    let (reflected, refracted) = (lustre.reflected, lustre.refracted);
    if lustre.flags & Lustre::FRESNEL != 0 {
        let mirror = match outside {
            Some(cosine) if passes => S::Colour::share(S::fresnel(cosine, lustre.r0)),
            _ => u16::MAX,
        };
        [product(&reflected, &[mirror; 3]), product(&refracted, &[u16::MAX - mirror; 3])]
    } else if passes {
        [reflected, refracted]
    } else {
        let sum = |axis: usize| reflected[axis].saturating_add(refracted[axis]);
        [[sum(0), sum(1), sum(2)], [0; 3]]
    }
}
