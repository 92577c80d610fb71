//! Frames a second.

use std::collections::VecDeque;

/// Frames that are counted.
const FRAMES: usize = 16;

/// When the last frames came.
#[derive(Clone, Debug, Default)]
pub(super) struct Rate {
    times: VecDeque<f64>,
}

impl Rate {
    /// Notes that a frame came, seconds.
    pub(super) fn note(&mut self, now: f64) {
        if self.times.len() == FRAMES {
            self.times.pop_front();
        }
        self.times.push_back(now);
    }

    /// Frames a second; `None` until there are two.
    pub(super) fn frames_a_second(&self) -> Option<f64> {
        let (first, last) = (self.times.front()?, self.times.back()?);
        (last > first).then(|| (self.times.len() - 1) as f64 / (last - first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frames_count() {
        let mut rate = Rate::default();
        assert_eq!(rate.frames_a_second(), None);
        rate.note(1.0);
        assert_eq!(rate.frames_a_second(), None);
        rate.note(3.0);
        assert_eq!(rate.frames_a_second(), Some(0.5));
        (0..20).for_each(|frame| rate.note(10.0 + f64::from(frame) / 4.0));
        assert_eq!(rate.frames_a_second(), Some(4.0));
    }
}
