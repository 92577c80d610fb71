//! Decimation: never more triangles than asked for, and what is promised to be kept is.

use glam::DVec3;
use std::collections::HashMap;

use host_tools::builtin;
use host_tools::compare::compare;
use host_tools::decimate::{DecimateError, decimate};
use host_tools::engine;
use host_tools::import::{self, Embedded};
use host_tools::model::{Model, Triangle};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use tests::oracle;
use tests::{meshes, scenes, shared};

/// A flat model of a mesh, each triangle with vertices of its own.
fn of(mesh: &[oracle::Triangle]) -> Model {
    let positions = mesh.iter().flatten().map(|v| DVec3::from_array(v.map(|c| c as f64))).collect();
    let triangles = (0..mesh.len() as u32)
        .map(|i| Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], normals: None, material: 0 })
        .collect();
    Model { positions, triangles, ..scenes::inside(1) }
}

fn demo() -> Model {
    // What shines shows any change of shape many times over.
    scenes::matt(import::load_from(&Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model)
}

fn corners(model: &Model, triangle: &Triangle) -> [DVec3; 3] {
    triangle.vertices.map(|v| model.positions[v as usize])
}

fn square(corners: [DVec3; 3]) -> DVec3 {
    let [a, b, c] = corners;
    (b - a).cross(c - a)
}

/// Whether each edge is there once in each direction.
fn is_closed(model: &Model) -> bool {
    let mut edges = HashMap::new();
    for [a, b, c] in model.triangles.iter().map(|triangle| triangle.vertices) {
        [(a, b), (b, c), (c, a)].into_iter().for_each(|edge| *edges.entry(edge).or_insert(0) += 1);
    }
    edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1))
}

fn volume(model: &Model) -> f64 {
    let cone = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c)) / 6.0;
    model.triangles.iter().map(|triangle| cone(corners(model, triangle))).sum()
}

/// What every model must hold: indices in range, all positions and normals used, normals of unit length.
fn is_whole(model: &Model) -> bool {
    let all_used = |count: usize, used: &mut dyn Iterator<Item = u32>| {
        let mut is_used = vec![false; count];
        used.for_each(|index| is_used[index as usize] = true);
        is_used.into_iter().all(|used| used)
    };
    all_used(model.positions.len(), &mut model.triangles.iter().flat_map(|t| t.vertices))
        && all_used(model.normals.len(), &mut model.triangles.iter().filter_map(|t| t.normals).flatten())
        && model.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-12)
        && model.triangles.iter().all(|t| (t.material as usize) < model.materials.len())
}

fn picture(model: &Model) -> Picture {
    let engine = engine::by_name("exact29").expect("a kernel of this name");
    let prepared = engine.prepare(model, &Options::default()).expect("it fits");
    engine.render(prepared.blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

#[test]
fn a_closed_sphere_stays_closed_and_keeps_its_volume() {
    let sphere = scenes::inside(12);
    for target in [1000, 501, 100, 20, 4] {
        let found = decimate(sphere.clone(), target).expect("a sphere");
        assert!(found.triangles.len() <= target && found.triangles.len() + 2 > target, "{target}");
        assert!(is_whole(&found) && is_closed(&found), "{target}");
        if target >= 100 {
            let ratio = volume(&found) / volume(&sphere);
            assert!((0.95..1.01).contains(&ratio), "{target}: {ratio}");
            let outward = |c: [DVec3; 3]| square(c).dot(c[0] + c[1] + c[2] - DVec3::splat(1.5)) > 0.0;
            assert!(found.triangles.iter().all(|t| outward(corners(&found, t))), "{target}: a triangle is turned over");
        }
        let mut open = found.clone();
        open.triangles.pop();
        assert!(!is_closed(&open));
    }
}

#[test]
fn a_model_that_has_no_more_is_left_alone() {
    let model = demo();
    for target in [model.triangles.len(), usize::MAX] {
        assert_eq!(decimate(model.clone(), target).expect("nothing to do"), model);
    }
}

#[test]
fn materials_keep_their_places_and_areas() {
    let model = demo();
    let found = decimate(model.clone(), 800).expect("enough");
    assert!((799..=800).contains(&found.triangles.len()) && is_whole(&found));
    let areas = |model: &Model| {
        let mut areas = vec![0.0; model.materials.len()];
        for triangle in &model.triangles {
            areas[triangle.material as usize] += square(corners(model, triangle)).length();
        }
        areas
    };
    for ((before, after), material) in areas(&model).into_iter().zip(areas(&found)).zip(&model.materials) {
        // What is of spheres alone has none.
        assert!(before == after || (after / before - 1.0).abs() < 0.02, "{}: {before} became {after}", material.name);
    }
    let apart = compare(&picture(&found), &picture(&model)).expect("of one size");
    assert!(apart.psnr.is_some_and(|psnr| psnr > 28.0), "{apart:?}");
}

/// A chessboard has outlines in its plane, which no flat error sees.
#[test]
fn outlines_between_materials_are_kept() {
    let side = 24;
    let mut board = of(&[]);
    board.materials.push(board.materials[0].clone());
    board.positions = (0..=side).flat_map(|y| (0..=side).map(move |x| DVec3::new(x.into(), y.into(), 0.0))).collect();
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let at = |x: u32, y: u32| y * (side + 1) + x;
        let material = (x / 6 + y / 6) % 2;
        let square = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        let triangle = |vertices| Triangle { vertices, normals: None, material };
        board.triangles.push(triangle([square[0], square[1], square[2]]));
        board.triangles.push(triangle([square[0], square[2], square[3]]));
    }
    let found = decimate(board, 32).expect("two a field");
    assert_eq!(found.triangles.len(), 32);
    for triangle in &found.triangles {
        let corners = corners(&found, triangle);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        assert_eq!(triangle.material, ((middle.x / 6.0) as u32 + (middle.y / 6.0) as u32) % 2);
        assert!((square(corners).z - 36.0).abs() < 1e-3, "{corners:?}");
    }
}

#[test]
fn smooth_normals_stay_near_their_faces() {
    let found = decimate(demo(), 800).expect("enough");
    let smooth: Vec<_> =
        found.triangles.iter().filter_map(|t| Some((square(corners(&found, t)), t.normals?))).collect();
    assert!(smooth.len() > 600);
    let near =
        smooth.iter().flat_map(|(face, normals)| normals.map(|n| face.normalize().dot(found.normals[n as usize])));
    assert!(near.fold(1.0, f64::min) > 0.5);
}

/// As many programs write flat shading: a normal of its own for each face.
#[test]
fn triangles_with_one_normal_each_are_flat() {
    let mut sphere = scenes::inside(12);
    sphere.normals = sphere.triangles.iter().map(|t| square(corners(&sphere, t)).normalize()).collect();
    for (triangle, normal) in sphere.triangles.iter_mut().zip(0..) {
        triangle.normals = Some([normal; 3]);
    }
    let found = decimate(sphere, 100).expect("a sphere");
    assert!(found.normals.is_empty() && found.triangles.iter().all(|t| t.normals.is_none()));
    assert!(is_closed(&found));
}

#[test]
fn what_cannot_be_reached_says_how_far_it_came() {
    for (name, mesh) in meshes::all(10) {
        let model = of(&mesh);
        let reached = match decimate(model.clone(), 1) {
            Ok(found) => found.triangles.len(),
            Err(DecimateError::Unreachable { triangles, target, reached }) => {
                assert_eq!((triangles, target), (mesh.len(), 1));
                assert!(reached > 1);
                reached
            }
            Err(error) => panic!("{name}: {error}"),
        };
        // A solid is four triangles at least, and nothing goes of triangles that touch nowhere.
        match name {
            "sphere" | "cuboid" => assert_eq!(reached, 4, "{name}"),
            "soup" => assert_eq!(reached, mesh.len()),
            _ => {}
        }
        let found = decimate(model, reached).expect("as far as it came");
        assert!(found.triangles.len() <= reached && is_whole(&found), "{name}");
    }
}

#[test]
fn degenerate_triangles_are_no_obstacle() {
    let mut sphere = meshes::sphere(10, 6);
    let solid = sphere.len();
    sphere.extend(meshes::degenerates(10));
    let found = decimate(of(&sphere), solid).expect("a sphere and nothing");
    assert!(found.triangles.len() <= solid && is_whole(&found));
}

/// Three sheets at one edge: no half-edge mesh holds them, and no gap may open there.
#[test]
fn sheets_that_share_an_edge_stay_together() {
    let side = 8;
    let mut sheets = Vec::new();
    for direction in [[1, 0], [-1, 1], [-1, -1]] {
        let point = |i: i64, j: i64| [500 + 10 * i * direction[0], 500 + 10 * i * direction[1], 10 * j];
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            sheets.push([point(i, j), point(i + 1, j), point(i + 1, j + 1)]);
            sheets.push([point(i, j), point(i + 1, j + 1), point(i, j + 1)]);
        }
    }
    let found = decimate(of(&sheets), 100).expect("few are at the edge");
    let mut at_the_edge = HashMap::new();
    for corner in found.triangles.iter().flat_map(|t| corners(&found, t)).filter(|p| p.x == 500.0 && p.y == 500.0) {
        *at_the_edge.entry(corner.z as i64).or_insert(0) += 1;
    }
    assert_eq!(at_the_edge.len() as i64, side + 1, "every vertex of the edge is still there");
}

#[test]
fn the_bunny_is_still_one() {
    let Some(path) = shared::scene("bunny/bunny_smooth.obj") else { return };
    let mut bunny = import::load(&path).expect("a real model").model;
    bunny.render.size = [160, 120];
    let whole = picture(&bunny);
    let mut before = f64::INFINITY;
    for (target, least) in [(5000, 33.0), (1000, 27.0), (100, 0.0)] {
        let found = decimate(bunny.clone(), target).expect("a bunny");
        assert!(found.triangles.len() <= target && found.triangles.len() + 2 > target);
        assert!(is_whole(&found));
        let psnr = compare(&picture(&found), &whole).expect("of one size").psnr.expect("they differ");
        assert!(psnr > least && psnr < before, "{target}: {psnr} dB");
        before = psnr;
    }
}
