//! Scenes that a kernel's grid is too coarse for: what is lost, and the kernel that keeps it.

use std::fmt::Write;

use crate::command::Folder;

/// Two triangles that are so many units wide, `small` ones of a hundredth of a unit in a material of their own, and one of the
/// other material a unit wide.
fn obj(wide: u32, small: usize) -> String {
    let mut obj = format!("mtllib scene.mtl\nusemtl stone\nv 0 0 0\nv {wide} 0 0\nv {wide} 0 {wide}\nv 0 0 {wide}\n");
    obj += "f 1 2 3\nf 1 3 4\nv 1 1 1\nv 2 1 1\nv 1 2 1\nf 5 6 7\nusemtl leaf\n";
    for i in 0..small {
        let x = i as f64 + 0.2;
        // Infallible: a string grows.
        let _ = writeln!(obj, "v {x} 1 0\nv {} 1 0\nv {x} 1.01 0\nf -3 -2 -1", x + 0.01);
    }
    obj
}

fn folder(obj: &str, toml: &str) -> Folder {
    let mtl = b"newmtl stone\nKd 0.5 0.5 0.5\nnewmtl leaf\nKd 0 1 0\n";
    Folder::new(&[("scene.obj", obj.as_bytes()), ("scene.mtl", mtl), ("scene.toml", toml.as_bytes())])
}

/// A scene seen from within, so that the grid is the geometry's.
const WITHIN: &str =
    "model = 'scene.obj'\n[camera]\nposition = [3, 2, 9]\nlook_at = [0, 1, 0]\n[render]\nsize = [16, 12]\n";

/// A scene with a light so far away.
fn lit_from(distance: &str) -> String {
    format!("{WITHIN}[[light]]\nkind = 'point'\nposition = [0, {distance}, 0]\n")
}

#[track_caller]
fn warned(folder: &Folder, kernel: &str, warnings: &str) {
    for line in ["prep scene.toml -o out.blob", "render scene.toml -o out.png", "inspect scene.toml"] {
        folder.succeeds(&format!("{line} --kernel {kernel}"), warnings);
    }
}

#[test]
fn triangles_that_collapse() {
    let wide = folder(&obj(1000, 7), WITHIN);
    warned(
        &wide,
        "exact14",
        "warning: 7 of 10 triangles have no area on the grid and were left out (7 with two corners in one point, 0 with all \
         three in a line)\n\
         warning: 70.0 % of the triangles are too small for the grid of exact14, all of `leaf`; exact20 keeps them all\n",
    );
    warned(&wide, "exact20", "");
    let wider = folder(&obj(4_000_000, 7), WITHIN);
    warned(
        &wider,
        "exact20",
        "warning: 7 of 10 triangles have no area on the grid and were left out (7 with two corners in one point, 0 with all \
         three in a line)\n\
         warning: 70.0 % of the triangles are too small for the grid of exact20, all of `leaf`; exact29 keeps them all\n",
    );
    warned(&wider, "exact29", "");
    let widest = folder(&obj(500_000_000, 7), WITHIN);
    let left_out = "triangles have no area on the grid and were left out";
    let of_leaf = "of the triangles are too small for the grid of";
    warned(
        &widest,
        "exact14",
        &format!(
            "warning: 8 of 10 {left_out} (8 with two corners in one point, 0 with all three in a line)\n\
             warning: 80.0 % {of_leaf} exact14, all of `leaf`; exact29 keeps all but 7\n"
        ),
    );
    warned(
        &widest,
        "exact29",
        &format!(
            "warning: 7 of 10 {left_out} (7 with two corners in one point, 0 with all three in a line)\n\
             warning: 70.0 % {of_leaf} exact29, all of `leaf`, and no kernel keeps more; make what is large smaller, or leave \
             it out\n"
        ),
    );
}

/// A hundredth of the triangles may collapse, unless they are all of a material.
#[test]
fn few_triangles_that_collapse() {
    // A step of the grid is 3 units; corners are 100 apart, but for the last triangles'.
    let scene = |collapsing: usize| {
        let mut obj = String::from("v 0 0 0\nv 100000 0 0\nv 0 0 100000\nf 1 2 3\n");
        for i in 0..199 {
            let (x, side) = (200 * i, if i < 199 - collapsing { 100.0 } else { 0.01 });
            let _ = writeln!(obj, "v {x} 1 0\nv {} 1 0\nv {x} {} 0\nf -3 -2 -1", x as f64 + side, 1.0 + side);
        }
        // The eye well above the ground, in steps.
        folder(&obj, &WITHIN.replace("[3, 2, 9]", "[3, 90, 9]"))
    };
    let left_out = |n: usize| {
        format!(
            "warning: {n} of 200 triangles have no area on the grid and were left out ({n} with two corners in one point, 0 \
             with all three in a line)\n"
        )
    };
    warned(&scene(2), "exact14", &left_out(2));
    let lost = "warning: 1.5 % of the triangles are too small for the grid of exact14; exact20 keeps all but 2\n";
    warned(&scene(3), "exact14", &(left_out(3) + lost));
    // What has no area in the file has none for any kernel.
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\nf 2 2 2\n";
    let left_out = "warning: 2 of 3 triangles have no area on the grid and were left out (2 with two corners in one point, 0 \
                    with all three in a line)\n";
    warned(&folder(obj, WITHIN), "exact14", left_out);
}

#[test]
fn a_light_or_a_camera_that_is_far_away() {
    let near = folder(&obj(16, 0), &lit_from("40"));
    warned(&near, "exact14", "");
    let far = folder(&obj(16, 0), &lit_from("20000"));
    warned(
        &far,
        "exact14",
        "warning: the camera or a light is so far from the triangles that 5 of the 15 bits of exact14 are left for them; use \
         exact29, which keeps 19, bring it closer, or make the light directional\n",
    );
    warned(&far, "exact29", "");
    let farther = folder(&obj(16, 0), &lit_from("1e7"));
    let nothing_finer = "warning: the camera or a light is so far from the triangles that 10 of the 29 bits of exact29 are \
                         left for them; bring it closer, or make the light directional\n";
    warned(&farther, "exact29", nothing_finer);
    let camera = WITHIN.replace("[3, 2, 9]", "[0, 0, 1e7]");
    warned(&folder(&obj(16, 0), &camera), "exact29", nothing_finer);
}

#[test]
fn nothing_is_left_but_another_kernel_keeps_it() {
    let folder = folder(&obj(2, 0), &lit_from("2e5"));
    for line in ["prep scene.toml -o out.blob", "render scene.toml -o out.png", "inspect scene.toml"] {
        folder.refuses(
            &format!("{line} --kernel exact14"),
            "error: scene.toml: none of 3 triangles has an area on the 15-bit grid of exact14, so nothing is left to render; \
             exact20 keeps 3 of them, or bring the camera and the lights closer to them, or make the lights directional\n",
        );
    }
}

#[test]
fn grids_that_the_kernel_has_not() {
    let folder = folder(&obj(1, 0), WITHIN);
    for (kernel, bits, most) in [("exact14", 16, 15), ("exact29", 30, 29), ("exact29", 7, 29), ("f32", 25, 24)] {
        folder.refuses(
            &format!("prep scene.toml --kernel {kernel} --grid-bits {bits} -o out.blob"),
            &format!("error: scene.toml: a grid of {bits} bits; {kernel} has grids of 8 to {most}\n"),
        );
    }
}

#[test]
fn budgets_that_are_none() {
    let folder = folder(&obj(1, 0), WITHIN);
    for (text, wrong) in [("over_4>3", "over_4>3"), ("flip<1,over_5<1", "over_5<1"), ("psnr>40@0x0", "psnr>40@0x0")] {
        let output = folder.run(&format!("prep scene.toml --budget {text} -o out.blob"));
        assert_eq!(output.status.code(), Some(2));
        let message = format!("`{wrong}` is no bound; it is a measure, `<`, `<=`, `>` or `>=`, a number");
        assert!(crate::command::text(&output.stderr).contains(&message), "{text}");
    }
    folder.refuses(
        "prep scene.toml --budget over_4<3@8x8 --size 9x8 -o out.blob",
        "error: --size is 9x8, and the budget is for 8x8; leave one out\n",
    );
    let output = folder.run("prep scene.toml --budget over_4<3 --kernel exact14 -o out.blob");
    assert_eq!(output.status.code(), Some(2));
    assert!(crate::command::text(&output.stderr).contains("cannot be used with"));
    assert_eq!(folder.contents().len(), 3, "nothing was written");
}

/// A scene that no kernel draws without a pixel's difference, as the light comes at an angle that none has.
#[test]
fn a_budget_that_no_kernel_stays_inside() {
    let scene = format!("{WITHIN}[[light]]\nkind = 'directional'\ndirection = [0.3, -0.8, 0.1]\nintensity = 0.7\n");
    let folder = folder(&obj(40, 0), &scene);
    let output = folder.run("prep scene.toml --budget flip<0 -o out.blob");
    let errors = crate::command::text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    let tried: Vec<&str> = errors.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(tried, ["exact14", "exact20", "exact29", "error:"], "{errors}");
    assert!(errors.contains("error: scene.toml: no kernel stays inside the budget; the closest: exact29"), "{errors}");
    assert_eq!(folder.contents().len(), 3, "nothing was written");
}
