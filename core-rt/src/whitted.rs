//! The tree of rays behind a pixel, as a loop (Whitted, "An Improved Illumination Model for Shaded Display", 1980).
//!
//! A surface that both mirrors and lets through makes two rays of one. The loop goes on with the mirror image and leaves
//! the other waiting, with the share of the pixel that it is for: at most one waits for each surface that a ray goes on
//! from, so that the storage is known when a firmware is linked. A share that no pixel would show is dropped. Where rays
//! may go on no more, the background is seen.

use heapless::VecView;

use crate::bvh::{Intersect, Stack};
use crate::colour::{Albedo, Colour, WHITE, product, towards_white};
use crate::kernel::{Kernel, Surface};
use crate::profile::{Need, Profile};
use crate::record::Lustre;
use crate::scene::Scene;
use crate::shade::{ColourOf, RayOf, Shaded, SpaceOf, UnitOf, sent, shade};
use crate::space::Space;
use crate::stats::{RayKind, Stats};

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
    // That of no hit is none: it is past the end.
    stats.surface(|| scene.bvh.id(hit));
    if !P::NEEDS.branches() {
        return sent(scene, ray, hit, stack, stats).unwrap_or_else(|| background(scene, ray));
    }
    let mut total = ColourOf::<P>::default();
    let (mut ray, mut share, mut depth, mut hit) = (ray, WHITE, 0, hit);
    let mut taken;
    if P::NEEDS.has(Need::Bounces) {
        branches.clear();
    }
    loop {
        if let Some(shaded) = shade(scene, ray, hit, stack, stats) {
            total = total.plus(shaded.colour.reflected(&share));
            if let Some(lustre) = shaded.lustre {
                for (next, share, kind) in go_on(scene, ray, hit, &shaded, lustre, &share).into_iter().flatten() {
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
        hit = scene.hits().closest(ray, stack, stats);
        stats.surface(|| scene.bvh.id(hit));
    }
}

/// What a ray sees that hits nothing.
fn background<P: Profile>(scene: &Scene<'_, P>, ray: &RayOf<P>) -> ColourOf<P> {
    let [bottom, top] = &scene.frame.background;
    // One colour is that colour, under a profile with skies too: shares of rounding would take some of it away.
    if !P::NEEDS.has(Need::Sky) || bottom == top {
        return Colour::constant(bottom);
    }
    let [down, up] = SpaceOf::<P>::altitude(P::Kernel::heading(ray));
    let lit = |radiance, share| ColourOf::<P>::lit(&ColourOf::<P>::light(radiance), share);
    lit(bottom, down).plus(lit(top, up))
}

/// The rays that go on from a surface: the one that passes it, and the mirrored one.
fn go_on<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    shaded: &Shaded<'_, P>,
    lustre: &Lustre,
    share: &Albedo,
) -> [GoesOn<P>; 2] {
    let along = P::Kernel::heading(ray);
    let surface = &shaded.surface;
    let bent = if P::NEEDS.has(Need::Refraction) && lustre.refracted != [0; 3] {
        let eta_q28 = lustre.eta_q28[usize::from(!surface.front)];
        turned(shaded, false, |normal| SpaceOf::<P>::refract(along, normal, eta_q28))
    } else {
        None
    };
    let [mirror, pass] = shares(shaded, lustre, bent);
    let leave = |from: &Surface<SpaceOf<P>>, direction, colour: &Albedo, kind| -> GoesOn<P> {
        let share = product(share, colour);
        let is_seen = share.iter().any(|&channel| channel >= LEAST);
        let ray = is_seen.then(|| P::Kernel::leaving(scene.settings, from, direction, hit))??;
        Some((ray, share, kind))
    };
    let passing = bent.and_then(|direction| {
        let behind = Surface { normal: SpaceOf::<P>::negate(surface.normal), ..*surface };
        leave(&behind, direction, &pass, RayKind::Refraction)
    });
    let mirrored = if P::NEEDS.has(Need::Reflection) && mirror != [0; 3] {
        let direction = turned(shaded, true, |normal| Some(SpaceOf::<P>::reflect(along, normal)));
        direction.and_then(|direction| leave(surface, direction, &mirror, RayKind::Reflection))
    } else {
        None
    };
    [passing, mirrored]
}

/// A direction turned by the shading normal, where that faces the ray and sends it to the side of the surface that it is
/// to be on, else by the surface's own.
fn turned<P: Profile>(
    shaded: &Shaded<'_, P>,
    stays: bool,
    turn: impl Fn(UnitOf<P>) -> Option<UnitOf<P>>,
) -> Option<UnitOf<P>> {
    let own = shaded.surface.normal;
    if P::NEEDS.has(Need::SmoothNormals) && shaded.cosine.is_some() && shaded.normal != own {
        match turn(shaded.normal) {
            Some(out) if SpaceOf::<P>::cosine(out, own).is_some() != stays => {}
            other => return other,
        }
    }
    turn(own)
}

/// What is reflected and what passes. Where nothing can pass, all that would is reflected.
fn shares<P: Profile>(shaded: &Shaded<'_, P>, lustre: &Lustre, bent: Option<UnitOf<P>>) -> [Albedo; 2] {
    let Some(bent) = bent else {
        let mirrored = if lustre.refracted == [0; 3] { &lustre.reflected } else { &lustre.mirrored };
        return [towards_white(mirrored, shaded.whiteness), [0; 3]];
    };
    let (reflected, refracted) = (&lustre.reflected, &lustre.refracted);
    if !P::NEEDS.has(Need::Schlick) || lustre.flags & Lustre::FRESNEL == 0 {
        return [*reflected, *refracted];
    }
    // The angle is wider on the thinner side.
    let is_denser_behind = shaded.surface.front == (lustre.eta_q28[0] <= 1 << 28);
    let cosine =
        if is_denser_behind { shaded.cosine } else { SpaceOf::<P>::cosine(SpaceOf::<P>::negate(bent), shaded.normal) };
    let mirror = ColourOf::<P>::share(SpaceOf::<P>::fresnel(cosine.unwrap_or_default(), lustre.r0));
    [product(reflected, &[mirror; 3]), product(refracted, &[u16::MAX - mirror; 3])]
}
