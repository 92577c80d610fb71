//! The box test by octant, as traversal has it, beside the one that serves every octant, where that is for all rays.

use core_rt::kernel::{ANY_OCTANT, Kernel};

/// Where a ray enters the children of a node, by its own octant.
///
/// # Panics
/// Where the test that serves every octant says something else.
pub fn enter<K: Kernel>(path: &K::Path, node: &K::Node, limit: K::Distance) -> [Option<K::Distance>; 2] {
    [0, 1].map(|child| {
        let chosen = match K::octant(path) {
            0 => K::enter::<0>(path, node, child, limit),
            1 => K::enter::<1>(path, node, child, limit),
            2 => K::enter::<2>(path, node, child, limit),
            3 => K::enter::<3>(path, node, child, limit),
            4 => K::enter::<4>(path, node, child, limit),
            5 => K::enter::<5>(path, node, child, limit),
            6 => K::enter::<6>(path, node, child, limit),
            7 => K::enter::<7>(path, node, child, limit),
            _ => return K::enter::<ANY_OCTANT>(path, node, child, limit),
        };
        if !K::ANY_OCTANT {
            let any = K::enter::<ANY_OCTANT>(path, node, child, limit);
            assert!(any == chosen, "{any:?} and not {chosen:?}: {path:?}");
        }
        chosen
    })
}
