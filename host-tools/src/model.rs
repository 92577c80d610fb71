//! The scene as its author described it: f64, undiscretised, in scene units.
//!
//! Everything downstream starts here: the importers fill a [`Model`], the grid and the BVH read it,
//! and the f64 [`reference`](crate::reference) traces it as it stands. Nothing here knows of kernels.
//! What the numbers mean for a picture is `docs/SHADING.md`.

use std::sync::Arc;

use glam::{DVec2, DVec3};

/// A scene: geometry, materials, lights and the view of it.
///
/// Triangle indices are in *file order*: after fan triangulation, before degenerates are dropped.
/// That index is the `prim` of every table and every hit; spheres are numbered after all triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Vertex positions, scene units, all finite.
    pub positions: Vec<DVec3>,
    /// What the albedo of each vertex is multiplied by, linear RGB in [0, 1]: one for each of `positions`, or empty for a
    /// scene without vertex colours.
    pub colours: Vec<DVec3>,
    /// Unit shading normals, indexed by [`Triangle::normals`]; empty for a flat scene.
    pub normals: Vec<DVec3>,
    /// Triangles in file order.
    pub triangles: Vec<Triangle>,
    /// Texture coordinates of the corners, v up: one entry for each of `triangles`, `None` where a corner has none; or
    /// empty for a scene without textures.
    pub uvs: Vec<Option<[DVec2; 3]>>,
    /// Spheres, in the order of the scene file.
    pub spheres: Vec<Sphere>,
    /// Materials, at least one.
    pub materials: Vec<Material>,
    /// Lights; a scene without any is lit by `render.ambient` alone.
    pub lights: Vec<Light>,
    /// The view.
    pub camera: Camera,
    /// What a ray that hits nothing sees.
    pub background: Background,
    /// Picture settings.
    pub render: RenderSettings,
}

/// Nothing but one grey material, dark, looked at from (0, 0, 1).
impl Default for Model {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            colours: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
            uvs: Vec::new(),
            spheres: Vec::new(),
            materials: vec![Material::default()],
            lights: Vec::new(),
            camera: Camera::default(),
            background: Background::default(),
            render: RenderSettings::default(),
        }
    }
}

/// A triangle by its vertices, counter-clockwise seen from its front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Model::positions`].
    pub vertices: [u32; 3],
    /// Indices into [`Model::normals`], or `None` for a flat triangle.
    pub normals: Option<[u32; 3]>,
    /// Index into [`Model::materials`].
    pub material: u32,
}

/// A sphere; its front is its outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre, scene units, finite.
    pub centre: DVec3,
    /// The radius, scene units, above 0.
    pub radius: f64,
    /// Index into [`Model::materials`].
    pub material: u32,
}

/// A surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, as in MTL or scene.toml; for messages.
    pub name: String,
    /// Linear RGB in [0, 1]: the albedo of diffuse light; of a metal or a mirror also the tint of what it reflects, and of
    /// a dielectric the tint of what passes through it.
    pub colour: DVec3,
    /// Emitted radiance, linear RGB, not negative (MTL `Ke`). It adds to the pixel; it lights nothing.
    pub emission: DVec3,
    /// What kind of surface it is.
    pub kind: MaterialKind,
    /// Index of refraction of the inside, above 0; outside is 1. For whatever has a refracted share.
    pub ior: f64,
    /// How it shows lights; `None` for no highlights.
    pub specular: Option<Specular>,
    /// The shares of diffuse, specular, reflected and refracted light, not negative, the last two at most 1 together;
    /// `None` for those that follow from the kind.
    pub weights: Option<[f64; 4]>,
    /// Cubes of a second albedo.
    pub checker: Option<Checker>,
    /// Whether light that it refracts casts a coloured shadow, and not a full one.
    pub tinted_shadow: bool,
    /// How far mirrored rays are strewn about the mirrored direction, in [0, 1]: 0 is a sharp mirror image.
    pub roughness: f64,
    /// What the albedo is multiplied by, where a triangle has texture coordinates.
    pub texture: Option<Arc<Texture>>,
}

/// The reflectance of what has none: a light grey.
pub const DEFAULT_DIFFUSE: f64 = 0.8;

/// A light grey Lambert surface.
impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            colour: DVec3::splat(DEFAULT_DIFFUSE),
            emission: DVec3::ZERO,
            kind: MaterialKind::Lambert,
            ior: 1.0,
            specular: None,
            weights: None,
            checker: None,
            tinted_shadow: false,
            roughness: 0.0,
            texture: None,
        }
    }
}

/// What kind of surface it is: what the shares of light are where [`Material::weights`] does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MaterialKind {
    /// Diffuse light, and highlights if there are any.
    #[default]
    Lambert,
    /// Highlights and reflections, both tinted, towards white at grazing angles.
    Metal,
    /// Reflections and refraction by Schlick's approximation.
    Dielectric,
    /// Reflections alone.
    Mirror,
}

/// Highlights: the mirror images of lights, which have no extent, blurred.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Their shape.
    pub lobe: Lobe,
    /// How narrow they are, from 1; whole, because the device's powers are.
    pub exponent: u32,
    /// Linear RGB in [0, 1] (MTL `Ks`).
    pub colour: DVec3,
}

/// What is raised to the exponent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lobe {
    /// The cosine between the normal and the direction half-way between light and viewer.
    #[default]
    BlinnPhong,
    /// The cosine between the reflected light and the viewer.
    Phong,
}

/// A pattern of cubes, every other one of a different albedo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checker {
    /// The side of a cube, scene units, above 0.
    pub size: f64,
    /// The albedo of the odd cubes, linear RGB in [0, 1].
    pub other: DVec3,
}

/// A picture on a surface, repeated without end. At least one texel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// sRGB bytes, row by row from the top: as many as the size says.
    pub texels: Vec<[u8; 3]>,
}

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is, or where it shines.
    pub kind: LightKind,
    /// Linear RGB times intensity, not negative. There is no 1/pi.
    pub radiance: DVec3,
    /// How it fades with distance. A directional light does not.
    pub falloff: Falloff,
}

impl Light {
    /// A light that is as bright everywhere.
    #[must_use]
    pub const fn new(kind: LightKind, radiance: DVec3) -> Self {
        Self { kind, radiance, falloff: Falloff::None }
    }
}

/// What kind of light it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// A point, in scene units.
    Point(DVec3),
    /// Parallel light; the direction in which it travels (towards the scene), not zero, any length.
    Directional(DVec3),
}

/// How a point light fades with distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Falloff {
    /// Not at all.
    #[default]
    None,
    /// By the square of the distance.
    InverseSquare {
        /// Where the light is as bright as its radiance says: a distance in scene units, above 0.
        reach: f64,
    },
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, scene units; of an orthographic camera, the middle of the plane in which rays start.
    pub position: DVec3,
    /// A point in the middle of the picture; differs from `position`.
    pub look_at: DVec3,
    /// Any direction that is not parallel to the view.
    pub up: DVec3,
    /// How much it sees.
    pub projection: Projection,
}

/// At (0, 0, 1), looking at the origin, 40 degrees high.
impl Default for Camera {
    fn default() -> Self {
        Self {
            position: DVec3::Z,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 40f64.to_radians() },
        }
    }
}

/// How a camera's rays go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// From the eye.
    Perspective {
        /// Vertical field of view, radians, in (0, pi).
        fov_y: f64,
    },
    /// In parallel.
    Orthographic {
        /// What the picture's height is in the scene, scene units, above 0.
        height: f64,
    },
}

/// What a ray that hits nothing sees: linear RGB, not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// The same everywhere.
    Colour(DVec3),
    /// Linear in the y of the ray's direction.
    Sky {
        /// Straight down.
        bottom: DVec3,
        /// Straight up.
        top: DVec3,
    },
}

/// Black.
impl Default for Background {
    fn default() -> Self {
        Self::Colour(DVec3::ZERO)
    }
}

impl From<DVec3> for Background {
    fn from(colour: DVec3) -> Self {
        Self::Colour(colour)
    }
}

/// Picture settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Camera rays a pixel, from 1.
    pub samples: u32,
    /// Whether a camera ray is followed as one path that goes on at random, diffusely too, and not as Whitted's tree.
    pub paths: bool,
    /// How often a ray is reflected or refracted at most.
    pub max_depth: u32,
    /// Light that reaches everything, linear RGB, not negative.
    pub ambient: DVec3,
    /// Whether surfaces are in each other's way of light.
    pub shadows: bool,
    /// How linear light becomes bytes.
    pub transfer: Transfer,
    /// How textures are looked up.
    pub filter: Filter,
    /// How pixels lie in a chip's memory.
    pub format: Format,
}

/// 640x480 with a ray a pixel, 10 reflections, sRGB.
impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            size: [640, 480],
            samples: 1,
            paths: false,
            max_depth: 10,
            ambient: DVec3::ZERO,
            shadows: true,
            transfer: Transfer::Srgb,
            filter: Filter::default(),
            format: Format::default(),
        }
    }
}

/// How linear light in [0, 1] becomes a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// IEC 61966-2-1, rounded to nearest.
    Srgb,
    /// 255 x, rounded to nearest.
    Linear,
}

/// How pixels lie in a chip's memory, and so what colours there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// A byte a channel.
    #[default]
    Rgb888,
    /// Five, six and five bits, dithered.
    Rgb565,
    /// A byte of luminance.
    Gray8,
}

/// How a texture is looked up between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The texel that the point is in.
    Nearest,
    /// The four nearest, by distance, in linear light.
    #[default]
    Bilinear,
}
