//! Why a blob was refused, in the log's words: its texts stay on the host.

use core_rt::blob::BlobError;
use core_rt::profile::Need;

/// A [`BlobError`] that can be logged without `core::fmt`.
pub(crate) struct Refusal<'a>(pub(crate) &'a BlobError);

impl defmt::Format for Refusal<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        match *self.0 {
            BlobError::Truncated { expected, found } => {
                defmt::write!(f, "cut short, {} bytes where {} are expected", found, expected);
            }
            BlobError::Oversized { expected, found } => {
                defmt::write!(f, "too long, {} bytes where {} are expected", found, expected);
            }
            BlobError::Foreign => defmt::write!(f, "there is none"),
            BlobError::Version { found } => defmt::write!(f, "of format version {}", found),
            BlobError::Kernel { found, expected } => defmt::write!(f, "for kernel {}, not {}", found, expected),
            BlobError::Checksum { stated, computed } => {
                defmt::write!(f, "damaged, CRC-32 {=u32:08x} where {=u32:08x} is stated", computed, stated);
            }
            BlobError::Misaligned => defmt::write!(f, "not at a multiple of 8"),
            BlobError::Header => defmt::write!(f, "its header is damaged"),
            BlobError::Sections => defmt::write!(f, "its sections do not fit its size"),
            BlobError::Tree { node } => defmt::write!(f, "its tree is broken at node {}", node),
            BlobError::Depth { stated } => defmt::write!(f, "its tree is deeper than {} levels", stated),
            BlobError::Bounds { node } => defmt::write!(f, "a box does not enclose what is in it, at node {}", node),
            BlobError::Triangle { index } => defmt::write!(f, "triangle record {} is inconsistent", index),
            BlobError::Sphere { index } => defmt::write!(f, "sphere record {} is inconsistent", index),
            BlobError::Origin => defmt::write!(f, "the camera or a light is too far away"),
            BlobError::Shading => defmt::write!(f, "a material, a light or a normal is out of range"),
            BlobError::Undeclared(need) => defmt::write!(f, "it has {}, undeclared", name(need)),
            BlobError::Missing(need) => defmt::write!(f, "it needs {}, which this firmware leaves out", name(need)),
        }
    }
}

fn name(need: Need) -> defmt::Str {
    match need {
        Need::PointLight => defmt::intern!("point lights"),
        Need::DirectionalLight => defmt::intern!("directional lights"),
        Need::Shadows => defmt::intern!("shadows"),
        Need::SmoothNormals => defmt::intern!("smooth normals"),
        Need::Emission => defmt::intern!("emission"),
        Need::Ambient => defmt::intern!("ambient light"),
        Need::Srgb => defmt::intern!("sRGB output"),
        Need::Linear => defmt::intern!("linear output"),
        Need::WideIds => defmt::intern!("wide triangle ids"),
        Need::WideNormals => defmt::intern!("wide normal indices"),
        Need::BlinnPhong => defmt::intern!("Blinn-Phong highlights"),
        Need::Phong => defmt::intern!("Phong highlights"),
        Need::Reflection => defmt::intern!("reflection"),
        Need::Refraction => defmt::intern!("refraction"),
        Need::Spheres => defmt::intern!("spheres"),
        Need::Falloff => defmt::intern!("lights that fade"),
        Need::Sky => defmt::intern!("a sky"),
        Need::Checker => defmt::intern!("checkers"),
        Need::TintedShadow => defmt::intern!("tinted shadows"),
        Need::Orthographic => defmt::intern!("parallel camera rays"),
        Need::Supersampling => defmt::intern!("several samples a pixel"),
        Need::VertexColours => defmt::intern!("vertex colours"),
        Need::Texture => defmt::intern!("textures"),
        Need::Bilinear => defmt::intern!("smooth textures"),
        Need::WideUvs => defmt::intern!("wide texture coordinates"),
        Need::Rgb888 => defmt::intern!("RGB888 output"),
        Need::Rgb565 => defmt::intern!("RGB565 output"),
        Need::Gray8 => defmt::intern!("gray output"),
        Need::Schlick => defmt::intern!("reflections after Schlick"),
        Need::SeveralLights => defmt::intern!("several lights"),
        Need::Bounces => defmt::intern!("rays that go on"),
        Need::WholeTriangles => defmt::intern!("triangles with records"),
        Need::SharedVertices => defmt::intern!("shared vertices"),
        Need::IdsInRecords => defmt::intern!("ids in records"),
        Need::Ids => defmt::intern!("ids of their own"),
        Need::Paths => defmt::intern!("paths"),
        Need::Roughness => defmt::intern!("rough mirrors"),
    }
}
