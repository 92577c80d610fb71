//! The error of pictures by paths falls as the inverse square root of the samples, by every kernel.

use std::ops::Range;

use host_tools::engine::ENGINES;
use tests::convergence::{ALLOWED, Truth, errors, exponent, scene, truth};

const COUNTS: [u32; 5] = [1, 4, 16, 64, 256];

/// Sixteen times as many as any picture has: a quarter of its error at the least.
const TRUTH_SAMPLES: u32 = 4096;

#[test]
fn the_error_falls_as_the_inverse_square_root_of_the_samples() {
    let model = scene([24, 18]);
    let Truth { picture, noise } = truth(&model, TRUTH_SAMPLES);
    for engine in ENGINES {
        let all = |range: Range<u16>| vec![range];
        let found = errors(engine, &model, &picture, &COUNTS, all);
        assert!(noise < found[4].1 / 3.0, "{}: the truth has a noise of {noise}, and {found:?}", engine.name());
        let slope = exponent(&found);
        assert!(ALLOWED.contains(&slope), "{}: {slope} by {found:?}", engine.name());
    }
    // Samples that are the same tell nothing new.
    let again = |range: Range<u16>| range.map(|_| 0..1).collect();
    let found = errors(ENGINES[0], &model, &picture, &COUNTS, again);
    let slope = exponent(&found);
    assert!(!ALLOWED.contains(&slope), "{slope} by {found:?}");
}
