//! The cheapest kernel, and the coarsest grid of it, whose picture stays inside a budget of error: decided from pictures.
//!
//! A budget is one bound or more on the measures of [`compare`](crate::compare): `over_4<0.1%@160x128`, `psnr>40,flip<0.01`.
//! The picture is drawn at the size that it names, else at the scene's, by one kernel after the other until one stays inside; then with ever
//! coarser grids, until one does not: with those bits, hardware for this scene would do.

use std::fmt;
use std::str::FromStr;

use super::engines;
use crate::compare::{Comparison, compare};
use crate::engine::Engine;
use crate::grid::LEAST_BITS;
use crate::model::Model;
use crate::picture::{Picture, parse_size, size_is_allowed};
use crate::prepare::Options;
use crate::reference::Reference;
use crate::render::TILE;

/// What is measured of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Measure {
    MaxAbs,
    MeanAbs,
    Rmse,
    Psnr,
    Ssim,
    Flip,
    Over1,
    Over4,
    Over64,
}

/// All of them, by name; those that are better when larger, and those that count pixels.
const MEASURES: [(&str, Measure); 9] = [
    ("max_abs", Measure::MaxAbs),
    ("mean_abs", Measure::MeanAbs),
    ("rmse", Measure::Rmse),
    ("psnr", Measure::Psnr),
    ("ssim", Measure::Ssim),
    ("flip", Measure::Flip),
    ("over_1", Measure::Over1),
    ("over_4", Measure::Over4),
    ("over_64", Measure::Over64),
];

impl Measure {
    fn name(self) -> &'static str {
        MEASURES.iter().find(|(_, measure)| *measure == self).map_or("", |(name, _)| name)
    }

    /// Whether it is of likeness, so that a budget bounds it from below.
    fn is_likeness(self) -> bool {
        matches!(self, Self::Psnr | Self::Ssim)
    }

    fn is_pixels(self) -> bool {
        matches!(self, Self::Over1 | Self::Over4 | Self::Over64)
    }

    fn of(self, apart: &Comparison) -> f64 {
        match self {
            Self::MaxAbs => apart.max_abs.into(),
            Self::MeanAbs => apart.mean_abs,
            Self::Rmse => apart.rmse,
            Self::Psnr => apart.psnr.unwrap_or(f64::INFINITY),
            Self::Ssim => apart.ssim,
            Self::Flip => apart.flip,
            Self::Over1 => apart.over_1 as f64,
            Self::Over4 => apart.over_4 as f64,
            Self::Over64 => apart.over_64 as f64,
        }
    }
}

/// One bound.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bound {
    measure: Measure,
    limit: f64,
    /// Whether the limit is in hundredths of all pixels.
    is_percent: bool,
    /// Whether the limit itself is allowed.
    is_inclusive: bool,
}

impl Bound {
    /// The measure in the bound's unit.
    fn value(&self, apart: &Comparison, pixels: u64) -> f64 {
        let value = self.measure.of(apart);
        if self.is_percent { value * 100.0 / pixels as f64 } else { value }
    }

    fn holds(&self, apart: &Comparison, pixels: u64) -> bool {
        let value = self.value(apart, pixels);
        let better = if self.measure.is_likeness() { value > self.limit } else { value < self.limit };
        better || self.is_inclusive && value == self.limit
    }

    fn unit(&self) -> &'static str {
        match (self.is_percent, self.measure) {
            (true, _) => " %",
            (_, Measure::Psnr) => " dB",
            _ => "",
        }
    }
}

/// Bounds that a picture must hold, all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    bounds: Vec<Bound>,
    /// The size of the picture that is judged; `None` for the scene's.
    pub size: Option<[u32; 2]>,
}

/// Why a text is no budget.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no bound; it is a measure, `<`, `<=`, `>` or `>=`, a number, perhaps `%` of the pixels, and perhaps `@WxH`, as \
     in over_4<0.1%@160x128; the measures are max_abs, mean_abs, rmse, flip, over_1, over_4 and over_64, from above, and psnr \
     and ssim, from below"
)]
pub struct NoBudget(String);

impl FromStr for Budget {
    type Err = NoBudget;

    /// Bounds with commas between them. One of them may name a size.
    fn from_str(text: &str) -> Result<Self, NoBudget> {
        let mut budget = Self { bounds: Vec::new(), size: None };
        for text in text.split(',') {
            let refused = || NoBudget(text.trim().into());
            let (bound, size) = match text.split_once('@') {
                Some((bound, size)) => {
                    (bound, Some(parse_size(size).filter(|&[w, h]| size_is_allowed(w, h)).ok_or_else(refused)?))
                }
                None => (text, None),
            };
            if size.is_some() && budget.size.is_some_and(|known| Some(known) != size) {
                return Err(refused());
            }
            budget.size = budget.size.or(size);
            budget.bounds.push(self::bound(bound).ok_or_else(refused)?);
        }
        Ok(budget)
    }
}

/// A bound without a size.
fn bound(text: &str) -> Option<Bound> {
    let at = text.find(['<', '>'])?;
    let (name, rest) = text.split_at(at);
    let is_from_below = rest.starts_with('>');
    let rest = &rest[1..];
    let (is_inclusive, rest) = rest.strip_prefix('=').map_or((false, rest), |rest| (true, rest));
    let (is_percent, number) = rest.trim().strip_suffix('%').map_or((false, rest), |number| (true, number));
    let (_, measure) = *MEASURES.iter().find(|(known, _)| *known == name.trim())?;
    let limit: f64 = number.trim().parse().ok()?;
    let makes_sense = limit.is_finite()
        && limit >= 0.0
        && is_from_below == measure.is_likeness()
        && (!is_percent || measure.is_pixels());
    makes_sense.then_some(Bound { measure, limit, is_percent, is_inclusive })
}

/// A kernel and a grid that was tried, and what its picture is like.
#[derive(Clone, Debug, PartialEq)]
pub struct Try {
    /// The kernel.
    pub kernel: &'static str,
    /// The bits of the grid.
    pub grid_bits: u32,
    /// Whether the picture stays inside the budget; where there is none, why.
    pub outcome: Result<bool, String>,
    /// What was measured, in the order of the bounds.
    text: String,
}

impl fmt::Display for Try {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match &self.outcome {
            Ok(true) => "inside",
            Ok(false) => "outside",
            Err(reason) => reason,
        };
        write!(f, "{:<8} {:>2} bits  {}{verdict}", self.kernel, self.grid_bits, self.text)
    }
}

/// What came of a search.
#[derive(Clone, Debug)]
pub struct Search {
    /// The cheapest kernel inside the budget, and the bits of its coarsest grid inside; `None` where there is none.
    pub chosen: Option<(&'static dyn Engine, u32)>,
    /// All that was tried, in order.
    pub tries: Vec<Try>,
}

/// Searches for the cheapest kernel and the coarsest grid that stay inside a budget, and tells of each try as it is done.
pub fn search(model: &Model, options: &Options, budget: &Budget, told: &mut dyn FnMut(&Try)) -> Search {
    let mut model = model.clone();
    model.render.size = budget.size.unwrap_or(model.render.size);
    let judge = Judge { truth: Reference::new(&model).picture(&|_| {}), model: &model, options, budget };
    let mut search = Search { chosen: None, tries: Vec::new() };
    let mut is_inside = |engine: &dyn Engine, bits| {
        let tried = judge.judge(engine, bits);
        told(&tried);
        let is_inside = tried.outcome == Ok(true);
        search.tries.push(tried);
        is_inside
    };
    for engine in engines() {
        let finest = options.grid_bits.map_or(engine.grid_bits(), |bits| bits.min(engine.grid_bits()));
        if is_inside(engine, finest) {
            let coarsest = (LEAST_BITS..finest).rev().take_while(|&bits| is_inside(engine, bits)).last();
            search.chosen = Some((engine, coarsest.unwrap_or(finest)));
            break;
        }
    }
    search
}

/// What a try is judged by.
struct Judge<'a> {
    truth: Picture,
    model: &'a Model,
    options: &'a Options,
    budget: &'a Budget,
}

impl Judge<'_> {
    fn judge(&self, engine: &dyn Engine, grid_bits: u32) -> Try {
        let refused =
            |reason: String| Try { kernel: engine.name(), grid_bits, outcome: Err(reason), text: String::new() };
        let options = Options { grid_bits: Some(grid_bits), ..*self.options };
        let picture = match engine.prepare(self.model, &options) {
            Ok(prepared) => engine.render(prepared.blob.bytes(), TILE, &|_| {}),
            Err(error) => return refused(error.to_string()),
        };
        let apart = match picture {
            Ok(rendered) => compare(&rendered.picture, &self.truth),
            Err(error) => return refused(error.to_string()),
        };
        let Ok(apart) = apart else { return refused("its picture has another size".into()) };
        let pixels = self.truth.pixels().len() as u64;
        let bounds = &self.budget.bounds;
        let text = bounds
            .iter()
            .map(|bound| format!("{} {:.4}{}, ", bound.measure.name(), bound.value(&apart, pixels), bound.unit()));
        Try {
            kernel: engine.name(),
            grid_bits,
            outcome: Ok(bounds.iter().all(|bound| bound.holds(&apart, pixels))),
            text: text.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_read_as_they_are_written() {
        let budget: Budget = " over_4 < 0.1% @ 160x128, psnr>=40".parse().expect("a budget");
        assert_eq!(budget.size, Some([160, 128]));
        let [pixels, psnr] = budget.bounds[..] else { panic!("two bounds") };
        assert_eq!(pixels, Bound { measure: Measure::Over4, limit: 0.1, is_percent: true, is_inclusive: false });
        assert_eq!(psnr, Bound { measure: Measure::Psnr, limit: 40.0, is_percent: false, is_inclusive: true });
        assert_eq!("flip<=0.01".parse::<Budget>().expect("a budget").size, None);
    }

    #[test]
    fn what_is_no_bound_is_named() {
        for wrong in [
            "",
            "over_4",
            "over_5<1",
            "over_4>1",
            "psnr<40",
            "rmse<1%",
            "over_4<-1",
            "over_4<NaN",
            "over_4<1@0x4",
            "over_4<1@160",
            "over_4<1%%",
            "flip<inf",
            "over_4<<1",
        ] {
            assert_eq!(wrong.parse::<Budget>(), Err(NoBudget(wrong.into())), "{wrong}");
        }
        let two = "flip<1@8x8,over_1<3@9x9".parse::<Budget>();
        assert_eq!(two, Err(NoBudget("over_1<3@9x9".into())), "two sizes");
    }

    #[test]
    fn bounds_hold_up_to_their_limit() {
        let black = Picture::new(10, 10);
        let mut other = black.clone();
        other.pixels_mut()[0] = [9, 0, 0];
        let apart = compare(&black, &other).expect("one size");
        for (text, holds) in [
            ("over_4<1%", false),
            ("over_4<=1%", true),
            ("over_4<1.01%", true),
            ("over_4<2", true),
            ("max_abs<9", false),
            ("max_abs<=9", true),
            ("psnr>40", true),
            ("psnr>60", false),
        ] {
            let budget: Budget = text.parse().expect("a budget");
            assert_eq!(budget.bounds[0].holds(&apart, 100), holds, "{text}");
        }
        // Equal pictures have no ratio of noise, and are inside any budget of it.
        let same = compare(&black, &black).expect("one size");
        assert!("psnr>999".parse::<Budget>().expect("a budget").bounds[0].holds(&same, 100));
    }
}
