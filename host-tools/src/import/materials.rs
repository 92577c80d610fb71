//! The materials of a scene: the names that its faces use, what MTL says of them, and what the
//! scene file changes.

use glam::DVec3;

use super::document::Document;
use super::error::{ImportError, Warning, excerpt, list};
use super::mtl::{self, DEFAULT_DIFFUSE};
use super::obj::Mesh;
use super::scan::Named;
use super::schema::{CheckerToml, MaterialKindToml, MaterialToml};
use super::source::Source;
use crate::model::Material;

/// What the material of faces without a `usemtl` is called.
const UNNAMED: &str = "default";

impl Document {
    /// One material for each of `mesh.materials`. `obj` is the name of the OBJ.
    pub(super) fn materials(
        &self,
        source: &dyn Source,
        obj: &str,
        mesh: &Mesh,
        warnings: &mut Vec<Warning>,
    ) -> Result<Vec<Material>, ImportError> {
        let library = mtl::read(source, obj, &mesh.libraries, warnings);
        let mut materials = Vec::new();
        let mut undefined: Vec<&Named> = Vec::new();
        let mut simplified: Vec<&str> = Vec::new();
        for named in &mesh.materials {
            let change = self.scene.material.get(shown(named));
            let entry = library.get(&named.name).copied();
            if entry.is_none() && change.is_none() && !named.name.is_empty() {
                undefined.push(named);
            }
            let entry = entry.unwrap_or_default();
            if !entry.plain {
                simplified.push(&named.name);
            }
            let colour = change.and_then(|change| change.colour.as_ref());
            let diffuse = self.colour("colour", 1.0, colour, entry.diffuse)?;
            let emission: DVec3 = entry.emission;
            materials.push(Material { name: shown(named).into(), diffuse, emission });
        }
        let file = source.describe(obj);
        if let Some(first) = undefined.first() {
            let names: Vec<&str> = undefined.iter().map(|named| named.name.as_str()).collect();
            let message =
                format!("materials that no MTL file defines, drawn in grey (Kd {DEFAULT_DIFFUSE}): {}", list(&names));
            warnings.push(Warning::line(&file, first.line, message));
        }
        if !simplified.is_empty() {
            let message = format!(
                "materials with transparency (d, Tr) or a texture (map_Kd), drawn as opaque \
                 Lambert: {}",
                list(&simplified)
            );
            warnings.push(Warning::file(&file, message));
        }
        self.check_changes(mesh, warnings)?;
        Ok(materials)
    }

    /// Checks every `[material.NAME]`, and warns of what will not be seen of it.
    fn check_changes(&self, mesh: &Mesh, warnings: &mut Vec<Warning>) -> Result<(), ImportError> {
        for (key, change) in &self.scene.material {
            let name = key.get_ref();
            self.colour("colour", 1.0, change.colour.as_ref(), DVec3::ZERO)?;
            if let Some(checker) = &change.checker {
                let CheckerToml { size, other } = checker.get_ref();
                if size.0 <= 0.0 {
                    let message = format!("checker size of {}; it must be above 0", size.0);
                    return Err(self.error(checker.span(), message));
                }
                self.colour("other", 1.0, Some(other), DVec3::ZERO)?;
            }
            let line = self.line(key.span());
            let mut warn = |message| warnings.push(Warning::line(&self.file, line, message));
            let used = mesh.materials.iter().map(shown);
            if !used.clone().any(|used| used == name) {
                let nearest = used.min_by_key(|used| strsim::damerau_levenshtein(name, used));
                let nearest = excerpt(nearest.unwrap_or(UNNAMED));
                let name = excerpt(name);
                warn(format!("no face has material `{name}`; the nearest name is `{nearest}`"));
            }
            let extras = extras(change);
            if !extras.is_empty() {
                let (name, extras) = (excerpt(name), extras.join(", "));
                warn(format!("material `{name}` is drawn as Lambert; not supported yet: {extras}"));
            }
        }
        Ok(())
    }
}

/// The name of a material in messages and in scene files.
fn shown(named: &Named) -> &str {
    if named.name.is_empty() { UNNAMED } else { &named.name }
}

/// The keys of a material that a Lambert surface has no use for.
fn extras(material: &MaterialToml) -> Vec<&'static str> {
    let keys = [
        ("kind", material.kind != MaterialKindToml::Lambert),
        ("ior", material.ior.is_some()),
        ("specular", material.specular.is_some()),
        ("exponent", material.exponent.is_some()),
        ("weights", material.weights.is_some()),
        ("checker", material.checker.is_some()),
        ("tinted_shadow", material.tinted_shadow == Some(true)),
    ];
    keys.into_iter().filter(|&(_, given)| given).map(|(key, _)| key).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::testing::{ROOM, refused, room, warnings};
    use crate::import::{Embedded, load_from};

    #[test]
    fn what_is_drawn_in_a_simpler_way_is_said() {
        let lines = "[material.wall]\nkind = 'dielectric'\nior = 1.5\n\
                     weights = [0, 0.5, 0.1, 0.8]\n[material.wal]\n";
        let imported = room(lines).unwrap();
        let expected = [
            "built-in s.toml:6: no face has material `wal`; the nearest name is `wall`",
            "built-in s.toml:2: material `wall` is drawn as Lambert; not supported yet: kind, ior, \
             weights",
        ];
        assert_eq!(warnings(&imported), expected);
        assert_eq!(imported.model.materials[0].diffuse, DVec3::splat(0.8));
    }

    #[test]
    fn undefined_and_unplain_materials_are_said_once() {
        let more: &[u8] = b"usemtl glass\nf 1 2 3\nusemtl wood\nf 1 2 3\nusemtl none\nf 1 2 3\n\
                            usemtl wall\nf 1 2 3\n";
        let obj = [b"mtllib m.mtl\n", ROOM, more].concat();
        let mtl = b"newmtl glass\nd 0.1\nnewmtl wood\nmap_Kd w.png\nnewmtl unused\nTr 1\n";
        let files: [(&str, &[u8]); 2] = [("x.obj", &obj), ("m.mtl", mtl)];
        let imported = load_from(&Embedded(&files), "x.obj").unwrap();
        let expected = [
            "built-in x.obj:5: materials that no MTL file defines, drawn in grey (Kd 0.8): \
             `wall`, `none`",
            "built-in x.obj: materials with transparency (d, Tr) or a texture (map_Kd), drawn as \
             opaque Lambert: `glass`, `wood`",
        ];
        assert_eq!(warnings(&imported), expected);
        let materials = imported.model.materials;
        let names: Vec<&str> = materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["wall", "glass", "wood", "none"]);
    }

    #[test]
    fn a_material_that_the_scene_file_colours_needs_no_mtl() {
        let imported = room("[material.wall]\ncolour = [1, 0, 0]").unwrap();
        assert_eq!(warnings(&imported), Vec::<String>::new());
        assert_eq!(imported.model.materials[0].diffuse, DVec3::X);
    }

    #[test]
    fn faces_without_a_material_are_called_default() {
        let obj: &[u8] = b"v 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n";
        let toml: &[u8] = b"model = 'x.obj'\n[material.default]\ncolour = [0, 0, 1]\n";
        let files = [("x.obj", obj), ("s.toml", toml)];
        let imported = load_from(&Embedded(&files), "s.toml").unwrap();
        assert_eq!(warnings(&imported), Vec::<String>::new());
        assert_eq!(imported.model.materials[0].name, "default");
        assert_eq!(imported.model.materials[0].diffuse, DVec3::Z);
    }

    #[test]
    fn colours_that_no_surface_has_are_refused() {
        refused(&[
            (
                "[material.wall]\ncolour = [0, 1.5, 0]",
                "3: colour [0, 1.5, 0] is out of range; each channel is from 0 to 1.0",
            ),
            (
                "[material.other]\ncolour = [0, -1, 0]",
                "3: colour [0, -1, 0] is out of range; each channel is from 0 to 1.0",
            ),
            ("[material.wall]\nchecker = { size = 0, other = [0, 0, 0] }", "3: checker size of 0; it must be above 0"),
        ]);
    }
}
