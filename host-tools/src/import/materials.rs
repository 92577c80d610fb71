//! The materials of a scene: the names that its faces and spheres use, what MTL says of them, and what the
//! scene file changes.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::document::Document;
use super::error::{ImportError, Warning, excerpt, list};
use super::mtl::{self, Entry};
use super::obj::Mesh;
use super::scan::Named;
use super::source::Source;
use super::texture;
use crate::model::{DEFAULT_DIFFUSE, Material, Texture};

/// What the material of faces and spheres that name none is called.
const UNNAMED: &str = "default";

/// The names of materials that are in use, in the order of their first use: those of faces, then those of spheres alone.
pub(super) struct Names {
    faces: Vec<Named>,
    spheres: Vec<Named>,
}

impl Names {
    /// Those of the faces of `mesh`.
    pub(super) fn of_faces(mesh: &Mesh) -> Self {
        Self { faces: mesh.materials.clone(), spheres: Vec::new() }
    }

    /// The index of a sphere's material, which is named in `line` of the scene file.
    pub(super) fn of_sphere(&mut self, name: &str, line: u64) -> u32 {
        let place = self.all().position(|known| shown(known) == name || known.name == name);
        place.unwrap_or_else(|| {
            self.spheres.push(Named { name: name.into(), line });
            self.faces.len() + self.spheres.len() - 1
        }) as u32
    }

    fn all(&self) -> impl Iterator<Item = &Named> + Clone {
        self.faces.iter().chain(&self.spheres)
    }
}

impl Document {
    /// One material for each of `names`. `obj` is the name of the OBJ, if there is one.
    pub(super) fn materials(
        &self,
        source: &dyn Source,
        obj: Option<&str>,
        mesh: &Mesh,
        names: &Names,
        warnings: &mut Vec<Warning>,
    ) -> Result<Vec<Material>, ImportError> {
        let library = obj.map_or_else(mtl::Library::new, |obj| mtl::read(source, obj, &mesh.libraries, warnings));
        let mut textures = Textures { source, known: HashMap::new(), missing: Vec::new() };
        let mut materials = Vec::new();
        let mut black = Vec::new();
        for named in names.all() {
            let entry = library.get(&named.name);
            let mut material = self.changed(shown(named), entry)?;
            let is_coloured = self.scene.material.get(shown(named)).is_some_and(|change| change.colour.is_some());
            if let Some(name) = entry.and_then(|entry| entry.texture.as_deref()).filter(|_| !is_coloured) {
                material.texture = textures.get(name);
            }
            if material.texture.is_some() && material.colour == DVec3::ZERO {
                black.push(shown(named));
            }
            materials.push(material);
        }
        if !black.is_empty() {
            let message =
                format!("materials with a texture that Kd, which it is multiplied by, makes black: {}", list(&black));
            warnings.push(Warning::file(&obj.map_or_else(String::new, |obj| source.describe(obj)), message));
        }
        let undefined = |named: &&Named| {
            !named.name.is_empty()
                && !library.contains_key(&named.name)
                && !self.scene.material.contains_key(shown(named))
        };
        let file = obj.map_or_else(String::new, |obj| source.describe(obj));
        for (file, named, kind) in [(&file, &names.faces, "MTL file"), (&self.file, &names.spheres, "table")] {
            let undefined: Vec<&Named> = named.iter().filter(undefined).collect();
            if let Some(first) = undefined.first() {
                let names: Vec<&str> = undefined.iter().map(|named| named.name.as_str()).collect();
                let names = list(&names);
                let message =
                    format!("materials that no {kind} defines, drawn in grey (Kd {DEFAULT_DIFFUSE}): {names}");
                warnings.push(Warning::line(file, first.line, message));
            }
        }
        if !textures.missing.is_empty() {
            let shown: Vec<String> =
                textures.missing.iter().take(3).map(|(name, why)| format!("`{name}` ({why})")).collect();
            let more = match textures.missing.len() - shown.len() {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let message = format!("textures that cannot be read, drawn with Kd alone: {}{more}", shown.join(", "));
            warnings.push(Warning::file(&file, message));
        }
        self.check_changes(names, warnings)?;
        Ok(materials)
    }

    /// The material called `name`: what MTL says of it, and what the scene file changes.
    fn changed(&self, name: &str, entry: Option<&Entry>) -> Result<Material, ImportError> {
        match self.scene.material.get(name) {
            Some(change) => self.change(name, entry, change),
            None => Ok(entry.unwrap_or(&Entry::default()).material(name)),
        }
    }

    /// Checks every `[material.NAME]` that is not in use, and warns of it.
    fn check_changes(&self, names: &Names, warnings: &mut Vec<Warning>) -> Result<(), ImportError> {
        let used = names.all().map(shown);
        for (key, change) in &self.scene.material {
            let name = key.get_ref();
            if used.clone().any(|used| used == name) {
                continue;
            }
            self.change(name, None, change)?;
            let nearest = used.clone().min_by_key(|used| strsim::damerau_levenshtein(name, used));
            let nearest = excerpt(nearest.unwrap_or(UNNAMED));
            let message = format!("nothing has material `{}`; the nearest name is `{nearest}`", excerpt(name));
            warnings.push(Warning::line(&self.file, self.line(key.span()), message));
        }
        Ok(())
    }
}

/// The textures of a scene, each read once.
struct Textures<'a> {
    source: &'a dyn Source,
    known: HashMap<String, Option<Arc<Texture>>>,
    /// Files that are none, and why.
    missing: Vec<(String, String)>,
}

impl Textures<'_> {
    fn get(&mut self, name: &str) -> Option<Arc<Texture>> {
        if let Some(known) = self.known.get(name) {
            return known.clone();
        }
        let texture = match texture::read(self.source, name) {
            Ok(texture) => Some(Arc::new(texture)),
            Err(why) => {
                self.missing.push((self.source.describe(name), why));
                None
            }
        };
        self.known.insert(name.into(), texture.clone());
        texture
    }
}

/// The name of a material in messages and in scene files.
fn shown(named: &Named) -> &str {
    if named.name.is_empty() { UNNAMED } else { &named.name }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use glam::DVec2;

    use super::*;
    use crate::import::testing::{ROOM, refused, room, scene, warnings};
    use crate::import::{Embedded, load_from};
    use crate::model::{Lobe, MaterialKind, Model, Specular};

    #[test]
    fn a_change_of_nothing_is_said() {
        let imported = room("[material.wall]\n[material.wal]\n").unwrap();
        let expected = "built-in s.toml:3: nothing has material `wal`; the nearest name is `wall`";
        assert_eq!(warnings(&imported), [expected]);
        assert_eq!(imported.model.materials[0].colour, DVec3::splat(0.8));
    }

    #[test]
    fn undefined_materials_and_missing_textures_are_said_once() {
        let more: &[u8] = b"usemtl glass\nf 1 2 3\nusemtl wood\nf 1 2 3\nusemtl none\nf 1 2 3\n\
                            usemtl wall\nf 1 2 3\nusemtl bark\nf 1 2 3\n";
        let obj = [b"mtllib m.mtl\n", ROOM, more].concat();
        let mtl =
            b"newmtl glass\nd 0.1\nnewmtl wood\nmap_Kd w.png\nnewmtl unused\nmap_Kd v.png\nnewmtl bark\nmap_Kd w.png";
        let files: [(&str, &[u8]); 2] = [("x.obj", &obj), ("m.mtl", mtl)];
        let imported = load_from(&Embedded(&files), "x.obj").unwrap();
        let expected = [
            "built-in x.obj:5: materials that no MTL file defines, drawn in grey (Kd 0.8): \
             `wall`, `none`",
            "built-in x.obj: textures that cannot be read, drawn with Kd alone: `built-in w.png` (no such file)",
        ];
        assert_eq!(warnings(&imported), expected);
        let materials = imported.model.materials;
        let names: Vec<&str> = materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["wall", "glass", "wood", "none", "bark"]);
        assert!(materials.iter().all(|m| m.texture.is_none()));
    }

    #[test]
    fn textures_are_shared_and_a_colour_takes_their_place() {
        let mut png = Cursor::new(Vec::new());
        image::DynamicImage::new_rgb8(3, 2).write_to(&mut png, image::ImageFormat::Png).unwrap();
        let obj = b"mtllib m.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 2\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n\
                    usemtl b\nf 1/1 2/2 3/3\nf 1 2 3\nusemtl c\nf 1/1 2/2 3/3\n";
        let mtl = b"newmtl a\nmap_Kd w.png\nnewmtl b\nmap_Kd w.png\nnewmtl c\nmap_Kd w.png\n";
        let toml = b"model = 'x.obj'\n[material.c]\ncolour = [1, 0, 0]\n";
        let files: [(&str, &[u8]); 4] = [("x.obj", obj), ("m.mtl", mtl), ("s.toml", toml), ("w.png", png.get_ref())];
        let imported = load_from(&Embedded(&files), "s.toml").unwrap();
        let expected = "built-in x.obj: triangles without texture coordinates, drawn without their texture: 1";
        assert_eq!(warnings(&imported), [expected]);
        let Model { materials, uvs, .. } = imported.model;
        let [a, b] = [0, 1].map(|i| materials[i].texture.as_ref().unwrap());
        assert!(Arc::ptr_eq(a, b) && a.size == [3, 2] && a.texels.len() == 6);
        assert_eq!((materials[0].colour, &materials[2].texture), (DVec3::ONE, &None));
        let some = Some([DVec2::ZERO, DVec2::X, DVec2::Y]);
        assert_eq!(uvs, [some, some, None, None], "only where there is a texture");
    }

    #[test]
    fn a_material_that_the_scene_file_colours_needs_no_mtl() {
        let imported = room("[material.wall]\ncolour = [1, 0, 0]").unwrap();
        assert_eq!(warnings(&imported), Vec::<String>::new());
        assert_eq!(imported.model.materials[0].colour, DVec3::X);
    }

    #[test]
    fn faces_without_a_material_are_called_default() {
        let obj: &[u8] = b"v 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n";
        let toml: &[u8] = b"model = 'x.obj'\n[material.default]\ncolour = [0, 0, 1]\n";
        let files = [("x.obj", obj), ("s.toml", toml)];
        let imported = load_from(&Embedded(&files), "s.toml").unwrap();
        assert_eq!(warnings(&imported), Vec::<String>::new());
        assert_eq!(imported.model.materials[0].name, "default");
        assert_eq!(imported.model.materials[0].colour, DVec3::Z);
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
            ("[material.wall]\nior = 0", "3: ior of 0; it must be from 0.1 to 10"),
            ("[material.wall]\nior = -1.5", "3: ior of -1.5; it must be from 0.1 to 10"),
            ("[material.wall]\nroughness = 1.01", "3: roughness of 1.01; it must be from 0 to 1"),
            ("[material.other]\nroughness = -0.1", "3: roughness of -0.1; it must be from 0 to 1"),
            ("[material.wall]\nexponent = 0", "3: exponent of 0; it must be from 1 to 10000"),
            ("[material.wall]\nexponent = 1e9", "3: exponent of 1000000000; it must be from 1 to 10000"),
            ("[material.wall]\nweights = [1, 0, -0.5, 0]", "3: a weight of -0.5; weights are from 0 to 1e30"),
            (
                "[material.other]\nweights = [0, 0, 0.5, 0.75]",
                "3: weights of reflected and refracted light are 1.25 together; they must be at most 1, or mirrors that \
                 face each other make light",
            ),
        ]);
    }

    #[test]
    fn kinds_have_defaults_of_their_own() {
        let wall = |lines: &str| room(&format!("[material.wall]\n{lines}")).unwrap().model.materials.remove(0);
        let grey = DVec3::splat(0.8);
        let shine = |colour| Some(Specular { lobe: Lobe::BlinnPhong, exponent: 50, colour });
        let look = |m: Material| (m.kind, m.colour, m.ior, m.specular, m.weights);
        assert_eq!(look(wall("kind = 'lambert'")), (MaterialKind::Lambert, grey, 1.0, None, None));
        assert_eq!(look(wall("kind = 'metal'")), (MaterialKind::Metal, grey, 1.0, shine(grey), None));
        assert_eq!(look(wall("kind = 'mirror'")), (MaterialKind::Mirror, DVec3::ONE, 1.0, None, None));
        assert_eq!(look(wall("kind = 'dielectric'")), (MaterialKind::Dielectric, DVec3::ONE, 1.5, None, None));
        let glossy = wall("exponent = 124.7\nspecular = 'phong'").specular;
        assert_eq!(glossy, Some(Specular { lobe: Lobe::Phong, exponent: 125, colour: DVec3::ONE }));
        let weighted = wall("weights = [0, 10, 0.8, 0.2]\ntinted_shadow = true");
        assert_eq!((weighted.weights, weighted.specular), (Some([0.0, 10.0, 0.8, 0.2]), shine(DVec3::ONE)));
        assert!(weighted.tinted_shadow);
        assert_eq!((wall("").roughness, wall("kind = 'metal'\nroughness = 0.25").roughness), (0.0, 0.25));
    }

    #[test]
    fn a_kind_takes_the_place_of_illum_and_leaves_the_rest() {
        let obj = [b"mtllib m.mtl\n", ROOM].concat();
        let mtl = b"newmtl wall\nKd 0.5 0.25 1\nKs 0.5\nNs 9\nNi 1.25\nillum 3\nKe 0 0 2\n";
        let look = |lines: &str| {
            let toml = format!("model = 'x.obj'\n[material.wall]\n{lines}");
            let files: [(&str, &[u8]); 3] = [("x.obj", &obj), ("m.mtl", mtl), ("s.toml", toml.as_bytes())];
            load_from(&Embedded(&files), "s.toml").unwrap().model.materials.remove(0)
        };
        assert_eq!(look("exponent = 7").specular.unwrap(), Specular { exponent: 7, ..look("").specular.unwrap() });
        assert_eq!(look("").weights, Some([1.0, 1.0, 1.0, 0.0]));
        let metal = look("kind = 'metal'");
        assert_eq!((metal.weights, metal.emission), (None, DVec3::Z * 2.0));
        let kd = DVec3::new(0.5, 0.25, 1.0);
        assert_eq!((metal.colour, metal.specular.unwrap().colour, metal.specular.unwrap().exponent), (kd, kd, 9));
        let glass = look("kind = 'dielectric'");
        assert_eq!((glass.colour, glass.ior, glass.specular), (DVec3::ONE, 1.25, None));
    }

    #[test]
    fn spheres_need_no_mesh_and_share_materials_with_one() {
        let ball = "[[sphere]]\ncentre = [0, 1, 0]\nradius = 2\n";
        let alone = scene(ball).unwrap();
        assert_eq!(warnings(&alone), Vec::<String>::new());
        assert_eq!((alone.model.spheres[0].radius, alone.model.materials[0].name.as_str()), (2.0, "default"));
        let lines =
            format!("{ball}material = 'wall'\n{ball}material = 'glass'\n{ball}material = 'ice'\n[material.glass]");
        let mixed = room(&lines).unwrap();
        let expected = [
            "built-in room.obj:4: materials that no MTL file defines, drawn in grey (Kd 0.8): `wall`",
            "built-in s.toml:13: materials that no table defines, drawn in grey (Kd 0.8): `ice`",
        ];
        assert_eq!(warnings(&mixed), expected);
        assert_eq!(mixed.model.spheres.iter().map(|s| s.material).collect::<Vec<_>>(), [0, 1, 2]);
        refused(&[
            ("[[sphere]]\nradius = 1", "2: missing field `centre`"),
            ("[[sphere]]\ncentre = [0, 0, 0]\nradius = 0", "4: radius of 0; it must be above 0 and at most 1e30"),
            ("[[sphere]]\ncentre = [0, 0, 0]\nradius = -1", "4: radius of -1; it must be above 0 and at most 1e30"),
            (
                "[[sphere]]\ncentre = [0, 2e30, 0]\nradius = 1",
                "3: [0, 2000000000000000000000000000000, 0] is beyond 1e30",
            ),
        ]);
    }
}
