//! Where work is laid for a thread: of what was not begun, only the newest counts.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Room for one piece of work.
#[derive(Debug)]
pub struct Desk<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct State<T> {
    work: Option<T>,
    is_closed: bool,
}

impl<T> Default for Desk<T> {
    fn default() -> Self {
        Self { state: Mutex::new(State { work: None, is_closed: false }), changed: Condvar::new() }
    }
}

impl<T> Desk<T> {
    /// Lays work there, instead of what waits.
    pub fn lay(&self, work: T) {
        self.state().work = Some(work);
        self.changed.notify_one();
    }

    /// Whether something waits, or the desk is closed: what is being done is outdated.
    pub fn is_waiting(&self) -> bool {
        let state = self.state();
        state.work.is_some() || state.is_closed
    }

    /// Waits for work; `None` once the desk is closed.
    pub fn take(&self) -> Option<T> {
        let mut state = self.state();
        loop {
            if state.is_closed {
                return None;
            }
            if let Some(work) = state.work.take() {
                return Some(work);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Ends it.
    pub fn close(&self) {
        self.state().is_closed = true;
        self.changed.notify_all();
    }

    /// Nothing that holds the lock can stop halfway.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_newest_counts_until_it_is_closed() {
        let desk = Desk::default();
        assert!(!desk.is_waiting());
        desk.lay(1);
        desk.lay(2);
        assert!(desk.is_waiting());
        assert_eq!(desk.take(), Some(2));
        assert!(!desk.is_waiting());
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| (desk.take(), desk.take()));
            desk.lay(3);
            while desk.is_waiting() {
                std::thread::yield_now();
            }
            desk.close();
            assert_eq!(waiting.join().unwrap(), (Some(3), None));
        });
    }
}
