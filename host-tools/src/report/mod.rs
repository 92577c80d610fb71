//! Error against run time: scenes by kernels and their knobs, on the host and on chips.

pub mod row;
