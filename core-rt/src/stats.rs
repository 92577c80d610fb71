//! Counting the work: boxes and primitives tested, rays by kind. A renderer that does not count pays nothing.

/// The kinds of ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera.
    Primary,
    /// From a surface to a light.
    Shadow,
    /// The mirror image in a surface.
    Reflection,
    /// Through a surface.
    Refraction,
}

/// What is told of the work as it is done.
pub trait Stats {
    /// So many box tests.
    #[inline(always)]
    fn boxes(&mut self, count: u32) {
        let _ = count;
    }
    /// A triangle test.
    #[inline(always)]
    fn triangle(&mut self) {}
    /// A sphere test.
    #[inline(always)]
    fn sphere(&mut self) {}
    /// A ray: a mirrored one and one through a surface as it begins to wait, others as they begin.
    #[inline(always)]
    fn ray(&mut self, kind: RayKind) {
        let _ = kind;
    }
    /// The shadow ray that was told of last has been followed to its end.
    #[inline(always)]
    fn lit(&mut self) {}
    /// The surface that a camera ray, a mirrored one or one through a surface sees, by its number in the file;
    /// [`NONE`](crate::kernel::NONE) for the background.
    #[inline(always)]
    fn surface(&mut self, id: impl FnOnce() -> u32) {
        let _ = id;
    }
    /// A light, by its number, reaches that surface.
    #[inline(always)]
    fn light(&mut self, number: u32) {
        let _ = number;
    }
    /// Of the mirrored rays and those through surfaces that were told of, the last that waits is taken up; or none is left.
    #[inline(always)]
    fn next(&mut self) {}
}

/// Counts nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoStats;

impl Stats for NoStats {}

/// Counts everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Ray-box tests.
    pub box_tests: u64,
    /// Ray-triangle tests, and ray-sphere tests with them.
    pub triangle_tests: u64,
    /// Camera rays.
    pub primary_rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Mirrored rays.
    pub reflection_rays: u64,
    /// Rays through surfaces.
    pub refraction_rays: u64,
}

impl Counts {
    /// The sum of two counts.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            box_tests: self.box_tests + other.box_tests,
            triangle_tests: self.triangle_tests + other.triangle_tests,
            primary_rays: self.primary_rays + other.primary_rays,
            shadow_rays: self.shadow_rays + other.shadow_rays,
            reflection_rays: self.reflection_rays + other.reflection_rays,
            refraction_rays: self.refraction_rays + other.refraction_rays,
        }
    }

    /// All rays.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.primary_rays + self.shadow_rays + self.reflection_rays + self.refraction_rays
    }
}

impl Stats for Counts {
    #[inline(always)]
    fn boxes(&mut self, count: u32) {
        self.box_tests += u64::from(count);
    }
    #[inline(always)]
    fn triangle(&mut self) {
        self.triangle_tests += 1;
    }
    #[inline(always)]
    fn sphere(&mut self) {
        self.triangle_tests += 1;
    }
    #[inline(always)]
    fn ray(&mut self, kind: RayKind) {
        match kind {
            RayKind::Primary => self.primary_rays += 1,
            RayKind::Shadow => self.shadow_rays += 1,
            RayKind::Reflection => self.reflection_rays += 1,
            RayKind::Refraction => self.refraction_rays += 1,
        }
    }
}
