//! What good input prints for other programs: one JSON object on stdout, and nothing else there.

use host_tools::picture::Picture;
use serde_json::{Map, Value};

use crate::command::Folder;

/// Runs a command, and returns the one object that it prints.
#[track_caller]
fn object(folder: &Folder, line: &str) -> Map<String, Value> {
    let printed = folder.succeeds(line, "");
    assert_eq!(printed.lines().count(), 1, "{printed}");
    match serde_json::from_str(&printed) {
        Ok(Value::Object(object)) => object,
        other => panic!("{other:?}"),
    }
}

/// The fields of an object, in order.
fn fields(object: &Map<String, Value>) -> Vec<&str> {
    object.keys().map(String::as_str).collect()
}

fn folder() -> Folder {
    let folder = Folder::with_triangle();
    folder.write("scene.toml", b"model = 'scene.obj'\n[render]\nsize = [24, 18]\n");
    folder
}

#[test]
fn render() {
    let folder = folder();
    for (kernel, scene) in [("exact29", "scene.toml"), ("exact14", "scene.blob")] {
        folder.succeeds("prep scene.toml --kernel exact14 -o scene.blob", "");
        let found = object(&folder, &format!("render {scene} --threads 2 -o out.png --json"));
        let mut expected = [
            "kernel",
            "width",
            "height",
            "image_crc32",
            "rays",
            "box_tests",
            "triangle_tests",
            "threads",
            "seconds",
            "simd",
        ];
        expected.sort_unstable();
        assert_eq!(fields(&found), expected);
        assert_eq!(found["kernel"], kernel);
        assert_eq!((&found["width"], &found["height"], &found["threads"]), (&24.into(), &18.into(), &2.into()));
        let picture = Picture::read_png(&folder.path("out.png")).unwrap();
        assert_eq!(found["image_crc32"], format!("{:08x}", picture.crc32()));
        assert_eq!(found["rays"]["primary"], 24 * 18);
        assert!(found["rays"]["shadow"].as_u64().is_some_and(|rays| (1..24 * 18).contains(&rays)));
        assert!(found["seconds"].as_f64().is_some_and(|seconds| seconds >= 0.0));
    }
}

#[test]
fn inspect() {
    let folder = folder();
    folder.succeeds("prep scene.toml --kernel exact29 -o scene.blob", "");
    let of_scene = object(&folder, "inspect scene.toml --json");
    let mut of_blob = object(&folder, "inspect scene.blob --json");
    let stated =
        ["kernel", "triangles", "degenerate", "nodes", "blob_bytes", "bytes_per_triangle", "grid_bits", "needs"];
    for field in stated {
        assert!(of_scene.contains_key(field), "{field}");
    }
    assert_eq!(of_scene["blob_bytes"], folder.read("scene.blob").len());
    assert_eq!((&of_scene["triangles"], &of_scene["grid_bits"]), (&1.into(), &29.into()));
    let needs = ["point lights", "shadows", "sRGB output", "RGB888 output", "triangles with records", "ids in records"];
    assert_eq!(of_scene["needs"], serde_json::json!(needs));
    // Why it needs them, without a look at a board.
    let lights = &of_scene["needs_explained"][0];
    let (need, count, what, data) = (&lights["need"], &lights["count"], &lights["what"], &lights["data_bytes"]);
    assert_eq!((need, count, what, data), (&"point lights".into(), &1.into(), &"light".into(), &28.into()));
    assert_eq!((&lights["code_bytes"], &of_scene["costs"]), (&Value::Null, &Value::Null));
    // A blob does not tell why triangles were left out.
    assert_eq!(of_blob.insert("degenerates".into(), of_scene["degenerates"].clone()), Some(Value::Null));
    assert_eq!(of_blob, of_scene);
}

#[test]
fn inspect_names_the_materials_that_ask() {
    let folder = folder();
    folder.write(
        "glass.toml",
        b"model = 'scene.obj'\n[render]\nsize = [24, 18]\n[material.default]\nkind = 'dielectric'\nior = 1.5\n\
          [[sphere]]\ncentre = [0, 0, 0]\nradius = 0.5\nmaterial = 'ball'\n[material.ball]\nkind = 'mirror'\n",
    );
    folder.succeeds("prep glass.toml --kernel exact29 -o glass.blob", "");
    for (scene, names) in [("glass.toml", ["ball", "default"]), ("glass.blob", ["material 0", "material 1"])] {
        let found = object(&folder, &format!("inspect {scene} --json"));
        let explained = found["needs_explained"].as_array().expect("a list");
        let of =
            |need: &str| explained.iter().find(|explained| explained["need"] == need).expect("a need of the scene");
        let mut reflecting: Vec<&str> =
            of("reflection")["materials"].as_array().expect("names").iter().filter_map(Value::as_str).collect();
        reflecting.sort_unstable();
        assert_eq!(reflecting, names);
        assert_eq!((&of("refraction")["count"], &of("spheres")["count"]), (&1.into(), &1.into()));
    }
}

#[test]
fn compare() {
    let folder = folder();
    folder.succeeds("render scene.toml --kernel exact29 -o a.png", "");
    folder.write(
        "dark.toml",
        b"model = 'scene.obj'\n[render]\nsize = [24, 18]\n[material.default]\ncolour = [0, 0, 0]\n",
    );
    folder.succeeds("render dark.toml -o b.png", "");
    let found = object(&folder, "compare a.png b.png -o diff.png --json");
    let mut expected = ["max_abs", "mean_abs", "rmse", "psnr", "ssim", "flip", "over_1", "over_4", "over_64"];
    expected.sort_unstable();
    assert_eq!(fields(&found), expected);
    assert!(found.values().all(Value::is_number), "{found:?}");
    assert_eq!(Picture::read_png(&folder.path("diff.png")).map(|diff| diff.width()).unwrap(), 24);
    // There is no number for the ratio of a signal to no noise.
    assert_eq!(object(&folder, "compare a.png a.png --json")["psnr"], Value::Null);
}

#[test]
fn without_json_it_is_for_people() {
    let folder = folder();
    for line in ["inspect scene.toml", "render scene.toml -o out.png", "prep scene.toml -o out.blob"] {
        assert!(!folder.succeeds(line, "").starts_with('{'));
    }
}
