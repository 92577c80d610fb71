//! A scene of the tracer of 1994 as a blob, which firmware reads in place.

use core_rt::colour::Transfer;
use planes_rt::blob::Header;
use planes_rt::scene::Scene;
use zerocopy::IntoBytes;

use crate::grid::Grid;
use crate::prepare::Blob;

/// The blob of a scene whose components lie so in the model's space, and whose pictures become bytes so.
#[must_use]
pub fn blob(scene: &Scene<'_>, place: &Grid, transfer: Transfer) -> Blob {
    let header = Header::new(scene, transfer, place.origin.to_array().map(f64::to_bits), place.scale.to_bits());
    let prefix = header.prefix();
    let mut bytes = prefix.as_bytes().to_vec();
    bytes.extend(header.as_bytes());
    bytes.extend(scene.spheres().as_bytes());
    bytes.resize((prefix.total_size as usize).saturating_sub(4), 0);
    bytes.extend(core_rt::blob::crc32(&bytes).to_le_bytes());
    Blob::from_bytes(&bytes)
}
