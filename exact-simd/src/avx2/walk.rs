//! The walk of one ray: nearest children first, what waits on a stack with the distance at which it is entered.

use heapless::Vec;

use super::collapse::WIDTH;
use super::tree::Word;

/// More may not wait: a tree of the blob has 64 levels at most, and each leaves seven of eight children waiting.
const WAITING_MAX: usize = 64 * (WIDTH - 1) + 1;

/// Which children of a node a ray enters before a limit.
pub(super) struct Entered<'n, T> {
    /// A bit each.
    pub(super) mask: u32,
    /// Where.
    pub(super) at: [T; WIDTH],
    /// What they are.
    pub(super) children: &'n [u32; WIDTH],
}

/// Visits leaves until `visit` returns no limit any more, or nothing waits.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn walk<'n, T: Copy + Default + PartialOrd>(
    mut limit: T,
    mut enter: impl FnMut(u32, T) -> Option<Entered<'n, T>>,
    mut visit: impl FnMut(Word, T) -> Option<T>,
) {
    let mut stack = Vec::<(u32, T), WAITING_MAX>::new();
    let _ = stack.push((0, T::default()));
    while let Some((word, entry)) = stack.pop() {
        if entry > limit {
            continue;
        }
        match Word::unpack(word) {
            Word::Node(index) => {
                let Some(Entered { mut mask, at, children }) = enter(index, limit) else { return };
                let below = stack.len();
                while mask != 0 {
                    let lane = mask.trailing_zeros() as usize % WIDTH;
                    mask &= mask - 1;
                    let child = (children[lane], at[lane]);
                    // The nearest last.
                    let mut place = stack.len();
                    // There is room: see above.
                    let _ = stack.push(child);
                    while place > below && stack[place - 1].1 < child.1 {
                        stack.swap(place - 1, place);
                        place -= 1;
                    }
                }
            }
            leaf => match visit(leaf, limit) {
                Some(nearer) => limit = nearer,
                None => return,
            },
        }
    }
}
