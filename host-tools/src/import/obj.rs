//! OBJ: our check of every statement, then `tobj`'s parse of what passed, then a [`Mesh`].
//!
//! `tobj` splits its meshes at every group and material, numbers vertices anew in each, and fills
//! in normals that a corner lacks. So it is shown `v`, `vt`, `vn` and `f` statements alone, as one mesh:
//! the order of the file and shared vertices survive, and the check notes which run of faces has
//! which material and which of them have normals and texture coordinates at all. Fans are `tobj`'s: corners (0, i, i + 1).

use std::iter;

use glam::{DVec2, DVec3};

use super::error::{ImportError, Warning, list};
use super::lines::{Checked, Lines};
use super::scan::{Faces, Named, ObjCheck};
use super::source::Source;
use crate::model::{Material, Triangle};

/// The geometry of an OBJ file, its materials by name only.
#[derive(Default)]
pub(super) struct Mesh {
    /// The vertices that faces use, in order of first use.
    pub positions: Vec<DVec3>,
    /// Their colours, linear RGB in [0, 1]; empty where there are none.
    pub colours: Vec<DVec3>,
    /// Texture coordinates of the corners of each triangle that has some; empty where none has.
    pub uvs: Vec<Option<[DVec2; 3]>>,
    /// The normals that triangles use, of unit length.
    pub normals: Vec<DVec3>,
    /// Fans of the faces, in file order; `material` indexes `materials`.
    pub triangles: Vec<Triangle>,
    /// What `usemtl` called the materials of the faces, in order of first use.
    pub materials: Vec<Named>,
    /// The arguments of `mtllib`.
    pub libraries: Vec<Named>,
}

/// Reads an OBJ file. Material libraries are named, not read.
pub(super) fn read(source: &dyn Source, name: &str, warnings: &mut Vec<Warning>) -> Result<Mesh, ImportError> {
    let file = source.describe(name);
    let lines = Lines::open(source, name).map_err(|error| ImportError::unreadable(&file, error))?;
    let mut statements = Checked::new(ObjCheck { lines, faces: Faces::default() });
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let parsed = tobj::load_obj_buf(&mut statements, &options, |_| Ok(Default::default()));
    if let Some(failure) = statements.failure {
        return Err(failure);
    }
    let parsed = parsed.map_err(|source| ImportError::Refused { file: file.clone(), source });
    let Some(parsed) = parsed?.0.pop() else {
        return Err(ImportError::NoFaces { file });
    };
    let faces = statements.check.faces;
    if let Some(&line) = faces.ignored.values().min() {
        let keywords: Vec<&String> = faces.ignored.keys().collect();
        let message = format!("statements that are not rendered are ignored: {}", list(&keywords));
        warnings.push(Warning::line(&file, line, message));
    }
    if let Some(line) = faces.colours.unusable {
        let message = "colours of vertices are ignored: from here on some are not from 0 to 1, or others have none";
        warnings.push(Warning::line(&file, line, message));
    }
    let (mesh, flattened) = assemble(&parsed.mesh, faces);
    if flattened > 0 {
        let message = format!("triangles with a normal of length zero, drawn flat: {flattened}");
        warnings.push(Warning::file(&file, message));
    }
    Ok(mesh)
}

/// Joins what `tobj` parsed to what the check noted. Also the number of triangles whose normals had
/// to be dropped.
fn assemble(parsed: &tobj::Mesh, faces: Faces) -> (Mesh, usize) {
    let mut normals = Normals::new(&parsed.normals);
    let mut flattened = 0;
    let tags = faces.runs.iter().flat_map(|run| iter::repeat_n(run, run.triangles));
    let corner_normals = parsed.normal_indices.as_chunks().0;
    let triangles = iter::zip(parsed.indices.as_chunks().0, tags)
        .enumerate()
        .map(|(i, (&vertices, run))| {
            let given = corner_normals.get(i).filter(|_| run.smooth);
            let kept = given.and_then(|&corners| normals.keep(corners));
            flattened += usize::from(given.is_some() && kept.is_none());
            Triangle { vertices, normals: kept, material: run.material }
        })
        .collect();
    let vectors = |components: &[f64]| components.as_chunks().0.iter().map(|&p| DVec3::from_array(p)).collect();
    let colours = if faces.colours.are_usable() { vectors(&parsed.vertex_color) } else { Vec::new() };
    let mesh = Mesh {
        positions: vectors(&parsed.positions),
        colours,
        uvs: texture_coordinates(parsed, &faces),
        triangles,
        normals: normals.kept,
        materials: faces.materials,
        libraries: faces.libraries,
    };
    (mesh, flattened)
}

/// The texture coordinates of each triangle; none at all where no triangle has any.
fn texture_coordinates(parsed: &tobj::Mesh, faces: &Faces) -> Vec<Option<[DVec2; 3]>> {
    if !faces.runs.iter().any(|run| run.textured) {
        return Vec::new();
    }
    let coordinates = parsed.texcoords.as_chunks().0;
    let corners = parsed.texcoord_indices.as_chunks().0;
    let tags = faces.runs.iter().flat_map(|run| iter::repeat_n(run.textured, run.triangles));
    let of = |corners: &[u32; 3]| corners.map(|corner| DVec2::from_array(coordinates[corner as usize]));
    iter::zip(corners, tags).map(|(corners, textured)| textured.then(|| of(corners))).collect()
}

impl Mesh {
    /// Leaves out the texture coordinates of triangles whose material has no texture, and warns of triangles that have a
    /// texture and do not say where. `file` is the OBJ.
    pub(super) fn keep_textured(&mut self, materials: &[Material], file: &str, warnings: &mut Vec<Warning>) {
        let has_texture = |triangle: &Triangle| materials[triangle.material as usize].texture.is_some();
        let textured = self.triangles.iter().filter(|triangle| has_texture(triangle)).count();
        for (triangle, uv) in iter::zip(&self.triangles, &mut self.uvs) {
            *uv = uv.filter(|_| has_texture(triangle));
        }
        let placed = self.uvs.iter().flatten().count();
        if placed == 0 {
            self.uvs = Vec::new();
        }
        if placed < textured {
            let bare = textured - placed;
            let message = format!("triangles without texture coordinates, drawn without their texture: {bare}");
            warnings.push(Warning::file(file, message));
        }
    }
}

/// Unit normals, of which only those in use are kept.
struct Normals {
    /// Of every normal of the file; `None` where the length is zero.
    units: Vec<Option<DVec3>>,
    /// Where in `kept` it is.
    places: Vec<Option<u32>>,
    kept: Vec<DVec3>,
}

impl Normals {
    fn new(components: &[f64]) -> Self {
        let unit = |&n: &[f64; 3]| {
            let n = DVec3::from_array(n);
            // Scaled first: the square of a tiny or huge length is not a number to divide by.
            let scale = n.abs().max_element();
            (scale > 0.0).then(|| (n / scale).normalize())
        };
        let units: Vec<_> = components.as_chunks().0.iter().map(unit).collect();
        Self { places: vec![None; units.len()], units, kept: Vec::new() }
    }

    /// Keeps the normals of a triangle, unless one has no direction.
    fn keep(&mut self, corners: [u32; 3]) -> Option<[u32; 3]> {
        let mut units = [DVec3::ZERO; 3];
        for (unit, corner) in iter::zip(&mut units, corners) {
            *unit = (*self.units.get(corner as usize)?)?;
        }
        let mut out = [0; 3];
        for (i, corner) in corners.into_iter().enumerate() {
            let place = &mut self.places[corner as usize];
            out[i] = *place.get_or_insert_with(|| {
                self.kept.push(units[i]);
                self.kept.len() as u32 - 1
            });
        }
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Embedded;

    fn mesh(text: &str) -> (Mesh, Vec<String>) {
        let files = [("x.obj", text.as_bytes())];
        let mut warnings = Vec::new();
        let mesh = read(&Embedded(&files), "x.obj", &mut warnings).unwrap();
        (mesh, warnings.iter().map(Warning::to_string).collect())
    }

    /// The corners of each triangle as positions along x.
    fn corners(mesh: &Mesh) -> Vec<[f64; 3]> {
        let x = |i: u32| mesh.positions[i as usize].x;
        mesh.triangles.iter().map(|t| t.vertices.map(x)).collect()
    }

    const FIVE: &str = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 3 0 1\nv 4 1 1\n";

    #[test]
    fn faces_keep_the_order_of_the_file_across_groups_and_materials() {
        let text = FIVE.to_owned()
            + "usemtl b\no one\nf 3 4 5\ng two\nf 1 2 3 4 5\nusemtl a\nf -1 -2 -3\n\
            o three\nusemtl b\nf 1 3 2 4\n";
        let (mesh, warnings) = mesh(&text);
        let expected = [
            [2.0, 3.0, 4.0],
            [0.0, 1.0, 2.0],
            [0.0, 2.0, 3.0],
            [0.0, 3.0, 4.0],
            [4.0, 3.0, 2.0],
            [0.0, 2.0, 1.0],
            [0.0, 1.0, 3.0],
        ];
        assert_eq!(corners(&mesh), expected);
        let materials: Vec<u32> = mesh.triangles.iter().map(|t| t.material).collect();
        assert_eq!(materials, [0, 0, 0, 0, 1, 0, 0]);
        let names: Vec<&str> = mesh.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["b", "a"]);
        assert_eq!(mesh.positions.len(), 5, "vertices are shared across groups");
        assert!(warnings.is_empty());
    }

    #[test]
    fn weights_of_vertices_are_ignored() {
        let (mesh, warnings) = mesh("v 0 0 0 2\nv 4 0 0 0.5 # c\nv 2 1 0\nv 3 0 1 1 1\nf 1 2 3\nf 1 2 4 # 9");
        assert_eq!(corners(&mesh), [[0.0, 4.0, 2.0], [0.0, 4.0, 3.0]]);
        assert!(warnings.is_empty() && mesh.colours.is_empty() && mesh.uvs.is_empty());
    }

    #[test]
    fn colours_of_vertices_are_all_or_none() {
        let (good, warnings) = mesh("v 9 9 9 0 0 0\nv 0 0 0 1 0 0\nv 1 0 0\nv 2 1 0 0 0 0.5 1\nf 2 3 4\n");
        assert_eq!(good.colours, [DVec3::X, DVec3::ONE, DVec3::new(0.0, 0.0, 0.5)], "white where there is none");
        assert!(warnings.is_empty());
        for (text, line) in [
            ("v 0 0 0\nv 1 0 0\nv 2 1 0 1 0 0\nf 1 2 3\n", 3),
            ("v 0 0 0 0 0 0\nv 1 0 0 255 0 0\nv 2 1 0 1 0 0\nf 1 2 3\n", 2),
            ("v 0 0 0 0 -1 0\nv 1 0 0\nv 2 1 0\nf 1 2 3\n", 1),
        ] {
            let (bad, warnings) = mesh(text);
            assert!(bad.colours.is_empty());
            let expected = format!("built-in x.obj:{line}: colours of vertices are ignored: ");
            assert!(warnings.len() == 1 && warnings[0].starts_with(&expected), "{warnings:?}");
        }
    }

    #[test]
    fn texture_coordinates_are_those_of_the_corners() {
        let text =
            FIVE.to_owned() + "vt 0.5\nvt 1 2\nvt -3 4 5\nf 1 2 3\nf 1/3 2/2 3/1\nf 1/1 2/1 3\nf 3/-1 4/-2 5/-3\n";
        let (mesh, _) = mesh(&text);
        let [a, b, c] = [[0.5, 0.0], [1.0, 2.0], [-3.0, 4.0]].map(DVec2::from_array);
        assert_eq!(mesh.uvs, [None, Some([c, b, a]), None, Some([c, b, a])]);
    }

    #[test]
    fn a_triangle_is_smooth_if_all_its_corners_have_normals_of_some_length() {
        let text = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 3 0 1\nvt 0 0\nvt 1\n\
            vn 9 9 9\nvn 0 0 2e-200\nvn 3e300 0 4e300\nvn 0 0 0\n\
            f 1//2 2//3 3//2\nf 1//2 2//3 3\nf 1/1/2 2/2/2 -1/-2/4\nf 1/1 2/2 4/1\n\
            f 1//2 2//2 3//2 4//-1\nf 1/1/3 2/1/3 4//3\n";
        let (mesh, warnings) = mesh(text);
        let normals: Vec<_> = mesh.triangles.iter().map(|t| t.normals).collect();
        let expected = [Some([0, 1, 0]), None, None, None, Some([0, 0, 0]), None, Some([1, 1, 1])];
        assert_eq!(normals, expected);
        assert_eq!(mesh.normals.len(), 2, "only normals in use are kept");
        assert_eq!(mesh.normals[0], DVec3::Z);
        assert!((mesh.normals[1] - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-15);
        let expected = ["built-in x.obj: triangles with a normal of length zero, drawn flat: 2"];
        assert_eq!(warnings, expected);
    }

    #[test]
    fn a_file_of_flat_faces_has_no_normals() {
        let (mesh, _) = mesh("v 0 0 0\nv 1 0 0\nv 2 1 0\nvn 0 1 0\nf 1 2 3\nf 1//1 2//1 3\n");
        assert!(mesh.normals.is_empty());
        assert!(mesh.triangles.iter().all(|t| t.normals.is_none()));
    }

    #[test]
    fn faces_may_stand_before_their_vertices() {
        let (mesh, _) = mesh("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 2 1 0\n");
        assert_eq!(corners(&mesh), [[0.0, 1.0, 2.0]]);
    }

    #[test]
    fn statements_that_are_not_rendered_are_named_once() {
        let text = format!("{FIVE}l 1 2\np 1\nl 2 3\ns off\nvp 1 2\ncurv 0 1\nf 1 2 3\n");
        let (_, warnings) = mesh(&text);
        let expected = "built-in x.obj:6: statements that are not rendered are ignored: \
                        `curv`, `l`, `p` and 1 more";
        assert_eq!(warnings, [expected]);
    }
}
