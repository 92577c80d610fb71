//! What in a blob asks for each of its needs, and how many of its bytes are there for it alone.

use std::collections::BTreeMap;

use core_rt::blob::Header;
use core_rt::kernel::Kernel;
use core_rt::profile::{Full, Need};
use core_rt::record::{Light, Lustre, Material};
use core_rt::scene::Scene;

/// What asks for a need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The need.
    pub need: Need,
    /// How many things ask for it, and what they are: materials, triangles, lights.
    pub count: u64,
    /// See `count`; in the singular. Empty for what the picture as a whole asks for.
    pub what: &'static str,
    /// Where they are materials, the number of each in the blob.
    pub materials: Vec<u32>,
    /// Bytes of the blob that would not be there without it.
    pub bytes: u64,
}

/// What asks for each need of a scene, in the order of their bits.
#[must_use]
pub fn asked<K: Kernel>(scene: &Scene<'_, Full<K>>, header: &Header) -> Vec<Asked> {
    header.needs.iter().map(|need| of(scene, header, need)).collect()
}

fn of<K: Kernel>(scene: &Scene<'_, Full<K>>, header: &Header, need: Need) -> Asked {
    let (shading, paint, counts) = (&scene.shading, &scene.shading.paint, &header.counts);
    let materials = |asks: &dyn Fn(&Material, Option<&Lustre>) -> bool, record: usize| {
        let lustre = |m: &Material| shading.lustres.get(usize::from(m.lustre).wrapping_sub(1));
        let numbers = (0..).zip(shading.materials).filter(|(_, m)| asks(m, lustre(m))).map(|(number, _)| number);
        let materials: Vec<u32> = numbers.collect();
        Asked {
            need,
            count: materials.len() as u64,
            what: "material",
            bytes: (materials.len() * record) as u64,
            materials,
        }
    };
    let shiny = |asks: &dyn Fn(&Lustre) -> bool| materials(&|_, lustre| lustre.is_some_and(asks), size_of::<Lustre>());
    let things =
        |count: u64, what, bytes: usize| Asked { need, count, what, materials: Vec::new(), bytes: bytes as u64 };
    let lights = |asks: &dyn Fn(&Light) -> bool, size: usize| {
        let count = shading.lights.iter().filter(|light| asks(light)).count();
        things(count as u64, "light", count * size)
    };
    let triangles = u64::from(counts.triangles);
    let smooth = || (0..counts.triangles).filter(|&index| !shading.is_flat(index)).count() as u64;
    match need {
        Need::PointLight => lights(&|light| light.kind == Light::POINT, size_of::<Light>()),
        Need::DirectionalLight => lights(&|light| light.kind == Light::DIRECTIONAL, size_of::<Light>()),
        Need::Falloff => lights(&|light| light.reach.mantissa != 0, 0),
        Need::Shadows => lights(&|_| true, 0),
        Need::SeveralLights => things(shading.lights.len() as u64, "light", 0),
        Need::SmoothNormals => {
            things(smooth(), "triangle", shading.normal_indices.size() + size_of_val(shading.normals))
        }
        Need::WideNormals => things(shading.normals.len() as u64, "normal", shading.normal_indices.size() / 2),
        Need::IdsInRecords => things(triangles, "triangle", 0),
        Need::Ids => things(triangles, "triangle", scene.bvh.ids.size()),
        Need::WideIds => things(triangles, "triangle", scene.bvh.ids.size() / 2),
        Need::Emission => materials(&|m, _| !m.emission.is_black(), 0),
        Need::BlinnPhong => shiny(&|l| l.shines() && l.flags & Lustre::PHONG == 0),
        Need::Phong => shiny(&|l| l.shines() && l.flags & Lustre::PHONG != 0),
        Need::Reflection => shiny(&|l| l.reflected != [0; 3]),
        Need::Refraction => shiny(&|l| l.refracted != [0; 3]),
        Need::Bounces => shiny(&|l| l.reflected != [0; 3] || l.refracted != [0; 3]),
        Need::TintedShadow => shiny(&|l| l.shadow != [0; 3]),
        Need::Schlick => shiny(&|l| l.flags & (Lustre::FRESNEL | Lustre::METAL) != 0),
        Need::Roughness => shiny(&|l| l.roughness != 0),
        Need::Checker => materials(&|m, _| m.checker != 0, size_of::<core_rt::record::Checker>()),
        Need::Spheres => things(counts.spheres.into(), "sphere", size_of_val(scene.bvh.spheres)),
        Need::VertexColours => things(triangles, "triangle", paint.colour_indices.size() + size_of_val(paint.colours)),
        Need::Texture => {
            let painted = (0..counts.triangles).filter(|&index| paint.uvs_of(index).is_some()).count();
            let places = paint.uv_indices.size() + size_of_val(paint.uvs);
            things(painted as u64, "triangle", places + size_of_val(paint.textures) + paint.texels.len())
        }
        Need::WideUvs => {
            let indices = paint.uv_indices.size() + paint.colour_indices.size();
            things((paint.uvs.len() + paint.colours.len()) as u64, "place in a texture or colour", indices / 2)
        }
        Need::WholeTriangles | Need::SharedVertices => things(triangles, "triangle", scene.bvh.triangles.bytes()),
        Need::Ambient
        | Need::Srgb
        | Need::Linear
        | Need::Sky
        | Need::Orthographic
        | Need::Supersampling
        | Need::Paths
        | Need::Bilinear
        | Need::Rgb888
        | Need::Rgb565
        | Need::Gray8 => things(0, "", 0),
    }
}

/// The number in the file of a triangle, or a sphere after them, of each material of the blob.
#[must_use]
pub fn bearers<K: Kernel>(scene: &Scene<'_, Full<K>>) -> BTreeMap<u32, u32> {
    let triangles = (0..scene.bvh.triangles.len()).map(|index| scene.bvh.triangles.material(index).unwrap_or_default());
    let spheres = scene.bvh.spheres.iter().map(K::sphere_material);
    (0..).zip(triangles.chain(spheres)).map(|(index, material)| (material, scene.bvh.id(index))).collect()
}
