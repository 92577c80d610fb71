//! Bad input, over the real command: what a user reads, the exit status, and what is on the disk afterwards.
//!
//! Commands run in a folder of their own, so that messages name files as the command line does. The expected text
//! stands beside each case.

mod arguments;
mod blobs;
mod closeness;
mod command;
mod decimation;
mod external;
mod good;
mod kernels;
mod outputs;
mod pictures;
mod planes;
mod rays;
mod report;
mod scene_files;
mod scene_toml;
mod spheres;
mod textures;
