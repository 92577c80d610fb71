//! Scenes that cannot be read, and OBJ files that say what cannot be.

use std::fs;

use host_tools::picture::Picture;

use crate::command::{Folder, TRIANGLE, text};

/// Renders `name` and expects the message, which names the file itself.
#[track_caller]
fn refused(folder: &Folder, name: &str, message: &str) {
    for line in [format!("render {name} -o out.png"), format!("prep {name} -o out.blob"), format!("inspect {name}")] {
        folder.refuses(&line, &format!("error: {message}\n"));
    }
}

#[test]
fn what_is_no_file() {
    let folder = Folder::new(&[]);
    fs::create_dir(folder.path("folder")).unwrap();
    fs::create_dir(folder.path("folder.obj")).unwrap();
    refused(&folder, "none.obj", "none.obj: no such file");
    refused(&folder, "none.toml", "none.toml: no such file");
    refused(&folder, "none.blob", "none.blob: no such file");
    refused(&folder, "no/such/scene.obj", "no/such/scene.obj: no such file");
    refused(&folder, "folder", "folder: this is a folder; give the name of a file");
    refused(&folder, ".", ".: this is a folder; give the name of a file");
    refused(&folder, "folder.obj", "folder.obj: this is a folder; name the .toml or .obj file in it");
}

#[test]
fn what_is_no_text() {
    let utf16: Vec<u8> = TRIANGLE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let with_mark = [b"\xff\xfe", utf16.as_slice()].concat();
    let cases: [(&str, &[u8], &str); 10] = [
        ("scene.obj", b"", "the file is empty"),
        ("scene.toml", b"", "the file is empty"),
        ("scene.obj", &with_mark, "the file is UTF-16; save it as UTF-8 text"),
        ("scene.toml", &with_mark, "the file is UTF-16; save it as UTF-8 text"),
        ("scene.obj", b"\xfe\xff\0v", "the file is UTF-16; save it as UTF-8 text"),
        ("scene.toml", b"model = '\xff'", "1: this is not UTF-8 text"),
        ("scene.obj", b"\x7fELF\x02\x01\x01\0\0\0", "1: a zero byte; this is a binary file or UTF-16, not UTF-8 text"),
        ("scene.obj", &utf16, "1: a zero byte; this is a binary file or UTF-16, not UTF-8 text"),
        ("scene.obj", b"\x1f\x8b\x08\x99\xd3", "1: `\\u{1f}\u{fffd}\\u{8}\u{fffd}\u{fffd}` is not an OBJ statement"),
        ("scene.obj", b"<html>\n", "1: `<html>` is not an OBJ statement"),
    ];
    for (name, contents, message) in cases {
        let folder = Folder::new(&[(name, contents)]);
        let separator = if message.starts_with(|c: char| c.is_ascii_digit()) { ":" } else { ": " };
        refused(&folder, name, &format!("{name}{separator}{message}"));
    }
}

#[cfg(unix)]
#[test]
fn what_has_no_end() {
    let folder = Folder::new(&[]);
    std::os::unix::fs::symlink("/dev/zero", folder.path("scene.obj")).unwrap();
    // Not by `refuses`, which would read the folder's files.
    let output = folder.run("inspect scene.obj");
    let expected = "error: scene.obj:1: a zero byte; this is a binary file or UTF-16, not UTF-8 text\n";
    assert_eq!((text(&output.stderr).as_str(), output.status.code()), (expected, Some(2)));
}

#[test]
fn geometry_that_cannot_be() {
    const THREE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases = [
        ("v 0 0 0\n", ": no faces; an OBJ scene needs at least one `f` statement"),
        ("# nothing\n", ": no faces; an OBJ scene needs at least one `f` statement"),
        ("v 0 nan 0\n", ":1: `nan` is not a finite number"),
        ("v 0 0 0\nv inf 0 0\n", ":2: `inf` is not a finite number"),
        ("v 0 0 -Infinity\n", ":1: `-Infinity` is not a finite number"),
        ("v 0 0 1e999\n", ":1: `1e999` is not a finite number"),
        ("v 0 0 3e38\n", ":1: `3e38` is beyond 1e30"),
        ("v 1 2\n", ":1: too few numbers: 2 of at least 3"),
        ("v 1,0 2,0 3,0\n", ":1: `1,0` is not a number"),
        ("{3}f 0 1 2\n", ":4: vertex index 0; indices count from 1, or back from -1"),
        ("{3}f 1 2 4\n", ":4: vertex index 4, but the file has 3"),
        ("{3}f -1 -2 -4\n", ":4: vertex index -4, but there are 3 before it"),
        ("{3}f 1 2 18446744073709551616\n", ":4: vertex index `18446744073709551616` is beyond 64 bits"),
        ("{3}f 1 2 -9999999999999999999\n", ":4: vertex index `-9999999999999999999` is beyond 64 bits"),
        ("{3}f 1 2 2.5\n", ":4: vertex index `2.5` is not an integer"),
        ("{3}f 1//1 2//1 3//1\n", ":4: normal index 1, but the file has 0"),
        ("{3}f 1 2\n", ":4: a face of 2 corners; it needs at least 3"),
        ("v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n", ": the scene has no extent: every vertex is at (1, 2, 3)"),
    ];
    for (obj, message) in cases {
        let folder = Folder::new(&[("scene.obj", obj.replace("{3}", THREE).as_bytes())]);
        refused(&folder, "scene.obj", &format!("scene.obj{message}"));
    }
}

#[test]
fn geometry_that_the_grid_cannot_hold() {
    // Three corners in a line, and two corners in one place.
    let obj = "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\nf 1 1 3\n";
    let folder = Folder::new(&[("scene.obj", obj.as_bytes())]);
    for (kernel, bits) in [("exact29", 29), ("exact14", 15)] {
        folder.refuses(
            &format!("render scene.obj --kernel {kernel} -o out.png"),
            &format!(
                "error: scene.obj: none of 2 triangles has an area on the {bits}-bit grid of {kernel}, so nothing is \
                 left to render; check the vertices, or bring the camera and the lights closer to them, or make the lights directional\n"
            ),
        );
    }
    let some = format!("{obj}v 0 3 0\nf 1 2 4\n");
    let folder = Folder::new(&[("scene.obj", some.as_bytes())]);
    folder.succeeds(
        "render scene.obj --size 8x8 -o out.png",
        "warning: 2 of 3 triangles have no area on the grid and were left out (1 with two corners in one point, 1 with all \
         three in a line)\n",
    );
    // f64 has steps of 2 here.
    let far = "v 1e16 0 0\nv 10000000000000002 0 0\nv 1e16 2 0\nf 1 2 3\n";
    refused(
        &Folder::new(&[("scene.obj", far.as_bytes())]),
        "scene.obj",
        "scene.obj: the scene is too small for where it is: its points are closer together than 64-bit numbers can tell; \
         bring it closer to (0, 0, 0), and the camera and the lights to it",
    );
}

#[test]
fn a_material_file_that_is_missing_or_malformed_is_a_warning() {
    let obj = format!("mtllib scene.mtl\nusemtl wall\n{TRIANGLE}");
    let cases: [(Option<&[u8]>, &str); 8] = [
        (
            None,
            "warning: scene.obj:1: material file scene.mtl: no such file; its materials are drawn in grey (Kd 0.8)\n\
             warning: scene.obj:2: materials that no MTL file defines, drawn in grey (Kd 0.8): `wall`\n",
        ),
        (Some(b""), "warning: scene.obj:2: materials that no MTL file defines, drawn in grey (Kd 0.8): `wall`\n"),
        (
            Some(b"newmtl wall\n\0\0\0"),
            "warning: scene.mtl:2: a zero byte; this is a binary file or UTF-16, not UTF-8 text; its materials are drawn in \
             grey\n\
             warning: scene.obj:2: materials that no MTL file defines, drawn in grey (Kd 0.8): `wall`\n",
        ),
        (Some(b"newmtl wall\n"), ""),
        (
            Some(b"newmtl wall\nKd red\n"),
            "warning: scene.mtl:2: Kd of material `wall`: `red` is not a number; drawn with 0.8\n",
        ),
        (
            Some(b"newmtl wall\nKd 0 0\n"),
            "warning: scene.mtl:2: Kd of material `wall`: 2 numbers where 3 are needed; drawn with 0.8\n",
        ),
        (
            Some(b"newmtl wall\nKd nan 0 0\n"),
            "warning: scene.mtl:2: Kd of material `wall`: `nan` is not a finite number; drawn with 0.8\n",
        ),
        (
            Some(b"newmtl wall\nKd 0 0 -1\n"),
            "warning: scene.mtl:2: Kd of material `wall`: -1 is negative; drawn with 0.8\n",
        ),
    ];
    let picture = |folder: &Folder| Picture::read_png(&folder.path("out.png")).unwrap();
    let plain = Folder::with_triangle();
    plain.succeeds("render scene.obj --size 16x12 -o out.png", "");
    assert!(picture(&plain).pixels().iter().any(|pixel| *pixel > [100; 3]), "grey in the light of the camera");
    for (mtl, warnings) in cases {
        let folder = Folder::new(&[("scene.obj", obj.as_bytes())]);
        if let Some(mtl) = mtl {
            folder.write("scene.mtl", mtl);
        }
        folder.succeeds("render scene.obj --size 16x12 -o out.png", warnings);
        assert_eq!(picture(&folder), picture(&plain));
    }
}

/// Textures and looks that are none: what is drawn in their place is said, and it is not black.
#[test]
fn a_texture_that_is_none_is_a_warning() {
    let obj = format!("mtllib scene.mtl\nusemtl wall\n{TRIANGLE}");
    let none = "drawn with Kd alone";
    let cases: [(&[u8], &str); 5] = [
        (b"newmtl wall\nmap_Kd none.png\n", {
            "warning: scene.obj: textures that cannot be read, {none}: `none.png` (no such file)\n"
        }),
        (b"newmtl wall\nmap_Kd scene.obj\n", {
            "warning: scene.obj: textures that cannot be read, {none}: `scene.obj` (not a PNG file)\n"
        }),
        (b"newmtl wall\nmap_Kd\n", {
            "warning: scene.mtl:2: map_Kd of material `wall`: a file name is missing; drawn without a texture\n"
        }),
        (b"newmtl wall\nNs -5\n", "warning: scene.mtl:2: Ns of material `wall`: -5 is below 0; drawn with 50\n"),
        (b"newmtl wall\nNi 0\nillum 12\n", {
            "warning: scene.mtl:2: Ni of material `wall`: 0 is below 0.1; drawn with 1.5\n\
             warning: scene.mtl:3: illum of material `wall`: `12` is not from 0 to 10; ignored\n"
        }),
    ];
    for (mtl, warnings) in cases {
        let folder = Folder::new(&[("scene.obj", obj.as_bytes()), ("scene.mtl", mtl)]);
        folder.succeeds("render scene.obj --size 16x12 -o out.png", &warnings.replace("{none}", none));
        let picture = Picture::read_png(&folder.path("out.png")).unwrap();
        assert!(picture.pixels().iter().any(|pixel| *pixel > [100; 3]));
    }
}
