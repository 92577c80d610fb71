//! The built-in scene, `scenes/demo`, so that the command shows a picture wherever it is run.

/// Its files by name, `scene.toml` first: what a folder on disk would hold.
pub const FILES: &[(&str, &[u8])] = &[
    ("scene.toml", include_bytes!("../../scenes/demo/scene.toml")),
    ("demo.obj", include_bytes!("../../scenes/demo/demo.obj")),
    ("demo.mtl", include_bytes!("../../scenes/demo/demo.mtl")),
];
