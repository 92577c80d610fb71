//! Keeps `docs/BLOB.md` honest: a reader made from the document alone reads what the host prepares, and finds in it
//! the scenes that went in.

mod agree;
mod cursor;
mod looks;
mod painted;
mod reader;

use agree::agree;
use std::path::Path;

use core_rt::profile::Prefer;
use glam::DVec3;
use host_tools::engine;
use host_tools::import::{self, Embedded, load_from};
use host_tools::model::{Filter, Format, Light, LightKind, Lobe, Model, Projection, Sphere, Transfer, Triangle};
use host_tools::prepare::{Options, Prepared};
use painted::is_painted;
use reader::{Blob, crc32, read};
use tests::scenes;

const KERNELS: [&str; 2] = ["exact14", "exact29"];

/// The built-in scene: lit by a point, partly smooth, with a lamp.
fn built_in() -> Model {
    scenes::matt(load_from(&Embedded(host_tools::builtin::FILES), "scene.toml").unwrap().model)
}

/// The same, flat, in linear light, under a sun.
fn flat() -> Model {
    let mut model = built_in();
    model.triangles.iter_mut().for_each(|triangle| triangle.normals = None);
    model.render.transfer = Transfer::Linear;
    model.render.size = [33, 57];
    model.background = DVec3::new(0.0, 1e-6, 30_000.0).into();
    let kind = LightKind::Directional(DVec3::new(0.3, -2.0, -0.4));
    model.lights.push(Light::new(kind, DVec3::new(3.0, 0.0, 1e-3)));
    model
}

/// One of the gallery.
fn gallery(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/gallery/{name}/scene.toml"));
    import::load(&path).unwrap().model
}

/// The same by parallel rays that start in the midst of it, several a pixel, in 16 bits.
fn parallel() -> Model {
    let mut model = built_in();
    let middle = model.positions.iter().sum::<DVec3>() / model.positions.len() as f64;
    model.camera.position = middle;
    model.camera.look_at = middle + DVec3::new(-1.0, -0.7, -0.4);
    model.camera.projection = Projection::Orthographic { height: 3.0 };
    (model.render.samples, model.render.format, model.render.size) = (5, Format::Rgb565, [31, 23]);
    model
}

/// The same from far off, a sample a pixel, in gray.
fn distant() -> Model {
    let mut model = parallel();
    model.camera.position -= 1e5 * (model.camera.look_at - model.camera.position);
    (model.render.samples, model.render.format) = (1, Format::Gray8);
    model
}

/// A square of 2 n^2 triangles over (n + 1)^2 positions, as many normals, and one triangle without area.
fn carpet(n: u32) -> Model {
    let mut model = built_in();
    let side = n + 1;
    let points = || (0..side * side).map(|i| (f64::from(i % side), f64::from(i / side)));
    model.positions = points().map(|(x, z)| DVec3::new(x, (x * z) % 7.0, z)).collect();
    model.normals = points().map(|(x, z)| DVec3::new(x - 9.0, 99.0, z).normalize()).collect();
    let triangle = |vertices| Triangle { vertices, normals: Some(vertices), material: 0 };
    model.triangles = (0..n * n)
        .map(|i| i / n * side + i % n)
        .flat_map(|i| [triangle([i, i + side, i + 1]), triangle([i + 1, i + side, i + side + 1])])
        .chain([triangle([0, 0, 1])])
        .collect();
    model
}

/// The built-in scene among spheres, one of them too small for any grid; or these alone.
fn with_spheres(alone: bool) -> Model {
    let mut model = if alone { flat() } else { built_in() };
    let (low, high) = model
        .positions
        .iter()
        .fold((model.positions[0], model.positions[0]), |(low, high), &p| (low.min(p), high.max(p)));
    let size = (high - low).max_element();
    if alone {
        model.triangles.clear();
        model.positions.clear();
        model.normals.clear();
    }
    let sphere = |i: u32| {
        let share = DVec3::new(f64::from(i % 3), f64::from(i % 4), f64::from(i % 5)) / 5.0;
        let radius = if i == 7 { 1e-12 } else { size * f64::from(i + 1) / 100.0 };
        Sphere { centre: low + (high - low) * share, radius, material: i % model.materials.len() as u32 }
    };
    model.spheres = (0..30).map(sphere).collect();
    model
}

fn prepare(model: &Model, kernel: &str) -> Prepared {
    engine::by_name(kernel).unwrap().prepare(model, &Options::default()).unwrap()
}

fn prepared(model: &Model, kernel: &str) -> Blob {
    read(prepare(model, kernel).blob.bytes())
}

#[test]
fn what_goes_in_is_read_by_the_document() {
    for kernel in KERNELS {
        for model in [built_in(), flat(), parallel(), distant()] {
            let Prepared { blob, grid, degenerates } = prepare(&model, kernel);
            let found = read(blob.bytes());
            assert_eq!(agree(&found, &model), Ok(()), "{kernel}");
            assert_eq!((found.header.origin, found.header.scale), (grid.origin.to_array(), grid.scale));
            assert_eq!(found.triangles.len() + degenerates.total() as usize, model.triangles.len());
        }
        let (mixed, flat) = (prepared(&built_in(), kernel), prepared(&flat(), kernel));
        // What the comparisons rely on: both kinds of triangles, trees of some depth, widths that are narrow.
        assert!(mixed.corners.contains(&None) && mixed.corners.iter().any(Option::is_some));
        assert!(
            mixed.header.depth > 5
                && mixed.header.needs >> 8
                    == (1 << 25 | 1 << 29 | if kernel == "exact14" { 1 << 33 } else { 1 << 34 }) >> 8
        );
        assert!(flat.corners.is_empty() && flat.normals.is_empty());
    }
}

#[test]
fn shared_vertices_are_read_by_the_document() {
    let options = Options { prefer: Prefer::Size, ..Options::default() };
    let small = |model: &Model, kernel| engine::by_name(kernel).unwrap().prepare(model, &options).unwrap().blob;
    for kernel in KERNELS {
        for model in [built_in(), flat(), with_spheres(false), gallery("materials"), carpet(260)] {
            let found = read(small(&model, kernel).bytes());
            assert_eq!(agree(&found, &model), Ok(()), "{kernel}");
            assert!(found.header.needs >> 29 & 0b101 == 0b100, "{kernel}");
            // Each vertex is there once.
            let mut places: Vec<_> = found.triangles.iter().flat_map(|triangle| triangle.vertices).collect();
            places.sort_unstable();
            places.dedup();
            assert_eq!(found.header.counts[2], places.len(), "{kernel}");
        }
    }
}

#[test]
fn looks_are_read_by_the_document() {
    let mut seen = 0;
    for kernel in KERNELS {
        for name in ["materials", "glass", "mirrors", "spheres"] {
            let mut model = gallery(name);
            model.materials.iter_mut().for_each(|m| m.tinted_shadow |= name == "glass");
            if name == "mirrors" {
                (model.render.paths, model.render.ambient) = (true, DVec3::ONE);
                model.materials.iter_mut().for_each(|m| m.roughness = 0.3);
            }
            let shiny = model.materials.iter_mut().filter_map(|m| m.specular.as_mut());
            shiny.for_each(|s| s.lobe = if name == "materials" { Lobe::Phong } else { Lobe::BlinnPhong });
            let found = prepared(&model, kernel);
            assert_eq!(agree(&found, &model), Ok(()), "{kernel} {name}");
            seen |= found.header.needs;

            let fault = |change: &dyn Fn(&mut Blob)| {
                let mut other = found.clone();
                change(&mut other);
                agree(&other, &model).unwrap_err()
            };
            let lustre = usize::from(found.materials.iter().map(|m| m.lustre).max().unwrap()) - 1;
            assert_eq!(fault(&|b| b.lustres[lustre].eta[1] += 2), "index of refraction");
            assert_eq!(fault(&|b| b.lustres[lustre].flags ^= 1), "flags");
            assert_eq!(fault(&|b| b.lustres[lustre].roughness ^= 2), "roughness");
            assert_eq!(fault(&|b| b.lustres[lustre].colours[2][1] ^= 2), "mirror image of all light");
            assert_eq!(fault(&|b| b.lustres[lustre].colours[4][2] ^= 2), "shadow");
            assert_eq!(fault(&|b| b.lights[0].reach.0 ^= 1 << 15), "reach of a light");
            assert_eq!(fault(&|b| b.header.max_depth += 1), "depth of reflections");
            if let Some(checker) = found.checkers.first() {
                assert_eq!(fault(&|b| b.checkers[0].start[2] ^= 1 << 63), "start of cubes");
                assert_eq!(fault(&|b| b.checkers[0].step = checker.step + (checker.step >> 16)), "size of cubes");
                assert_eq!(fault(&|b| b.checkers[0].other[0] ^= 2), "colour of odd cubes");
            }
        }
    }
    for bit in [10, 11, 12, 13, 15, 16, 17, 18, 28, 30, 32, 35, 36] {
        assert!(seen >> bit & 1 == 1, "no scene of these has need {bit}");
    }
}

#[test]
fn spheres_are_read_by_the_document() {
    for kernel in KERNELS {
        for alone in [false, true] {
            let model = with_spheres(alone);
            let (Prepared { degenerates, .. }, found) = (prepare(&model, kernel), prepared(&model, kernel));
            assert_eq!(agree(&found, &model), Ok(()), "{kernel}");
            assert_eq!((degenerates.spheres, found.spheres.len()), (1, 29), "{kernel}");
            let fault = |change: &dyn Fn(&mut Blob, &mut Model)| {
                let (mut other, mut model) = (found.clone(), model.clone());
                change(&mut other, &mut model);
                agree(&other, &model).unwrap_err()
            };
            let first = found.triangles.len();
            assert_eq!(fault(&|_, m| m.spheres[3].centre.y += 0.01), "centre and radius");
            assert_eq!(fault(&|b, _| b.spheres[4].radius -= 1), "centre and radius");
            assert_eq!(fault(&|b, _| b.spheres[5].material = 1 << 20), {
                if kernel == "exact14" { "range of materials" } else { "a material that is not there" }
            });
            assert_eq!(fault(&|b, _| b.ids[first + 1] = b.header.file_triangles as u32 + 30), "an id beyond the file");
            assert_eq!(fault(&|b, _| b.ids.swap(first, first + 1)), "centre and radius");
            assert_eq!(fault(&|_, m| m.spheres[7].radius = 1.0), "spheres with room are there, and no others");
            assert_eq!(fault(&|b, _| b.header.file_spheres += 1), "spheres in the file");
        }
    }
}

#[test]
fn widths_change_where_the_document_says() {
    for kernel in KERNELS {
        // 2 n^2 + 1 triangles pass 2^16 after n = 181; (n + 1)^2 normals reach it at n = 255.
        for (n, wide_ids, wide_normals) in [(181, 0, 0), (182, 1, 0), (254, 1, 0), (255, 1, 1)] {
            let model = carpet(n);
            let found = prepared(&model, kernel);
            assert_eq!(agree(&found, &model), Ok(()), "{kernel} {n}");
            // Those of exact29 have room in the records.
            let wide_ids = if kernel == "exact14" { wide_ids } else { 0 };
            assert_eq!((found.header.needs >> 8 & 1, found.header.needs >> 9 & 1), (wide_ids, wide_normals), "{n}");
        }
    }
}

#[test]
fn textures_and_colours_are_read_by_the_document() {
    for kernel in KERNELS {
        for filter in [Filter::Nearest, Filter::Bilinear] {
            let mut model = tests::painted::model();
            model.render.filter = filter;
            let blob = prepared(&model, kernel);
            assert_eq!(agree(&blob, &model), Ok(()), "{kernel}");
            assert_eq!(is_painted(&blob, &model), Ok(()), "{kernel}");
            let fault = |change: &dyn Fn(&mut Model)| {
                let mut other = model.clone();
                change(&mut other);
                is_painted(&blob, &other).unwrap_err()
            };
            assert_eq!(fault(&|m| m.uvs[0] = None), "which triangles have coordinates");
            assert_eq!(fault(&|m| m.uvs[0].as_mut().unwrap()[1].y += 1e-5), "coordinates");
            assert_eq!(fault(&|m| m.uvs[0].as_mut().unwrap()[1].y += 1.0), "coordinates");
            assert_eq!(fault(&|m| m.materials[1].texture = m.materials[0].texture.clone()), "texels");
            assert_eq!(fault(&|m| m.materials[2].texture = None), "which materials have textures");
            assert_eq!(fault(&|m| m.colours[1].x *= 0.9999), "colours");
            let mut shifted = model.clone();
            let corners = shifted.uvs[0].as_mut().unwrap();
            corners.iter_mut().for_each(|uv| uv.x += 7.0);
            assert_eq!(is_painted(&blob, &shifted), Ok(()), "whole repeats change nothing");
        }
        // White ones change nothing, and are left out.
        let mut white = tests::painted::model();
        white.colours.fill(DVec3::ONE);
        let found = prepared(&white, kernel);
        assert_eq!((agree(&found, &white), is_painted(&found, &white)), (Ok(()), Ok(())));
    }
}

#[test]
fn many_colours_or_coordinates_have_wide_indices() {
    for kernel in KERNELS {
        for (n, wide) in [(254, 0), (255, 1)] {
            let mut model = carpet(n);
            model.colours = (0..(n + 1) * (n + 1))
                .map(|i| DVec3::new(f64::from(i % 256), f64::from(i / 256), 0.0) / 255.0)
                .collect();
            let found = prepared(&model, kernel);
            assert_eq!((agree(&found, &model), is_painted(&found, &model)), (Ok(()), Ok(())), "{kernel} {n}");
            assert_eq!(found.header.needs >> 24 & 1, wide, "{n}");
        }
    }
}

#[test]
fn a_single_leaf_has_no_nodes() {
    for kernel in KERNELS {
        let mut model = carpet(1);
        model.triangles.truncate(1);
        model.lights.clear();
        let found = prepared(&model, kernel);
        assert_eq!(agree(&found, &model), Ok(()), "{kernel}");
        assert_eq!((found.header.root, found.header.depth, found.nodes.len()), (1 << 31, 0, 0));
    }
}

#[test]
fn another_scene_is_told_from_the_blobs() {
    for kernel in KERNELS {
        let (model, blob) = (flat(), prepared(&flat(), kernel));
        let fault = |change: &dyn Fn(&mut Model)| {
            let mut other = model.clone();
            change(&mut other);
            agree(&blob, &other).unwrap_err()
        };
        assert_eq!(fault(&|m| m.lights.truncate(1)), "needs");
        assert_eq!(fault(&|m| m.render.size[0] += 1), "size");
        assert_eq!(fault(&|m| m.background = DVec3::new(0.0, 1e-6, 30_003.0).into()), "background");
        assert_eq!(fault(&|m| m.render.ambient.x *= 1.0001), "ambient");
        assert_eq!(fault(&|m| m.camera.position.x += 0.01), "eye");
        assert_eq!(
            fault(&|m| m.camera.projection = Projection::Perspective { fov_y: 40.4f64.to_radians() }),
            "directions"
        );
        assert_eq!(fault(&|m| m.positions[9].y += 0.01), "vertices");
        assert_eq!(fault(&|m| m.triangles[0].vertices.rotate_left(1)), "vertices");
        assert_eq!(fault(&|m| m.materials.iter_mut().for_each(|x| x.colour.y *= 0.999)), "albedo");
        assert_eq!(fault(&|m| m.lights[0].radiance.x *= 1.001), "strength of a light");
        assert_eq!(fault(&|m| m.lights[1].kind = LightKind::Directional(DVec3::X)), "direction of a light");
        assert_eq!(fault(&|m| m.lights.swap(0, 1)), "strength of a light");

        for model in [parallel(), distant()] {
            let blob = prepared(&model, kernel);
            let fault = |change: &dyn Fn(&mut Model)| {
                let mut other = model.clone();
                change(&mut other);
                agree(&blob, &other).unwrap_err()
            };
            assert_eq!(fault(&|m| m.render.format = Format::Rgb888), "needs");
            let expected = if model.render.samples == 1 { "needs" } else { "samples" };
            assert_eq!(fault(&|m| m.render.samples += 1), expected);
            let raised = |m: &mut Model| {
                m.camera.position += 0.01 * m.camera.up;
                m.camera.look_at += 0.01 * m.camera.up;
            };
            assert_eq!(fault(&raised), "origins");
            assert_eq!(fault(&|m| m.camera.projection = Projection::Orthographic { height: 3.01 }), "origins");
            let tilted =
                |m: &mut Model| m.camera.look_at += 0.02 * m.camera.position.distance(m.camera.look_at) * m.camera.up;
            assert_eq!(fault(&tilted), "origins");
        }

        let (smooth, blob) = (built_in(), prepared(&built_in(), kernel));
        let mut other = smooth.clone();
        other.normals.iter_mut().for_each(|normal| *normal = DVec3::new(normal.y, normal.x, normal.z));
        assert_eq!(agree(&blob, &other).unwrap_err(), "normals");
    }
}

#[test]
fn a_blob_that_breaks_a_rule_is_told_from_one_that_does_not() {
    for kernel in KERNELS {
        let (model, blob) = (built_in(), prepared(&built_in(), kernel));
        let fault = |change: &dyn Fn(&mut Blob)| {
            let mut other = blob.clone();
            change(&mut other);
            agree(&other, &model).unwrap_err()
        };
        assert_eq!(fault(&|b| b.nodes[0].children.swap(0, 1)), "order of nodes");
        assert_eq!(fault(&|b| b.nodes[3].boxes[1].high[2] = b.nodes[3].boxes[1].low[2] - 1), {
            let leaf = blob.nodes[3].children[1] >> 31 == 1;
            if leaf { "a vertex outside its leaf's box" } else { "a box outside its parent's" }
        });
        assert_eq!(fault(&|b| b.header.depth += 1), "depth");
        assert_eq!(fault(&|b| b.lights[0].place[1] += b.kernel.span), "span");
        assert_eq!(fault(&|b| b.header.along[2] = 1), "a direction of all rays");
        assert_eq!(fault(&|b| b.header.format = 1), "format");
        assert_eq!(fault(&|b| b.header.samples = 2), "samples");
        assert_eq!(fault(&|b| b.triangles[5].shift += 1), "shift");
        assert_eq!(fault(&|b| b.triangles[5].n[0] += 1), "n");
        assert_eq!(fault(&|b| b.ids[1] = b.ids[0]), "vertices");
        assert_eq!(fault(&|b| b.corners[7] = b.corners[7].xor(Some([0; 3]))), "which triangles are flat");
        assert_eq!(fault(&|b| b.normals[0][0] += 4), "normals");
    }
}

#[test]
fn the_checksum_is_the_usual_one_and_sees_every_bit() {
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    let blob = prepare(&built_in(), "exact14").blob;
    let covered = &blob.bytes()[..400];
    for bit in 0..8 * covered.len() {
        let mut other = covered.to_vec();
        other[bit / 8] ^= 1 << (bit % 8);
        assert_ne!(crc32(&other), crc32(covered));
    }
}
