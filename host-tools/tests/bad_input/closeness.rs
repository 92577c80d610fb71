//! Scenes in which a kernel's grid does not keep surfaces, sides and normals: what is said, and the kernel that keeps them.

use std::fmt::Write;

use crate::command::{Folder, text};

/// A square of a thousand units, seen from above, with more of an OBJ and of a scene file.
fn folder(obj: &str, toml: &str) -> Folder {
    let square = "v 0 0 0\nv 1000 0 0\nv 1000 0 1000\nv 0 0 1000\nf 1 3 2\nf 1 4 3\n";
    let camera = "model = 'scene.obj'\n[render]\nsize = [16, 12]\n";
    let camera = format!("{camera}[camera]\nposition = [500, 400, 900]\nlook_at = [500, 0, 500]\n{toml}");
    Folder::new(&[("scene.obj", format!("{square}{obj}").as_bytes()), ("scene.toml", camera.as_bytes())])
}

#[track_caller]
fn warned(folder: &Folder, kernel: &str, warning: &str) {
    folder.succeeds(&format!("prep scene.toml -o out.blob --kernel {kernel}"), warning);
}

#[test]
fn surfaces_that_the_grid_puts_into_one() {
    // A step of exact14 is a 32nd of a unit.
    let above = |height: &str| format!("v 100 {height} 100\nv 300 {height} 100\nv 100 {height} 300\nf -3 -1 -2\n");
    let folder_of = |height| folder(&above(height), "");
    let warning = "warning: 1 of 3 triangles are so close to another surface that the grid of exact14 may put them on its \
                   other side; exact20 keeps them all\n";
    warned(&folder_of("0.04"), "exact14", warning);
    warned(&folder_of("0.04"), "exact20", "");
    warned(&folder_of("0.08"), "exact14", "");
    // What is in one plane in the file is so on every grid, and the first is seen.
    warned(&folder_of("0"), "exact14", "");
}

#[test]
fn facets_that_face_another_way() {
    // A strip along x of triangles so many units wide, a third as steep.
    let strip = |wide: f64| {
        let mut obj = String::new();
        for i in 0..20 {
            let (x, y) = (100.0 + wide * f64::from(i), 5.0 + wide / 3.0 * f64::from(i));
            // Infallible: a string grows.
            let _ = write!(
                obj,
                "v {x} {y} 100\nv {} {} 100\nv {x} {y} {}\nf -3 -1 -2\n",
                x + wide,
                y + wide / 3.0,
                100.0 + wide
            );
        }
        folder(&obj, "")
    };
    let folder = strip(0.07);
    let output = text(&folder.run("prep scene.toml -o out.blob --kernel exact14").stderr);
    assert!(
        output.contains("22 triangles are so small that they face another way on the grid of exact14; exact20"),
        "{output}"
    );
    warned(&folder, "exact20", "");
    warned(&strip(7.0), "exact14", "");
}

#[test]
fn a_light_that_may_be_behind_a_wall() {
    let light = |height: &str| format!("[[light]]\nkind = 'point'\nposition = [500, {height}, 500]\n");
    let warning = "warning: the camera or a light is so close to a surface that the grid of exact14 may put it on the other \
                   side; exact20 does not\n";
    warned(&folder("", &light("0.01")), "exact14", warning);
    warned(&folder("", &light("0.01")), "exact20", "");
    warned(&folder("", &light("1")), "exact14", "");
    // On it, it is on neither side.
    warned(&folder("", &light("0")), "exact14", "");
}

#[test]
fn a_light_that_is_stronger_than_a_blob_holds() {
    let light = |intensity: &str| {
        format!(
            "[[light]]\nkind = 'point'\nposition = [500, 300, 500]\nintensity = {intensity}\nfalloff = 'inverse-square'\nreach = 1\n"
        )
    };
    let warning =
        "warning: inverse-square lights of over 32767 are drawn with that: 1; make their reach longer instead\n";
    warned(&folder("", &light("32769")), "exact29", warning);
    warned(&folder("", &light("32767")), "exact29", "");
}

#[test]
fn triangles_that_the_reports_box_test_passes() {
    // A step is about a 500,000th of a unit: 8192 of them, twice what differences are rounded to, are a 65th of a unit.
    let small = |wide: f64| {
        let triangle = format!("v 100 1 100\nv {} 1 100\nv 100 1 {}\nf -3 -1 -2\n", 100.0 + wide, 100.0 + wide);
        folder(&triangle, "")
    };
    let warning = "warning: the boxes of 1 of 3 triangles are smaller than what the box test of hanika-c tells apart, so that \
                   rays pass them; hanika-cons loses none\n";
    warned(&small(0.01), "hanika-c", warning);
    warned(&small(0.01), "hanika-cd", "");
    warned(&small(0.02), "hanika-c", "");
    warned(&small(0.01), "hanika-cons", "");
}
