//! Why pixels differ: the first cause that applies, by what the rays behind them saw.

use core_rt::kernel::NONE;

use super::row::{Cause, Causes};
use crate::compare::{SizeMismatch, difference};
use crate::model::Format;
use crate::picture::Picture;
use crate::witness::Seen;

/// A picture and what its rays saw.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<'a> {
    /// The picture.
    pub picture: &'a Picture,
    /// What the rays behind each pixel saw, in its order.
    pub seen: &'a [Seen],
}

/// The pixels of a picture that differ from those of the reference's, by cause.
///
/// # Errors
/// Where the pictures differ in size.
pub fn causes(drawn: Drawn<'_>, truth: Drawn<'_>, format: Format) -> Result<Causes, SizeMismatch> {
    let gray = difference(drawn.picture, truth.picture)?;
    let mut causes = Causes::default();
    let colours = drawn.picture.pixels().iter().zip(truth.picture.pixels());
    let seen = drawn.seen.iter().zip(truth.seen);
    for ((&[difference, ..], (here, there)), (mine, others)) in gray.pixels().iter().zip(colours).zip(seen) {
        if difference == 0 {
            continue;
        }
        let cause = if mine.first == NONE && others.first != NONE {
            &mut causes.holes
        } else if mine.camera != others.camera {
            &mut causes.visibility
        } else if mine.secondary != others.secondary {
            &mut causes.secondary
        } else if mine.shadows != others.shadows {
            &mut causes.shadow
        } else if (0..3).any(|channel| here[channel].abs_diff(there[channel]) > steps(format)[channel]) {
            &mut causes.shading
        } else {
            &mut causes.quantisation
        };
        let Cause { pixels, over_4, over_64 } = cause;
        *pixels += 1;
        *over_4 += u64::from(difference > 4);
        *over_64 += u64::from(difference > 64);
    }
    Ok(causes)
}

/// The widest step of each channel of a format, of 255.
const fn steps(format: Format) -> [u8; 3] {
    match format {
        Format::Rgb888 | Format::Gray8 => [1; 3],
        // 31 and 63 steps, widened to 255.
        Format::Rgb565 => [9, 5, 9],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one pixel.
    fn found(colours: [[u8; 3]; 2], seen: [Seen; 2], format: Format) -> Causes {
        let [a, b] = colours.map(|colour| Picture::from_fn(1, 1, |_, _| colour));
        let [mine, others] = &seen;
        let drawn = Drawn { picture: &a, seen: std::slice::from_ref(mine) };
        causes(drawn, Drawn { picture: &b, seen: std::slice::from_ref(others) }, format).unwrap()
    }

    #[test]
    fn the_first_cause_counts_and_only_where_pixels_differ() {
        let far = [[0; 3], [90, 0, 0]];
        let one = Cause { pixels: 1, over_4: 1, over_64: 1 };
        let seen = Seen { first: 3, camera: 1, secondary: 1, shadows: 1 };
        let other = Seen { first: 4, camera: 2, secondary: 2, shadows: 2 };
        let none = Causes::default();
        let cases = [
            ([Seen { first: NONE, ..other }, seen], Causes { holes: one, ..none }),
            ([other, Seen { first: NONE, ..seen }], Causes { visibility: one, ..none }),
            // The first sample sees the same; another does not.
            ([Seen { first: 3, ..other }, seen], Causes { visibility: one, ..none }),
            ([Seen { first: 3, camera: 1, ..other }, seen], Causes { secondary: one, ..none }),
            ([Seen { shadows: 2, ..seen }, seen], Causes { shadow: one, ..none }),
            ([seen, seen], Causes { shading: one, ..none }),
        ];
        for (pair, expected) in cases {
            assert_eq!(found(far, pair, Format::Rgb888), expected);
            assert_eq!(found([[7; 3]; 2], pair, Format::Rgb888), none, "the same colour");
        }
    }

    #[test]
    fn one_step_is_quantisation() {
        let seen = Seen { first: 3, camera: 1, secondary: 1, shadows: 1 };
        let kind = |colours, format| {
            let Causes { shading, quantisation, .. } = found(colours, [seen; 2], format);
            (shading.pixels, quantisation.pixels)
        };
        assert_eq!(kind([[1, 2, 3], [0, 3, 2]], Format::Rgb888), (0, 1));
        assert_eq!(kind([[1, 2, 3], [0, 4, 2]], Format::Rgb888), (1, 0));
        assert_eq!(kind([[9, 5, 9], [0; 3]], Format::Rgb565), (0, 1));
        assert_eq!(kind([[9, 6, 9], [0; 3]], Format::Rgb565), (1, 0));
    }
}
