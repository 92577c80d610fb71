//! A parsed `scene.toml` with its text, so that every error has its line; and the checks of single
//! values.

use std::ops::{Range, RangeInclusive};

use glam::DVec3;
use toml::Spanned;

use super::error::{ImportError, excerpt, reason};
use super::schema::{Number, SceneToml, Vector};
use super::source::Source;
use super::{LARGEST, SMALLEST, beside, extension};

/// A parsed file.
#[derive(Debug)]
pub(super) struct Document {
    /// The file, for messages.
    pub file: String,
    pub scene: SceneToml,
    text: String,
}

impl Document {
    /// The settings of a scene that has no file for them; `file` is its OBJ.
    pub(super) fn absent(file: String) -> Self {
        Self { file, scene: SceneToml::default(), text: String::new() }
    }

    /// Parses the contents of `file`.
    pub(super) fn parse(file: String, bytes: Vec<u8>) -> Result<Self, ImportError> {
        if bytes.is_empty() {
            return Err(ImportError::Empty { file });
        }
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            return Err(ImportError::Utf16 { file });
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = error.utf8_error().valid_up_to();
            let line = line_at(error.as_bytes(), good);
            ImportError::line(&file, line, "this is not UTF-8 text")
        })?;
        let scene = toml::from_str(&text).map_err(|error| {
            let place = error.span().unwrap_or_default().start;
            let line = line_at(text.as_bytes(), place);
            ImportError::line(&file, line, explain(error.message()))
        })?;
        Ok(Self { file, scene, text })
    }

    /// The name of the OBJ, as the scene file `name` gives it; `None` of a scene of spheres alone.
    ///
    /// # Errors
    /// Nothing to see, no such file, or not an OBJ.
    pub(super) fn model(&self, source: &dyn Source, name: &str) -> Result<Option<String>, ImportError> {
        let Some(model) = &self.scene.model else {
            if !self.scene.sphere.is_empty() {
                return Ok(None);
            }
            let message = "`model` is missing; name an OBJ file, such as model = \"room.obj\"";
            return Err(self.error(0..0, message));
        };
        let obj = beside(name, model.get_ref());
        let wrong = match source.open(&obj) {
            _ if extension(&obj) != "obj" => "a model is an .obj file".into(),
            Ok(_) => return Ok(Some(obj)),
            Err(error) => reason(&error),
        };
        Err(self.error(model.span(), format!("model {}: {wrong}", source.describe(&obj))))
    }

    /// The line of a place in the text.
    pub(super) fn line(&self, place: Range<usize>) -> u64 {
        line_at(self.text.as_bytes(), place.start)
    }

    /// What is wrong at a place in the text.
    pub(super) fn error(&self, place: Range<usize>, message: impl Into<String>) -> ImportError {
        ImportError::line(&self.file, self.line(place), message)
    }

    /// A whole number in a range.
    pub(super) fn count(
        &self,
        key: &str,
        range: RangeInclusive<u32>,
        value: &Spanned<Number>,
    ) -> Result<u32, ImportError> {
        let Number(number) = *value.get_ref();
        // Casting saturates, and what it changes is no whole number of the range.
        let whole = number as u32;
        if f64::from(whole) == number && range.contains(&whole) {
            return Ok(whole);
        }
        let message = format!("{key} of {number}; it must be a whole number from {} to {}", range.start(), range.end());
        Err(self.error(value.span(), message))
    }

    /// A point in scene units.
    pub(super) fn point(&self, value: &Spanned<Vector>) -> Result<DVec3, ImportError> {
        let Vector(point) = *value.get_ref();
        if point.abs().max_element() <= LARGEST {
            return Ok(point);
        }
        Err(self.error(value.span(), format!("{point} is beyond {LARGEST:e}")))
    }

    /// A direction of any length but zero.
    pub(super) fn direction(&self, key: &str, value: &Spanned<Vector>) -> Result<DVec3, ImportError> {
        let Vector(direction) = *value.get_ref();
        if (SMALLEST..=LARGEST).contains(&direction.abs().max_element()) {
            return Ok(direction);
        }
        let message = format!("{key} {direction} is not a direction; give one of length 1 or so");
        Err(self.error(value.span(), message))
    }

    /// Linear RGB from 0 to `most`, or `absent` where there is none.
    pub(super) fn colour(
        &self,
        key: &str,
        most: f64,
        value: Option<&Spanned<Vector>>,
        absent: DVec3,
    ) -> Result<DVec3, ImportError> {
        let Some(value) = value else {
            return Ok(absent);
        };
        let Vector(colour) = *value.get_ref();
        if colour.min_element() >= 0.0 && colour.max_element() <= most {
            return Ok(colour);
        }
        let message = format!("{key} {colour} is out of range; each channel is from 0 to {most:?}");
        Err(self.error(value.span(), message))
    }
}

/// The line, from 1, of the byte at `place`.
fn line_at(text: &[u8], place: usize) -> u64 {
    1 + text.iter().take(place).filter(|&&b| b == b'\n').count() as u64
}

/// The parser's message on one line; where it names the keys or the values that would be right, the
/// nearest of them, not all.
fn explain(message: &str) -> String {
    // Serde's wording: "unknown field `colr`, expected one of `kind`, `colour`".
    let mut quoted = message.split('`').skip(1).step_by(2);
    let what = match message {
        _ if message.starts_with("unknown field") => "unknown key",
        _ if message.starts_with("unknown variant") => "unknown value",
        "invalid type: map, expected a sequence" => {
            return "there may be several of these; double the brackets, such as [[light]]".into();
        }
        _ => {
            // Serde's words for what TOML calls otherwise.
            let message = message.replace("a sequence", "an array").replace("a map", "a table").replace(" as i128", "");
            return message.split_whitespace().collect::<Vec<_>>().join(" ");
        }
    };
    let given = quoted.next().unwrap_or_default();
    let nearest = quoted.min_by_key(|known| strsim::damerau_levenshtein(given, known));
    format!("{what} `{}`; the nearest known one is `{}`", excerpt(given), nearest.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::testing::scene;

    fn fault(text: &[u8]) -> String {
        Document::parse("x.toml".into(), text.to_vec()).unwrap_err().to_string()
    }

    #[test]
    fn every_fault_of_form_has_its_line() {
        let cases = [
            ("model = 'a'\nmodle = 'b'", "2: unknown key `modle`; the nearest known one is `model`"),
            ("\n[camera]\nfov = 40", "3: unknown key `fov`; the nearest known one is `fov_y`"),
            ("[[light]]\n[[light]]\ncolor = 1", "3: unknown key `color`; the nearest known one is `colour`"),
            ("[[light]]\nkind = 'pint'", "2: unknown value `pint`; the nearest known one is `point`"),
            ("[material.a]\nkind = 'glass'", "2: unknown value `glass`; the nearest known one is `metal`"),
            ("transfer = 'SRGB'", "1: unknown value `SRGB`; the nearest known one is `srgb`"),
            ("[camera]\nfov_y = nan", "2: NaN is not a finite number"),
            ("[camera]\nposition = [0,\n1, inf]", "3: inf is not a finite number"),
            ("[camera]\nposition = [0, 1]", "2: invalid length 2, expected three numbers such as [0, 1, 5]"),
            ("[camera]\nup = [0, 1, 0, 0]", "2: invalid length 4, expected three numbers such as [0, 1, 5]"),
            ("[camera]\nfov_y = '40'", "2: invalid type: string \"40\", expected a number"),
            ("model = 3", "1: invalid type: integer `3`, expected a string"),
            ("camera = 3", "1: invalid type: integer `3`, expected a table such as [camera]"),
            ("[light]\nkind = 'point'", "1: there may be several of these; double the brackets, such as [[light]]"),
            ("[material.a]\nroughness = 'rough'", "2: invalid type: string \"rough\", expected a number"),
            ("[material.a]\nroughness = nan", "2: NaN is not a finite number"),
            ("[render]\npaths = 1", "2: invalid type: integer `1`, expected a boolean"),
            ("[render]\nsamples = true", "2: invalid type: boolean `true`, expected a number"),
        ];
        for (text, expected) in cases {
            assert_eq!(fault(text.as_bytes()), format!("x.toml:{expected}"), "{text}");
        }
        assert!(fault(b"model = 'a'\n[camera\n").starts_with("x.toml:2: "));
        assert!(fault(b"model = 'a'\nmodel = 'b'\n").starts_with("x.toml:2: "));
    }

    #[test]
    fn what_is_not_text_is_refused() {
        assert_eq!(fault(b""), "x.toml: the file is empty");
        assert_eq!(fault(b"\xff\xfem\0"), "x.toml: the file is UTF-16; save it as UTF-8 text");
        assert_eq!(fault(b"model = 'a'\n# \xff"), "x.toml:2: this is not UTF-8 text");
    }

    #[test]
    fn every_key_of_the_format_is_known() {
        let text = include_bytes!("every_key.toml");
        let scene = Document::parse("x.toml".into(), text.to_vec()).unwrap().scene;
        assert_eq!(scene.sphere.len(), 1);
        assert_eq!(scene.camera.unwrap().get_ref().fov_y.as_ref().unwrap().get_ref().0, 40.0);
    }

    #[test]
    fn a_scene_has_a_model_that_is_an_obj() {
        let missing = "1: `model` is missing; name an OBJ file, such as model = \"room.obj\"";
        let cases = [
            ("transfer = 'srgb'", missing),
            ("\nmodel = 'no.obj'", "2: model built-in no.obj: no such file"),
            ("model = 'room.ply'", "1: model built-in room.ply: a model is an .obj file"),
        ];
        for (text, expected) in cases {
            let expected = format!("built-in s.toml:{expected}");
            assert_eq!(scene(text).unwrap_err(), expected);
        }
    }
}
