//! The statements of an MTL file: the check of each on its way to `tobj`, with what is drawn where one is wrong.

use std::ops::RangeInclusive;

use super::error::excerpt;
use super::lines::{Statement, number};
use crate::model::DEFAULT_DIFFUSE;

/// The greatest exponent of a highlight.
pub(super) const LARGEST_EXPONENT: f64 = 10_000.0;
/// The exponent of a highlight that has none.
pub(super) const DEFAULT_EXPONENT: u32 = 50;
/// The indices of refraction that there are: the format's own greatest, and its inverse.
pub(super) const IORS: RangeInclusive<f64> = 0.1..=10.0;
/// The index of refraction of glass.
pub(super) const DEFAULT_IOR: f64 = 1.5;

/// Appends a statement for `tobj` to `out`, if it is one that matters.
///
/// # Errors
/// A warning: what is wrong and what is done about it. The statement may have been passed on.
pub(super) fn check(statement: &Statement<'_>, material: &mut Option<String>, out: &mut String) -> Result<(), String> {
    let keyword = statement.keyword();
    let word = statement.words().next().unwrap_or_default();
    match keyword {
        "newmtl" if statement.name().is_empty() => {
            *material = None;
            return Err("a material without a name is ignored".into());
        }
        "newmtl" => {
            *material = Some(statement.name().into());
            *out = format!("newmtl {}\n", statement.name());
        }
        "Kd" | "Ks" | "Ke" | "Tf" | "Ns" | "Ni" | "d" | "Tr" | "illum" | "map_Kd" => {
            let Some(name) = material else {
                return Err(format!("{keyword} before any `newmtl` is ignored"));
            };
            let (value, wrong) = match keyword {
                "Kd" => colour(statement, DEFAULT_DIFFUSE, 1.0),
                "Ks" => colour(statement, 0.0, 1.0),
                "Ke" => colour(statement, 0.0, f64::INFINITY),
                "Tf" => colour(statement, 1.0, 1.0),
                "Ns" => scalar(word, DEFAULT_EXPONENT.into(), 0.0..=LARGEST_EXPONENT),
                "Ni" => scalar(word, DEFAULT_IOR, IORS),
                "d" if word == "-halo" => return Ok(()),
                "d" => scalar(word, 1.0, 0.0..=1.0),
                "Tr" => scalar(word, 0.0, 0.0..=1.0),
                "illum" => illumination(word),
                _ => texture(statement.name()),
            };
            if !value.is_empty() {
                *out = format!("{keyword} {value}\n");
            }
            if let Some(wrong) = wrong {
                return Err(format!("{keyword} of material `{}`{wrong}", excerpt(name)));
            }
        }
        _ => {}
    }
    Ok(())
}

/// What `tobj` is to read after a keyword, nothing for no statement at all; and what was wrong.
type Verdict = (String, Option<String>);

/// The colour after a keyword: three numbers, or one for all three channels.
fn colour(statement: &Statement<'_>, default: f64, largest: f64) -> Verdict {
    let given = || {
        let values = statement.words().map(number).collect::<Result<Vec<f64>, String>>()?;
        if let Some(negative) = values.iter().find(|&&v| v < 0.0) {
            return Err(format!("{negative} is negative"));
        }
        match values[..] {
            [all] => Ok([all; 3]),
            [r, g, b] => Ok([r, g, b]),
            _ => Err(format!("{} numbers where 3 are needed", values.len())),
        }
    };
    let (value, wrong) = match given() {
        Ok(value) => {
            let used = value.map(|v| v.min(largest));
            (used, (value != used).then(|| format!(" is over {largest}, and is cut to {largest}")))
        }
        Err(wrong) => ([default; 3], Some(format!(": {wrong}; drawn with {default}"))),
    };
    (value.map(|v| v.to_string()).join(" "), wrong)
}

/// A number in a range.
fn scalar(word: &str, default: f64, range: RangeInclusive<f64>) -> Verdict {
    let (value, wrong) = match number(word) {
        Ok(value) if value > *range.end() => {
            (*range.end(), Some(format!(" is {value}, and is cut to {}", range.end())))
        }
        Ok(value) if value < *range.start() => {
            (default, Some(format!(": {value} is below {}; drawn with {default}", range.start())))
        }
        Ok(value) => (value, None),
        Err(wrong) => (default, Some(format!(": {wrong}; drawn with {default}"))),
    };
    (value.to_string(), wrong)
}

/// The number of an illumination model.
fn illumination(word: &str) -> Verdict {
    match word.parse::<u8>() {
        Ok(model @ 0..=10) => (model.to_string(), None),
        _ => (String::new(), Some(format!(": `{}` is not from 0 to 10; ignored", excerpt(word)))),
    }
}

/// The file of a texture, which may have spaces in its name, after options with their numbers.
fn texture(text: &str) -> Verdict {
    let mut rest = text;
    let mut options = Vec::new();
    while rest.starts_with('-') {
        let (option, more) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        options.push(option);
        rest = more.trim_start();
        let most = match option {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            _ => 1,
        };
        for i in 0..most {
            match rest.split_once(char::is_whitespace) {
                Some((value, more)) if i == 0 || number(value).is_ok() => rest = more.trim_start(),
                _ => break,
            }
        }
    }
    let wrong = match (rest.is_empty(), options.is_empty()) {
        (true, _) => Some(": a file name is missing; drawn without a texture".into()),
        (false, false) => Some(format!(": options are ignored: {}", options.join(", "))),
        (false, true) => None,
    };
    // Some exporters write paths as their system does.
    (rest.replace('\\', "/"), wrong)
}
