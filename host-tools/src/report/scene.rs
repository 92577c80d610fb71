//! Scenes as a report knows them: by a name, and by a digest of all files that they were read from.

use std::cell::RefCell;
use std::io::{self, BufRead, Cursor};
use std::path::Path;

use super::SceneFacts;
use crate::builtin;
use crate::import::{self, Embedded, ImportError, Imported, Source, Warning};
use crate::model::Model;

/// The CRC of xz: long enough that no two versions of a scene are taken for one.
const CRC_64: crc::Crc<u64> = crc::Crc::<u64>::new(&crc::CRC_64_XZ);

/// A scene of the command line.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What the report says of it.
    pub facts: SceneFacts,
    /// The scene and the digest of its files; `None` where it could not be read.
    pub content: Option<Content>,
}

/// What was read.
#[derive(Clone, Debug)]
pub struct Content {
    /// The scene.
    pub model: Model,
    /// What its author should know.
    pub warnings: Vec<Warning>,
    /// Over the names and bytes of all its files, 16 hexadecimal digits.
    pub digest: String,
}

/// Reads scenes; without a path, the built-in one. Names are made of letters, digits, `-`, `_` and `.`, so that they can
/// be parts of file names, and no two are the same.
#[must_use]
pub fn read<P: AsRef<Path>>(paths: &[P]) -> Vec<Scene> {
    let mut scenes: Vec<Scene> = Vec::new();
    if paths.is_empty() {
        scenes.push(scene("demo".into(), "built-in", content(&Embedded(builtin::FILES), "scene.toml")));
    }
    for path in paths {
        let path = path.as_ref();
        let read = import::place(path).and_then(|(folder, name)| content(&folder, name));
        let plain = name(path);
        let is_taken = |name: &String| scenes.iter().any(|scene| scene.facts.name == *name);
        let numbered = (2..).map(|number| format!("{plain}-{number}"));
        let free = std::iter::once(plain.clone()).chain(numbered).find(|name| !is_taken(name));
        // Numbers do not end before paths do.
        scenes.push(scene(free.unwrap_or_default(), &path.to_string_lossy(), read));
    }
    scenes
}

fn scene(name: String, path: &str, read: Result<Content, ImportError>) -> Scene {
    let (content, failed) = match read {
        Ok(content) => (Some(content), None),
        Err(error) => (None, Some(error.to_string())),
    };
    let count = |of: fn(&Model) -> usize| content.as_ref().map_or(0, |content| of(&content.model) as u64);
    let (triangles, spheres) = (count(|model| model.triangles.len()), count(|model| model.spheres.len()));
    Scene { facts: SceneFacts { name, path: path.into(), triangles, spheres, failed }, content }
}

/// The file's name without its end; its folder's where that is `scene`.
fn name(path: &Path) -> String {
    let text = |part: Option<&std::ffi::OsStr>| part.map(|part| part.to_string_lossy().into_owned());
    let stem = text(path.file_stem()).unwrap_or_default();
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.into());
    let folder = text(absolute.parent().and_then(Path::file_name));
    let name = if stem == "scene" { folder.unwrap_or(stem) } else { stem };
    name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}

fn content(source: &dyn Source, name: &str) -> Result<Content, ImportError> {
    let watched = Watched { source, seen: RefCell::default() };
    let Imported { model, warnings } = import::load_from(&watched, name)?;
    let digest = format!("{:016x}", CRC_64.checksum(&watched.seen.into_inner()));
    Ok(Content { model, warnings, digest })
}

/// Notes what is read through it.
struct Watched<'s> {
    source: &'s dyn Source,
    /// Of each file, in order: its name, its length and the digest of its bytes.
    seen: RefCell<Vec<u8>>,
}

impl Source for Watched<'_> {
    fn open(&self, name: &str) -> io::Result<Box<dyn BufRead + '_>> {
        let bytes = self.source.read(name)?;
        let mut seen = self.seen.borrow_mut();
        seen.extend(name.as_bytes());
        seen.extend((bytes.len() as u64).to_le_bytes());
        seen.extend(CRC_64.checksum(&bytes).to_le_bytes());
        Ok(Box::new(Cursor::new(bytes)))
    }

    fn describe(&self, name: &str) -> String {
        self.source.describe(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 2\nusemtl red\nf 1 2 3\n";

    #[test]
    fn names_are_of_files_or_folders_and_differ() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["scene.toml", "b c/mesh.obj", "other/mesh.obj", "fine/scene.toml"].map(|p| folder.path().join(p));
        let scenes = read(&paths);
        let names: Vec<&str> = scenes.iter().map(|scene| scene.facts.name.as_str()).collect();
        assert_eq!(names[1..], ["mesh", "mesh-2", "fine"]);
        assert!(scenes.iter().all(|scene| scene.facts.failed.as_ref().is_some_and(|why| why.contains("no such file"))));
    }

    #[test]
    fn the_digest_is_of_every_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("a.obj"), OBJ).unwrap();
        fs::write(path("a.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
        let digest = || read(&[path("a.obj")])[0].content.clone().unwrap().digest;
        let first = digest();
        assert_eq!(first, digest());
        fs::write(path("a.mtl"), "newmtl red\nKd 0 1 0\n").unwrap();
        assert_ne!(first, digest(), "a file that the scene refers to");
        fs::write(path("a.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
        assert_eq!(first, digest());
    }

    #[test]
    fn without_a_path_it_is_the_built_in_scene() {
        let scenes = read::<&Path>(&[]);
        assert_eq!((scenes.len(), scenes[0].facts.name.as_str()), (1, "demo"));
        assert!(scenes[0].facts.triangles > 0 && scenes[0].facts.failed.is_none());
    }
}
