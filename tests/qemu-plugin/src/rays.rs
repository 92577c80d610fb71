//! Which kind of ray is followed, by marks that a program passes.
//!
//! Camera rays are what there is to do where nothing else is marked. A shadow ray begins and ends, and what went on before
//! goes on. Rays that go on from a surface wait, the last of them is taken up first, and where none is left the next
//! camera ray is.

/// The kinds, in the order of all arrays.
pub(crate) const KINDS: usize = 4;

const PRIMARY: usize = 0;
const SHADOW: usize = 1;
const REFLECTION: usize = 2;
const REFRACTION: usize = 3;

/// What a mark says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A shadow ray begins.
    Shadow,
    /// It has ended.
    Lit,
    /// A mirrored ray waits.
    Reflection,
    /// A ray through a surface waits.
    Refraction,
    /// The last ray that waits is taken up, or none is left.
    Next,
}

/// All marks, in the order of their arguments.
pub(crate) const MARKS: [Mark; 5] = [Mark::Shadow, Mark::Lit, Mark::Reflection, Mark::Refraction, Mark::Next];

/// The kind that is followed, and how far counters rose for each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rays {
    kind: usize,
    /// The kind that a shadow ray is for.
    before: Option<usize>,
    waiting: Vec<usize>,
    /// The counters at the last mark.
    since: Vec<u64>,
    rises: [Vec<u64>; KINDS],
}

impl Rays {
    /// A window begins, the counters standing as given.
    pub(crate) fn begin(&mut self, now: &[u64]) {
        self.since = now.to_vec();
    }

    /// The window ends, the counters standing as given; whether no ray is left over.
    pub(crate) fn end(&mut self, now: &[u64]) -> bool {
        self.credit(now);
        let is_done = self.before.is_none() && self.waiting.is_empty() && self.kind == PRIMARY;
        (self.kind, self.before) = (PRIMARY, None);
        self.waiting.clear();
        is_done
    }

    /// A mark within a window is passed, the counters standing as given; whether it may be.
    pub(crate) fn pass(&mut self, mark: Mark, now: &[u64]) -> bool {
        self.credit(now);
        match mark {
            Mark::Shadow => {
                let is_first = self.before.is_none();
                self.before = Some(self.kind);
                self.kind = SHADOW;
                is_first
            }
            Mark::Lit => match self.before.take() {
                Some(before) => {
                    self.kind = before;
                    true
                }
                None => false,
            },
            Mark::Reflection => {
                self.waiting.push(REFLECTION);
                true
            }
            Mark::Refraction => {
                self.waiting.push(REFRACTION);
                true
            }
            Mark::Next => {
                self.kind = self.waiting.pop().unwrap_or(PRIMARY);
                true
            }
        }
    }

    /// How far a counter rose for each kind.
    pub(crate) fn rises(&self, counter: usize) -> [u64; KINDS] {
        [PRIMARY, SHADOW, REFLECTION, REFRACTION].map(|kind| self.rises[kind].get(counter).copied().unwrap_or(0))
    }

    fn credit(&mut self, now: &[u64]) {
        // What was translated since stood at 0.
        self.since.resize(now.len(), 0);
        let rises = &mut self.rises[self.kind];
        rises.resize(now.len(), 0);
        for ((sum, since), &now) in rises.iter_mut().zip(&mut self.since).zip(now) {
            *sum += now - *since;
            *since = now;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One counter that rises by one from mark to mark.
    fn followed(marks: &[Mark]) -> ([u64; KINDS], bool) {
        let mut rays = Rays::default();
        rays.begin(&[10]);
        let mut is_right = true;
        for (now, &mark) in (11..).zip(marks) {
            is_right &= rays.pass(mark, &[now]);
        }
        is_right &= rays.end(&[11 + marks.len() as u64]);
        (rays.rises(0), is_right)
    }

    #[test]
    fn kinds_follow_the_marks() {
        use Mark::{Lit, Next, Reflection, Refraction, Shadow};
        assert_eq!(followed(&[]), ([1, 0, 0, 0], true));
        assert_eq!(followed(&[Shadow, Lit, Shadow, Lit]), ([3, 2, 0, 0], true));
        // The mirrored ray waits last, and so is first; it has a shadow, and a mirrored ray of its own.
        let both = [Refraction, Reflection, Next, Shadow, Lit, Reflection, Next, Next, Next];
        assert_eq!(followed(&both), ([4, 1, 4, 1], true));
    }

    #[test]
    fn marks_out_of_order_are_told() {
        use Mark::{Lit, Next, Reflection, Shadow};
        for marks in [&[Lit][..], &[Shadow], &[Shadow, Shadow, Lit], &[Reflection], &[Reflection, Next]] {
            assert!(!followed(marks).1, "{marks:?}");
        }
    }

    #[test]
    fn counters_that_come_later_stood_at_zero() {
        let mut rays = Rays::default();
        rays.begin(&[]);
        assert!(rays.pass(Mark::Shadow, &[5]) && rays.pass(Mark::Lit, &[6, 7]) && rays.end(&[6, 7, 8]));
        assert_eq!([0, 1, 2, 3].map(|counter| rays.rises(counter)), [[5, 1, 0, 0], [0, 7, 0, 0], [8, 0, 0, 0], [0; 4]]);
    }
}
