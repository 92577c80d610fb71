//! Which chips a scene fits: what its firmware takes by a real link, beside the memory of the chips that
//! [probe-rs](https://probe.rs) knows.
//!
//! [`need`] is what a scene takes, [`database`] what chips have, [`table`] what the database does not say, [`fit`] the
//! comparison. The command is `intray fit`.

pub mod cli;
pub mod core;
pub mod database;
pub mod fit;
mod listing;
pub mod need;
mod single;
pub mod table;
