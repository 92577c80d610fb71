//! Numbers of triangles that cannot be, or cannot be reached.

use crate::command::Folder;

/// Two triangles apart: neither can go.
const APART: &[u8] = b"v 0 0 0\nv 2 0 0\nv 0 2 2\nv 5 0 0\nv 7 0 0\nv 5 2 2\nf 1 2 3\nf 4 5 6\n";

#[test]
fn numbers_out_of_range() {
    let folder = Folder::with_triangle();
    for number in ["0", "-1", "33554433"] {
        folder.refuses(
            &format!("prep scene.obj --triangles {number} -o out.blob"),
            &format!(
                "error: invalid value '{number}' for '--triangles <N>': {number} is not in 1..=33554432\n\n\
                 For more information, try '--help'.\n"
            ),
        );
    }
}

#[test]
fn too_few_for_what_is_kept() {
    let folder = Folder::new(&[("scene.obj", APART)]);
    folder.refuses(
        "prep scene.obj --triangles 1 -o out.blob",
        "error: scene.obj: decimating 2 triangles ends at 2, and at most 1 were asked for: what is left are outlines of \
         parts, of materials and of creases, which are kept; ask for --triangles 2, or make the model of fewer parts, \
         materials and sharp edges\n",
    );
}

#[test]
fn as_many_as_there_are_changes_nothing() {
    let folder = Folder::new(&[("scene.obj", APART)]);
    folder.succeeds("prep scene.obj -o whole.blob", "");
    for number in [2, 3, 33_554_432] {
        folder.succeeds(&format!("prep scene.obj --triangles {number} -o out.blob"), "");
        assert!(folder.read("out.blob") == folder.read("whole.blob"));
    }
}
