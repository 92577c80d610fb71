//! Where rays go on from a surface, and in which shares: the mirrored one and the one that passes.

use crate::colour::{Albedo, Colour, product, towards_white};
use crate::kernel::{Kernel, Surface};
use crate::profile::{Need, Profile};
use crate::record::Lustre;
use crate::scene::Scene;
use crate::shade::{ColourOf, RayOf, Shaded, SpaceOf, UnitOf};
use crate::space::Space;

/// What a ray sees that hits nothing.
pub(crate) fn background<P: Profile>(scene: &Scene<'_, P>, ray: &RayOf<P>) -> ColourOf<P> {
    let [bottom, top] = &scene.frame.background;
    // One colour is that colour, under a profile with skies too: shares of rounding would take some of it away.
    if !P::NEEDS.has(Need::Sky) || bottom == top {
        return Colour::constant(bottom);
    }
    let [down, up] = SpaceOf::<P>::altitude(P::Kernel::heading(ray));
    let lit = |radiance, share| ColourOf::<P>::lit(&ColourOf::<P>::light(radiance), share);
    lit(bottom, down).plus(lit(top, up))
}

/// The direction behind the surface of a ray that came `along`; `None` where none passes.
#[inline]
pub(crate) fn bent<P: Profile>(shaded: &Shaded<'_, P>, lustre: &Lustre, along: UnitOf<P>) -> Option<UnitOf<P>> {
    if !P::NEEDS.has(Need::Refraction) || lustre.refracted == [0; 3] {
        return None;
    }
    let eta_q28 = lustre.eta_q28[usize::from(!shaded.surface.front)];
    turned(shaded, false, |normal| SpaceOf::<P>::refract(along, normal, eta_q28))
}

/// The direction in which a ray that came `along` is mirrored; on a rough surface, strewn by two random numbers.
#[inline]
pub(crate) fn mirrored<P: Profile>(
    shaded: &Shaded<'_, P>,
    lustre: &Lustre,
    along: UnitOf<P>,
    numbers: impl FnOnce() -> [u32; 2],
) -> Option<UnitOf<P>> {
    let mirrored = turned(shaded, true, |normal| Some(SpaceOf::<P>::reflect(along, normal)))?;
    if !P::NEEDS.has(Need::Roughness) || lustre.roughness == 0 {
        return Some(mirrored);
    }
    Some(strewn(shaded, mirrored, lustre.roughness, numbers()))
}

/// A direction and, in a share, one of all that there are: on the surface's side.
pub(crate) fn strewn<P: Profile>(
    shaded: &Shaded<'_, P>,
    direction: UnitOf<P>,
    share: u16,
    numbers: [u32; 2],
) -> UnitOf<P> {
    let own = shaded.surface.normal;
    match SpaceOf::<P>::strewn(direction, SpaceOf::<P>::anywhere(numbers), share) {
        Some(out) if SpaceOf::<P>::aligned(out, own) => out,
        Some(below) => SpaceOf::<P>::reflect(below, own),
        None => direction,
    }
}

/// The ray from the surface on the viewer's side.
#[inline]
pub(crate) fn leaving<P: Profile>(
    scene: &Scene<'_, P>,
    shaded: &Shaded<'_, P>,
    direction: UnitOf<P>,
    hit: u32,
) -> Option<RayOf<P>> {
    P::Kernel::leaving(scene.settings, &shaded.surface, direction, hit)
}

/// The ray from the surface on the other side.
#[inline]
pub(crate) fn passing<P: Profile>(
    scene: &Scene<'_, P>,
    shaded: &Shaded<'_, P>,
    direction: UnitOf<P>,
    hit: u32,
) -> Option<RayOf<P>> {
    let surface = &shaded.surface;
    let behind = Surface { normal: SpaceOf::<P>::negate(surface.normal), ..*surface };
    P::Kernel::leaving(scene.settings, &behind, direction, hit)
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
pub(crate) fn shares<P: Profile>(shaded: &Shaded<'_, P>, lustre: &Lustre, bent: Option<UnitOf<P>>) -> [Albedo; 2] {
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
