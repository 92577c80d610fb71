//! What `compare` cannot compare.

use std::fs;

use crate::command::Folder;

/// A folder with `a.png` and `b.png`, of 4x4 and 4x5 pixels.
fn folder() -> Folder {
    let folder = Folder::with_triangle();
    folder.succeeds("render scene.obj --size 4x4 -o a.png", "");
    folder.succeeds("render scene.obj --size 4x5 -o b.png", "");
    folder
}

#[test]
fn what_is_no_picture() {
    let folder = folder();
    fs::create_dir(folder.path("folder")).unwrap();
    let png = folder.read("a.png");
    folder.write("cut.png", &png[..50]);
    folder.write("empty.png", b"");
    for (other, message) in [
        ("none.png", "none.png: no such file"),
        ("folder", "folder: this is a folder; give the name of a file"),
        ("scene.obj", "scene.obj: not a PNG; pictures are read and written as PNG only"),
        ("empty.png", "empty.png: not a PNG; pictures are read and written as PNG only"),
        ("cut.png", "cut.png: a PNG that is damaged or cut short (unexpected end of file); make it anew"),
    ] {
        folder.refuses(&format!("compare a.png {other} -o diff.png"), &format!("error: {message}\n"));
        folder.refuses(&format!("compare {other} a.png --json"), &format!("error: {message}\n"));
    }
}

#[test]
fn of_different_sizes() {
    folder().refuses(
        "compare a.png b.png -o diff.png",
        "error: a.png, b.png: the pictures differ in size: 4 x 4 and 4 x 5 pixels; only equal sizes can be compared\n",
    );
}

#[test]
fn a_difference_that_cannot_be_written() {
    folder().refuses(
        "compare a.png a.png -o no/diff.png",
        "error: no/diff.png: cannot be written: there is no folder no; create it first\n",
    );
}
