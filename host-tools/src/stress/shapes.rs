//! Scenes from simple shapes.

use glam::DVec3;

use crate::model::{
    Background, Camera, Light, LightKind, Material, MaterialKind, Model, Projection, RenderSettings, Sphere, Transfer,
    Triangle,
};

/// Width and height of a case's picture: a chip draws it within seconds, by every kernel.
pub const SIZE: [u32; 2] = [64, 48];

/// A vector.
#[must_use]
pub const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A scene that grows.
///
/// Its pixels are in proportion to light: so a bound on light is one on gray levels, the same everywhere.
#[derive(Clone, Debug)]
pub struct Scene {
    /// So far.
    pub model: Model,
}

impl Scene {
    /// Nothing yet, seen from a place 40 degrees high, under a blue sky.
    #[must_use]
    pub fn seen(from: DVec3, look_at: DVec3) -> Self {
        let camera = Camera {
            position: from,
            look_at,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 40f64.to_radians() },
        };
        let render = RenderSettings { size: SIZE, transfer: Transfer::Linear, ..RenderSettings::default() };
        let background = Background::Colour(v(0.125, 0.25, 0.5));
        Self { model: Model { materials: Vec::new(), camera, background, render, ..Model::default() } }
    }

    /// Adds a point light.
    #[must_use]
    pub fn light(mut self, place: DVec3, strength: f64) -> Self {
        self.model.lights.push(Light::new(LightKind::Point(place), DVec3::splat(strength)));
        self
    }

    /// Adds parallel light, by the way that it goes.
    #[must_use]
    pub fn sun(mut self, direction: DVec3, strength: f64) -> Self {
        self.model.lights.push(Light::new(LightKind::Directional(direction), DVec3::splat(strength)));
        self
    }

    /// The material that what is added from now on has.
    #[must_use]
    pub fn of(mut self, material: Material) -> Self {
        self.model.materials.push(material);
        self
    }

    /// A matt colour for what is added from now on.
    #[must_use]
    pub fn matt(self, colour: DVec3) -> Self {
        self.of(Material { colour, ..Material::default() })
    }

    /// A kind of surface for what is added from now on, white.
    #[must_use]
    pub fn kind(self, kind: MaterialKind, ior: f64) -> Self {
        self.of(Material { colour: DVec3::ONE, kind, ior, ..Material::default() })
    }

    /// The number of the material that is added to.
    fn material(&mut self) -> u32 {
        if self.model.materials.is_empty() {
            self.model.materials.push(Material::default());
        }
        self.model.materials.len() as u32 - 1
    }

    /// Adds triangles by numbers of their own points.
    #[must_use]
    pub fn mesh(
        mut self,
        points: impl IntoIterator<Item = DVec3>,
        triangles: impl IntoIterator<Item = [u32; 3]>,
    ) -> Self {
        let material = self.material();
        let first = self.model.positions.len() as u32;
        self.model.positions.extend(points);
        let triangle = |corners: [u32; 3]| Triangle { vertices: corners.map(|c| c + first), normals: None, material };
        self.model.triangles.extend(triangles.into_iter().map(triangle));
        self
    }

    /// Adds a triangle.
    #[must_use]
    pub fn triangle(self, a: DVec3, b: DVec3, c: DVec3) -> Self {
        self.mesh([a, b, c], [[0, 1, 2]])
    }

    /// Adds a parallelogram from a corner and two sides.
    #[must_use]
    pub fn quad(self, corner: DVec3, a: DVec3, b: DVec3) -> Self {
        self.mesh([corner, corner + a, corner + a + b, corner + b], [[0, 1, 2], [0, 2, 3]])
    }

    /// Adds level ground around a point, facing up.
    #[must_use]
    pub fn ground(self, middle: DVec3, half: f64) -> Self {
        self.quad(middle + v(-half, 0.0, half), v(2.0 * half, 0.0, 0.0), v(0.0, 0.0, -2.0 * half))
    }

    /// Adds a box between two corners, facing outwards.
    #[must_use]
    pub fn block(self, low: DVec3, high: DVec3) -> Self {
        let corner = |i: u32| {
            v(
                [low.x, high.x][(i & 1) as usize],
                [low.y, high.y][(i >> 1 & 1) as usize],
                [low.z, high.z][(i >> 2) as usize],
            )
        };
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        self.mesh((0..8).map(corner), faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]))
    }

    /// Adds a sphere.
    #[must_use]
    pub fn sphere(mut self, centre: DVec3, radius: f64) -> Self {
        let material = self.material();
        self.model.spheres.push(Sphere { centre, radius, material });
        self
    }

    /// Adds a sphere of triangles: so many bands, twice as many wedges.
    #[must_use]
    pub fn globe(self, centre: DVec3, radius: f64, bands: u32) -> Self {
        let wedges = 2 * bands;
        let ring = |band: u32| {
            let polar = core::f64::consts::PI * f64::from(band) / f64::from(bands);
            (0..wedges).map(move |wedge| {
                let around = core::f64::consts::TAU * f64::from(wedge) / f64::from(wedges);
                let out = radius * libm::sin(polar);
                centre + v(out * libm::cos(around), radius * libm::cos(polar), -out * libm::sin(around))
            })
        };
        let inner: Vec<DVec3> = (1..bands).flat_map(ring).collect();
        let last = 1 + inner.len() as u32;
        let at = move |band: u32, wedge: u32| match band {
            0 => 0,
            band if band == bands => last,
            band => 1 + (band - 1) * wedges + wedge % wedges,
        };
        let points = [centre + v(0.0, radius, 0.0)].into_iter().chain(inner).chain([centre - v(0.0, radius, 0.0)]);
        let cell = move |(band, wedge): (u32, u32)| {
            let [a, b, c, d] = [at(band, wedge), at(band + 1, wedge), at(band + 1, wedge + 1), at(band, wedge + 1)];
            // A cell at a pole is one triangle: there b and c, or a and d, are one.
            [(band + 1 < bands).then_some([a, b, c]), (band > 0).then_some([a, c, d])].into_iter().flatten()
        };
        let cells = (0..bands).flat_map(move |band| (0..wedges).map(move |wedge| (band, wedge)));
        self.mesh(points, cells.flat_map(cell))
    }

    /// The scene with every length times a factor, and moved then.
    #[must_use]
    pub fn placed(mut self, factor: f64, offset: DVec3) -> Self {
        let to = |p: DVec3| p * factor + offset;
        let model = &mut self.model;
        model.positions.iter_mut().for_each(|p| *p = to(*p));
        for sphere in &mut model.spheres {
            sphere.centre = to(sphere.centre);
            sphere.radius *= factor;
        }
        for light in &mut model.lights {
            if let LightKind::Point(place) = &mut light.kind {
                *place = to(*place);
            }
        }
        model.camera.position = to(model.camera.position);
        model.camera.look_at = to(model.camera.look_at);
        self
    }

    /// It is done.
    #[must_use]
    pub fn done(mut self) -> super::Subject {
        self.material();
        self.model.into()
    }

    /// It is done, with rays of its own.
    #[must_use]
    pub fn with_rays(self, rays: Vec<[DVec3; 2]>) -> super::Subject {
        super::Subject { rays, ..self.done() }
    }
}
