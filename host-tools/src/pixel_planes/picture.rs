//! A picture by the modelled processors themselves: every value in its bits, every swap done.

use planes_rt::colour::Light;
use planes_rt::scene::Scene;
use rayon::prelude::*;

use super::Run;
use super::arithmetic::{Broadcast, perform};
use super::memory::Moment;
use super::processors::{PROCESSORS, Processors};
use super::program::{Shape, Step, Value};
use crate::render::Progress;

/// What the processors leave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// The light of all pixels, row by row.
    pub light: Vec<Light>,
    /// Of all pixels, how many were enabled at each step.
    pub enabled: Vec<u64>,
    /// Operations on single bits that a processor did.
    pub bit_operations: u64,
}

impl Run {
    /// Draws a scene of the shape that was planned for, on the threads of the current rayon pool.
    #[must_use]
    pub fn draw(&self, scene: &Scene<'_>, shape: &Shape, progress: Progress<'_>) -> Drawn {
        let [width, height] = scene.settings().size.map(usize::from);
        let mut light = vec![[0; 3]; width * height];
        let counts = light.par_chunks_mut(PROCESSORS).enumerate().map(|(number, light)| {
            let told = self.draw_some(scene, shape, number * PROCESSORS, light, |_, _, _| ());
            progress(light.len() as u64);
            told
        });
        let nothing = || (vec![0; self.steps.len()], 0);
        let (enabled, bit_operations) = counts.reduce(nothing, |(mut sum, operations), (more, others)| {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
            (sum, operations.max(others))
        });
        Drawn { light, enabled, bit_operations }
    }

    /// Draws the pixels from `first` on, row by row, at most [`PROCESSORS`], telling of the values after each step; how many were
    /// enabled at each, and the operations of one.
    pub fn draw_some(
        &self,
        scene: &Scene<'_>,
        shape: &Shape,
        first: usize,
        light: &mut [Light],
        mut tell: impl FnMut(&Step, &Moment, &Processors),
    ) -> (Vec<u64>, u64) {
        let width = usize::from(scene.settings().size[0]);
        let pixel = |processor: usize| [(first + processor) % width, (first + processor) / width].map(|c| c as u16);
        let ray = |processor: usize| scene.ray(pixel(processor));
        let local =
            self.plan.moments.iter().flat_map(|moment| moment.places.values().chain([&moment.scratch]).flatten());
        let local = local.max().map_or(0, |&last| last + 1);
        let mut processors = Processors::new(local, self.plan.backing_bits as usize);
        // Those beyond the picture do what those of its last pixels do, and are not counted.
        let drawn = light.len();
        let mut enabled = Vec::with_capacity(self.steps.len());
        for (step, moment) in self.steps.iter().zip(&self.plan.moments) {
            for transfer in &moment.transfers {
                processors.transfer(&transfer.places, transfer.home, transfer.is_outward);
            }
            let broadcast = Broadcast::new(scene, shape, step.sphere);
            let begun = perform(step.operation, &mut processors, &moment.places, &moment.scratch, broadcast, &ray);
            enabled.push((0..drawn).filter(|&processor| begun.has(processor)).count() as u64);
            tell(step, moment, &processors);
        }
        if let Some(places) = self.plan.moments.last().and_then(|moment| moment.places.get(&Value::Light)) {
            for (processor, light) in light.iter_mut().enumerate() {
                let channel = |channel: usize| {
                    let bits = places.len() / 3;
                    processors.read(&places[channel * bits..(channel + 1) * bits], processor) as u16
                };
                *light = [0, 1, 2].map(channel);
            }
        }
        (enabled, processors.operations)
    }
}
