//! The reference's pictures: one for all points that differ from a scene in size, samples and depth alone.

use std::sync::{Arc, Mutex, PoisonError};

use super::measure::truth_samples;
use super::row::Point;
use crate::model::Model;
use crate::picture::Picture;
use crate::reference::Reference;
use crate::witness::Seen;

/// How many are kept. Points that share one come one after the other.
const MOST: usize = 4;

/// What the reference draws.
#[derive(Clone, Debug)]
pub(super) struct Truth {
    pub(super) picture: Picture,
    /// What the rays behind each pixel saw.
    pub(super) seen: Vec<Seen>,
}

impl Truth {
    /// Of a model, with its size, samples and depth.
    pub(super) fn of(model: &Model) -> Self {
        let [width, height] = model.render.size;
        let (pixels, seen) = Reference::new(model).witness([width, height], &|_| ());
        let mut picture = Picture::new(width, height);
        picture.pixels_mut().copy_from_slice(&pixels);
        Self { picture, seen }
    }
}

/// What it depends on: scene, size, samples, depth.
type Key = (String, [u32; 2], u32, u32);

/// The pictures that were drawn last.
#[derive(Debug, Default)]
pub(super) struct Truths(Mutex<Vec<(Key, Arc<Truth>)>>);

impl Truths {
    /// The picture of a point, drawn if it is not there.
    pub(super) fn of<E>(&self, point: &Point, draw: impl FnOnce() -> Result<Truth, E>) -> Result<Arc<Truth>, E> {
        let key = (point.scene.clone(), point.size, truth_samples(point), point.depth);
        // Others wait: they would draw the same. Nothing is half done where one of them panics.
        let mut there = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, truth)) = there.iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(truth));
        }
        let truth = Arc::new(draw()?);
        if there.len() == MOST {
            there.remove(0);
        }
        there.push((key, Arc::clone(&truth)));
        Ok(truth)
    }
}
