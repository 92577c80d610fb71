//! The light of a point: what it emits, what lights add to it, and what it mirrors and lets through.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Reference;
use super::optics::{fresnel, reflect, refract, schlick};
use super::random::Random;
use super::ray::Ray;
use super::shape::Shape;
use super::surface::Surface;
use super::trace::Bounce;
use crate::model::{Background, Falloff, Light, LightKind, Lobe, Material, MaterialKind, Specular};
use crate::witness::{Place, Seen};

/// The nearest that a light of inverse-square falloff gets, as a part of its reach: at most 256 times as bright as there.
const NEAREST: f64 = 1.0 / 16.0;

/// The shares of a material's light.
struct Weights {
    diffuse: f64,
    specular: f64,
    /// By how much the colours of highlights and reflections go towards white.
    whiteness: f64,
    reflected: f64,
    refracted: f64,
}

/// What a surface does with light, and where it sends what it does not keep.
pub(super) struct Ways {
    weights: Weights,
    /// By how much diffuse light is multiplied, linear RGB.
    pub(super) diffuse: DVec3,
    /// The mirrored direction of unit length, and by how much what comes from there is multiplied.
    pub(super) mirrored: (DVec3, DVec3),
    /// Likewise behind the surface, if anything comes from there.
    pub(super) refracted: Option<(DVec3, DVec3)>,
}

/// What all lights together do to a point.
struct Lit {
    /// Sum of E cos, linear RGB, with the light that is everywhere.
    diffuse: DVec3,
    /// Sum of E lobe, linear RGB.
    specular: DVec3,
    /// Bit i is set where light i contributes.
    lights: u64,
}

impl Reference<'_> {
    /// What the ray that met `surface` brings, linear RGB, and the lights that contribute there.
    pub(super) fn shade(
        &self,
        surface: &Surface<'_>,
        bounce: Bounce,
        random: &mut Random,
        seen: &mut Seen,
    ) -> (DVec3, u64) {
        let ways = surface.ways();
        let (mut colour, lights) = self.sent(surface, &ways, self.model.render.ambient, bounce.place, seen);
        let (mirrored, weight) = ways.mirrored;
        if let Some(next) = bounce.next(bounce.place.mirrored(), weight) {
            colour += weight * self.trace(surface, surface.strewn(mirrored, random), next, random, seen);
        }
        if let Some((direction, weight)) = ways.refracted
            && let Some(next) = bounce.next(bounce.place.refracted(), weight)
        {
            colour += weight * self.trace(surface, direction, next, random, seen);
        }
        (colour, lights)
    }

    /// What a surface sends of its own, of the light that is everywhere and of the lights, linear RGB, and which lights
    /// contribute.
    pub(super) fn sent(
        &self,
        surface: &Surface<'_>,
        ways: &Ways,
        ambient: DVec3,
        place: Place,
        seen: &mut Seen,
    ) -> (DVec3, u64) {
        let (material, weights) = (surface.material, &ways.weights);
        let lit = self.lit(surface, weights, ambient);
        // What gives nothing back need not be lit, and others do not look for lights there.
        if ways.diffuse != DVec3::ZERO || weights.specular > 0.0 {
            (0..u64::BITS).filter(|i| lit.lights >> i & 1 != 0).for_each(|i| seen.light(place, i));
        }
        let mut colour = material.emission + surface.albedo * lit.diffuse * weights.diffuse;
        if let Some(specular) = &material.specular {
            colour += weights.towards_white(specular.colour) * lit.specular * weights.specular;
        }
        (colour, lit.lights)
    }

    /// What a ray along `direction` sees that hits nothing.
    pub(super) fn background(&self, direction: DVec3) -> DVec3 {
        match self.model.background {
            Background::Colour(colour) => colour,
            Background::Sky { bottom, top } => {
                // Scaled first: the square of a length may be out of range.
                let direction = Ray::new(DVec3::ZERO, direction).step;
                bottom + (top - bottom) * ((1.0 + direction.normalize().y) / 2.0)
            }
        }
    }

    /// What the lights do to a point, beside light that is everywhere.
    fn lit(&self, surface: &Surface<'_>, weights: &Weights, ambient: DVec3) -> Lit {
        let mut lit = Lit { diffuse: ambient, specular: DVec3::ZERO, lights: 0 };
        let specular = surface.material.specular.filter(|_| weights.specular > 0.0);
        if weights.diffuse == 0.0 && specular.is_none() {
            return lit;
        }
        for (i, light) in self.model.lights.iter().enumerate() {
            let (towards, end) = match light.kind {
                LightKind::Point(position) => (position - surface.point, Some(position)),
                LightKind::Directional(travel) => (-travel, None),
            };
            // Not a number if the light is at the point, which then counts as unlit.
            let l = Ray::new(surface.point, towards).step.normalize();
            let cosine = surface.normal.dot(l);
            let lifted = surface.lifted.filter(|_| self.model.render.shadows);
            if !(cosine > 0.0
                && (lifted.is_some_and(|lifted| lifted != surface.point) || surface.geometric_normal.dot(l) > 0.0))
            {
                continue;
            }
            let from = lifted.unwrap_or(surface.point);
            let ray = Ray::new(from, end.map_or(towards, |end| end - from));
            let passed = if self.model.render.shadows { self.passed(&ray, surface.prim, end) } else { DVec3::ONE };
            if passed == DVec3::ZERO {
                continue;
            }
            let radiance = passed * arriving(light, towards);
            lit.diffuse += radiance * cosine;
            if let Some(specular) = &specular {
                lit.specular += radiance * lobe(specular, surface, l);
            }
            lit.lights |= 1_u64.checked_shl(i as u32).unwrap_or(0);
        }
        lit
    }

    /// What is left of the light that comes the other way along `ray`, which starts on primitive `start`, from `end`, a
    /// point light; without one, from infinity. Zero where something opaque is between.
    fn passed(&self, ray: &Ray, start: u32, end: Option<DVec3>) -> DVec3 {
        let limit = if end.is_some() { ray.scale } else { f64::INFINITY };
        let is_between = |shape: &Shape, depth: f64| {
            depth > 0.0 && depth < limit && !end.is_some_and(|end| shape.ends_at(end, ray, depth, limit, self.contact))
        };
        let mut passed = DVec3::ONE;
        self.bvh.traverse(ray, limit, |shapes| {
            for shape in shapes {
                let depths = shape.depths_from(ray, start, self.contact);
                let count = depths.into_iter().flatten().filter(|&depth| is_between(shape, depth)).count();
                for _ in 0..count {
                    passed *= self.shadow_tint(shape.prim());
                }
            }
            if passed == DVec3::ZERO { ControlFlow::Break(()) } else { ControlFlow::Continue(limit) }
        });
        passed
    }

    /// What a surface leaves of light that goes through it on its way to be shaded.
    fn shadow_tint(&self, prim: u32) -> DVec3 {
        let model = self.model;
        let index = prim as usize;
        let number = match model.triangles.get(index) {
            Some(triangle) => triangle.material,
            None => model.spheres[index - model.triangles.len()].material,
        };
        let material = &model.materials[number as usize];
        let share = match (material.weights, material.kind) {
            _ if !material.tinted_shadow => 0.0,
            (Some([.., refracted]), _) => refracted,
            (None, MaterialKind::Dielectric) => 1.0,
            (None, _) => 0.0,
        };
        transmission_tint(material) * share
    }
}

impl Weights {
    /// A colour of highlights or reflections, as it is at the ray's angle.
    fn towards_white(&self, colour: DVec3) -> DVec3 {
        colour + (DVec3::ONE - colour) * self.whiteness
    }
}

impl Surface<'_> {
    /// What becomes of light here.
    pub(super) fn ways(&self) -> Ways {
        let refracted = self.refracted();
        let weights = self.weights(refracted);
        let mirrored = weights.towards_white(reflection_tint(self.material)) * weights.reflected;
        let passing = transmission_tint(self.material) * weights.refracted;
        Ways {
            diffuse: self.albedo * weights.diffuse,
            mirrored: (self.reflected(), mirrored),
            refracted: refracted.map(|direction| (direction, passing)),
            weights,
        }
    }

    /// The normal by which a ray is turned: ns, where that faces the ray and sends it to the side of ng that it is to be
    /// on, else ng.
    fn turned(&self, turn: impl Fn(DVec3) -> Option<DVec3>, stays: bool) -> Option<DVec3> {
        let is_right = |out: DVec3| (out.dot(self.geometric_normal) > 0.0) == stays;
        if self.direction.dot(self.normal) < 0.0 {
            match turn(self.normal) {
                Some(out) if !is_right(out) => {}
                other => return other,
            }
        }
        turn(self.geometric_normal)
    }

    /// The direction of the mirrored ray, unit length.
    fn reflected(&self) -> DVec3 {
        let mirror = |n| Some(reflect(self.direction, n));
        self.turned(mirror, true).unwrap_or(self.geometric_normal)
    }

    /// The direction of the ray that goes on behind the surface, unit length; `None` where all light is reflected.
    fn refracted(&self) -> Option<DVec3> {
        let ior = self.material.ior;
        let eta = if self.is_front { 1.0 / ior } else { ior };
        self.turned(|n| refract(self.direction, n, eta), false)
    }

    /// The shares of light, given the direction of refracted light.
    fn weights(&self, refracted: Option<DVec3>) -> Weights {
        let material = self.material;
        let constant = |[diffuse, specular, reflected, refracted]: [f64; 4]| Weights {
            diffuse,
            specular,
            whiteness: 0.0,
            reflected,
            refracted,
        };
        let cosine = -self.direction.dot(self.normal);
        let mut weights = match (material.weights, material.kind) {
            (Some(given), _) => constant(given),
            (None, MaterialKind::Lambert) => constant([1.0, 1.0, 0.0, 0.0]),
            (None, MaterialKind::Mirror) => constant([0.0, 1.0, 1.0, 0.0]),
            (None, MaterialKind::Metal) => {
                Weights { whiteness: schlick(0.0, cosine), ..constant([0.0, 1.0, 1.0, 0.0]) }
            }
            (None, MaterialKind::Dielectric) => {
                // Angles are wider on the side of the lower index.
                let is_denser_behind = self.is_front == (material.ior >= 1.0);
                let behind = refracted.map_or(0.0, |out| -out.dot(self.normal));
                let reflected = fresnel(material.ior, if is_denser_behind { cosine } else { behind });
                constant([0.0, 1.0, reflected, 1.0 - reflected])
            }
        };
        if refracted.is_none() {
            weights.reflected += weights.refracted;
            weights.refracted = 0.0;
        }
        weights
    }
}

/// The tint of what a surface reflects.
fn reflection_tint(material: &Material) -> DVec3 {
    match material.kind {
        MaterialKind::Metal | MaterialKind::Mirror => material.colour,
        MaterialKind::Dielectric => DVec3::ONE,
        MaterialKind::Lambert => material.specular.map_or(DVec3::ONE, |specular| specular.colour),
    }
}

/// The tint of what passes through a surface.
fn transmission_tint(material: &Material) -> DVec3 {
    if material.kind == MaterialKind::Dielectric { material.colour } else { DVec3::ONE }
}

/// What arrives of a light over the way `towards` it, without what is in between.
fn arriving(light: &Light, towards: DVec3) -> DVec3 {
    match (light.kind, light.falloff) {
        (LightKind::Point(_), Falloff::InverseSquare { reach }) => {
            let distance = (towards.length() / reach).max(NEAREST);
            light.radiance / (distance * distance)
        }
        _ => light.radiance,
    }
}

/// How much of a light at the unit direction `l` is mirrored towards the viewer.
fn lobe(specular: &Specular, surface: &Surface<'_>, l: DVec3) -> f64 {
    let v = -surface.direction;
    let cosine = match specular.lobe {
        Lobe::BlinnPhong => (l + v).try_normalize().map_or(0.0, |half| half.dot(surface.normal)),
        Lobe::Phong => reflect(-l, surface.normal).dot(v),
    };
    libm::pow(cosine.max(0.0), specular.exponent.into())
}
