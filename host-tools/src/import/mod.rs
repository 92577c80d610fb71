//! The importer: OBJ, MTL and `scene.toml` to a [`Model`].
//!
//! | file | what it does |
//! | --- | --- |
//! | `source` | where files come from |
//! | `lines` | text to statements, and the checked stream that `tobj` reads of an MTL |
//! | `scan`, `obj` | the check of an OBJ and what it says; its geometry |
//! | `mtl`, `statement`, `looks` | what an MTL says, the check of it, and what it looks like |
//! | `texture` | picture files |
//! | `schema` | the keys of a `scene.toml` |
//! | `document` | its text, so that an error has a line; checks of single values |
//! | `camera`, `setting`, `materials`, `change`, `sphere` | what its tables mean, with the defaults |
//! | `error` | errors and warnings |
//!
//! What cannot be drawn as meant is an error; what is drawn in a simpler way is a [`Warning`].
//! Whatever the bytes, nothing panics: the fuzz targets `obj` and `scene_toml` hold it to that.

mod camera;
mod change;
mod document;
mod error;
mod lines;
mod looks;
mod materials;
mod mtl;
mod obj;
mod scan;
mod schema;
mod setting;
mod source;
mod sphere;
mod statement;
#[cfg(test)]
mod testing;
mod texture;

use std::io;
use std::path::Path;

use camera::Bounds;
use document::Document;
use materials::Names;
use obj::Mesh;

pub use error::{ImportError, Warning};
pub use setting::{GREATEST_DEPTH, MOST_SAMPLES};
pub use source::{Embedded, Folder, Source};

use crate::model::Model;

/// The greatest coordinate, scene units: products of a good many still fit an f64.
pub const LARGEST: f64 = 1e30;
/// The least extent of a scene, and the least length of a direction.
pub const SMALLEST: f64 = 1e-30;

/// A scene, and what its author should know of how it will be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The scene. Indices are in range, positions finite, normals of unit length, and every
    /// position and normal is used by a triangle.
    pub model: Model,
    /// In the order in which they were found.
    pub warnings: Vec<Warning>,
}

/// Imports a `scene.toml` or a bare `.obj`, by the extension of its name.
///
/// # Errors
/// Everything that [`ImportError`] lists.
pub fn load(path: &Path) -> Result<Imported, ImportError> {
    let (folder, name) = place(path)?;
    load_from(&folder, name)
}

/// The folder that a scene file is in, and its name there.
///
/// # Errors
/// Where it is a folder itself, or its name is not UTF-8.
pub fn place(path: &Path) -> Result<(Folder, &str), ImportError> {
    let file = error::printable(&path.to_string_lossy());
    if path.is_dir() {
        return Err(ImportError::unreadable(&file, io::ErrorKind::IsADirectory.into()));
    }
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
        let message = "the name is not UTF-8; rename the file";
        let error = io::Error::new(io::ErrorKind::InvalidInput, message);
        return Err(ImportError::unreadable(&file, error));
    };
    Ok((Folder(path.parent().unwrap_or(Path::new("")).into()), name))
}

/// Imports the scene `name` of a [`Source`].
///
/// # Errors
/// Everything that [`ImportError`] lists.
pub fn load_from(source: &dyn Source, name: &str) -> Result<Imported, ImportError> {
    let file = source.describe(name);
    match extension(name).as_str() {
        "obj" => assemble(source, Some(name), &Document::absent(file)),
        "toml" => {
            let contents = source.read(name).map_err(|error| ImportError::unreadable(&file, error))?;
            let document = Document::parse(file, contents)?;
            let obj = document.model(source, name)?;
            assemble(source, obj.as_deref(), &document)
        }
        _ => Err(ImportError::Extension { file }),
    }
}

/// The model of an OBJ, if there is one, under the settings of a scene file.
fn assemble(source: &dyn Source, obj: Option<&str>, document: &Document) -> Result<Imported, ImportError> {
    let mut warnings = Vec::new();
    let mesh = match obj {
        Some(obj) => obj::read(source, obj, &mut warnings)?,
        None => Mesh::default(),
    };
    let mut names = Names::of_faces(&mesh);
    let spheres = document.spheres(&mut names)?;
    let bounds = Bounds::of(&mesh.positions, &spheres);
    if let Some(obj) = obj.filter(|_| bounds.diagonal() < SMALLEST) {
        let [x, y, z] = bounds.low.to_array();
        return Err(ImportError::NoExtent { file: source.describe(obj), x, y, z });
    }
    let materials = document.materials(source, obj, &mesh, &names, &mut warnings)?;
    let uvs = obj.map_or_else(Vec::new, |obj| mesh.textured(&materials, &source.describe(obj), &mut warnings));
    let camera = document.camera(bounds)?;
    let model = Model {
        positions: mesh.positions,
        colours: mesh.colours,
        normals: mesh.normals,
        triangles: mesh.triangles,
        uvs,
        spheres,
        materials,
        lights: document.lights(&camera)?,
        camera,
        background: document.background()?,
        render: document.render()?,
    };
    Ok(Imported { model, warnings })
}

/// The extension of a name, in lower case; empty where there is none.
fn extension(name: &str) -> String {
    let extension = Path::new(name).extension().unwrap_or_default();
    extension.to_string_lossy().to_ascii_lowercase()
}

/// The name of a file that the file `name` calls `other`.
fn beside(name: &str, other: &str) -> String {
    Path::new(name).with_file_name(other).to_string_lossy().into_owned()
}
