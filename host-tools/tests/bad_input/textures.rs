//! Textures and texture coordinates at their ends and beyond them: never a black picture without a word.

use host_tools::picture::Picture;

use crate::command::Folder;

/// A triangle that faces the camera, with coordinates at its corners, of a material with a texture.
fn folder(coordinates: &str, mtl: &str, size: [u32; 2]) -> Folder {
    let obj = format!("mtllib scene.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 2\n{coordinates}usemtl wall\nf 1/1 2/2 3/3\n");
    let folder = Folder::new(&[("scene.obj", obj.as_bytes()), ("scene.mtl", mtl.as_bytes())]);
    Picture::from_fn(size[0], size[1], |_, _| [200, 100, 250]).write_png(&folder.path("a.png")).unwrap();
    folder
}

const MTL: &str = "newmtl wall\nmap_Kd a.png\n";
const CORNERS: &str = "vt 0 0\nvt 1 0\nvt 0 1\n";

/// Whether the texture's colours are seen.
fn is_coloured(folder: &Folder) -> bool {
    let picture = Picture::read_png(&folder.path("out.png")).unwrap();
    picture.pixels().iter().any(|&[red, green, blue]| red > 100 && green > 50 && green < red && red < blue)
}

#[test]
fn any_size_and_any_place() {
    for size in [[1, 1], [1, 7], [5, 3], [4096, 2]] {
        for coordinates in [CORNERS, "vt -3\nvt 0.5 999\nvt 7 -1\n", "vt 1e29 0\nvt 1e29 1e29\nvt 1e29 1e29\n"] {
            let folder = folder(coordinates, MTL, size);
            let expected = if coordinates.contains("1e29 0") {
                "warning: scene.obj: triangles with over 1022 repeats of their texture, drawn without it: 1\n"
            } else {
                ""
            };
            for kernel in ["exact14", "exact29", "f32"] {
                folder.succeeds(&format!("render scene.obj --kernel {kernel} --size 16x12 -o out.png"), expected);
                assert_eq!(is_coloured(&folder), expected.is_empty(), "{size:?} {coordinates:?}");
            }
        }
    }
}

#[test]
fn coordinates_that_are_none_are_refused() {
    let folder = folder("vt 0 0\nvt nan 0\nvt 0 1\n", MTL, [2, 2]);
    folder.refuses("render scene.obj -o out.png", "error: scene.obj:6: `nan` is not a finite number\n");
}

#[test]
fn a_black_kd_is_said() {
    let folder = folder(CORNERS, "newmtl wall\nKd 0 0 0\nmap_Kd a.png\n", [2, 2]);
    let expected =
        "warning: scene.obj: materials with a texture that Kd, which it is multiplied by, makes black: `wall`\n";
    folder.succeeds("render scene.obj --size 16x12 -o out.png", expected);
}

#[test]
fn fewer_and_smaller_texels() {
    let folder = folder(CORNERS, MTL, [40, 20]);
    let size = |options: &str| {
        folder.succeeds(&format!("prep scene.obj {options} -o scene.blob"), "");
        folder.succeeds("render scene.obj --size 16x12 -o out.png", "");
        assert!(is_coloured(&folder));
        folder.read("scene.blob").len()
    };
    let whole = size("");
    assert_eq!(whole - size("--texels rgb565"), 40 * 20);
    assert_eq!(whole - size("--texels gray8"), 40 * 20 * 2);
    assert_eq!(whole - size("--texture-size 4"), 40 * 20 * 3 - 4 * 2 * 3);
    for (option, said) in
        [("--texture-size 0", "1..=4096"), ("--texture-size 4097", "1..=4096"), ("--texels x", "rgb565")]
    {
        let output = folder.run(&format!("prep scene.obj {option} -o scene.blob"));
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(said) && output.status.code() == Some(2), "{text}");
    }
}

#[test]
fn decimation_says_what_it_leaves_out() {
    let obj = "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\nvt 0 0\n\
               usemtl wall\nf 1/1 2/1 5/1 4/1\nf 2/1 3/1 6/1 5/1\nf 4/1 5/1 8/1 7/1\nf 5/1 6/1 9/1 8/1\n";
    let folder = folder(CORNERS, MTL, [2, 2]);
    folder.write("scene.obj", obj.as_bytes());
    folder.succeeds(
        "render scene.obj --size 16x12 --triangles 4 -o out.png",
        "warning: scene.obj: decimated, and drawn without textures and colours of vertices\n",
    );
}
