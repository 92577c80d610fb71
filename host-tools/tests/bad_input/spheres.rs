//! Spheres that a kernel's grid is too coarse for.

use std::fmt::Write;

use crate::command::Folder;

/// A sphere that is so large, and one of a hundredth of a unit.
fn folder(large: &str) -> Folder {
    let mut toml = String::from("[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n[render]\nsize = [16, 12]\n");
    for (x, radius) in [("0", large), ("2", "0.01")] {
        // Infallible: a string grows.
        let _ = writeln!(toml, "[[sphere]]\ncentre = [{x}, 0, 0]\nradius = {radius}");
    }
    Folder::new(&[("scene.toml", toml.as_bytes())])
}

#[track_caller]
fn warned(folder: &Folder, kernel: &str, warnings: &str) {
    for line in ["prep scene.toml -o out.blob", "render scene.toml -o out.png", "inspect scene.toml"] {
        folder.succeeds(&format!("{line} --kernel {kernel}"), warnings);
    }
}

#[test]
fn spheres_that_are_too_small() {
    let wide = folder("1000");
    let small = "warning: 1 of 2 spheres are too small for the grid of";
    warned(&wide, "exact14", &format!("{small} exact14 and were left out; exact20 keeps them all\n"));
    warned(&wide, "exact20", "");
    warned(&wide, "hanika-cd", "");
    warned(
        &folder("1e7"),
        "exact20",
        &format!(
            "{small} exact20 and were left out, and no kernel keeps more; make what is large smaller, or leave it out\n"
        ),
    );
}

#[test]
fn nothing_is_left() {
    let toml = "[camera]\nposition = [0, 0, 1e6]\nlook_at = [0, 0, 0]\n[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\n";
    let folder = Folder::new(&[("scene.toml", toml.as_bytes())]);
    folder.refuses(
        "render scene.toml -o out.png --kernel exact14",
        "error: scene.toml: none of 1 spheres has a size on the 15-bit grid of exact14, so nothing is left to render; \
         exact29 keeps 1 of them, or bring the camera and the lights closer to them, or make the lights directional\n",
    );
}
