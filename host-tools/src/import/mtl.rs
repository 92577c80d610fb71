//! MTL: the colours of materials, by `tobj` behind a check of our own.
//!
//! Nothing that is wrong in a material ends an import: it is said in a warning, and the material
//! keeps its default, so that the picture shows a shape in grey and never silently nothing.

use std::collections::HashMap;

use glam::DVec3;

use super::beside;
use super::error::{ImportError, Warning, excerpt, reason};
use super::lines::{Check, Checked, Lines, Statement, number};
use super::scan::Named;
use super::source::Source;

/// The reflectance of what has none: a light grey.
pub(super) const DEFAULT_DIFFUSE: f64 = 0.8;

/// What an MTL file says of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Entry {
    /// `Kd`, linear RGB in [0, 1].
    pub diffuse: DVec3,
    /// `Ke`, linear RGB, not negative.
    pub emission: DVec3,
    /// Whether it is an opaque surface of one colour: neither `d`, `Tr` nor `map_Kd` say otherwise.
    pub plain: bool,
}

impl Default for Entry {
    fn default() -> Self {
        Self { diffuse: DVec3::splat(DEFAULT_DIFFUSE), emission: DVec3::ZERO, plain: true }
    }
}

/// Materials by name. Of two with the same name the later one holds.
pub(super) type Library = HashMap<String, Entry>;

/// Reads the libraries that the OBJ `obj` names.
pub(super) fn read(source: &dyn Source, obj: &str, libraries: &[Named], warnings: &mut Vec<Warning>) -> Library {
    let mut library = Library::new();
    for named in libraries {
        for name in files(source, obj, &named.name) {
            match Lines::open(source, &name) {
                Ok(lines) => library.extend(parse(lines, warnings)),
                Err(error) => {
                    let (file, reason) = (source.describe(&name), reason(&error));
                    let message = format!(
                        "material file {file}: {reason}; its materials are drawn in grey \
                         (Kd {DEFAULT_DIFFUSE})"
                    );
                    warnings.push(Warning::line(&source.describe(obj), named.line, message));
                }
            }
        }
    }
    library
}

/// The files that an `mtllib` names: one whose name may hold spaces, or several.
fn files(source: &dyn Source, obj: &str, names: &str) -> Vec<String> {
    let whole = beside(obj, names);
    let several: Vec<String> = names.split_whitespace().map(|name| beside(obj, name)).collect();
    let there = |name: &String| source.open(name).is_ok();
    if !there(&whole) && several.iter().any(there) { several } else { vec![whole] }
}

/// Parses one file.
fn parse(lines: Lines<'_>, warnings: &mut Vec<Warning>) -> Library {
    let check = MtlCheck { lines, material: None, warnings };
    let mut statements = Checked::new(check);
    let parsed = tobj::load_mtl_buf(&mut statements);
    let MtlCheck { lines, warnings, .. } = statements.check;
    let failure = match (parsed, statements.failure) {
        (Ok((materials, _)), _) => {
            return materials.iter().map(|m| (m.name.clone(), entry(m))).collect();
        }
        (Err(_), Some(failure)) => failure.to_string(),
        (Err(error), None) => format!("{}: {error}", lines.file),
    };
    warnings.push(Warning::text(format!("{failure}; its materials are drawn in grey")));
    Library::new()
}

fn entry(material: &tobj::Material) -> Entry {
    let default = Entry::default();
    // `tobj` knows `d` but not its complement.
    let transmission = material.unknown_param.get("Tr").and_then(|word| number(word).ok());
    let opaque = material.dissolve.is_none_or(|d| d >= 1.0) && transmission.is_none_or(|t| t <= 0.0);
    Entry {
        diffuse: material.diffuse.map_or(default.diffuse, DVec3::from_array),
        emission: material.emissive.map_or(default.emission, DVec3::from_array),
        plain: opaque && material.diffuse_texture.is_none(),
    }
}

/// The check of an MTL file on its way to `tobj`. It passes on what makes an [`Entry`].
struct MtlCheck<'a, 'w> {
    lines: Lines<'a>,
    /// The material that is being described, once there is one.
    material: Option<String>,
    warnings: &'w mut Vec<Warning>,
}

impl Check for MtlCheck<'_, '_> {
    fn next(&mut self, out: &mut String) -> Result<(), ImportError> {
        while out.is_empty() {
            let Some(statement) = self.lines.next()? else {
                return Ok(());
            };
            let line = statement.line;
            if let Err(message) = check(&statement, &mut self.material, out) {
                self.warnings.push(Warning::line(&self.lines.file, line, message));
            }
        }
        Ok(())
    }
}

/// Appends a statement for `tobj` to `out`, if it is one that matters.
///
/// # Errors
/// A warning: what is wrong and what is done about it. The statement may have been passed on.
fn check(statement: &Statement<'_>, material: &mut Option<String>, out: &mut String) -> Result<(), String> {
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
        "Kd" | "Ke" => {
            let Some(name) = material else {
                return Err(format!("{keyword} before any `newmtl` is ignored"));
            };
            let (default, largest) = if keyword == "Kd" { (DEFAULT_DIFFUSE, 1.0) } else { (0.0, f64::INFINITY) };
            let given = colour(statement);
            let used = given.clone().map_or([default; 3], |value| value.map(|v| v.min(largest)));
            *out = format!("{keyword} {} {} {}\n", used[0], used[1], used[2]);
            let name = excerpt(name);
            match given {
                Err(wrong) => {
                    let message = format!("{keyword} of material `{name}`: {wrong}; drawn with {default}");
                    return Err(message);
                }
                Ok(value) if value != used => {
                    let message = format!("{keyword} of material `{name}` is over 1, and is cut to 1");
                    return Err(message);
                }
                Ok(_) => {}
            }
        }
        _ if material.is_none() => {}
        "d" | "Tr" if number(word).is_ok() => *out = format!("{keyword} {word}\n"),
        "map_Kd" if !word.is_empty() => *out = format!("map_Kd {}\n", statement.name()),
        _ => {}
    }
    Ok(())
}

/// The colour after `Kd` or `Ke`: three numbers, or one for all three channels.
fn colour(statement: &Statement<'_>) -> Result<[f64; 3], String> {
    let values = statement.words().map(number).collect::<Result<Vec<f64>, String>>()?;
    if let Some(negative) = values.iter().find(|&&v| v < 0.0) {
        return Err(format!("{negative} is negative"));
    }
    match values[..] {
        [all] => Ok([all; 3]),
        [r, g, b] => Ok([r, g, b]),
        _ => Err(format!("{} numbers where 3 are needed", values.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Embedded;

    fn library(text: &[u8]) -> (Library, Vec<String>) {
        let files = [("x.mtl", text)];
        let source = Embedded(&files);
        let mut warnings = Vec::new();
        let library = parse(Lines::open(&source, "x.mtl").unwrap(), &mut warnings);
        (library, warnings.iter().map(Warning::to_string).collect())
    }

    #[test]
    fn colours_and_looks_are_read() {
        let (library, warnings) = library(
            b"newmtl a b #1\nKd 0.1 0.2 0.3 # red\nKe 17 12 4\nillum 2\nNs junk\nKa nan\n\
              newmtl grey\r\n\tKd .5\r\nd 1\r\nTr 0\r\nnewmtl glass\nd 0.3\nnewmtl film\nTr 0.3\n\
              newmtl wood\nmap_Kd a b.png\nnewmtl halo\nd -halo 0.5\n",
        );
        assert_eq!(warnings, Vec::<String>::new());
        let a = library["a b #1"];
        assert_eq!(a.diffuse, DVec3::new(0.1, 0.2, 0.3));
        assert_eq!(a.emission, DVec3::new(17.0, 12.0, 4.0));
        let grey = Entry { diffuse: DVec3::splat(0.5), ..Entry::default() };
        assert_eq!(library["grey"], grey);
        assert_eq!(library["halo"], Entry::default());
        for name in ["glass", "film", "wood"] {
            assert_eq!(library[name], Entry { plain: false, ..Entry::default() }, "{name}");
        }
    }

    #[test]
    fn what_is_wrong_is_said_and_the_default_stands() {
        let cases: [(&[u8], &str); 9] = [
            (b"Kd 0 0 0\nnewmtl m", "1: Kd before any `newmtl` is ignored"),
            (b"newmtl\nnewmtl m", "1: a material without a name is ignored"),
            (b"newmtl m\nKd 1 nan 1", "2: Kd of material `m`: `nan` is not a finite number; drawn with 0.8"),
            (b"newmtl m\nKd red", "2: Kd of material `m`: `red` is not a number; drawn with 0.8"),
            (b"newmtl m\nKd 0.5 0.5", "2: Kd of material `m`: 2 numbers where 3 are needed; drawn with 0.8"),
            (b"newmtl m\nKd", "2: Kd of material `m`: 0 numbers where 3 are needed; drawn with 0.8"),
            (b"newmtl m\nKd 0 0 0\nKd 0 0 -1", "3: Kd of material `m`: -1 is negative; drawn with 0.8"),
            (b"newmtl m\nKe 0 0 -1", "2: Ke of material `m`: -1 is negative; drawn with 0"),
            (b"newmtl m\nKe 1e400", "2: Ke of material `m`: `1e400` is not a finite number; drawn with 0"),
        ];
        for (text, expected) in cases {
            let (library, warnings) = library(text);
            assert_eq!(warnings, [format!("built-in x.mtl:{expected}")]);
            assert_eq!(library["m"], Entry::default(), "{expected}");
        }
    }

    #[test]
    fn more_than_all_light_is_cut() {
        let (library, warnings) = library(b"newmtl m\nKd 0.5 1 1.5\n");
        assert_eq!(warnings, ["built-in x.mtl:2: Kd of material `m` is over 1, and is cut to 1"]);
        assert_eq!(library["m"].diffuse, DVec3::new(0.5, 1.0, 1.0));
    }

    #[test]
    fn a_binary_file_defines_nothing() {
        let (library, warnings) = library(b"newmtl m\nKd 0 0 0\n\0\0");
        let expected = "built-in x.mtl:3: a zero byte; this is a binary file or UTF-16, not UTF-8 \
                        text; its materials are drawn in grey";
        assert_eq!(warnings, [expected]);
        assert!(library.is_empty());
    }

    #[test]
    fn a_library_may_have_spaces_in_its_name_or_be_several() {
        let source = Embedded(&[("s/a b.mtl", b""), ("s/c.mtl", b""), ("s/d.mtl", b"")]);
        assert_eq!(files(&source, "s/x.obj", "a b.mtl"), ["s/a b.mtl"]);
        assert_eq!(files(&source, "s/x.obj", "c.mtl d.mtl"), ["s/c.mtl", "s/d.mtl"]);
        assert_eq!(files(&source, "s/x.obj", "c.mtl e.mtl"), ["s/c.mtl", "s/e.mtl"]);
        assert_eq!(files(&source, "s/x.obj", "no such.mtl"), ["s/no such.mtl"]);
    }
}
