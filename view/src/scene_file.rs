//! The camera, written into a `scene.toml` of which all else stays as it is, comments too.

use std::path::Path;

use host_tools::files;
use host_tools::model::{Camera, Projection};
use toml_edit::{Array, DocumentMut, Item, Table, TableLike, Value, value};

/// Whether a scene has no light of its own, so that the importer puts one at the camera; an `.obj` has none.
///
/// # Errors
/// Where the file cannot be read as a scene, for a person.
pub fn has_headlight(path: &Path) -> Result<bool, String> {
    if !is_scene_toml(path) {
        return Ok(true);
    }
    let document = read(path)?;
    Ok(document.get("light").is_none_or(|lights| match lights {
        Item::ArrayOfTables(tables) => tables.is_empty(),
        Item::Value(Value::Array(tables)) => tables.is_empty(),
        _ => false,
    }))
}

/// Writes a camera into the scene's file, whole or not at all.
///
/// # Errors
/// Where that cannot be done, for a person.
pub fn write(path: &Path, home: &Camera, camera: &Camera) -> Result<(), String> {
    if !is_scene_toml(path) {
        let name = path.file_name().unwrap_or_default().display();
        return Err(format!(
            "{}: not a scene.toml, so there is no place for a camera; make one with model = \"{name}\"",
            path.display()
        ));
    }
    let mut document = read(path)?;
    set(&mut document, home, camera).ok_or_else(|| format!("{}: `camera` is not a table", path.display()))?;
    files::write_atomically(path, document.to_string().as_bytes()).map_err(|error| error.to_string())
}

fn is_scene_toml(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

fn read(path: &Path) -> Result<DocumentMut, String> {
    let bytes = files::read(path).map_err(|error| error.to_string())?;
    let text = String::from_utf8(bytes).map_err(|_| format!("{}: not UTF-8 text", path.display()))?;
    text.parse().map_err(|error| format!("{}: {error}", path.display()))
}

/// Sets position, direction and what is seen of the projection; `None` where `camera` is there and no table.
fn set(document: &mut DocumentMut, home: &Camera, camera: &Camera) -> Option<()> {
    let table = document.entry("camera").or_insert_with(|| Item::Table(Table::new())).as_table_like_mut()?;
    replace(table, "position", vector(camera.position.to_array()));
    replace(table, "look_at", vector(camera.look_at.to_array()));
    if camera.projection != home.projection {
        match camera.projection {
            // As it was rounded: radians have more digits than the degrees that they were made of.
            Projection::Perspective { fov_y } => {
                replace(table, "fov_y", decimal(&format!("{:.2}", fov_y.to_degrees())))
            }
            Projection::Orthographic { height } => replace(table, "height", height.into()),
        }
    }
    Some(())
}

fn vector(components: [f64; 3]) -> Value {
    Value::Array(components.into_iter().collect::<Array>())
}

/// A number that has no more digits than it is written with.
fn decimal(text: &str) -> Value {
    text.parse::<f64>().unwrap_or_default().into()
}

/// Sets a value; what stands around it, such as a comment behind it, stays.
fn replace(table: &mut dyn TableLike, key: &str, new: Value) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            let decor = old.decor().clone();
            *old = new;
            *old.decor_mut() = decor;
        }
        None => {
            table.insert(key, value(new));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use std::fs;

    fn written(text: &str, camera: &Camera) -> Result<String, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, text).unwrap();
        write(&path, &Camera::default(), camera)?;
        Ok(fs::read_to_string(&path).unwrap())
    }

    fn moved() -> Camera {
        Camera { position: DVec3::new(0.25, -1.0, 4.0), look_at: DVec3::new(0.0, 0.5, 1e-3), ..Camera::default() }
    }

    #[test]
    fn all_but_the_camera_stays() {
        let text = "# a scene\nmodel = 'a.obj' # quoted so\n\n[camera] # here\nposition = [ 0, 1,\n  5 ] # metres\n  look_at=[0,1,0]\nfov_y = 40\n\n[render]\nsize = [6_4, 48]\n";
        let expected = "# a scene\nmodel = 'a.obj' # quoted so\n\n[camera] # here\nposition = [0.25, -1.0, 4.0] # metres\n  look_at=[0.0, 0.5, 0.001]\nfov_y = 40\n\n[render]\nsize = [6_4, 48]\n";
        assert_eq!(written(text, &moved()).unwrap(), expected);
        assert_eq!(written(expected, &moved()).unwrap(), expected);
    }

    #[test]
    fn a_camera_is_added_where_there_is_none() {
        let found = written("model = 'a.obj'\n[render]\nsamples = 2\n", &moved()).unwrap();
        let expected = "model = 'a.obj'\n[render]\nsamples = 2\n\n[camera]\nposition = [0.25, -1.0, 4.0]\nlook_at = [0.0, 0.5, 0.001]\n";
        assert_eq!(found, expected);
        let found = written("model = 'a.obj'\ncamera = { fov_y = 30 } # narrow\n", &moved()).unwrap();
        assert!(found.contains("fov_y = 30") && found.contains("look_at = [0.0, 0.5, 0.001]"), "{found}");
        assert!(found.ends_with("# narrow\n"), "{found}");
    }

    #[test]
    fn a_changed_view_is_written_in_degrees() {
        let narrow = Camera { projection: Projection::Perspective { fov_y: 38f64.to_radians() }, ..moved() };
        let found = written("[camera]\nfov_y = 40 # wide\n", &narrow).unwrap();
        assert!(found.starts_with("[camera]\nfov_y = 38.0 # wide\n"), "{found}");
        let high = Camera { projection: Projection::Orthographic { height: 2.5 }, ..moved() };
        let found = written("[camera]\nprojection = 'orthographic'\nheight = 2\n", &high).unwrap();
        assert!(found.contains("\nheight = 2.5\n"), "{found}");
    }

    #[test]
    fn what_is_no_scene_is_left_alone() {
        assert!(written("camera = 3\n", &moved()).unwrap_err().ends_with("`camera` is not a table"));
        assert!(written("camera = [\n", &moved()).unwrap_err().contains("scene.toml: "));
        let error = write(Path::new("some/mesh.obj"), &Camera::default(), &moved()).unwrap_err();
        assert_eq!(
            error,
            "some/mesh.obj: not a scene.toml, so there is no place for a camera; make one with model = \"mesh.obj\""
        );
    }

    #[test]
    fn a_scene_without_lights_has_one_at_the_camera() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        for (text, expected) in [
            ("model = 'a.obj'\n", true),
            ("light = []\n", true),
            ("light = [{ position = [0, 1, 2] }]\n", false),
            ("[[light]]\nposition = [0, 1, 2]\n", false),
        ] {
            fs::write(&path, text).unwrap();
            assert_eq!(has_headlight(&path), Ok(expected), "{text}");
        }
        assert_eq!(has_headlight(Path::new("mesh.obj")), Ok(true));
        assert!(has_headlight(Path::new("no/scene.toml")).is_err());
    }
}
