//! The scene as its author described it: f64, undiscretised, in scene units.
//!
//! Everything downstream starts here: the importers fill a [`Model`], the grid and the BVH read it,
//! and the f64 [`reference`](crate::reference) traces it as it stands. Nothing here knows of kernels.

use glam::DVec3;

/// A scene: geometry, materials, lights and the view of it.
///
/// Triangle indices are in *file order*: after fan triangulation, before degenerates are dropped.
/// That index is the `prim` of every table and every hit.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Vertex positions, scene units, all finite.
    pub positions: Vec<DVec3>,
    /// Unit shading normals, indexed by [`Triangle::normals`]; empty for a flat scene.
    pub normals: Vec<DVec3>,
    /// Triangles in file order.
    pub triangles: Vec<Triangle>,
    /// Materials, at least one.
    pub materials: Vec<Material>,
    /// Lights; a scene without any is lit by `render.ambient` alone.
    pub lights: Vec<Light>,
    /// The view.
    pub camera: Camera,
    /// What a ray that hits nothing sees: linear RGB.
    pub background: DVec3,
    /// Picture settings.
    pub render: RenderSettings,
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

/// A Lambert surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, as in MTL or scene.toml; for messages.
    pub name: String,
    /// Diffuse reflectance, linear RGB in [0, 1] (MTL `Kd`).
    pub diffuse: DVec3,
    /// Emitted radiance, linear RGB, not negative (MTL `Ke`). It adds to the pixel; it lights nothing.
    pub emission: DVec3,
}

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is, or where it shines.
    pub kind: LightKind,
    /// Linear RGB times intensity, not negative. There is no falloff and no 1/pi.
    pub radiance: DVec3,
}

/// What kind of light it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// A point, in scene units.
    Point(DVec3),
    /// Parallel light; the direction in which it travels (towards the scene), not zero, any length.
    Directional(DVec3),
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, scene units.
    pub position: DVec3,
    /// A point in the middle of the picture; differs from `position`.
    pub look_at: DVec3,
    /// Any direction that is not parallel to the view.
    pub up: DVec3,
    /// Vertical field of view, radians, in (0, pi).
    pub fov_y: f64,
}

/// Picture settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Light that reaches everything, linear RGB, not negative.
    pub ambient: DVec3,
    /// How linear light becomes bytes.
    pub transfer: Transfer,
}

/// How linear light in [0, 1] becomes a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// IEC 61966-2-1, rounded to nearest.
    Srgb,
    /// 255 x, rounded to nearest.
    Linear,
}
