//! How far a picture is from the reference, worked out beside everything else.

use std::sync::atomic::{AtomicU64, Ordering};

use host_tools::compare::{Comparison, compare};
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::reference::{Reference, encode};
use rayon::ThreadPool;
use rayon::prelude::*;

use crate::desk::Desk;
use crate::painter::{Scene, View};

/// A picture to be judged.
#[derive(Clone, Debug)]
pub struct Case {
    /// The number of the wish that it is of.
    pub serial: u64,
    /// What it shows.
    pub view: View,
    /// The full picture.
    pub picture: Picture,
}

/// Judges whatever is laid on the desk until that is closed. A case is given up where `newest` is no longer its wish.
pub fn work(
    scene: &Scene,
    desk: &Desk<Case>,
    newest: &AtomicU64,
    pool: &ThreadPool,
    tell: &(dyn Fn(u64, Comparison) + Sync),
) {
    while let Some(case) = desk.take() {
        let is_wanted = || newest.load(Ordering::Relaxed) == case.serial;
        if !is_wanted() {
            continue;
        }
        let model = case.view.of(scene);
        let judged = pool.install(|| {
            let reference = reference(&model, &is_wanted)?;
            // Of one size.
            compare(&case.picture, &reference).ok()
        });
        if let Some(comparison) = judged {
            tell(case.serial, comparison);
        }
    }
}

/// The reference's picture, row by row, as long as it is wanted.
fn reference(model: &Model, is_wanted: &(dyn Fn() -> bool + Sync)) -> Option<Picture> {
    let [width, height] = model.render.size;
    let reference = Reference::new(model);
    let row = |y: u32| {
        let colour = |x| encode(reference.pixel_colour([width, height], x, y), model.render.transfer);
        is_wanted().then(|| (0..width).map(colour).collect::<Vec<_>>())
    };
    let rows: Vec<Vec<[u8; 3]>> = (0..height).into_par_iter().map(row).collect::<Option<_>>()?;
    Some(Picture::from_fn(width, height, |x, y| rows[y as usize][x as usize]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use host_tools::{builtin, import};

    #[test]
    fn it_is_the_reference_as_everyone_has_it() {
        let mut model = import::load_from(&import::Embedded(builtin::FILES), "scene.toml").unwrap().model;
        model.render.size = [24, 18];
        for samples in [1, 3] {
            model.render.samples = samples;
            let expected = Reference::new(&model).picture(&|_| ());
            assert_eq!(reference(&model, &|| true), Some(expected));
        }
        assert_eq!(reference(&model, &|| false), None);
    }
}
