//! The blob: how a scene is laid out in flash, and how it is checked once. `docs/BLOB.md` specifies it.

pub(crate) mod check;
mod decode;
mod error;
mod header;

pub use decode::decode;
pub use error::BlobError;
pub use header::{Counts, Header, MAGIC, PREFIX_SIZE, Prefix, SourceGrid, TRAILER_SIZE, VERSION, crc32};

pub(crate) use header::open;
