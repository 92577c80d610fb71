//! Axes that fit their values: logarithmic where the values span a decade, with a place for what a scale cannot show.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

use super::number::tick;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scale {
    Linear,
    /// Linear, with more below less.
    Downwards,
    Logarithmic,
}

/// The way from values to positions along an axis. Positions are what `plotters` is given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    scale: Scale,
    /// Positions of both ends.
    ends: (f64, f64),
    /// Where there are marks, and what they say.
    ticks: Vec<(f64, String)>,
    /// The position for zero on a logarithmic axis and for infinity on a downward one.
    beyond: Option<f64>,
}

/// Marks of an axis, at most about this many.
const MOST_TICKS: f64 = 6.0;

impl Axis {
    /// For values of at least 0: from 0 on, or logarithmic where they span a decade.
    pub(super) fn upwards(values: impl Iterator<Item = f64>) -> Self {
        let (mut least, mut most, mut zero) = (f64::INFINITY, 0.0f64, false);
        for value in values.filter(|value| value.is_finite()) {
            if value > 0.0 {
                least = least.min(value);
                most = most.max(value);
            } else {
                zero = true;
            }
        }
        if least >= most || most < 10.0 * least {
            return Self::linear(0.0, if most > 0.0 { most } else { 1.0 });
        }
        let (low, high) = (libm::log10(least), libm::log10(most));
        let room = 0.06 * (high - low);
        let ticks = logarithmic_ticks(low - room, high + room);
        let axis = Self { scale: Scale::Logarithmic, ends: (low - room, high + room), ticks, beyond: None };
        if zero { axis.with_place_beyond("0") } else { axis }
    }

    /// For values of which more is better: better is at the lower end, infinity below it as "equal".
    pub(super) fn downwards(values: impl Iterator<Item = f64>) -> Self {
        let (mut least, mut most, mut infinite) = (f64::INFINITY, f64::NEG_INFINITY, false);
        for value in values {
            if value.is_finite() {
                least = least.min(value);
                most = most.max(value);
            } else {
                infinite = true;
            }
        }
        if least > most {
            (least, most) = (0.0, 1.0);
        }
        let room = (0.08 * (most - least)).max(0.5);
        let (from, to) = (least - room, most + room);
        let ticks = linear_ticks(from, to).into_iter().map(|(value, text)| (-value, text)).collect();
        let axis = Self { scale: Scale::Downwards, ends: (-to, -from), ticks, beyond: None };
        if infinite { axis.with_place_beyond("equal") } else { axis }
    }

    /// Marks at 0, 1, 2, ….
    pub(super) fn of_categories(names: &[String]) -> Self {
        let ticks = names.iter().enumerate().map(|(index, name)| (index as f64, name.clone())).collect();
        let last = names.len().saturating_sub(1) as f64;
        Self { scale: Scale::Linear, ends: (-0.3, last + 0.3), ticks, beyond: None }
    }

    fn linear(from: f64, to: f64) -> Self {
        let end = to + 0.06 * (to - from);
        Self { scale: Scale::Linear, ends: (from, end), ticks: linear_ticks(from, end), beyond: None }
    }

    fn with_place_beyond(mut self, name: &str) -> Self {
        let span = self.ends.1 - self.ends.0;
        let place = self.ends.0 - 0.06 * span;
        self.ends.0 = place - 0.05 * span;
        self.ticks.insert(0, (place, name.into()));
        self.beyond = Some(place);
        self
    }

    /// Where a value is drawn. What the scale cannot show is at its own place.
    pub(super) fn position(&self, value: f64) -> f64 {
        let position = match self.scale {
            Scale::Linear => value,
            Scale::Downwards => -value,
            Scale::Logarithmic => libm::log10(value),
        };
        if position.is_finite() { position } else { self.beyond.unwrap_or(self.ends.0) }
    }

    /// Whether some value has the place of what the scale cannot show.
    pub(super) fn has_place_beyond(&self) -> bool {
        self.beyond.is_some()
    }
}

fn linear_ticks(from: f64, to: f64) -> Vec<(f64, String)> {
    let rough = (to - from) / MOST_TICKS;
    let power = libm::pow(10.0, libm::floor(libm::log10(rough)));
    let step = [1.0, 2.0, 5.0].map(|digit| digit * power).into_iter().find(|&step| step >= rough);
    let step = step.unwrap_or(10.0 * power);
    let first = libm::ceil(from / step) as i64;
    let last = libm::floor(to / step) as i64;
    (first..=last).map(|index| (index as f64 * step, tick(index as f64 * step))).collect()
}

fn logarithmic_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let digits: &[f64] = if high - low >= 2.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let skip = libm::ceil((high - low) / MOST_TICKS).max(1.0) as usize;
    let decades = (libm::floor(low) as i32..=libm::ceil(high) as i32).step_by(skip);
    let values = decades.flat_map(|decade| digits.iter().map(move |digit| digit * libm::pow(10.0, f64::from(decade))));
    let ticks = values.map(|value| (libm::log10(value), tick(value)));
    ticks.filter(|&(position, _)| (low..=high).contains(&position)).collect()
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let share = (value - self.ends.0) / (self.ends.1 - self.ends.0);
        from + libm::round(share.clamp(0.0, 1.0) * f64::from(to - from)) as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.iter().map(|tick| tick.0).collect()
    }

    fn range(&self) -> Range<f64> {
        self.ends.0..self.ends.1
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, position: &f64) -> String {
        self.ticks.iter().find(|tick| tick.0 == *position).map_or(String::new(), |tick| tick.1.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|tick| tick.1.as_str()).collect()
    }

    #[test]
    fn a_decade_asks_for_logarithms_and_zero_gets_a_place() {
        let near = Axis::upwards([2.0, 19.0].into_iter());
        assert_eq!((near.scale, names(&near)), (Scale::Linear, vec!["0", "5", "10", "15", "20"]));
        let far = Axis::upwards([0.01, 10.0].into_iter());
        assert_eq!((far.scale, names(&far)), (Scale::Logarithmic, vec!["0.01", "0.1", "1", "10"]));
        assert!(!far.has_place_beyond());
        let with_zero = Axis::upwards([0.0, 0.01, 10.0].into_iter());
        assert_eq!(names(&with_zero)[0], "0");
        assert!(with_zero.position(0.0) < with_zero.position(0.01));
    }

    #[test]
    fn more_is_below_and_equal_pictures_lowest() {
        let axis = Axis::downwards([30.0, 55.0, f64::INFINITY].into_iter());
        assert!(axis.position(f64::INFINITY) < axis.position(55.0));
        assert!(axis.position(55.0) < axis.position(30.0));
        assert_eq!(names(&axis), ["equal", "30", "35", "40", "45", "50", "55"]);
    }

    #[test]
    fn every_value_is_inside() {
        let sets: [&[f64]; 6] = [&[], &[0.0], &[0.0, 0.0], &[3.0], &[1e-9, 1e12, 0.0], &[7.0, 7.0]];
        for values in sets {
            let values = || values.iter().copied();
            for axis in [Axis::upwards(values()), Axis::downwards(values())] {
                assert!(axis.ends.0 < axis.ends.1 && axis.ticks.len() <= 14, "{axis:?}");
                for value in values() {
                    assert!((axis.ends.0..=axis.ends.1).contains(&axis.position(value)), "{value} {axis:?}");
                }
            }
        }
    }
}
