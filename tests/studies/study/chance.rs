//! What the tracer of 1994 has by chance, beside the text: several samples, rough mirrors and paths, with error against samples.

use host_tools::engine::PLANES12;
use tests::convergence::{ALLOWED, Truth, errors, spheres, truth};

use super::paths::Row;
use super::text::{Verdict, table};

/// Samples a pixel.
const COUNTS: [u32; 5] = [1, 4, 16, 64, 256];

/// Of the reference's picture.
const TRUTH_SAMPLES: u32 = 4096;

const SIZE: [u32; 2] = [48, 36];

const TEXT: &str = "\n## Several samples, rough mirrors and paths\n\n\
    The text's future work: \"statistically-based random jittering of reflection rays\", several dozen samples a pixel. Random numbers are a \
    hash of pixel, sample and generation (`docs/SHADING.md`), so that processors need no generator, no edge of a tile or a renderer shows, \
    and a picture is the same everywhere: lanes in lockstep, pixels one by one and both chips have the same bits. A scene of one sample \
    without any of it has the code and the speed of before. The machine below has none: its program is the text's.\n\n\
    - **Samples** of a pixel go through the places of `docs/SHADING.md`, since rays are linear in the place; one goes through the middle. \
    Directions are rounded to whole units after that: where a picture has more pixels than they have units, places are as coarse as these.\n\
    - **Rough mirrors**, of a `roughness` r: the reflected ray m goes on along m + r |m| s, for a point s of the unit sphere, is brought \
    back to the length of m, and mirrored at the surface where it would go into it.\n\
    - **Paths**, with `paths = true`: at each sphere a path adds the sphere's own light and what its light sends there, in its share, and \
    goes on in one direction, matt or mirrored, by chance in proportion to the largest channels of the two; the share is multiplied \
    by the way's albedo over its probability. Matt is n + |n| s, for the normal n, brought to the length that the ray had: as often as the \
    cosine is large. So normals and rays stay in their words, a processor needs no stack, and a matt surface costs the albedo, 36 bits.\n\n\
    A path of `planes12` gathers what `docs/SHADING.md` says of paths, and as in all its pictures: of one light, parallel, by N.L, without \
    shadows or highlights; the mirror's colour as it is, without Schlick; one colour behind everything, which lights what sees it; nothing \
    that passes. No light is more than white, a lamp's neither; shares saturate at 128. There is no `ambient`, which stands for what paths gather.\n";

/// The figures.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chance {
    /// Of paths.
    pub(crate) row: Row,
    /// Of the reference's picture.
    pub(crate) noise: f64,
}

impl Chance {
    pub(crate) fn measure() -> Self {
        let model = spheres(SIZE);
        let Truth { picture, noise } = truth(&model, TRUTH_SAMPLES);
        let errors = errors(PLANES12, &model, &picture, &COUNTS, |range| vec![range]);
        Self { row: Row { kernel: PLANES12.name(), errors }, noise }
    }

    pub(crate) fn verdict(&self) -> Verdict {
        let exponent = self.row.exponent();
        Verdict {
            claim: "the error falls as the inverse square root of the samples",
            holds: ALLOWED.contains(&exponent),
            because: format!("an exponent of {exponent:.3}; {} to {} count as -0.5", ALLOWED.start(), ALLOWED.end()),
        }
    }

    /// Its part of the document.
    pub(crate) fn document(&self) -> String {
        let [width, height] = SIZE;
        let head = COUNTS.map(|count| count.to_string());
        let errors = self.row.errors.iter().map(|(_, error)| format!("{error:.5}"));
        format!(
            "{TEXT}\nFour spheres by paths, matt, rough, half a mirror and shining, in {width}x{height} pixels against the f64 reference \
             without shadows, which has random numbers of its own and {TRUTH_SAMPLES} samples a pixel, with a noise of {:.5}: the root mean \
             square error in light, of which white is 1, by samples a pixel, and what of it no number of samples takes away, the \
             words' and the reference's (as in `docs/PATHS.md`).\n\n{}- {}\n",
            self.noise,
            table(
                &[&head[..], &["own error".into()]].concat(),
                [errors.chain([format!("{:.5}", self.row.own())]).collect()]
            ),
            self.verdict(),
        )
    }
}
