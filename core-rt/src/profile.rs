//! Profiles: what is compiled in.
//!
//! A profile is a type, and what it has is a constant: branches on it fold, and the linker drops what is left behind
//! them. The host uses [`Full`]; a firmware's is derived from the blob that it is built for.

use core::fmt::{Debug, Display, Formatter};
use core::marker::PhantomData;

use serde::{Deserialize, Serialize};

use crate::bvh::{InPlace, Walk};
use crate::kernel::Kernel;

/// One thing that a scene may need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Need {
    /// Point lights.
    PointLight = 1,
    /// Directional lights.
    DirectionalLight = 1 << 1,
    /// Shadow rays.
    Shadows = 1 << 2,
    /// Normals at vertices.
    SmoothNormals = 1 << 3,
    /// Surfaces that add light of their own.
    Emission = 1 << 4,
    /// Light that reaches everything.
    Ambient = 1 << 5,
    /// The sRGB transfer function.
    Srgb = 1 << 6,
    /// Pixels in proportion to light.
    Linear = 1 << 7,
    /// More than 2^16 triangles in the file.
    WideIds = 1 << 8,
    /// More than 2^16 - 1 normals.
    WideNormals = 1 << 9,
    /// Highlights after Blinn.
    BlinnPhong = 1 << 10,
    /// Highlights after Phong.
    Phong = 1 << 11,
    /// Mirror images.
    Reflection = 1 << 12,
    /// Light that passes a surface.
    Refraction = 1 << 13,
    /// Spheres.
    Spheres = 1 << 14,
    /// Lights that fade with distance.
    Falloff = 1 << 15,
    /// A background that depends on the direction.
    Sky = 1 << 16,
    /// Cubes of a second albedo.
    Checker = 1 << 17,
    /// Shadows that glass colours.
    TintedShadow = 1 << 18,
    /// Camera rays in parallel.
    Orthographic = 1 << 19,
    /// Several camera rays a pixel.
    Supersampling = 1 << 20,
    /// Albedos at vertices.
    VertexColours = 1 << 21,
    /// Pictures on surfaces.
    Texture = 1 << 22,
    /// Pictures on surfaces, smooth between texels.
    Bilinear = 1 << 23,
    /// More than 2^16 - 1 texture coordinates or colours of vertices.
    WideUvs = 1 << 24,
    /// Pixels of three bytes.
    Rgb888 = 1 << 25,
    /// Pixels of 16 bits, dithered.
    Rgb565 = 1 << 26,
    /// Pixels of one byte.
    Gray8 = 1 << 27,
    /// Reflections that grow towards grazing angles.
    Schlick = 1 << 28,
    /// Triangles with a record each.
    WholeTriangles = 1 << 29,
    /// More than one light.
    SeveralLights = 1 << 30,
    /// Triangles that share vertices.
    SharedVertices = 1 << 31,
    /// Rays that go on from surfaces and are followed. Without it, those see the background.
    Bounces = 1 << 32,
    /// Ids apart from what they are of.
    Ids = 1 << 33,
    /// Ids beside the materials of records.
    IdsInRecords = 1 << 34,
    /// Rays that go on from surfaces one at a time, at random, from matt ones too.
    Paths = 1 << 35,
    /// Blurred mirror images.
    Roughness = 1 << 36,
}

impl Need {
    /// All of them.
    pub const ALL: [Self; 37] = [
        Self::PointLight,
        Self::DirectionalLight,
        Self::Shadows,
        Self::SmoothNormals,
        Self::Emission,
        Self::Ambient,
        Self::Srgb,
        Self::Linear,
        Self::WideIds,
        Self::WideNormals,
        Self::BlinnPhong,
        Self::Phong,
        Self::Reflection,
        Self::Refraction,
        Self::Spheres,
        Self::Falloff,
        Self::Sky,
        Self::Checker,
        Self::TintedShadow,
        Self::Orthographic,
        Self::Supersampling,
        Self::VertexColours,
        Self::Texture,
        Self::Bilinear,
        Self::WideUvs,
        Self::Rgb888,
        Self::Rgb565,
        Self::Gray8,
        Self::Schlick,
        Self::WholeTriangles,
        Self::SeveralLights,
        Self::SharedVertices,
        Self::Bounces,
        Self::Ids,
        Self::IdsInRecords,
        Self::Paths,
        Self::Roughness,
    ];

    /// Its bit in a header: 0 to 63.
    #[must_use]
    pub const fn bit(self) -> u32 {
        (self as u64).trailing_zeros()
    }
}

impl Display for Need {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::PointLight => "point lights",
            Self::DirectionalLight => "directional lights",
            Self::Shadows => "shadows",
            Self::SmoothNormals => "smooth normals",
            Self::Emission => "emission",
            Self::Ambient => "ambient light",
            Self::Srgb => "sRGB output",
            Self::Linear => "linear output",
            Self::WideIds => "wide triangle ids",
            Self::WideNormals => "wide normal indices",
            Self::BlinnPhong => "Blinn-Phong highlights",
            Self::Phong => "Phong highlights",
            Self::Reflection => "reflection",
            Self::Refraction => "refraction",
            Self::Spheres => "spheres",
            Self::Falloff => "lights that fade",
            Self::Sky => "a sky",
            Self::Checker => "checkers",
            Self::TintedShadow => "tinted shadows",
            Self::Orthographic => "parallel camera rays",
            Self::Supersampling => "several samples a pixel",
            Self::VertexColours => "vertex colours",
            Self::Texture => "textures",
            Self::Bilinear => "smooth textures",
            Self::WideUvs => "wide texture coordinates",
            Self::Rgb888 => "RGB888 output",
            Self::Rgb565 => "RGB565 output",
            Self::Gray8 => "gray output",
            Self::Schlick => "reflections after Schlick",
            Self::WholeTriangles => "triangles with records",
            Self::SharedVertices => "shared vertices",
            Self::SeveralLights => "several lights",
            Self::Bounces => "rays that go on",
            Self::Ids => "ids of their own",
            Self::IdsInRecords => "ids in records",
            Self::Paths => "paths",
            Self::Roughness => "rough mirrors",
        })
    }
}

/// A set of needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Needs(u64);

impl Needs {
    /// None.
    pub const NONE: Self = Self(0);
    /// All.
    pub const ALL: Self = {
        let (mut all, mut place) = (Self::NONE, 0);
        while place < Need::ALL.len() {
            all = all.with(Need::ALL[place], true);
            place += 1;
        }
        all
    };

    /// From the bits of a header.
    #[must_use]
    pub const fn from_bits(bits: u64) -> Self {
        Self(bits)
    }

    /// As a header has them.
    #[must_use]
    pub const fn bits(self) -> u64 {
        self.0
    }

    /// Whether a need is in the set.
    #[must_use]
    pub const fn has(self, need: Need) -> bool {
        self.0 & need as u64 != 0
    }

    /// Whether every need in the set is one of [`Need::ALL`].
    #[must_use]
    pub const fn is_known(self) -> bool {
        self.0 & !Self::ALL.0 == 0
    }

    /// The set with a need added, if `wanted`.
    #[must_use]
    pub const fn with(self, need: Need, wanted: bool) -> Self {
        if wanted { Self(self.0 | need as u64) } else { self }
    }

    /// The set without a need.
    #[must_use]
    pub const fn without(self, need: Need) -> Self {
        Self(self.0 & !(need as u64))
    }

    /// The first need that `self` has and `other` lacks.
    #[must_use]
    #[inline(never)]
    pub fn first_missing_in(self, other: Self) -> Option<Need> {
        Need::ALL.iter().copied().find(|&need| self.has(need) && !other.has(need))
    }

    /// Whether surfaces have highlights.
    #[must_use]
    pub const fn highlights(self) -> bool {
        self.has(Need::BlinnPhong) || self.has(Need::Phong)
    }

    /// Whether rays go on from surfaces.
    #[must_use]
    pub const fn branches(self) -> bool {
        self.has(Need::Reflection) || self.has(Need::Refraction)
    }

    /// Whether surfaces may be more than matt.
    #[must_use]
    pub const fn lustres(self) -> bool {
        self.highlights() || self.branches() || self.has(Need::TintedShadow)
    }

    /// Whether anything is between the corners of triangles.
    #[must_use]
    pub const fn weights(self) -> bool {
        self.has(Need::SmoothNormals) || self.paint()
    }

    /// Whether surfaces are painted.
    #[must_use]
    pub const fn paint(self) -> bool {
        self.has(Need::Texture) || self.has(Need::VertexColours)
    }

    /// The needs of the set.
    pub fn iter(self) -> impl Iterator<Item = Need> {
        Need::ALL.into_iter().filter(move |&need| self.has(need))
    }
}

/// What gives way where flash and time compete. The picture is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Prefer {
    /// Flash: what is done often is in several copies, and what can be looked up is.
    #[default]
    Speed,
    /// Time: everything is there once.
    Size,
}

/// What is compiled in.
pub trait Profile: Copy + Debug + Default + Send + Sync + 'static {
    /// The arithmetic.
    type Kernel: Kernel;
    /// How rays find what they hit.
    type Walk<'a>: Walk<Self>;
    /// Everything that a scene under this profile may need.
    const NEEDS: Needs;
    /// What it is compiled for.
    const PREFER: Prefer = Prefer::Speed;
}

/// Everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Full<K>(PhantomData<K>);

impl<K: Kernel> Profile for Full<K> {
    type Kernel = K;
    type Walk<'a> = InPlace;
    const NEEDS: Needs = Needs::ALL;
}
