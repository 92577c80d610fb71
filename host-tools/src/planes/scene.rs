//! A model in the tracer's words.

use core_rt::samples::MAX_SAMPLES;
use glam::DVec3;
use planes_rt::camera::{Camera, FRACTION_BITS, Linear};
use planes_rt::colour::{LIGHT_MAX, SHARE_ONE, Surface};
use planes_rt::scene::{Outline, Scene, SceneError, Settings, Sphere};
use planes_rt::widths::Widths;

use crate::grid::Grid;
use crate::model::{Background, LightKind, Material, MaterialKind, Model, Projection};
use crate::plane::Plane;

/// How long the longest direction of a picture is: integers "on the order of 500".
pub const DIRECTION_LENGTH: u16 = 511;

/// What is asked for beside the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The words.
    pub widths: Widths,
    /// Where a pixel ends.
    pub outline: Outline,
    /// The length of the longest direction of a picture, components' units.
    pub direction: u16,
}

impl Default for Options {
    fn default() -> Self {
        Self { widths: Widths::PIXEL_PLANES, outline: Outline::default(), direction: DIRECTION_LENGTH }
    }
}

/// Why a model has no place in the tracer's words.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanesError {
    /// There are triangles.
    #[error(
        "planes12 traces spheres alone, and the scene has {0} triangles; use --kernel exact29, or exact14 for a chip"
    )]
    Triangles(usize),
    /// There are no spheres.
    #[error("planes12 traces spheres, and the scene has none")]
    Empty,
    /// A material lets light through.
    #[error("planes12 reflects and does not refract, and `{0}` does; use --kernel exact29")]
    Refracts(String),
    /// Directions are shorter than can be told apart, or longer than their words.
    #[error("directions of length {length}; there are lengths of 1 to {most} in components of {bits} bits")]
    Direction {
        /// That was asked for.
        length: u16,
        /// The longest.
        most: i32,
        /// Of a component.
        bits: u32,
    },
    /// What the tracer itself refuses.
    #[error("planes12: {0}")]
    Scene(#[from] SceneError),
}

/// A scene of integers, and how it lies in the model's space.
#[derive(Clone, Debug)]
pub struct Planes {
    spheres: Vec<Sphere>,
    light: [i16; 3],
    background: [u16; 3],
    camera: Camera,
    settings: Settings,
    /// Components' units a scene unit.
    pub scale: f64,
    /// What components of zero stand for.
    middle: DVec3,
    /// What of the model is shown plainer than it is.
    pub warnings: Vec<String>,
}

impl Planes {
    /// A model in words.
    ///
    /// Everything that rays begin or end at lies in a ball of half the largest component, so that the difference of two places
    /// is held. With the widths of the text, sums of their products are too, for directions of the largest component.
    ///
    /// # Errors
    /// Where it has what the tracer does not know, or lies beyond its words.
    pub fn new(model: &Model, options: &Options) -> Result<Self, PlanesError> {
        let most = options.widths.coordinate_max();
        if !model.triangles.is_empty() {
            return Err(PlanesError::Triangles(model.triangles.len()));
        }
        if !(1..=most).contains(&i32::from(options.direction)) {
            let (length, bits) = (options.direction, options.widths.coordinate());
            return Err(PlanesError::Direction { length, most, bits });
        }
        let mut warnings = Vec::new();
        let place = Place::of(model, most)?;
        let (light, radiance) = light(model, &place, most, &mut warnings);
        let spheres = model.spheres.iter().map(|sphere| {
            let surface = surface(&model.materials[sphere.material as usize], model, radiance)?;
            let radius = (sphere.radius * place.scale).round().max(1.0) as i16;
            Ok(Sphere { centre: place.components(sphere.centre), radius, surface })
        });
        let spheres = spheres.collect::<Result<Vec<_>, PlanesError>>()?;
        let longest = spheres.iter().map(|sphere| u64::from(sphere.radius.unsigned_abs())).max().unwrap_or(0);
        if (longest * u64::from(options.direction)).pow(2) > options.widths.determinant_max() as u64 {
            warnings.push(format!(
                "a sphere of radius {longest} and directions of length {}: their product squared exceeds a determinant of {} \
                 bits, which saturates",
                options.direction,
                options.widths.determinant()
            ));
        }
        let settings = Settings {
            widths: options.widths,
            size: model.render.size.map(|side| side.min(u16::MAX.into()) as u16),
            generations: model.render.max_depth.saturating_add(1).min(u16::MAX.into()) as u16,
            outline: options.outline,
            samples: model.render.samples.clamp(1, MAX_SAMPLES.into()) as u16,
            paths: model.render.paths,
        };
        if model.render.paths && sends_more_than_white(model) {
            warnings.push("planes12 has no light beyond white, and the scene has; paths gather white there".into());
        }
        let planes = Self {
            spheres,
            light,
            background: background(model, &mut warnings),
            camera: camera(model, &place, options.direction),
            settings,
            scale: place.scale,
            middle: place.middle,
            warnings,
        };
        planes.scene()?;
        Ok(planes)
    }

    /// How its components lie in the model's space.
    #[must_use]
    pub fn place(&self) -> Grid {
        Grid { origin: self.middle, scale: self.scale }
    }

    /// What is traced.
    ///
    /// # Errors
    /// None, once it was made.
    pub fn scene(&self) -> Result<Scene<'_>, SceneError> {
        Scene::new_checked(&self.spheres, self.light, self.background, self.camera, self.settings)
    }
}

/// How a model lies among the integers.
struct Place {
    middle: DVec3,
    scale: f64,
}

impl Place {
    /// A ball around all spheres and all origins of rays, of half the largest component.
    fn of(model: &Model, most: i32) -> Result<Self, PlanesError> {
        if model.spheres.is_empty() {
            return Err(PlanesError::Empty);
        }
        let origins = Plane::of(model).map_or_else(|| vec![model.camera.position], |plane| plane.corners().to_vec());
        let spheres = model.spheres.iter().map(|sphere| (sphere.centre, sphere.radius));
        let all: Vec<(DVec3, f64)> = spheres.chain(origins.into_iter().map(|origin| (origin, 0.0))).collect();
        let low = all.iter().map(|(point, radius)| *point - *radius).fold(DVec3::INFINITY, DVec3::min);
        let high = all.iter().map(|(point, radius)| *point + *radius).fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = (low + high) / 2.0;
        let reach = all.iter().map(|(point, radius)| (*point - middle).length() + radius).fold(0.0, f64::max);
        // A unit less for what is rounded.
        Ok(Self { middle, scale: (f64::from(most / 2) - 1.0).max(1.0) / reach })
    }

    fn components(&self, point: DVec3) -> [i16; 3] {
        ((point - self.middle) * self.scale).round().to_array().map(|c| c as i16)
    }
}

/// The vector to the light, `most` long, and the light's strength; zero where there is none.
fn light(model: &Model, place: &Place, most: i32, warnings: &mut Vec<String>) -> ([i16; 3], DVec3) {
    let Some(light) = model.lights.first() else { return ([0; 3], DVec3::ZERO) };
    if model.lights.len() > 1 {
        warnings.push(format!("planes12 has one light, and the scene {}; the first is shown", model.lights.len()));
    }
    let towards = match light.kind {
        LightKind::Directional(travel) => -travel,
        LightKind::Point(position) => {
            warnings.push("planes12 has parallel light; that of a point comes as it does to the scene's middle".into());
            position - place.middle
        }
    };
    // Towards zero, so that rounding lengthens nothing.
    let vector = towards.normalize_or_zero() * f64::from(most);
    (vector.to_array().map(|c| c as i16), light.radiance)
}

/// A material under the light.
fn surface(material: &Material, model: &Model, radiance: DVec3) -> Result<Surface, PlanesError> {
    let [diffuse, _, reflected, refracted] = material.weights.unwrap_or(match material.kind {
        MaterialKind::Lambert => [1.0, 1.0, 0.0, 0.0],
        MaterialKind::Metal | MaterialKind::Mirror => [0.0, 1.0, 1.0, 0.0],
        MaterialKind::Dielectric => [0.0, 0.0, 0.0, 1.0],
    });
    if refracted > 0.0 {
        return Err(PlanesError::Refracts(material.name.clone()));
    }
    let tint = match material.kind {
        MaterialKind::Metal | MaterialKind::Mirror => material.colour,
        MaterialKind::Dielectric => DVec3::ONE,
        MaterialKind::Lambert => material.specular.map_or(DVec3::ONE, |specular| specular.colour),
    };
    let albedo = material.colour * diffuse;
    // Paths gather what ambient light stands for.
    let (matt, ambient) = if model.render.paths { (albedo, DVec3::ZERO) } else { (DVec3::ZERO, model.render.ambient) };
    let [roughness, ..] = words(DVec3::splat(if reflected > 0.0 { material.roughness } else { 0.0 }), SHARE_ONE);
    Ok(Surface {
        roughness,
        lit: words(albedo * radiance, LIGHT_MAX),
        own: words(material.emission + albedo * ambient, LIGHT_MAX),
        mirror: words(tint * reflected, SHARE_ONE),
        matt: words(matt, SHARE_ONE),
    })
}

/// Whether what paths would gather does not fit words of light.
fn sends_more_than_white(model: &Model) -> bool {
    let is_more = |colour: DVec3| colour.max_element() > 1.0;
    let seen = match model.background {
        Background::Colour(colour) => colour,
        Background::Sky { bottom, top } => bottom.max(top),
    };
    model.spheres.iter().any(|sphere| is_more(model.materials[sphere.material as usize].emission)) || is_more(seen)
}

/// A colour in words, of which `one` is 1; more than that saturates.
fn words(colour: DVec3, one: u16) -> [u16; 3] {
    colour.to_array().map(|channel| (channel.clamp(0.0, 1.0) * f64::from(one)).round() as u16)
}

fn background(model: &Model, warnings: &mut Vec<String>) -> [u16; 3] {
    let colour = match model.background {
        Background::Colour(colour) => colour,
        Background::Sky { bottom, top } => {
            warnings.push("planes12 has one colour behind the scene; the sky is shown as its mean".into());
            (bottom + top) / 2.0
        }
    };
    words(colour, LIGHT_MAX)
}

/// The camera, with directions up to `length`.
fn camera(model: &Model, place: &Place, length: u16) -> Camera {
    let (length, [width, height]) = (f64::from(length), model.render.size.map(f64::from));
    let view = &model.camera;
    // What is seen at the distance 1, or in the plane that rays start in.
    let (plane, is_parallel) = match view.projection {
        Projection::Perspective { fov_y } => {
            (Plane { middle: view.position, ..Plane::new(model, 2.0 * libm::tan(fov_y / 2.0)) }, false)
        }
        Projection::Orthographic { height } => (Plane::new(model, height), true),
    };
    let pixel = 2.0 * plane.half[1] / height;
    let (right, down) = (plane.right * pixel, -plane.up * pixel);
    let from_middle = -(right * (width - 1.0) + down * (height - 1.0)) / 2.0;
    if is_parallel {
        let first = plane.middle - place.middle + from_middle;
        return Camera {
            origin: linear([first, right, down], place.scale),
            direction: linear([plane.forward, DVec3::ZERO, DVec3::ZERO], length),
        };
    }
    let first = plane.forward + from_middle;
    Camera {
        origin: Linear::constant(place.components(view.position)),
        direction: linear([first, right, down], length / first.length()),
    }
}

fn linear(triples: [DVec3; 3], scale: f64) -> Linear {
    let [first, right, down] =
        triples.map(|triple| (triple * (scale * f64::from(1 << FRACTION_BITS))).round().to_array().map(|c| c as i32));
    Linear { first, right, down }
}
