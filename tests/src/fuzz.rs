//! What the fuzz targets run, and what holds for every input: no panic, and either a sound model or
//! an error that says something on one line; of a blob, an error or a picture.
//!
//! The targets themselves (`fuzz/`) need nightly; `tests/fuzz_corpus.rs` runs the same functions
//! over their corpora on stable.

use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::kernel::Kernel;
use core_rt::profile::Full;
use core_rt::scene::Scene;
use glam::DVec3;
use host_tools::import::{Embedded, ImportError, Imported, load_from};
use host_tools::model::{Model, Projection};
use host_tools::prepare::Blob;

use crate::blobs::{Draft, corners, repaired};

/// Imports bytes as an OBJ, which is also its own material library under the name `m.mtl`.
///
/// # Panics
/// If the importer panics, returns an unsound model, or an error that is no message.
pub fn obj(data: &[u8]) {
    check(load_from(&Embedded(&[("x.obj", data), ("m.mtl", data)]), "x.obj"));
}

/// Imports bytes as a scene.toml beside a `room.obj` of one triangle.
///
/// # Panics
/// As [`obj`].
pub fn scene_toml(data: &[u8]) {
    const ROOM: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wall\nf 1 2 3\n";
    check(load_from(&Embedded(&[("x.toml", data), ("room.obj", ROOM)]), "x.toml"));
}

/// Checks bytes as a blob of every kernel: as they are, and with what a fuzzer cannot guess put right: the prefix, the
/// checksum, and what a triangle's record has that follows from its vertices. What is accepted is rendered.
///
/// # Panics
/// If the check or the renderer does, or the renderer looks at a node twice.
pub fn blob(data: &[u8]) {
    blob_of::<Exact14>(data);
    blob_of::<Exact20>(data);
    blob_of::<Exact29>(data);
}

fn blob_of<K: Kernel>(data: &[u8]) {
    render_if_accepted::<K>(&Blob::from_bytes(data));
    let signed = repaired(data, K::ID);
    render_if_accepted::<K>(&signed);
    if let Some(mut draft) = Draft::<K>::read(signed.bytes()) {
        let made = |triangle: &K::Triangle| draft.triangle(&K::vertices(triangle), K::material(triangle));
        draft.triangles = draft.triangles.iter().map(|triangle| made(triangle).unwrap_or(*triangle)).collect();
        let made = |sphere: &K::Sphere| K::sphere(&K::ball(sphere), K::sphere_material(sphere));
        draft.spheres = draft.spheres.iter().map(|sphere| made(sphere).unwrap_or(*sphere)).collect();
        render_if_accepted::<K>(&draft.write());
    }
}

fn render_if_accepted<K: Kernel>(blob: &Blob) {
    if let Ok(scene) = Scene::<Full<K>>::new_checked(blob.bytes()) {
        corners(&scene);
    }
}

fn check(result: Result<Imported, ImportError>) {
    let messages = match &result {
        Ok(imported) => imported.warnings.iter().map(ToString::to_string).collect(),
        Err(error) => vec![error.to_string()],
    };
    for message in messages {
        let printable = message.starts_with("built-in ") && !message.contains(char::is_control);
        assert!(printable, "not a message: {message:?}");
    }
    if let Ok(imported) = result
        && let Err(fault) = sound(&imported.model)
    {
        panic!("{fault}: {:?}", imported.model);
    }
}

/// Checks what [`Model`] promises to those who read one.
///
/// # Errors
/// Names what is wrong.
pub fn sound(model: &Model) -> Result<(), &'static str> {
    let rule = |holds: bool, fault| if holds { Ok(()) } else { Err(fault) };
    let below = |indices: [u32; 3], count: usize| indices.iter().all(|&i| (i as usize) < count);
    rule(model.positions.iter().all(|p| p.is_finite()), "a position is not finite")?;
    rule(model.normals.iter().all(|n| n.is_normalized()), "a normal is not of unit length")?;
    rule(!model.triangles.is_empty() || !model.spheres.is_empty(), "there are no triangles")?;
    let of_each = |count: usize, all: usize| count == 0 || count == all;
    rule(of_each(model.colours.len(), model.positions.len()), "colours are not of vertices")?;
    rule(of_each(model.uvs.len(), model.triangles.len()), "texture coordinates are not of triangles")?;
    for sphere in &model.spheres {
        rule(sphere.centre.is_finite() && sphere.radius > 0.0, "a sphere is none")?;
        rule((sphere.material as usize) < model.materials.len(), "a material is out of range")?;
    }
    for triangle in &model.triangles {
        rule(below(triangle.vertices, model.positions.len()), "a vertex is out of range")?;
        let normals = triangle.normals.is_none_or(|n| below(n, model.normals.len()));
        rule(normals, "a normal is out of range")?;
        let material = (triangle.material as usize) < model.materials.len();
        rule(material, "a material is out of range")?;
    }
    for material in &model.materials {
        let is_tint = |colour: DVec3| colour.min_element() >= 0.0 && colour.max_element() <= 1.0;
        let others = [material.checker.map(|checker| checker.other), material.specular.map(|specular| specular.colour)];
        let reflects = is_tint(material.colour) && others.into_iter().flatten().all(is_tint);
        rule(reflects, "a reflectance is not in [0, 1]")?;
        rule(material.checker.is_none_or(|checker| checker.size > 0.0), "a checker has no size")?;
        rule(material.ior.is_finite() && material.ior > 0.0, "an index of refraction is not above 0")?;
        rule(material.specular.is_none_or(|specular| specular.exponent > 0), "an exponent is 0")?;
        let shares = material.weights.unwrap_or_default();
        let adds_up = shares.iter().all(|&share| share >= 0.0) && shares[2] + shares[3] <= 1.0;
        rule(adds_up, "the weights make light")?;
        let emits = material.emission.is_finite() && material.emission.min_element() >= 0.0;
        rule(emits, "an emission is not a colour")?;
    }
    rule(!model.lights.is_empty(), "there is no light")?;
    for light in &model.lights {
        let shines = light.radiance.is_finite() && light.radiance.min_element() >= 0.0;
        rule(shines, "a radiance is not a colour")?;
    }
    let camera = &model.camera;
    let view = camera.look_at - camera.position;
    let sees = view.is_finite() && view.abs().max_element() > 0.0;
    rule(sees, "the camera looks nowhere")?;
    let opens = match camera.projection {
        Projection::Perspective { fov_y } => fov_y > 0.0 && fov_y < std::f64::consts::PI,
        Projection::Orthographic { height } => height.is_finite() && height > 0.0,
    };
    rule(opens, "the view has no angle")?;
    rule(camera.up.is_finite() && camera.up.abs().max_element() > 0.0, "there is no up")?;
    rule(model.render.size.iter().all(|side| (1..=16384).contains(side)), "no such picture")
}

#[cfg(test)]
mod tests {
    use host_tools::model::{Checker, Lobe, Specular, Sphere};

    use super::*;

    #[test]
    fn an_unsound_model_is_told_from_a_sound_one() {
        let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
        let good = load_from(&Embedded(&[("x.obj", text)]), "x.obj").unwrap().model;
        assert_eq!(sound(&good), Ok(()));
        let bad = |change: &dyn Fn(&mut Model)| {
            let mut model = good.clone();
            change(&mut model);
            sound(&model).unwrap_err()
        };
        assert_eq!(bad(&|m| m.positions[0].x = f64::NAN), "a position is not finite");
        assert_eq!(bad(&|m| m.normals[0].z = 2.0), "a normal is not of unit length");
        assert_eq!(bad(&|m| m.triangles.clear()), "there are no triangles");
        assert_eq!(bad(&|m| m.triangles[0].vertices[1] = 3), "a vertex is out of range");
        assert_eq!(bad(&|m| m.triangles[0].normals = Some([0, 0, 1])), "a normal is out of range");
        assert_eq!(bad(&|m| m.materials.clear()), "a material is out of range");
        assert_eq!(bad(&|m| m.materials[0].colour.y = 1.1), "a reflectance is not in [0, 1]");
        assert_eq!(bad(&|m| m.materials[0].emission.y = -1.0), "an emission is not a colour");
        assert_eq!(bad(&|m| m.lights.clear()), "there is no light");
        assert_eq!(bad(&|m| m.lights[0].radiance.x = -1.0), "a radiance is not a colour");
        assert_eq!(bad(&|m| m.camera.look_at = m.camera.position), "the camera looks nowhere");
        for projection in [Projection::Perspective { fov_y: 4.0 }, Projection::Orthographic { height: 0.0 }] {
            assert_eq!(bad(&|m| m.camera.projection = projection), "the view has no angle");
        }
        assert_eq!(bad(&|m| m.materials[0].ior = 0.0), "an index of refraction is not above 0");
        assert_eq!(bad(&|m| m.materials[0].weights = Some([0.0, 0.0, 1.0, 0.5])), "the weights make light");
        let specular = Specular { lobe: Lobe::Phong, exponent: 0, colour: DVec3::ONE };
        assert_eq!(bad(&|m| m.materials[0].specular = Some(specular)), "an exponent is 0");
        let checker = Checker { size: 0.0, other: DVec3::ONE };
        assert_eq!(bad(&|m| m.materials[0].checker = Some(checker)), "a checker has no size");
        assert_eq!(bad(&|m| m.colours = vec![DVec3::ONE]), "colours are not of vertices");
        assert_eq!(bad(&|m| m.uvs = vec![None; 2]), "texture coordinates are not of triangles");
        let point = Sphere { centre: DVec3::ZERO, radius: 0.0, material: 0 };
        assert_eq!(bad(&|m| m.spheres.push(point)), "a sphere is none");
        assert_eq!(bad(&|m| m.camera.up = Default::default()), "there is no up");
        assert_eq!(bad(&|m| m.render.size[0] = 0), "no such picture");
    }

    #[test]
    #[should_panic = "a texture"]
    fn a_message_of_two_lines_is_told_from_one() {
        let message = "a texture\ncoordinate".into();
        let (file, line) = ("built-in x.obj".into(), 1);
        check(Err(ImportError::Line { file, line, message }));
    }
}
