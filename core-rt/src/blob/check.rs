//! The one check of a scene's contents, after which no accessor fails.
//!
//! The tree must be in preorder, and triangles and spheres in the order of its leaves, each exactly once: then it is a tree, it
//! ends, and its depth is what a traversal's stack must hold.

use heapless::Vec;

use super::{BlobError, Header};
use crate::bvh::{Bvh, Child};
use crate::colour::{Albedo, Radiance, Transfer};
use crate::kernel::{Bounds, Kernel};
use crate::profile::{Need, Needs, Profile};
use crate::record::{Light, Lustre, Reach};
use crate::scene::{MAX_DEPTH, Scene, Shading};
use crate::space::{Space, is_unit_q30};

/// Checks all that the sections say.
pub(crate) fn all<P: Profile>(header: &Header, scene: &Scene<'_, P>) -> Result<(), BlobError> {
    tree(header, &scene.bvh)?;
    contents(header, &scene.bvh, &scene.shading)?;
    if P::NEEDS.paint() {
        scene.shading.paint.check::<P>(header.counts.triangles)?;
    }
    Ok(())
}

/// Checks what the sections say beside the [tree], which comes first.
// Out of line, as the tree's check is: neither has then the other's part of the stack.
#[inline(never)]
fn contents<P: Profile>(header: &Header, bvh: &Bvh<'_, P>, shading: &Shading<'_, P::Kernel>) -> Result<(), BlobError> {
    let starts_within = |whole: &_| header.camera.starts_within(header.camera_use(P::NEEDS), whole, P::Kernel::SPAN);
    origins(starts_within, bvh, shading)?;
    triangles(header, bvh, shading)?;
    if P::NEEDS.has(Need::Spheres) {
        spheres(header, bvh, shading)?;
    }
    materials_and_lights::<P>(header, shading)
}

/// Every triangle must be what the kernel makes of its vertices, and what it refers to must be there.
fn triangles<P: Profile>(header: &Header, bvh: &Bvh<'_, P>, shading: &Shading<'_, P::Kernel>) -> Result<(), BlobError> {
    for index in 0..bvh.triangles.len() {
        let material_exists =
            bvh.triangles.material(index).is_some_and(|material| (material as usize) < shading.materials.len());
        let id_exists = bvh.id(index) < header.file_triangles;
        let normals_exist = shading.normal_indices.is_empty()
            || shading.normal_indices.triple(index).iter().all(|&n| (n as usize) < shading.normals.len())
            || shading.is_flat(index);
        if !(bvh.triangles.is_valid(index) && id_exists && normals_exist && material_exists) {
            return Err(BlobError::Triangle { index });
        }
    }
    Ok(())
}

/// Every sphere must be one that the kernel holds, and what it refers to must be there.
fn spheres<P: Profile>(header: &Header, bvh: &Bvh<'_, P>, shading: &Shading<'_, P::Kernel>) -> Result<(), BlobError> {
    for (index, (sphere, place)) in (0..).zip(bvh.spheres.iter().zip(bvh.triangles.len()..)) {
        let material = P::Kernel::sphere_material(sphere);
        let consistent = P::Kernel::sphere(&P::Kernel::ball(sphere), material).is_some_and(|made| made == *sphere);
        let id_exists =
            bvh.id(place).checked_sub(header.file_triangles).is_some_and(|number| number < header.file_spheres);
        if !(consistent && id_exists && (material as usize) < shading.materials.len()) {
            return Err(BlobError::Sphere { index });
        }
    }
    Ok(())
}

/// What shading reads must be in range, and declared.
///
/// What the profile lacks is not looked into further than to find that the scene needs it: it is refused for that then.
fn materials_and_lights<P: Profile>(header: &Header, shading: &Shading<'_, P::Kernel>) -> Result<(), BlobError> {
    let mut used = of_header(header);
    let mut valid = header.background.iter().chain([&header.ambient]).all(is_in_range);
    for material in shading.materials {
        used = used.with(Need::Emission, !material.emission.is_black());
        valid &= is_in_range(&material.emission)
            && usize::from(material.lustre) <= shading.lustres.len()
            && usize::from(material.checker) <= shading.checkers.len();
    }
    // Where rays may not go on, the background is seen instead of what they would see.
    let goes_on = header.max_depth > 0 || header.background.iter().any(|colour| !colour.is_black());
    let mut is_rough = false;
    for lustre in shading.lustres {
        let tints = header.needs.has(Need::Shadows) && lustre.shadow != [0; 3];
        let goes_on_in = |share: &Albedo| goes_on && *share != [0; 3];
        used = used
            .with(if lustre.flags & Lustre::PHONG == 0 { Need::BlinnPhong } else { Need::Phong }, lustre.shines())
            // What would pass a surface, and cannot, is mirrored.
            .with(Need::Reflection, goes_on_in(&lustre.reflected) || goes_on_in(&lustre.refracted))
            .with(Need::Refraction, goes_on_in(&lustre.refracted))
            .with(Need::Schlick, lustre.flags & (Lustre::FRESNEL | Lustre::METAL) != 0)
            .with(Need::TintedShadow, tints);
        is_rough |= lustre.roughness != 0;
        valid &= !P::NEEDS.lustres() || lustre_is_valid(lustre);
    }
    for checker in shading.checkers {
        used = used.with(Need::Checker, true);
        valid &= checker.reserved == 0;
    }
    for light in shading.lights {
        used = used
            .with(if light.kind == Light::POINT { Need::PointLight } else { Need::DirectionalLight }, true)
            .with(Need::Falloff, light.kind == Light::POINT && light.reach.mantissa != 0);
        valid &= is_in_range(&light.radiance) && light_is_valid::<P>(light);
    }
    if P::NEEDS.has(Need::SmoothNormals) {
        valid &= shading.normals.iter().all(<P::Kernel as Kernel>::Space::is_unit);
    }
    if !valid {
        return Err(BlobError::Shading);
    }
    // Paths gather what ambient light stands for, and one ray at a time goes on, which waits for none.
    let paths = header.needs.has(Need::Paths);
    if paths && !header.ambient.is_black() {
        return Err(BlobError::Shading);
    }
    used = used
        .with(Need::Bounces, used.branches() && header.max_depth > 0 && !paths)
        .with(Need::Roughness, used.branches() && is_rough);
    match used.first_missing_in(header.needs) {
        Some(need) => Err(BlobError::Undeclared(need)),
        None => Ok(()),
    }
}

/// Origins of camera rays and point lights must be where the kernel's differences hold them.
fn origins<P: Profile>(
    starts_within: impl Fn(&Bounds) -> bool,
    bvh: &Bvh<'_, P>,
    shading: &Shading<'_, P::Kernel>,
) -> Result<(), BlobError> {
    let mut whole = Bounds::NOTHING;
    match bvh.nodes {
        [root, ..] => P::Kernel::boxes(root).iter().for_each(|held| whole = whole.union(held)),
        // The root is a leaf.
        [] => bvh.bounds().for_each(|held| whole = whole.union(&held)),
    }
    let mut lights = shading.lights.iter().filter(|light| light.kind == Light::POINT).map(|light| light.place);
    let fits = lights.all(|origin| whole.spanned_from(origin, P::Kernel::SPAN)) && starts_within(&whole);
    if fits { Ok(()) } else { Err(BlobError::Origin) }
}

/// The exponent is one that shifts can do.
fn is_in_range(radiance: &Radiance) -> bool {
    Radiance::EXPONENTS.contains(&radiance.exponent)
}

/// What light is bent by must leave room in the products.
fn lustre_is_valid(lustre: &Lustre) -> bool {
    lustre.flags & !(Lustre::PHONG | Lustre::FRESNEL | Lustre::METAL) == 0
        && lustre.gain <= 15
        && !lustre.eta_q28.contains(&0)
}

/// A light must be of a known kind.
fn light_is_valid<P: Profile>(light: &Light) -> bool {
    let Reach { mantissa, exponent } = light.reach;
    let fades = mantissa == 0 || mantissa >> 15 == 1 && Reach::EXPONENTS.contains(&exponent);
    match light.kind {
        Light::POINT => fades,
        Light::DIRECTIONAL => fades && (!P::NEEDS.has(Need::DirectionalLight) || is_unit_q30(light.place)),
        _ => false,
    }
}

/// What the header says that shading comes upon. A profile that was derived from it must not be without it: the picture
/// would depend on the profile.
fn of_header(header: &Header) -> Needs {
    Needs::NONE
        .with(Need::SeveralLights, header.counts.lights > 1)
        .with(Need::Ambient, !header.ambient.is_black())
        .with(if header.transfer == Transfer::Srgb { Need::Srgb } else { Need::Linear }, true)
        .with(header.format.need(), true)
        .with(Need::Supersampling, header.samples > 1 && !header.needs.has(Need::Paths))
        .with(Need::Sky, header.background[0] != header.background[1])
}

/// A node whose second child is still to be checked, and that child's level: a word for both, since nothing that a chip
/// does takes more stack than this check. Indices that a tree can refer to are below 2^25.
#[derive(Clone, Copy)]
struct Pending(u32);

const _: () = assert!(Child::INDEX_END == 1 << Pending::INDEX_BITS && MAX_DEPTH < 1 << (32 - Pending::INDEX_BITS));

impl Pending {
    const INDEX_BITS: u32 = 25;

    fn new(node: u32, level: u8) -> Self {
        Self(u32::from(level) << Self::INDEX_BITS | node)
    }

    fn node(self) -> u32 {
        self.0 & (Child::INDEX_END - 1)
    }

    fn level(self) -> u8 {
        (self.0 >> Self::INDEX_BITS) as u8
    }
}

/// Checks that the tree is one, of the stated depth, and that all that it holds is where its boxes say.
// Out of line, so that its stack is on top of neither what the header takes while it is decoded nor of what the rest of the
// check does: together they are the deepest that a firmware's stack gets.
#[inline(never)]
fn tree<P: Profile>(header: &Header, bvh: &Bvh<'_, P>) -> Result<(), BlobError> {
    // The root has no parent, but what the box test computes with must lie on the grid.
    let (low, high) = (P::Kernel::MARGIN, (1 << P::Kernel::GRID_BITS) - 1 - P::Kernel::MARGIN);
    let grid = Bounds { low: [low; 3], high: [high; 3] };
    let triangles = bvh.triangles.len();
    let (mut next_node, mut next_triangle, mut next_sphere) = (0, 0, triangles);
    let mut pending: Vec<Pending, { MAX_DEPTH + 1 }> = Vec::new();
    // A subtree: its reference, the node and slot that hold it, and its level.
    let mut current: (u32, Option<(u32, bool)>, u8) = (bvh.root, None, 0);
    loop {
        let (reference, holder, level) = current;
        let node = holder.map_or(0, |(node, _)| node);
        let held = holder.and_then(|(node, second)| {
            let [a, b] = P::Kernel::boxes(bvh.nodes.get(node as usize)?);
            Some(if second { b } else { a })
        });
        let inside = |content: &Bounds| held.unwrap_or(grid).contains(content);
        match Child::unpack(reference) {
            Child::Node(index) => {
                if index != next_node || index >= Child::INDEX_END {
                    return Err(BlobError::Tree { node });
                }
                let record = bvh.nodes.get(index as usize).ok_or(BlobError::Tree { node })?;
                next_node += 1;
                if level >= header.depth {
                    return Err(BlobError::Depth { stated: header.depth });
                }
                if !P::Kernel::boxes(record).iter().all(inside) {
                    return Err(BlobError::Bounds { node });
                }
                let [first, _] = P::Kernel::children(record);
                pending.push(Pending::new(index, level + 1)).map_err(|_| BlobError::Depth { stated: header.depth })?;
                current = (first, Some((index, false)), level + 1);
            }
            Child::Leaf { first, count } => {
                let enclosed = if P::NEEDS.has(Need::Spheres) && first >= triangles {
                    if first != next_sphere {
                        return Err(BlobError::Tree { node });
                    }
                    next_sphere += count; // at most 2^25 + 64
                    let run = bvh.spheres.get((first - triangles) as usize..(next_sphere - triangles) as usize);
                    run.ok_or(BlobError::Tree { node })?.iter().all(|s| inside(&P::Kernel::ball(s).bounds()))
                } else {
                    if first != next_triangle || count > triangles - first {
                        return Err(BlobError::Tree { node });
                    }
                    next_triangle += count;
                    let mut enclosed = true;
                    for index in first..next_triangle {
                        let vertices = bvh.triangles.vertices(index).ok_or(BlobError::Triangle { index })?;
                        enclosed &= inside(&Bounds::of(&vertices));
                    }
                    enclosed
                };
                if !enclosed {
                    return Err(BlobError::Bounds { node });
                }
                let Some(waiting) = pending.pop() else { break };
                let (node, level) = (waiting.node(), waiting.level());
                let record = bvh.nodes.get(node as usize).ok_or(BlobError::Tree { node })?;
                let [_, second] = P::Kernel::children(record);
                current = (second, Some((node, true)), level);
            }
        }
    }
    let is_whole = next_node as usize == bvh.nodes.len()
        && next_triangle == triangles
        && (!P::NEEDS.has(Need::Spheres) || (next_sphere - triangles) as usize == bvh.spheres.len());
    if is_whole { Ok(()) } else { Err(BlobError::Tree { node: next_node }) }
}
