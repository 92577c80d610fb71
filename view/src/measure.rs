//! How fast it is: someone who moves and stops a few times, and a watch.

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::frame::Frame;
use crate::keys::Hold;
use crate::painter::Scene;
use crate::staff::Staff;
use crate::viewer::{Setup, Update, Viewer};

/// How often one moves and stops.
const ROUNDS: usize = 4;

/// Seconds of moving.
const MOVING: f64 = 2.0;

/// What one holds, to go round the scene, and back in the next round.
const HELD: [[Hold; 2]; 2] = [[Hold::Right, Hold::TurnLeft], [Hold::Left, Hold::TurnRight]];

/// What was measured.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Report {
    /// The kernel.
    pub kernel: &'static str,
    /// Of the window, pixels.
    pub width: u32,
    /// Of the window, pixels.
    pub height: u32,
    /// Of what is traced while one moves, pixels.
    pub draft_width: u32,
    /// Of what is traced while one moves, pixels.
    pub draft_height: u32,
    /// Threads that trace.
    pub threads: usize,
    /// Whether frames went to a window, and not to memory alone.
    pub window: bool,
    /// Drafts a second, the mean of all rounds.
    pub frames_per_second: f64,
    /// Of the slowest round.
    pub frames_per_second_least: f64,
    /// From stopping to the full picture, the mean of all rounds.
    pub full_ms: f64,
    /// Of the slowest round.
    pub full_ms_most: f64,
}

/// Someone who moves and stops.
#[derive(Clone, Debug, Default)]
pub struct Pilot {
    phase: Phase,
    rounds: Vec<Round>,
}

#[derive(Clone, Copy, Debug, Default)]
enum Phase {
    /// Until the first full picture is there.
    #[default]
    Waiting,
    /// Since some time, and after so many drafts.
    Moving(f64, u64),
    /// Until the full picture is there, having moved at so many frames a second.
    Stopping(f64),
}

#[derive(Clone, Copy, Debug)]
struct Round {
    frames_per_second: f64,
    full_ms: f64,
}

impl Pilot {
    /// Presses and lets go of keys; true once all is measured.
    pub fn fly(&mut self, viewer: &mut Viewer, now: f64) -> bool {
        let held = HELD[self.rounds.len() % HELD.len()];
        match (self.phase, viewer.full_after()) {
            (Phase::Waiting, Some(_)) => {
                held.into_iter().for_each(|key| viewer.hold(key, true, now));
                self.phase = Phase::Moving(now, viewer.drafts());
            }
            (Phase::Moving(since, before), _) if now - since >= MOVING => {
                held.into_iter().for_each(|key| viewer.hold(key, false, now));
                self.phase = Phase::Stopping((viewer.drafts() - before) as f64 / (now - since));
            }
            (Phase::Stopping(frames_per_second), Some(after)) => {
                self.rounds.push(Round { frames_per_second, full_ms: 1000.0 * after });
                self.phase = Phase::Waiting;
            }
            _ => {}
        }
        self.rounds.len() == ROUNDS
    }

    /// What was measured, beside what is known without.
    #[must_use]
    pub fn report(&self, known: Report) -> Report {
        let mean =
            |of: &dyn Fn(&Round) -> f64| self.rounds.iter().map(of).sum::<f64>() / self.rounds.len().max(1) as f64;
        Report {
            frames_per_second: mean(&|round| round.frames_per_second),
            frames_per_second_least: self
                .rounds
                .iter()
                .map(|round| round.frames_per_second)
                .fold(f64::INFINITY, f64::min),
            full_ms: mean(&|round| round.full_ms),
            full_ms_most: self.rounds.iter().map(|round| round.full_ms).fold(0.0, f64::max),
            ..known
        }
    }
}

/// Measures without a window: frames go to memory.
///
/// # Errors
/// Where there are no threads to be had, or no picture, for a person.
pub fn without_window(scene: &Scene, setup: Setup, threads: usize) -> Result<Pilot, String> {
    let (sender, updates) = channel();
    let tell = Arc::new(move |update: Update| {
        // Nobody listens any more where it has ended.
        let _ = sender.send(update);
    });
    let staff = Staff::new(Default::default(), scene, threads, &(tell as _))?;
    let size = setup.size;
    let mut viewer = Viewer::new(&scene.model, setup);
    let mut pilot = Pilot::default();
    let mut pixels = vec![0; size[0] as usize * size[1] as usize];
    let begin = Instant::now();
    let now = || begin.elapsed().as_secs_f64();
    let mut failure = None;
    while !pilot.fly(&mut viewer, now()) {
        if let Some(order) = viewer.tick(now()) {
            staff.carry_out(order, &mut |_| ());
        }
        if let Some(mut frame) = Frame::new(&mut pixels, size) {
            viewer.paint(&mut frame);
        }
        let wait = viewer.deadline(now()).map_or(MOVING, |deadline| (deadline - now()).max(0.0));
        match updates.recv_timeout(Duration::from_secs_f64(wait)) {
            Ok(update) => {
                for update in std::iter::once(update).chain(updates.try_iter()) {
                    if let Update::Drawn(_, crate::painter::Drawn::Failed(reason)) = &update {
                        failure = Some(reason.clone());
                    }
                    // The reference would take a core, as it does for whoever looks.
                    for order in viewer.update(update, now()) {
                        staff.carry_out(order, &mut |_| ());
                    }
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if let Some(reason) = failure {
            return Err(reason);
        }
    }
    Ok(pilot)
}
