//! Which kernel a scene is prepared for, where nobody names one: [`auto`] decides from the mesh, [`budget`] from pictures.

pub mod auto;
pub mod budget;
mod view;

use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::kernel::Kernel;

use crate::engine::{self, Engine};

/// The kernels to choose from, the cheapest on a chip first. The others are for comparison: none of them is both cheaper and
/// closer than one of these.
pub const CHEAPEST_FIRST: [&str; 3] = [<Exact14 as Kernel>::NAME, <Exact20 as Kernel>::NAME, <Exact29 as Kernel>::NAME];

/// The same, as engines.
pub fn engines() -> impl Iterator<Item = &'static dyn Engine> {
    CHEAPEST_FIRST.into_iter().filter_map(engine::by_name)
}
