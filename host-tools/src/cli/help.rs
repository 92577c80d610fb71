//! What would make a scene fit where it is too large.

use core_rt::blob::Header;
use core_rt::profile::Need;

use super::load::Scene;
use crate::engine::Sizes;

/// What would make a blob fit into `room` bytes of flash, in words.
#[must_use]
pub fn smaller(scene: &Scene, header: &Header, sizes: &Sizes, room: u64) -> String {
    let triangles = u64::from(header.counts.triangles);
    let bytes = scene.blob.bytes().len() as u64;
    // In proportion, a fiftieth less for what does not shrink with the triangles.
    let fitting = triangles * room / bytes.max(1) * 49 / 50;
    let mut help = Vec::new();
    if fitting > 0 {
        help.push(format!("fewer triangles (`intray prep --triangles {fitting}` instead of {triangles})"));
    }
    if header.needs.has(Need::WholeTriangles) {
        help.push("triangles that share vertices, for time (`--prefer size`)".into());
    }
    if scene.engine.name() != "exact14" {
        help.push("the kernel exact14, whose records are the smallest".into());
    }
    if sizes.normals > 0 {
        help.push(format!("no smooth normals, which take {} bytes", sizes.normals));
    }
    if sizes.texels > 0 {
        help.push(format!(
            "smaller textures, whose texels take {} bytes (`--texture-size 64`, `--texels rgb565`)",
            sizes.texels
        ));
    }
    help.join("; ")
}
