//! Real models that are not part of the project, where they are present.

use std::path::{Path, PathBuf};

/// The path of a model beside the project, or `None`, with a line that says so, where the folder is absent.
#[must_use]
pub fn scene(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped {name}: no shared/scenes beside the project");
    None
}
