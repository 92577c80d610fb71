//! What becomes of wishes, and what follows.

use super::rate::Rate;
use super::{Order, Viewer};
use crate::chip::{Effort, Job};
use crate::judge::Case;
use crate::painter::{Drawn, Wish};

impl Viewer {
    /// Something has become of the last wish.
    pub(super) fn drawn(&mut self, drawn: Drawn, now: f64) -> Vec<Order> {
        let Some(wish) = self.wish else { return Vec::new() };
        match drawn {
            Drawn::Draft(picture, took) => {
                self.is_drafting = false;
                self.facts.took = Some(took);
                self.rate.note(now);
                self.drafts += 1;
                self.canvas.draft(&picture, wish.view.size);
                Vec::new()
            }
            Drawn::Tiles(tiles) => {
                tiles.iter().for_each(|(tile, pixels)| self.canvas.tile(*tile, pixels));
                Vec::new()
            }
            Drawn::Fewer(tiles, samples) => {
                tiles.iter().for_each(|(tile, pixels)| _ = self.canvas.show(*tile, pixels));
                self.facts.samples = Some(samples);
                Vec::new()
            }
            Drawn::Full(took) => {
                self.facts.took = Some(took);
                self.facts.full_after = Some(now - self.changed_at);
                self.rate = Rate::default();
                self.finished(wish)
            }
            Drawn::Failed(reason) => {
                self.is_drafting = false;
                self.facts.failure = Some(reason);
                Vec::new()
            }
        }
    }

    /// What follows the full picture.
    fn finished(&mut self, wish: Wish) -> Vec<Order> {
        let Some(picture) = self.canvas.full() else { return Vec::new() };
        let mut orders = vec![Order::Judge(Case { serial: wish.serial, view: wish.view, picture: picture.clone() })];
        if std::mem::take(&mut self.saves_when_full) {
            orders.push(Order::Save(picture.clone(), self.kernel()));
        }
        orders.extend(self.time());
        orders
    }

    /// The order to time the full picture, on a chip's panel.
    pub(super) fn time(&self) -> Vec<Order> {
        let full = self.canvas.full().zip(self.wish).filter(|_| self.setup.is_chip);
        let job = full.map(|(picture, Wish { serial, view, .. })| Job {
            serial,
            view,
            picture: picture.clone(),
            target: self.setup.board,
        });
        job.map(Order::Time).into_iter().collect()
    }

    /// A chip's time has come.
    pub(super) fn timed(&mut self, effort: Result<Effort, String>) {
        if let (Ok(effort), Some(took)) = (&effort, self.facts.took) {
            let place = [self.setup.board, self.setup.kernels[1]];
            self.known = Some((place, effort.seconds / took.rays.max(1) as f64));
        }
        self.facts.effort = Some(effort);
    }
}
