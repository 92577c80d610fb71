//! A small scene for the tests of this module.

use super::{Embedded, Imported, load_from};

/// An OBJ of one triangle of material `wall`, between the corners (0, 0, 0) and (2, 2, 2).
pub(super) const ROOM: &[u8] = b"v 0 0 0\nv 2 0 0\nv 0 2 2\nusemtl wall\nf 1 2 3\n";

/// [`ROOM`] under a scene.toml of a `model` line and `lines`; the error as text.
pub(super) fn room(lines: &str) -> Result<Imported, String> {
    scene(&format!("model = 'room.obj'\n{lines}"))
}

/// [`ROOM`] as `room.obj` beside a scene.toml.
pub(super) fn scene(toml: &str) -> Result<Imported, String> {
    let files = [("s.toml", toml.as_bytes()), ("room.obj", ROOM)];
    load_from(&Embedded(&files), "s.toml").map_err(|error| error.to_string())
}

/// Checks that each `lines`, under [`room`], is refused in the words that follow.
pub(super) fn refused(cases: &[(&str, &str)]) {
    for (lines, expected) in cases {
        let expected = format!("built-in s.toml:{expected}");
        assert_eq!(room(lines).unwrap_err(), expected, "{lines}");
    }
}

/// The warnings of an import.
pub(super) fn warnings(imported: &Imported) -> Vec<String> {
    imported.warnings.iter().map(ToString::to_string).collect()
}
