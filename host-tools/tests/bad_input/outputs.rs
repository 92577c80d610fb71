//! Where results go: folders that are not there, files that are, readers that stop reading.

use std::fs;
use std::io::pipe;
use std::process::Stdio;

use crate::command::{Folder, text};

#[test]
fn a_folder_that_does_not_exist() {
    let folder = Folder::with_triangle();
    for line in ["render scene.obj -o no/such/out.png", "prep scene.obj -o no/such/out.png"] {
        folder.refuses(line, {
            "error: no/such/out.png: cannot be written: there is no folder no/such; create it first\n"
        });
    }
    folder.refuses(
        "render scene.obj -o scene.obj/out.png",
        "error: scene.obj/out.png: cannot be written: there is no folder scene.obj; create it first\n",
    );
}

#[test]
fn a_folder_in_the_place_of_the_file() {
    let folder = Folder::with_triangle();
    fs::create_dir(folder.path("out.png")).unwrap();
    folder.refuses("render scene.obj -o out.png", "error: out.png: this is a folder; give the name of a file\n");
    folder.refuses("prep scene.obj -o out.png", "error: out.png: this is a folder; give the name of a file\n");
}

#[test]
fn the_built_in_scene_needs_its_folder() {
    let folder = Folder::new(&[("out", b"a file")]);
    let before = folder.contents();
    let output = folder.run("");
    assert!(text(&output.stderr).starts_with("error: out: cannot make this folder: "), "{output:?}");
    assert_eq!(output.status.code(), Some(2));
    assert!(folder.contents() == before);
}

#[test]
fn twice_is_as_good_as_once() {
    let folder = Folder::with_triangle();
    let (render, prep) = ("render scene.obj --size 8x6 -o out.png", "prep scene.obj -o out.blob");
    folder.succeeds(render, "");
    folder.succeeds(prep, "");
    let once = folder.contents();
    folder.succeeds(render, "");
    folder.succeeds(prep, "");
    assert!(folder.contents() == once);
    assert_eq!(once.len(), 3, "the scene, the picture and the blob");
}

#[cfg(unix)]
#[test]
fn a_disk_that_is_full() {
    let folder = Folder::with_triangle();
    if !std::path::Path::new("/dev/full").exists() {
        return;
    }
    folder.refuses(
        "render scene.obj --size 4x4 -o /dev/full",
        "error: /dev/full: cannot be written: No space left on device (os error 28)\n",
    );
    let full = fs::File::create("/dev/full").unwrap();
    let output = folder.intray(&["inspect", "scene.obj"]).stdout(full).output().unwrap();
    assert_eq!(
        (text(&output.stderr).as_str(), output.status.code()),
        ("error: cannot write to standard output: No space left on device (os error 28)\n", Some(2))
    );
}

/// A pipe whose reader is gone, as `head` leaves it.
fn closed() -> Stdio {
    let (_, writer) = pipe().unwrap();
    writer.into()
}

#[test]
fn a_reader_that_has_gone() {
    let folder = Folder::with_triangle();
    let lines =
        ["inspect scene.obj", "inspect scene.obj --json", "render scene.obj --size 4x4 -o out.png", "--help", "-V"];
    for line in lines {
        let words: Vec<&str> = line.split_whitespace().collect();
        let output = folder.intray(&words).stdout(closed()).output().unwrap();
        assert_eq!((text(&output.stderr).as_str(), output.status.code()), ("", Some(0)), "{line}");
    }
    folder.write("scene.obj", b"mtllib none.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n");
    for (line, status) in [("inspect none.obj", 2), ("render", 2), ("inspect scene.obj", 0)] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let code = folder.intray(&words).stdout(Stdio::null()).stderr(closed()).status().unwrap().code();
        assert_eq!(code, Some(status), "{line}");
    }
}
