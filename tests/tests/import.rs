//! The importer from outside: scenes on disk, good and bad, and what is said of each.

use std::path::Path;

use glam::DVec3;
use host_tools::import::{Embedded, Imported, load, load_from};
use host_tools::model::{LightKind, Model, Projection, Transfer};

/// An OBJ with the corners (0, 0, 0) and (2, 2, 2).
const ROOM: &[u8] = b"v 0 0 0\nv 2 0 0\nv 0 2 2\nusemtl wall\nf 1 2 3\n";

/// A scene of [`ROOM`] with the given lines after `model`.
fn room(lines: &str) -> Imported {
    let toml = format!("model = 'room.obj'\n{lines}");
    let files = [("s.toml", toml.as_bytes()), ("room.obj", ROOM)];
    load_from(&Embedded(&files), "s.toml").unwrap()
}

/// Vertical field of view, radians; not a number of parallel rays.
fn fov_y(model: &Model) -> f64 {
    match model.camera.projection {
        Projection::Perspective { fov_y } => fov_y,
        Projection::Orthographic { .. } => f64::NAN,
    }
}

fn warnings(imported: &Imported) -> Vec<String> {
    imported.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn files_that_cannot_be_read_as_scenes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&str, Option<&[u8]>, &str); 10] = [
        ("none.obj", None, ": no such file"),
        ("none.toml", None, ": no such file"),
        ("mesh.stl", Some(b"solid"), ": a scene is a .toml or .obj file"),
        ("mesh", Some(b"v"), ": a scene is a .toml or .obj file"),
        ("empty.obj", Some(b""), ": the file is empty"),
        ("blank.OBJ", Some(b"\n# nothing\n"), ": no faces; an OBJ scene needs at least one `f` statement"),
        ("vertices.obj", Some(b"v 0 0 0\n"), ": no faces; an OBJ scene needs at least one `f` statement"),
        ("utf16.obj", Some(b"\xff\xfev\0"), ": the file is UTF-16; save it as UTF-8 text"),
        ("png.obj", Some(b"\x89PNG\r\n\x1a\n\0"), ":1: `\u{fffd}PNG` is not an OBJ statement"),
        (
            "point.obj",
            Some(b"v 1 2 3\nv 1 2 3\nv 9 9 9\nf 1 2 1\n"),
            ": the scene has no extent: every vertex is at (1, 2, 3)",
        ),
    ];
    for (name, contents, expected) in cases {
        let path = folder.path().join(name);
        if let Some(contents) = contents {
            std::fs::write(&path, contents).unwrap();
        }
        let error = load(&path).unwrap_err().to_string();
        assert_eq!(error, format!("{}{expected}", path.display()));
    }
    let error = load(folder.path()).unwrap_err().to_string();
    let expected = ": this is a folder; name the .toml or .obj file in it";
    assert_eq!(error, format!("{}{expected}", folder.path().display()));
}

#[test]
fn a_scene_on_disk_finds_its_files_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("meshes")).unwrap();
    std::fs::write(at("meshes/Room.OBJ"), [b"mtllib m.mtl gone.mtl\n", ROOM].concat()).unwrap();
    std::fs::write(at("meshes/m.mtl"), "newmtl wall\nKd 0.1 0.2 0.3\nKe 4 5 6\n").unwrap();
    std::fs::write(at("s.toml"), "model = 'meshes/Room.OBJ'\n").unwrap();
    let imported = load(&at("s.toml")).unwrap();
    let material = &imported.model.materials[0];
    assert_eq!(material.name, "wall");
    assert_eq!(material.colour, DVec3::new(0.1, 0.2, 0.3));
    assert_eq!(material.emission, DVec3::new(4.0, 5.0, 6.0));
    let (obj, gone) = (at("meshes/Room.OBJ"), at("meshes/gone.mtl"));
    let expected = format!(
        "{}:1: material file {}: no such file; its materials are drawn in grey (Kd 0.8)",
        obj.display(),
        gone.display()
    );
    assert_eq!(warnings(&imported), [expected]);
}

#[test]
fn a_bare_obj_is_framed() {
    let imported = load_from(&Embedded(&[("room.obj", ROOM)]), "room.obj").unwrap();
    let model = imported.model;
    // The box from 0 to 2 has its centre at 1 and half a diagonal of sqrt 3; of the way to the
    // camera, (1, 0.75, 1.5) / sqrt 3.8125, sin 20 degrees is 0.3420201433256687.
    let distance = 3f64.sqrt() / 0.342_020_143_325_668_7 / 3.8125f64.sqrt();
    let position = DVec3::ONE + distance * DVec3::new(1.0, 0.75, 1.5);
    assert!((model.camera.position - position).length() < 1e-12);
    assert_eq!(model.camera.look_at, DVec3::ONE);
    assert_eq!(model.camera.up, DVec3::Y);
    assert!((fov_y(&model) - 0.698_131_700_797_731_8).abs() < 1e-15);
    assert_eq!(model.lights.len(), 1);
    assert_eq!(model.lights[0].kind, LightKind::Point(model.camera.position));
    assert_eq!(model.lights[0].radiance, DVec3::ONE);
    assert_eq!(model.background, DVec3::ZERO.into());
    assert_eq!(model.render.size, [640, 480]);
    assert_eq!(model.render.ambient, DVec3::ZERO);
    assert_eq!(model.render.transfer, Transfer::Srgb);
    // The same scene by a scene.toml that says nothing else.
    assert_eq!(room("").model, model);
}

#[test]
fn the_settings_of_a_scene_reach_the_model() {
    let imported = room(
        "transfer = 'linear'\n[camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\n\
         up = [0, 2, 1]\nfov_y = 90\n\
         [[light]]\nposition = [0, 2, 1]\ncolour = [1, 0.5, 0]\nintensity = 4\nfalloff = 'none'\n\
         [[light]]\nkind = 'directional'\ndirection = [0, -3, 0]\n\
         [background]\ncolour = [0.1, 0.2, 0.3]\n\
         [render]\nsize = [320, 200]\nsamples = 1\nmax_depth = 3\nambient = [0.4, 0.5, 0.6]\n\
         [material.wall]\nkind = 'lambert'\ncolour = [0, 0.5, 1]\n",
    );
    assert_eq!(warnings(&imported), Vec::<String>::new());
    let model = imported.model;
    assert_eq!(model.camera.position, DVec3::new(0.0, 1.0, 5.0));
    assert_eq!(model.camera.look_at, DVec3::Y);
    assert_eq!(model.camera.up, DVec3::new(0.0, 2.0, 1.0));
    assert_eq!(fov_y(&model), std::f64::consts::FRAC_PI_2);
    assert_eq!(model.lights[0].kind, LightKind::Point(DVec3::new(0.0, 2.0, 1.0)));
    assert_eq!(model.lights[0].radiance, DVec3::new(4.0, 2.0, 0.0));
    assert_eq!(model.lights[1].kind, LightKind::Directional(DVec3::new(0.0, -3.0, 0.0)));
    assert_eq!(model.lights[1].radiance, DVec3::ONE);
    assert_eq!(model.background, DVec3::new(0.1, 0.2, 0.3).into());
    assert_eq!(model.render.size, [320, 200]);
    assert_eq!(model.render.ambient, DVec3::new(0.4, 0.5, 0.6));
    assert_eq!(model.render.transfer, Transfer::Linear);
    assert_eq!(model.materials[0].colour, DVec3::new(0.0, 0.5, 1.0));
}

/// Folder and scene file; triangles, smooth triangles, materials and warnings.
type RealScene = (&'static str, usize, usize, usize, usize);

#[test]
fn real_scenes_are_imported_whole() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    if !folder.is_dir() {
        eprintln!("skipped: there is no {}", folder.display());
        return;
    }
    let scenes: [RealScene; 7] = [
        // Eighteen quads; a count that takes the CR at the line ends for corners gives 37.
        ("cornell-box/scene.toml", 36, 0, 8, 0),
        ("cornell-box/CornellBox-Original.obj", 36, 0, 8, 0),
        ("suzanne/suzanne.obj", 968, 0, 1, 1),
        ("teapot/teapot.obj", 2_256, 2_256, 1, 0),
        // One normal of length zero, at four triangles; textures.
        ("sponza-dabrovic/scene.toml", 66_454, 66_450, 19, 2),
        ("bunny/bunny_smooth.obj", 69_451, 69_451, 1, 0),
        // 3,283 of its faces have no normals.
        ("coffee/coffee.obj", 235_265, 231_982, 5, 0),
    ];
    for (name, triangles, smooth, materials, warned) in scenes {
        let imported = load(&folder.join(name)).unwrap();
        let model = &imported.model;
        assert_eq!(model.triangles.len(), triangles, "{name}");
        let with_normals = model.triangles.iter().filter(|t| t.normals.is_some()).count();
        assert_eq!(with_normals, smooth, "{name}");
        assert_eq!(model.materials.len(), materials, "{name}");
        assert_eq!(imported.warnings.len(), warned, "{name}: {:?}", warnings(&imported));
        assert_eq!(tests::fuzz::sound(model), Ok(()), "{name}");
    }
}
