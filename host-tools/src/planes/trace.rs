//! Rays of one's own, in scene units, by the tracer of 1994.
//!
//! The origin becomes the nearest place in components, after a move along the ray where it is beyond them; the direction is as long as a picture's longest, rounded to components. So
//! coarse are both that a hit is that of a ray a unit aside: what the tracer sees, and not what is there.

use glam::DVec3;
use planes_rt::pixel::meet;
use planes_rt::scene::Scene;

use super::scene::DIRECTION_LENGTH;
use crate::grid::Grid;
use crate::reference::Hit;
use crate::trace::Trace;

/// A scene, and how it lies in the model's space.
#[derive(Clone, Copy, Debug)]
pub struct Tracer<'a> {
    scene: Scene<'a>,
    place: Grid,
}

impl<'a> Tracer<'a> {
    /// Traces the spheres of a scene whose components lie so.
    #[must_use]
    pub fn new(scene: Scene<'a>, place: Grid) -> Self {
        Self { scene, place }
    }
}

impl Trace for Tracer<'_> {
    fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let Grid { origin: middle, scale } = self.place;
        let most = f64::from(self.scene.settings().widths.coordinate_max());
        // Of any length that f64 has.
        let longest = direction.abs().max_element();
        let scaled = direction / longest;
        let unit = scaled.try_normalize()?;
        let start = (origin - middle) * scale;
        let skipped = enter(start, unit, most / 2.0)?;
        let words =
            |whole: DVec3| whole.round().clamp(DVec3::splat(-most), DVec3::splat(most)).to_array().map(|c| c as i16);
        let step = words(unit * f64::from(DIRECTION_LENGTH));
        let (prim, _, t) = meet(&self.scene, words(start + unit * skipped), step)?;
        let t = f64::from(t) / f64::from(1 << self.scene.settings().widths.t_fraction());
        // How far the direction in components goes along the one that was given.
        let along = skipped + t * DVec3::from_array(step.map(f64::from)).dot(unit);
        Some(Hit { t: along / scale / scaled.length() / longest, prim: prim as u32, u: 0.0, v: 0.0 })
    }
}

/// How far along its direction a ray comes to the ball of half the largest component, in which all spheres lie and from which all
/// differences are held; `None` where it never does.
fn enter(start: DVec3, unit: DVec3, radius: f64) -> Option<f64> {
    if !start.is_finite() {
        return None;
    }
    if start.length() <= radius {
        return Some(0.0);
    }
    let along = start.dot(unit);
    let beside = start - unit * along;
    let half_chord = radius * radius - beside.length_squared();
    let way = -along - half_chord.max(0.0).sqrt();
    (half_chord >= 0.0 && way >= 0.0).then_some(way)
}
