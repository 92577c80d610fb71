//! A `scene.toml` that says what cannot be.

use host_tools::picture::Picture;

use crate::command::Folder;

/// Renders `scene.toml`, which is `model = "scene.obj"` and these lines, and expects the message with its line.
#[track_caller]
fn refused(lines: &str, message: &str) {
    let folder = Folder::with_triangle();
    folder.write("scene.toml", format!("model = \"scene.obj\"\n{lines}\n").as_bytes());
    folder.refuses("render scene.toml -o out.png", &format!("error: scene.toml:{message}\n"));
}

#[test]
fn keys_and_values_of_the_wrong_kind() {
    for (lines, message) in [
        ("transfr = 'srgb'", "2: unknown key `transfr`; the nearest known one is `transfer`"),
        ("[camera]\nfov = 40", "3: unknown key `fov`; the nearest known one is `fov_y`"),
        ("[[light]]\ncolor = [1, 1, 1]", "3: unknown key `color`; the nearest known one is `colour`"),
        ("transfer = 'rgb'", "2: unknown value `rgb`; the nearest known one is `srgb`"),
        ("[camera]\nfov_y = 'wide'", "3: invalid type: string \"wide\", expected a number"),
        ("[camera]\nposition = 1", "3: invalid type: integer `1`, expected three numbers such as [0, 1, 5]"),
        ("[camera]\nposition = [0, 1]", "3: invalid length 2, expected three numbers such as [0, 1, 5]"),
        ("[camera]\nposition = [0, 1, 'x']", "3: invalid type: string \"x\", expected a number"),
        ("[camera]\nposition = [0, nan, 5]", "3: NaN is not a finite number"),
        ("[camera]\nfov_y = inf", "3: inf is not a finite number"),
        ("[[light]]\nposition = [0, 0, 0]\nintensity = nan", "4: NaN is not a finite number"),
        ("camera = 3", "2: invalid type: integer `3`, expected a table such as [camera]"),
        ("light = 3", "2: invalid type: integer `3`, expected an array"),
        ("[light]", "2: there may be several of these; double the brackets, such as [[light]]"),
        ("material = 3", "2: invalid type: integer `3`, expected a table"),
        ("[render]\nsize = '640x480'", "3: invalid type: string \"640x480\", expected an array"),
        ("[render]\nsize = [99999999999999999999, 1]", {
            "3: invalid type: integer `99999999999999999999`, expected a number"
        }),
        ("[camera", "2: unclosed table, expected `]`"),
        ("model = 'other.obj'", "2: duplicate key"),
    ] {
        refused(lines, message);
    }
}

#[test]
fn the_model() {
    for (text, message) in [
        ("transfer = 'srgb'\n", "1: `model` is missing; name an OBJ file, such as model = \"room.obj\""),
        ("model = 3\n", "1: invalid type: integer `3`, expected a string"),
        ("\nmodel = 'none.obj'\n", "2: model none.obj: no such file"),
        ("model = 'scene.toml'\n", "1: model scene.toml: a model is an .obj file"),
        ("model = scene.obj\n", "1: string values must be quoted, expected literal string"),
    ] {
        let folder = Folder::with_triangle();
        folder.write("scene.toml", text.as_bytes());
        folder.refuses("render scene.toml -o out.png", &format!("error: scene.toml:{message}\n"));
    }
    // What is wrong with the OBJ is said of the OBJ.
    let folder = Folder::new(&[("scene.toml", b"model = 'scene.obj'"), ("scene.obj", b"v 1 2\n")]);
    folder.refuses("inspect scene.toml", "error: scene.obj:1: too few numbers: 2 of at least 3\n");
}

#[test]
fn cameras_that_see_nothing() {
    for (lines, message) in [
        (
            "[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 3]",
            "4: the camera is at its own look_at; move one of them",
        ),
        ("[camera]\nfov_y = 0", "3: fov_y of 0 degrees; it must be above 0 and below 180"),
        ("[camera]\nfov_y = 400", "3: fov_y of 400 degrees; it must be above 0 and below 180"),
        ("[camera]\nfov_y = -40", "3: fov_y of -40 degrees; it must be above 0 and below 180"),
        (
            "[camera]\nposition = [0, 5, 0]\nlook_at = [0, 0, 0]",
            "2: up is parallel to the view; give an up that is upwards in the picture",
        ),
        ("[camera]\nposition = [0, 5, 0]", "3: a position needs a look_at as well"),
    ] {
        refused(lines, message);
    }
}

#[test]
fn pictures_that_cannot_be() {
    for size in
        ["[0, 480]", "[640, 0]", "[640, -480]", "[640.5, 480]", "[640]", "[16385, 1]", "[16384, 16384]", "[1e300, 1]"]
    {
        refused(
            &format!("[render]\nsize = {size}"),
            "3: size must be a width and a height in whole pixels, such as [640, 480]; a picture has 1 to 16384 pixels a \
             side, and at most 67108864 in all",
        );
    }
}

#[test]
fn samples_and_formats_that_cannot_be() {
    for (lines, message) in [
        ("samples = 0", "3: samples of 0; it must be a whole number from 1 to 1024"),
        ("samples = 1025", "3: samples of 1025; it must be a whole number from 1 to 1024"),
        ("samples = 4.5", "3: samples of 4.5; it must be a whole number from 1 to 1024"),
        ("format = 'rgb666'", "3: unknown value `rgb666`; the nearest known one is `rgb565`"),
        ("format = 16", "3: wanted string or table"),
    ] {
        refused(&format!("[render]\n{lines}"), message);
    }
}

/// A camera or a light so far away that the geometry is a point on the grid.
#[test]
fn distances_beyond_the_grid() {
    for lines in ["[camera]\nposition = [1e30, 0, 0]\nlook_at = [0, 0, 0]", "[[light]]\nposition = [0, 0, 1e30]"] {
        refused(
            lines,
            " none of 1 triangles has an area on the 29-bit grid of exact29, so nothing is left to render; check the \
             vertices, or bring the camera and the lights closer to them, or make the lights directional",
        );
    }
}

/// What is strange and can be drawn all the same.
#[test]
fn extremes_that_are_good() {
    for lines in [
        "[camera]\nposition = [1e8, 3, 0]\nlook_at = [0, 0, 0]",
        "[camera]\nposition = [3, 3, 0]\nlook_at = [0, 0, 0]\nfov_y = 179.99999999999",
        "[camera]\nposition = [3, 3, 0]\nlook_at = [0, 0, 0]\nfov_y = 1e-310",
        "[camera]\nposition = [3, 3, 0]\nlook_at = [0, 0, 0]\nup = [0, 1e-30, 0]",
        "[camera]\nposition = [0.5, 0.5, 0.5]\nlook_at = [0.5000000001, 0.5, 0.5]",
        "[camera]\nposition = [3, 3, 0]\nlook_at = [0, 0, 0]\nprojection = 'orthographic'\nheight = 1e-30",
        "[camera]\nposition = [3e15, 3e15, 0]\nlook_at = [0, 0, 0]\nprojection = 'orthographic'\nheight = 2\n[[light]]\nposition = [0, 0, 2]",
        "[camera]\nposition = [0.3, 0.3, 0]\nlook_at = [0, 0, 0]\nprojection = 'orthographic'\nheight = 2",
        "[camera]\nposition = [3, 3, 0]\nlook_at = [0, 0, 0]\nfov_y = 179.99999999999\n[render]\nsamples = 1024",
        "[[light]]\nposition = [0, 0, 1e8]\nintensity = 1e30\ncolour = [1e30, 1, 1e-30]",
        "[[light]]\nkind = 'directional'\ndirection = [0, 1e-30, 0]",
        "[[light]]\nposition = [0.5, 0.5, 0.5]\nintensity = 0",
        "[background]\ncolour = [1e30, 0, 0]\n[render]\nambient = [1e-30, 1e30, 0]",
    ] {
        for kernel in ["exact29", "exact14"] {
            let folder = Folder::with_triangle();
            folder.write("scene.toml", format!("model = 'scene.obj'\n{lines}\n").as_bytes());
            // What is far takes bits; `kernels` has what is said then.
            if !lines.contains("1e8") {
                folder.succeeds(&format!("render scene.toml --size 9x7 --kernel {kernel} -o out.png"), "");
            }
        }
    }
}

#[test]
fn materials_that_cannot_be() {
    for (lines, message) in [
        ("[material.default]\nior = 0", "3: ior of 0; it must be from 0.1 to 10"),
        ("[material.default]\nior = nan", "3: NaN is not a finite number"),
        ("[material.default]\ncolour = [0, -1, 0]", {
            "3: colour [0, -1, 0] is out of range; each channel is from 0 to 1.0"
        }),
        ("[material.default]\nexponent = 20000", "3: exponent of 20000; it must be from 1 to 10000"),
        ("[material.default]\nweights = [1, 0, 0]", "3: invalid length 3, expected an array of length 4"),
        ("[material.unused]\nkind = 'glass'", "3: unknown value `glass`; the nearest known one is `metal`"),
        ("[[sphere]]\ncentre = [0, 0, 0]\nradius = 0", "4: radius of 0; it must be above 0 and at most 1e30"),
    ] {
        refused(lines, message);
    }
}

/// Lights and cameras where they hardly can be, and surfaces that show nothing of their own: never a silent black picture.
#[test]
fn what_is_asked_for_is_drawn() {
    const SPHERE: &str = "[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nmaterial = 'default'\n";
    for lines in [
        "[camera]\nprojection = 'orthographic'\nheight = 3",
        "[[light]]\nposition = [0.2, 0.2, 3]\nfalloff = 'inverse-square'\nreach = 3",
        "[background]\nsky = [[0, 0, 0], [1, 1, 1]]",
        "[material.default]\nkind = 'mirror'\n[background]\ncolour = [1, 1, 1]",
        "[material.default]\nkind = 'dielectric'\nweights = [0, 0.5, 0.1, 0.8]\n[background]\ncolour = [1, 1, 1]",
        // A light inside a surface, in it, and at the camera.
        "[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nmaterial = 'default'\n[[light]]\nposition = [0, 0, 0]\n[render]\nambient = [0.5, 0.5, 0.5]",
        "[[light]]\nposition = [0.25, 0.25, 0]\n[render]\nambient = [0.5, 0.5, 0.5]",
        "[camera]\nposition = [0, 0, 3]\nlook_at = [0.2, 0.2, 0]\n[[light]]\nposition = [0, 0, 3]\nfalloff = 'inverse-square'\nreach = 2",
        // A camera inside glass.
        "[[sphere]]\ncentre = [0, 0, 3]\nradius = 1\nmaterial = 'default'\n[camera]\nposition = [0, 0, 3.2]\nlook_at = [0.2, 0.2, 0]\n\
         [material.default]\nkind = 'dielectric'\nior = 1.5\n[background]\ncolour = [1, 1, 1]",
    ] {
        let folder = Folder::with_triangle();
        folder.write("scene.toml", format!("model = 'scene.obj'\n{lines}\n").as_bytes());
        for kernel in ["exact14", "exact29", "hanika-cons", "f32"] {
            folder.succeeds(&format!("render scene.toml --size 9x7 --kernel {kernel} -o out.png"), "");
            let picture = Picture::read_png(&folder.path("out.png")).unwrap();
            assert!(picture.pixels().iter().any(|pixel| *pixel > [100; 3]), "{lines}");
        }
    }
    let folder = Folder::with_triangle();
    folder.write("scene.toml", format!("{SPHERE}[material.default]\nkind = 'metal'\n").as_bytes());
    folder.succeeds("render scene.toml --size 9x7 -o out.png", "");
}

/// A sphere of a material that nothing defines is grey, and one that is the whole scene needs no OBJ.
#[test]
fn spheres_alone() {
    let folder = Folder::with_triangle();
    folder.write("scene.toml", b"[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nmaterial = 'gold'\n");
    let warning = "warning: scene.toml:4: materials that no table defines, drawn in grey (Kd 0.8): `gold`\n";
    for kernel in ["exact14", "exact29", "hanika-cons", "f32"] {
        for line in ["inspect scene.toml", "prep scene.toml -o out.blob", "render scene.toml -o out.png --size 8x6"] {
            folder.succeeds(&format!("{line} --kernel {kernel}"), warning);
        }
    }
    folder.succeeds("inspect out.blob", "");
}
