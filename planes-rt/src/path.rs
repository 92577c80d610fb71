//! Paths: where a ray goes on by chance, from what is matt too, and the share of the pixel that it stands for then.
//!
//! As `docs/SHADING.md` has them, with what this tracer knows of light: at each sphere a path adds what that sends, and goes on in
//! one direction, about the normal or mirrored. Which, is by chance in proportion to the largest channels of the two, and its share
//! grows by as much as the other is left out. So one ray a sample is enough, and processors need no stack.

use core_rt::random::{Sample, below};

use crate::colour::{Surface, share_of};
use crate::jitter::{diffuse, strewn};
use crate::step::reflection;
use crate::widths::Widths;

/// The largest share, 128: beyond it shares saturate. They grow where surfaces say that they send on more than they get. Times
/// light, or times a factor of 2^12, it is below 2^31.
pub(crate) const SHARE_MOST: i32 = 1 << 18;

/// A ray that goes on from a surface, and what it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Onward {
    pub(crate) direction: [i16; 3],
    pub(crate) share: [i32; 3],
}

/// Where a path goes on that came along `direction` with a share, as what is random of this surface of a sample says; `None` where
/// nothing would be seen of it. Surfaces have numbers from 1.
#[inline(always)]
pub(crate) fn onward(
    surface: &Surface,
    [direction, normal]: [[i16; 3]; 2],
    share: [i32; 3],
    (sample, number): (Sample, u32),
    widths: Widths,
) -> Option<Onward> {
    let [choice, height, turn, _] = sample.numbers(number);
    let (is_matt, factor) = chosen(surface, choice);
    let share = [0, 1, 2].map(|channel| share_of(share[channel], factor[channel]).min(SHARE_MOST));
    if share == [0; 3] {
        return None;
    }
    let direction = if is_matt {
        diffuse(direction, normal, [height, turn], widths)
    } else {
        let mirrored = reflection(direction, normal, widths);
        match surface.roughness {
            0 => mirrored,
            roughness => strewn(mirrored, normal, roughness, [height, turn], widths),
        }
    };
    Some(Onward { direction, share })
}

/// Whether the matt way is taken, by a random number, and what the share is multiplied by: the way's albedo over its probability,
/// at most 2 in the unit of shares. An albedo is below 2^12, and so is the sum of two largest channels but for its end.
#[inline(always)]
fn chosen(surface: &Surface, choice: u32) -> (bool, [i32; 3]) {
    let [matt, mirror] = [surface.matt, surface.mirror].map(|[r, g, b]| u32::from(r.max(g).max(b)));
    let all = matt + mirror;
    let is_matt = below(choice, all) < matt;
    let (albedo, strongest) = if is_matt { (surface.matt, matt) } else { (surface.mirror, mirror) };
    if strongest == all {
        return (is_matt, albedo.map(i32::from));
    }
    let factor = |c: u16| (u32::from(c) * all + strongest / 2).checked_div(strongest).unwrap_or_default();
    (is_matt, albedo.map(|c| factor(c) as i32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{LIGHT_MAX, SHARE_ONE};

    const ALBEDOS: [[u16; 3]; 6] =
        [[0; 3], [SHARE_ONE; 3], [1, 0, 0], [1024, 1023, 3], [0, SHARE_ONE, 291], [512, 512, 512]];

    /// The mean over all choices, each as likely as it is, is the sum of the albedos: a factor is within half a unit of its own.
    #[test]
    fn what_is_chosen_stands_for_what_is_not() {
        for matt in ALBEDOS {
            for mirror in ALBEDOS {
                let surface = Surface { matt, mirror, ..Surface::default() };
                let mut sums = [0i64; 3];
                let choices = 1i64 << 12;
                for choice in 0..1u32 << 12 {
                    let (is_matt, factor) = chosen(&surface, choice << 20);
                    let way = if is_matt { matt } else { mirror };
                    assert!(way != [0; 3] || matt == mirror, "{surface:?}: a way that is black");
                    assert!(factor.iter().all(|&c| (0..=2 * i32::from(SHARE_ONE)).contains(&c)), "{factor:?}");
                    (0..3).for_each(|channel| sums[channel] += i64::from(factor[channel]));
                }
                for channel in 0..3 {
                    let meant = i64::from(matt[channel]) + i64::from(mirror[channel]);
                    // A way is taken by a whole number of the choices: one more or less is a factor more.
                    let off = (sums[channel] - meant * choices).abs();
                    assert!(off <= choices / 2 + 2 * 2 * i64::from(SHARE_ONE), "{surface:?}: {sums:?}");
                }
            }
        }
    }

    #[test]
    fn shares_saturate_and_end_at_nothing() {
        let white = Surface { matt: [SHARE_ONE; 3], mirror: [SHARE_ONE; 3], ..Surface::default() };
        let at = |surface: &Surface, share, number| {
            let sample = Sample { pixel: [u16::MAX; 2], number: u16::MAX };
            onward(surface, [[0, 0, -500], [0, 0, 200]], share, (sample, number), Widths::PIXEL_PLANES)
        };
        let mut share = [i32::from(SHARE_ONE); 3];
        for number in 1..40 {
            share = at(&white, share, number).unwrap().share;
        }
        assert_eq!(share, [SHARE_MOST; 3]);
        // The ends fit 32 bits: the largest share of the brightest light, and twice the largest share.
        assert_eq!(share_of(LIGHT_MAX.into(), SHARE_MOST), i32::from(LIGHT_MAX) << 7);
        assert_eq!(share_of(SHARE_MOST, 2 * i32::from(SHARE_ONE)), 2 * SHARE_MOST);
        let grey = Surface { matt: [512; 3], ..Surface::default() };
        let mut surfaces = 0;
        while let Some(next) = at(&grey, share, surfaces) {
            (share, surfaces) = (next.share, surfaces + 1);
        }
        // 2^18 by quarters: 1 is left after nine of them.
        assert_eq!((share, surfaces), ([1; 3], 9));
        assert_eq!(at(&Surface::default(), share, 1), None);
    }
}
