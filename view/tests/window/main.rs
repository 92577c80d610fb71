//! `intray-view` in a window on a display of memory alone, moved by synthetic events: what is seen is what `intray render` draws,
//! bit for bit.
//!
//! What needs Xvfb is skipped where it is absent, with a line that says so; `cargo xtask test` installs it.
#![cfg(target_os = "linux")]

mod display;

use std::fs;
use std::path::Path;
use std::process::Command;

use display::{Display, Key, Session};
use host_tools::engine::{self, ENGINES};
use host_tools::import;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::render::TILE;
use tempfile::TempDir;

const SIZE: [u32; 2] = [200, 160];

/// A folder with a copy of the built-in scene.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, contents) in host_tools::builtin::FILES {
        fs::write(folder.path().join(name), contents).unwrap();
    }
    folder
}

/// What `intray render SCENE --kernel KERNEL --size SIZE` draws.
fn rendered(scene: &Path, kernel: &str, size: [u32; 2]) -> Picture {
    let mut model = import::load(scene).unwrap().model;
    model.render.size = size;
    let engine = engine::by_name(kernel).unwrap();
    let blob = engine.prepare(&model, &Options::default()).unwrap().blob;
    engine.render(blob.bytes(), TILE, &|_| ()).unwrap().picture
}

/// A window with nothing written over the picture.
fn bare<'a>(display: &'a Display, folder: &TempDir, line: &str) -> Session<'a> {
    let session = display.open(folder.path(), line);
    session.press(Key::H);
    session.press(Key::H);
    session
}

#[test]
fn a_still_picture_is_that_of_render_by_every_kernel() {
    let Some(display) = Display::start() else { return };
    let folder = folder();
    let scene = folder.path().join("scene.toml");
    let session = bare(&display, &folder, "scene.toml --size 200x160");
    let first = rendered(&scene, "exact29", SIZE);
    session.wait_for(&first);
    for (number, engine) in ENGINES.into_iter().enumerate() {
        session.press(Key::digit(number));
        session.wait_for(&rendered(&scene, engine.name(), SIZE));
    }
    // Kernels can be told apart, and so can pictures.
    assert_ne!(session.screenshot(), first);

    session.press(Key::P);
    let last = ENGINES[ENGINES.len() - 1].name();
    assert_eq!(session.line(), format!("scene-{last}-1.png: saved"));
    let saved = |number: u32| Picture::read_png(&folder.path().join(format!("scene-{last}-{number}.png"))).unwrap();
    assert_eq!(saved(1), rendered(&scene, last, SIZE));
    session.press(Key::P);
    assert_eq!(session.line(), format!("scene-{last}-2.png: saved"));
    assert_eq!(saved(2), saved(1));
    session.press(Key::ESCAPE);
    assert_eq!(session.end(), Some(0));
}

/// Spheres alone, two of which see each other.
const SPHERES: &str = "[camera]\nposition = [0.4, 0.3, 3]\nlook_at = [0, 0, 0]\n\
    [[sphere]]\ncentre = [-0.5, 0, 0]\nradius = 0.5\nmaterial = 'chrome'\n\
    [[sphere]]\ncentre = [0.6, 0.1, 0.2]\nradius = 0.4\nmaterial = 'red'\n\
    [material.chrome]\nkind = 'mirror'\ncolour = [0.9, 0.9, 0.9]\n[material.red]\ncolour = [0.9, 0.1, 0.1]\n\
    [[light]]\nkind = 'directional'\ndirection = [-1, -2, -1]\n";

#[test]
fn the_tracer_of_spheres_is_switched_to_where_there_are_spheres_alone() {
    let Some(display) = Display::start() else { return };
    let folder = folder();
    let spheres = folder.path().join("spheres.toml");
    fs::write(&spheres, SPHERES).unwrap();
    let planes = Key::digit(ENGINES.len());
    let session = bare(&display, &folder, "spheres.toml --size 200x160");
    session.wait_for(&rendered(&spheres, "exact29", SIZE));
    session.press(planes);
    let first = rendered(&spheres, "planes12", SIZE);
    session.wait_for(&first);
    assert_ne!(first, rendered(&spheres, "exact29", SIZE));
    // It moves, too.
    session.hold(&[Key::W, Key::D], 300);
    session.press(Key::O);
    assert_eq!(session.line(), "spheres.toml: the camera is written");
    let moved = rendered(&spheres, "planes12", SIZE);
    assert_ne!(moved, first);
    session.wait_for(&moved);
    session.press(Key::P);
    assert_eq!(session.line(), "spheres-planes12-1.png: saved");
    drop(session);

    let session = bare(&display, &folder, "scene.toml --size 200x160 --kernel exact20");
    let expected = rendered(&folder.path().join("scene.toml"), "exact20", SIZE);
    session.wait_for(&expected);
    session.press(planes);
    let warning = session.warning();
    assert!(warning.starts_with("warning: planes12 traces spheres alone, and the scene has "), "{warning}");
    assert!(ENGINES.into_iter().all(|engine| warning.contains(engine.name())), "{warning}");
    session.wait_for(&expected);
}

#[test]
fn samples_of_paths_add_up_to_the_picture_of_render() {
    let Some(display) = Display::start() else { return };
    let folder = folder();
    let scene = folder.path().join("scene.toml");
    let text = fs::read_to_string(&scene).unwrap().replace("[render]", "[render]\npaths = true\nsamples = 10");
    fs::write(&scene, text).unwrap();
    let session = bare(&display, &folder, "scene.toml --size 120x90");
    let still = rendered(&scene, "exact29", [120, 90]);
    session.wait_for(&still);
    session.press(Key::digit(2));
    session.wait_for(&rendered(&scene, "exact14", [120, 90]));
    session.press(Key::digit(0));
    session.hold(&[Key::W, Key::D], 300);
    session.press(Key::O);
    assert_eq!(session.line(), "scene.toml: the camera is written");
    let moved = rendered(&scene, "exact29", [120, 90]);
    assert_ne!(moved, still);
    session.wait_for(&moved);
    // As many samples as the scene says, and not one less.
    let fewer = fs::read_to_string(&scene).unwrap().replace("samples = 10", "samples = 8");
    fs::write(&scene, fewer).unwrap();
    assert_ne!(rendered(&scene, "exact29", [120, 90]), moved);
}

#[test]
fn one_moves_by_keys_and_mouse_and_the_camera_goes_to_the_scene() {
    let Some(display) = Display::start() else { return };
    let folder = folder();
    let scene = folder.path().join("scene.toml");
    let before = fs::read_to_string(&scene).unwrap();
    let session = bare(&display, &folder, "scene.toml --size 200x160 --kernel exact20");
    session.wait_for(&rendered(&scene, "exact20", SIZE));
    for move_on in [
        &(|| session.hold(&[Key::W, Key::D], 300)) as &dyn Fn(),
        &|| session.drag([100, 80], [130, 60]),
        // Out of the box, and of its grid.
        &|| session.hold(&[Key::S], 900),
        &|| session.wheel(true, 3),
    ] {
        let old = fs::read_to_string(&scene).unwrap();
        move_on();
        session.press(Key::O);
        assert_eq!(session.line(), "scene.toml: the camera is written");
        assert_ne!(fs::read_to_string(&scene).unwrap(), old);
        session.wait_for(&rendered(&scene, "exact20", SIZE));
    }
    let of_camera = |line: &&str| ["position = ", "look_at = ", "fov_y = "].iter().any(|key| line.starts_with(key));
    let after = fs::read_to_string(&scene).unwrap();
    let changed = before.lines().zip(after.lines()).filter(|(old, new)| old != new);
    assert!(changed.clone().count() == 3 && changed.clone().all(|(old, _)| of_camera(&old)), "{after}");
    assert_eq!(before.lines().count(), after.lines().count());

    session.press(Key::R);
    fs::write(&scene, before).unwrap();
    session.wait_for(&rendered(&scene, "exact20", SIZE));
}

#[test]
fn a_window_of_almost_nothing_goes_on() {
    let Some(display) = Display::start() else { return };
    let folder = folder();
    let scene = folder.path().join("scene.toml");
    let session = bare(&display, &folder, "scene.toml --size 200x160");
    session.wait_for(&rendered(&scene, "exact29", SIZE));
    for size in [[1, 1], [1, 90], [90, 1], [3, 2], [151, 77]] {
        session.resize(size);
        session.wait_for(&rendered(&scene, "exact29", size));
        session.hold(&[Key::LEFT], 40);
        session.press(Key::R);
    }
    session.wait_for(&rendered(&scene, "exact29", [151, 77]));
}

#[test]
fn a_mesh_alone_has_its_light_at_the_camera() {
    let Some(display) = Display::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mesh.obj"), "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 2 3\nf 1 3 4\nf 1 4 2\n")
        .unwrap();
    let obj = folder.path().join("mesh.obj");
    let session = bare(&display, &folder, "mesh.obj --size 120x90");
    session.wait_for(&rendered(&obj, "exact29", [120, 90]));
    session.press(Key::O);
    let refusal = "mesh.obj: not a scene.toml, so there is no place for a camera; make one with model = \"mesh.obj\"";
    assert_eq!(session.warning(), format!("warning: {refusal}"));
    drop(session);

    // In a scene.toml the camera takes the light along.
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, "model = 'mesh.obj'\n").unwrap();
    let session = bare(&display, &folder, "scene.toml --size 120x90");
    session.wait_for(&rendered(&obj, "exact29", [120, 90]));
    session.hold(&[Key::W, Key::E], 300);
    session.press(Key::O);
    assert_eq!(session.line(), "scene.toml: the camera is written");
    session.wait_for(&rendered(&scene, "exact29", [120, 90]));
}

#[test]
fn a_panel_shows_what_the_chip_would() {
    let Some(display) = Display::start() else { return };
    let folder = folder();
    // What the board has no room for, so that no firmware is built here.
    let session = bare(&display, &folder, "scene.toml --size 200x160 --board microbit --panel 64x48 --kernel f64");
    let mut model = import::load(&folder.path().join("scene.toml")).unwrap().model;
    (model.render.size, model.render.format) = ([64, 48], host_tools::model::Format::Rgb565);
    let f64 = engine::by_name("f64").unwrap();
    let blob = f64.prepare(&model, &Options::default()).unwrap().blob;
    let panel = f64.render(blob.bytes(), TILE, &|_| ()).unwrap().picture;
    // Three times as large, in the middle.
    let expected = Picture::from_fn(200, 160, |x, y| {
        let inside = (4..196).contains(&x) && (8..152).contains(&y);
        if inside { panel.pixels()[((y - 8) / 3 * 64 + (x - 4) / 3) as usize] } else { [0x20; 3] }
    });
    session.wait_for(&expected);
}

/// The command without a display.
fn without_display(folder: &TempDir, line: &str) -> (String, String, Option<i32>) {
    let output = Command::new(env!("CARGO_BIN_EXE_intray-view"))
        .args(line.split(' '))
        .current_dir(folder.path())
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(output.stdout), text(output.stderr), output.status.code())
}

#[test]
fn without_a_display_it_offers_render() {
    let folder = folder();
    let (stdout, stderr, status) = without_display(&folder, "scene.toml");
    assert_eq!((stdout.as_str(), status), ("", Some(2)));
    assert!(stderr.starts_with("error: there is no display ("), "{stderr}");
    assert!(stderr.ends_with("); `intray render scene.toml -o PNG` draws without one\n"), "{stderr}");
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
}

#[test]
fn what_cannot_be_viewed_is_refused() {
    let folder = folder();
    fs::write(folder.path().join("scene.blob"), "bytes").unwrap();
    fs::write(folder.path().join("bad.toml"), "model = 'demo.obj'\n[camera]\nfov = 3\n").unwrap();
    let triangles = host_tools::import::load(&folder.path().join("scene.toml")).unwrap().model.triangles.len();
    let refusal = format!(
        "error: scene.toml: planes12 traces spheres alone, and the scene has {triangles} triangles; for these there are exact29, \
         exact20, exact14, hanika-c, hanika-cd, hanika-cons, f32, f64\n"
    );
    for (line, message) in [
        ("scene.toml --kernel planes12", refusal.as_str()),
        ("none.toml", "error: none.toml: no such file\n"),
        (
            "scene.blob",
            "error: scene.blob: not a scene.toml or an .obj; a blob has its camera in it, so give the scene that it was made \
             from\n",
        ),
        ("bad.toml", "error: bad.toml:3: unknown key `fov`; the nearest known one is `fov_y`\n"),
    ] {
        assert_eq!(without_display(&folder, line), (String::new(), message.into(), Some(2)), "{line}");
    }
    for line in
        ["scene.toml --kernel exact41", "scene.toml --size 0x9", "scene.toml --board nano", "scene.toml --panel 9"]
    {
        let (stdout, stderr, status) = without_display(&folder, line);
        assert_eq!((stdout.as_str(), status), ("", Some(2)), "{line}");
        assert!(stderr.starts_with("error: invalid value '"), "{stderr}");
    }
}

#[test]
fn a_measurement_needs_no_display() {
    let folder = folder();
    let (stdout, stderr, status) = without_display(&folder, "scene.toml --measure --size 32x24");
    assert_eq!(status, Some(0), "{stderr}");
    assert!(stderr.starts_with("there is no display (") && stderr.ends_with("), so frames go to memory\n"), "{stderr}");
    let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((&report["kernel"], &report["window"]), (&"exact29".into(), &false.into()));
    assert_eq!([&report["width"], &report["draft_width"], &report["draft_height"]], [32, 16, 12]);
    assert!(report["frames_per_second"].as_f64() >= report["frames_per_second_least"].as_f64());
    assert!(report["full_ms"].as_f64().unwrap() > 0.0);
}
