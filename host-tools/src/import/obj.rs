//! OBJ: what a file says, checked, as a [`Mesh`] of what its faces use.

use std::iter;

use glam::{DVec2, DVec3};

use super::error::{ImportError, Warning, list};
use super::lines::Lines;
use super::scan::{Faces, Named, UNPLACED, scan};
use super::source::Source;
use crate::compacted::Compacted;
use crate::model::{Material, Triangle};

/// The geometry of an OBJ file, its materials by name only.
#[derive(Default)]
pub(super) struct Mesh {
    /// The vertices that faces use, in order of first use.
    pub positions: Vec<DVec3>,
    /// Their colours, linear RGB in [0, 1]; empty where there are none.
    pub colours: Vec<DVec3>,
    /// The normals that triangles use, of unit length.
    pub normals: Vec<DVec3>,
    /// Fans of the faces, in file order; `material` indexes `materials`.
    pub triangles: Vec<Triangle>,
    /// Where in `coordinates` those of each triangle's corners are, or [`UNPLACED`]; not of all, where the last have none.
    uvs: Vec<[u32; 3]>,
    /// The texture coordinates of the file.
    coordinates: Vec<DVec2>,
    /// What `usemtl` called the materials of the faces, in order of first use.
    pub materials: Vec<Named>,
    /// The arguments of `mtllib`.
    pub libraries: Vec<Named>,
}

/// Reads an OBJ file. Material libraries are named, not read.
pub(super) fn read(source: &dyn Source, name: &str, warnings: &mut Vec<Warning>) -> Result<Mesh, ImportError> {
    let file = source.describe(name);
    let lines = Lines::open(source, name).map_err(|error| ImportError::unreadable(&file, error))?;
    let faces = scan(lines)?;
    if let Some(&line) = faces.ignored.values().min() {
        let keywords: Vec<&String> = faces.ignored.keys().collect();
        let message = format!("statements that are not rendered are ignored: {}", list(&keywords));
        warnings.push(Warning::line(&file, line, message));
    }
    if let Some(line) = faces.colours.unusable {
        let message = "colours of vertices are ignored: from here on some are not from 0 to 1, or others have none";
        warnings.push(Warning::line(&file, line, message));
    }
    let (mesh, flattened) = assemble(faces);
    if flattened > 0 {
        let message = format!("triangles with a normal of length zero, drawn flat: {flattened}");
        warnings.push(Warning::file(&file, message));
    }
    Ok(mesh)
}

/// Keeps what triangles use. Also the number of triangles whose normals had to be dropped.
fn assemble(faces: Faces) -> (Mesh, usize) {
    let Faces { mut positions, coordinates, mut normals, mut triangles, uvs, materials, libraries, colours, .. } =
        faces;
    triangles.shrink_to_fit();
    normals.iter_mut().for_each(|normal| *normal = unit(*normal));
    let (mut vertices, mut kept, mut flattened) = (Compacted::default(), Compacted::default(), 0);
    for triangle in &mut triangles {
        triangle.vertices = triangle.vertices.map(|vertex| vertices.number(vertex as usize));
        if let Some(corners) = triangle.normals {
            let is_smooth = corners.iter().all(|&corner| normals[corner as usize] != DVec3::ZERO);
            flattened += usize::from(!is_smooth);
            triangle.normals = is_smooth.then(|| corners.map(|corner| kept.number(corner as usize)));
        }
    }
    // Each old list goes as soon as its new one is there.
    normals = kept.used().map(|normal| normals[normal]).collect();
    let colours = colours.usable().map_or_else(Vec::new, |all| vertices.used().map(|vertex| all[vertex]).collect());
    positions = vertices.used().map(|vertex| positions[vertex]).collect();
    (Mesh { positions, colours, normals, triangles, uvs, coordinates, materials, libraries }, flattened)
}

/// The vector of length 1 in a direction; zero for none.
fn unit(normal: DVec3) -> DVec3 {
    // Scaled first: the square of a tiny or huge length is not a number to divide by.
    let scale = normal.abs().max_element();
    if scale > 0.0 { (normal / scale).normalize() } else { DVec3::ZERO }
}

impl Mesh {
    /// The texture coordinates of each triangle whose material has a texture; none at all where no triangle has any. Warns
    /// of triangles that have a texture and do not say where. `file` is the OBJ.
    pub(super) fn textured(
        &self,
        materials: &[Material],
        file: &str,
        warnings: &mut Vec<Warning>,
    ) -> Vec<Option<[DVec2; 3]>> {
        let has_texture = |triangle: &Triangle| materials[triangle.material as usize].texture.is_some();
        let of = |corners: &[u32; 3]| corners.map(|corner| self.coordinates[corner as usize]);
        let uvs = self.uvs.iter().chain(iter::repeat(&UNPLACED));
        let uvs = iter::zip(&self.triangles, uvs)
            .map(|(triangle, corners)| (*corners != UNPLACED && has_texture(triangle)).then(|| of(corners)));
        let textured = self.triangles.iter().filter(|triangle| has_texture(triangle)).count();
        let placed = uvs.clone().flatten().count();
        if placed < textured {
            let bare = textured - placed;
            let message = format!("triangles without texture coordinates, drawn without their texture: {bare}");
            warnings.push(Warning::file(file, message));
        }
        if placed == 0 { Vec::new() } else { uvs.collect() }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::import::Embedded;
    use crate::model::Texture;

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

    /// `tobj` splits meshes at groups and materials, and makes up what a corner lacks: of files without these it reads the same.
    #[test]
    fn faces_are_what_another_parser_reads() {
        let mut state = 1u64;
        let mut below = |end: u64| {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 33) % end
        };
        for round in 0..64 {
            let (mut text, mut counts) = (String::new(), [0; 3]);
            for _ in 0..60 {
                let mut numbers = || (below(2001) as f64 - 1000.5) / 16.0;
                let [x, y, z] = [numbers(), numbers(), numbers()];
                text += &format!("v {x} {y} {z}\nvt {y:e} {z:e}\nvn {z} {x} {y}\n");
                counts = counts.map(|count| count + 1);
                if counts[0] < 6 {
                    continue;
                }
                let mut place = |list: usize| match below(2) {
                    0 => 1 + below(counts[list]) as i64,
                    _ => -1 - below(counts[list]) as i64,
                };
                let corners = (0..3 + round % 4).map(|_| match round % 3 {
                    0 => format!(" {}", place(0)),
                    1 => format!(" {}//{}", place(0), place(2)),
                    _ => format!(" {}/{}/{}", place(0), place(1), place(2)),
                });
                text += &format!("f{}\n", corners.collect::<String>());
            }
            let (ours, _) = mesh(&text);
            let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
            let theirs = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| Ok(Default::default())).unwrap();
            let theirs = &theirs.0[0].mesh;
            let triple = |all: &[f64], place: u32| DVec3::from_slice(&all[3 * place as usize..]);
            assert_eq!(ours.triangles.len() * 3, theirs.indices.len());
            for (i, triangle) in ours.triangles.iter().enumerate() {
                for corner in 0..3 {
                    let at = 3 * i + corner;
                    let position = ours.positions[triangle.vertices[corner] as usize];
                    assert_eq!(position, triple(&theirs.positions, theirs.indices[at]));
                    if let Some(normals) = triangle.normals {
                        let normal = triple(&theirs.normals, theirs.normal_indices[at]).normalize();
                        assert!((ours.normals[normals[corner] as usize] - normal).length() < 1e-12);
                    }
                    if let Some(uvs) = ours.uvs.get(i) {
                        let uv = &theirs.texcoords[2 * theirs.texcoord_indices[at] as usize..];
                        assert_eq!(ours.coordinates[uvs[corner] as usize], DVec2::from_slice(uv));
                    }
                }
            }
            assert_eq!(ours.triangles.iter().all(|t| t.normals.is_some()), round % 3 > 0);
            assert_eq!(ours.uvs.len(), if round % 3 > 1 { ours.triangles.len() } else { 0 });
        }
    }

    #[test]
    fn weights_of_vertices_are_ignored() {
        let (mesh, warnings) = mesh("v 0 0 0 2\nv 4 0 0 0.5 # c\nv 2 1 0\nv 3 0 1 1 1\nf 1 2 3\nf 1 2 4 # 9");
        assert_eq!(corners(&mesh), [[0.0, 4.0, 2.0], [0.0, 4.0, 3.0]]);
        assert!(warnings.is_empty() && mesh.colours.is_empty());
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
        let text = FIVE.to_owned()
            + "vt 0.5\nvt 1 2\nvt -3 4 5\nf 1 2 3\nf 1/3 2/2 3/1\nf 1/1 2/1 3\nf 3/-1 4/-2 5/-3\nf 1 2 3\n";
        let (mesh, _) = mesh(&text);
        let [a, b, c] = [[0.5, 0.0], [1.0, 2.0], [-3.0, 4.0]].map(DVec2::from_array);
        let picture = Texture { size: [1, 1], texels: vec![[0; 3]] };
        let textured = Material { texture: Some(Arc::new(picture)), ..Material::default() };
        let mut warnings = Vec::new();
        let uvs = mesh.textured(&[textured], "x", &mut warnings);
        assert_eq!(uvs, [None, Some([c, b, a]), None, Some([c, b, a]), None]);
        assert_eq!(
            warnings.iter().map(Warning::to_string).collect::<Vec<_>>(),
            ["x: triangles without texture coordinates, drawn without their texture: 3"]
        );
        assert_eq!(mesh.textured(&[Material::default()], "x", &mut Vec::new()), []);
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
