//! The box test by octant, as traversal has it, beside the one that serves every octant.

use core_rt::kernel::{ANY_OCTANT, Kernel};

/// Where a ray enters the children of a node, by its own octant.
///
/// # Panics
/// Where the test that serves every octant says something else.
pub fn enter<K: Kernel>(ray: &K::Ray, node: &K::Node, limit: K::Distance) -> [Option<K::Distance>; 2] {
    let any = K::enter::<ANY_OCTANT>(ray, node, limit);
    let chosen = match K::octant(ray) {
        0 => K::enter::<0>(ray, node, limit),
        1 => K::enter::<1>(ray, node, limit),
        2 => K::enter::<2>(ray, node, limit),
        3 => K::enter::<3>(ray, node, limit),
        4 => K::enter::<4>(ray, node, limit),
        5 => K::enter::<5>(ray, node, limit),
        6 => K::enter::<6>(ray, node, limit),
        _ => K::enter::<7>(ray, node, limit),
    };
    assert!(any == chosen, "{any:?} and not {chosen:?}: {ray:?}");
    any
}
