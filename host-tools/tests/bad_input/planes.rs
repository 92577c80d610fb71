//! Scenes and arguments that the tracer of 1994 and its machine refuse.

use crate::command::Folder;

const SPHERE: &str = "[[sphere]]\ncentre = [0, 0, 0]\nradius = 0.2\n[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\n[render]\nsize = [16, 12]\n";

fn folder(toml: &str) -> Folder {
    let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    Folder::new(&[("scene.toml", toml.as_bytes()), ("a.obj", triangle)])
}

#[test]
fn scenes_that_it_does_not_know() {
    let spheres = folder(SPHERE);
    spheres.succeeds("render scene.toml --kernel planes12 -o out.png", "");
    spheres.succeeds("pixel-planes scene.toml -o out.png", "");
    spheres.succeeds("render scene.toml --kernel planes12 --samples 4 -o out.png", "");
    spheres.succeeds("render scene.toml --kernel planes12 --samples 4 --paths -o out.png", "");
    spheres.succeeds(
        "pixel-planes scene.toml --samples 4 --paths -o out.png",
        "warning: the machine is the text's, whose program follows no paths; `intray render --kernel planes12` does\n\
         warning: the machine is the text's, with one ray through the middle of each pixel; `intray render --kernel planes12` has more\n",
    );
    let triangles = folder("model = \"a.obj\"\n");
    for line in [
        "render scene.toml --kernel planes12 -o out.png",
        "pixel-planes scene.toml",
        "trace scene.toml --kernel planes12 --rays - -o out.csv",
        "emulate scene.toml --kernel planes12 --board microbit -o out.png",
    ] {
        triangles.refuses(
            line,
            "error: scene.toml: planes12 traces spheres alone, and the scene has 1 triangles; use --kernel exact29, or exact14 for \
             a chip\n",
        );
    }
    for line in [
        "prep scene.toml --kernel planes12 -o out.blob",
        "inspect scene.toml --kernel planes12",
        "flash scene.toml --kernel planes12 --board pico --uf2 out.uf2",
    ] {
        spheres.refuses(
            line,
            "error: planes12, the tracer of 1994, draws spheres alone and has no blobs: render, trace, emulate, report, stress, \
             pixel-planes and view know it; choose another kernel, such as exact29, or exact14 for a chip\n",
        );
    }
    spheres.refuses(
        "emulate scene.toml --kernel planes12 --board microbit --hits tile -o out.png",
        "error: --hits and --breakdown are of kernels with a tree; planes12 has neither\n",
    );
    spheres.refuses(
        "render scene.toml --kernel planes12 --format rgb565 -o out.png",
        "error: --leaf, --prefer, --grid-bits, --format and the knobs of arithmetic are other kernels'; planes12 has none of them\n",
    );
}

#[test]
fn machines_that_there_cannot_be() {
    let spheres = folder(SPHERE);
    for (arguments, error) in [
        (
            "--local-bits 100",
            "scene.toml: `camera ray` needs 146 bits at once, and a processor has 100; widen it or narrow the words",
        ),
        ("--backing-bits 32", "scene.toml: 352 bits are swapped out, and the backing store has 32"),
        ("--coordinate-bits 16", "components of 16 bits; there are 4 to 15"),
        ("--t-bits 11", "a fraction of t of 11 bits; there are 0 to 10"),
        (
            "--direction 4000",
            "scene.toml: directions of length 4000; there are lengths of 1 to 2047 in components of 12 bits",
        ),
        ("--clock 0", "--clock 0: expected a number of MHz above 0"),
    ] {
        spheres.refuses(&format!("pixel-planes scene.toml {arguments}"), &format!("error: {error}\n"));
    }
}
