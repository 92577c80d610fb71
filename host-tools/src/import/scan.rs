//! The check of every statement of an OBJ file, on its way to `tobj`, and what it notes in passing.

use std::collections::{BTreeMap, HashMap};
use std::num::IntErrorKind;

use super::LARGEST;
use super::error::{ImportError, excerpt};
use super::lines::{Check, Lines, Statement, number};

/// The check of an OBJ file on its way to `tobj`.
pub(super) struct ObjCheck<'a> {
    pub lines: Lines<'a>,
    pub faces: Faces,
}

impl Check for ObjCheck<'_> {
    fn next(&mut self, out: &mut String) -> Result<(), ImportError> {
        while out.is_empty() {
            let Some(statement) = self.lines.next()? else {
                return self.finish();
            };
            let line = statement.line;
            let checked = self.faces.statement(&statement, out);
            checked.map_err(|message| self.error(line, message))?;
        }
        Ok(())
    }
}

impl ObjCheck<'_> {
    /// What can be said at the end of the file only.
    fn finish(&self) -> Result<(), ImportError> {
        let file = || self.lines.file.clone();
        if self.lines.is_empty() {
            return Err(ImportError::Empty { file: file() });
        }
        self.faces.references().map_err(|(line, message)| self.error(line, message))?;
        if self.faces.runs.is_empty() {
            return Err(ImportError::NoFaces { file: file() });
        }
        Ok(())
    }

    fn error(&self, line: u64, message: String) -> ImportError {
        ImportError::line(&self.lines.file, line, message)
    }
}

/// The three lists that a corner `v/vt/vn` indexes, in that order.
const LISTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// What the statements so far have said.
#[derive(Default)]
pub(super) struct Faces {
    /// How many of each of the [`LISTS`] there are.
    counts: [u64; 3],
    /// The largest index into each, and its line. A face may stand before its vertices.
    furthest: [(u64, u64); 3],
    /// The triangles, in file order.
    pub runs: Vec<Run>,
    triangles: usize,
    /// The `usemtl` in force, and its index in `materials` once a face has used it.
    current: (Named, Option<u32>),
    /// The materials of the runs, in order of first use.
    pub materials: Vec<Named>,
    known: HashMap<String, u32>,
    /// The arguments of `mtllib`.
    pub libraries: Vec<Named>,
    /// The colours of vertices.
    pub colours: Colours,
    /// Keywords that we do not render, and the line of the first of each.
    pub ignored: BTreeMap<String, u64>,
}

/// Whether vertices have colours: the first one decides for all, since `tobj` asks for a colour of each or of none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Colours {
    /// Whether the first vertex has one; `None` before there was a vertex.
    are_passed_on: Option<bool>,
    /// The line of the first that is not from 0 to 1, or that comes after vertices without one.
    pub unusable: Option<u64>,
}

impl Colours {
    /// Whether what was passed on are the colours of all vertices.
    pub(super) fn are_usable(self) -> bool {
        self.are_passed_on == Some(true) && self.unusable.is_none()
    }
}

/// A name and where it was given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Named {
    /// As in the file, spaces included; empty for the material of faces before any `usemtl`.
    pub name: String,
    /// The line, from 1.
    pub line: u64,
}

/// Consecutive triangles that are alike.
pub(super) struct Run {
    pub triangles: usize,
    /// Index into [`Faces::materials`].
    pub material: u32,
    /// Whether all their corners have a normal.
    pub smooth: bool,
    /// Whether all their corners have texture coordinates.
    pub textured: bool,
}

impl Faces {
    /// Takes note of a statement, and appends it to `out` if it is one for `tobj`.
    ///
    /// # Errors
    /// Says what is wrong with it.
    fn statement(&mut self, statement: &Statement<'_>, out: &mut String) -> Result<(), String> {
        let words: Vec<&str> = statement.words().collect();
        match statement.keyword() {
            "v" => {
                numbers(&words, 3, LARGEST)?;
                self.counts[0] += 1;
                // Beyond x, y and z comes a weight, of which `tobj` would make use, or a colour.
                match self.colour(&words, statement.line) {
                    Some(colour) => pass("v", &[&words[..3], &colour].concat(), out),
                    None => pass("v", &words[..3], out),
                }
            }
            "vt" => {
                numbers(&words, 1, f64::MAX)?;
                self.counts[1] += 1;
                pass("vt", &[words[0], words.get(1).unwrap_or(&"0")], out);
            }
            "vn" => {
                numbers(&words, 3, f64::MAX)?;
                self.counts[2] += 1;
                pass("vn", &words[..3], out);
            }
            "f" => {
                self.face(&words, statement.line)?;
                pass("f", &words, out);
            }
            "usemtl" => {
                let named = Named { name: statement.name().into(), line: statement.line };
                self.current = (named, None);
            }
            "mtllib" => {
                let name = statement.name().into();
                self.libraries.push(Named { name, line: statement.line });
            }
            "o" | "g" | "s" => {}
            other if other.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') => {
                if !self.ignored.contains_key(other) {
                    self.ignored.insert(other.into(), statement.line);
                }
            }
            junk => return Err(format!("`{}` is not an OBJ statement", excerpt(junk))),
        }
        Ok(())
    }

    /// The colour of a vertex for `tobj`, where all of the file have one.
    fn colour<'w>(&mut self, words: &[&'w str], line: u64) -> Option<[&'w str; 3]> {
        let given = words.get(3..6).map(|colour| [colour[0], colour[1], colour[2]]);
        let is_share = |word: &str| number(word).is_ok_and(|share| (0.0..=1.0).contains(&share));
        let colour = given.filter(|words| words.iter().all(|word| is_share(word)));
        let are_passed_on = *self.colours.are_passed_on.get_or_insert(colour.is_some());
        if given.is_some() && (colour.is_none() || !are_passed_on) {
            self.colours.unusable.get_or_insert(line);
        }
        are_passed_on.then(|| colour.unwrap_or(["1"; 3]))
    }

    fn face(&mut self, corners: &[&str], line: u64) -> Result<(), String> {
        if corners.len() < 3 {
            return Err(format!("a face of {} corners; it needs at least 3", corners.len()));
        }
        let (mut smooth, mut textured) = (true, true);
        for corner in corners {
            let [_, has_texture, has_normal] = self.corner(corner, line)?;
            smooth &= has_normal;
            textured &= has_texture;
        }
        let triangles = corners.len() - 2;
        self.triangles += triangles;
        // Three corners a triangle are numbered in 32 bits.
        if self.triangles > u32::MAX as usize / 3 {
            return Err("more triangles than 32-bit indices can number".into());
        }
        let material = self.material();
        match self.runs.last_mut() {
            Some(run) if run.material == material && run.smooth == smooth && run.textured == textured => {
                run.triangles += triangles;
            }
            _ => self.runs.push(Run { triangles, material, smooth, textured }),
        }
        Ok(())
    }

    /// Checks `v`, `v/vt`, `v//vn` or `v/vt/vn`; which of them it has.
    fn corner(&mut self, corner: &str, line: u64) -> Result<[bool; 3], String> {
        let mut given = [false; 3];
        for (list, word) in corner.split('/').enumerate() {
            let Some(name) = LISTS.get(list) else {
                return Err(format!("`{}` is not v, v/vt, v//vn or v/vt/vn", excerpt(corner)));
            };
            if word.is_empty() && list > 0 {
                continue;
            }
            let index = word.parse::<i64>().map_err(|error| match error.kind() {
                IntErrorKind::PosOverflow | IntErrorKind::NegOverflow => {
                    format!("{name} index `{}` is beyond 64 bits", excerpt(word))
                }
                _ => format!("{name} index `{}` is not an integer", excerpt(word)),
            })?;
            let count = self.counts[list];
            match index {
                0 => {
                    return Err(format!("{name} index 0; indices count from 1, or back from -1"));
                }
                1.. => {
                    let furthest = &mut self.furthest[list];
                    if index as u64 > furthest.0 {
                        *furthest = (index as u64, line);
                    }
                }
                _ if index.unsigned_abs() > count => {
                    return Err(format!("{name} index {index}, but there are {count} before it"));
                }
                _ => {}
            }
            given[list] = true;
        }
        Ok(given)
    }

    /// The index of the material in force.
    fn material(&mut self) -> u32 {
        let (named, index) = &mut self.current;
        *index.get_or_insert_with(|| {
            *self.known.entry(named.name.clone()).or_insert_with(|| {
                self.materials.push(named.clone());
                self.materials.len() as u32 - 1
            })
        })
    }

    /// Checks that what was referred to is there. The error is a line and a message.
    fn references(&self) -> Result<(), (u64, String)> {
        for (list, name) in LISTS.iter().enumerate() {
            let ((index, line), count) = (self.furthest[list], self.counts[list]);
            if index > count {
                return Err((line, format!("{name} index {index}, but the file has {count}")));
            }
        }
        Ok(())
    }
}

/// Checks that there are enough words, and that all are finite numbers of at most `largest`.
fn numbers(words: &[&str], least: usize, largest: f64) -> Result<(), String> {
    if words.len() < least {
        return Err(format!("too few numbers: {} of at least {least}", words.len()));
    }
    for word in words {
        if number(word)?.abs() > largest {
            return Err(format!("`{}` is beyond {largest:e}", excerpt(word)));
        }
    }
    Ok(())
}

/// Writes a statement for `tobj`.
fn pass(keyword: &str, words: &[&str], out: &mut String) {
    out.push_str(keyword);
    for word in words {
        out.push(' ');
        out.push_str(word);
    }
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Embedded;

    /// What the check says of three vertices, a normal and `line`, which is line 5.
    fn verdict(line: &str) -> String {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n{line}\nf 1 2 3\n");
        let files = [("x", text.as_bytes())];
        let source = Embedded(&files);
        let lines = Lines::open(&source, "x").unwrap();
        let mut check = ObjCheck { lines, faces: Faces::default() };
        loop {
            let mut out = String::new();
            match check.next(&mut out) {
                Err(error) => return error.to_string().replace("built-in x:5: ", ""),
                Ok(()) if out.is_empty() => return "good".into(),
                Ok(()) => {}
            }
        }
    }

    #[test]
    fn each_fault_is_named() {
        let cases = [
            ("v 1 2", "too few numbers: 2 of at least 3"),
            ("vn 1 2 # 3", "too few numbers: 2 of at least 3"),
            ("vt", "too few numbers: 0 of at least 1"),
            ("v 1 nan 3", "`nan` is not a finite number"),
            ("v 1 2 -inf", "`-inf` is not a finite number"),
            ("v 1 2 1e400", "`1e400` is not a finite number"),
            ("v 1 2 2e30", "`2e30` is beyond 1e30"),
            ("v 1 2 3 x", "`x` is not a number"),
            ("vn 0 0 infinity", "`infinity` is not a finite number"),
            ("vt nan", "`nan` is not a finite number"),
            ("v 1,5 2,5 3,5", "`1,5` is not a number"),
            ("f", "a face of 0 corners; it needs at least 3"),
            ("f 1 2", "a face of 2 corners; it needs at least 3"),
            ("f 0 1 2", "vertex index 0; indices count from 1, or back from -1"),
            ("f 1//0 2//1 3//1", "normal index 0; indices count from 1, or back from -1"),
            ("f 1 2 4", "vertex index 4, but the file has 3"),
            ("f 1//1 2//1 3//2", "normal index 2, but the file has 1"),
            ("f 1/1 2/1 3/1", "texture coordinate index 1, but the file has 0"),
            ("f 1 2 -4", "vertex index -4, but there are 3 before it"),
            ("f 1 2 -9223372036854775808", "vertex index -9223372036854775808, but there are 3 before it"),
            ("f 1 2 9223372036854775807", "vertex index 9223372036854775807, but the file has 3"),
            ("f 1 2 9223372036854775808", "vertex index `9223372036854775808` is beyond 64 bits"),
            ("f 1 2 -9223372036854775809", "vertex index `-9223372036854775809` is beyond 64 bits"),
            ("f 1 2 3.0", "vertex index `3.0` is not an integer"),
            ("f 1 2 three", "vertex index `three` is not an integer"),
            ("f /1 2 3", "vertex index `` is not an integer"),
            ("f 1/2/3/4 2 3", "`1/2/3/4` is not v, v/vt, v//vn or v/vt/vn"),
            ("<!DOCTYPE html>", "`<!DOCTYPE` is not an OBJ statement"),
            ("\u{1}\u{2}", "`\\u{1}\\u{2}` is not an OBJ statement"),
        ];
        for (line, expected) in cases {
            assert_eq!(verdict(line), expected, "{line}");
        }
    }

    #[test]
    fn what_is_unusual_but_right_passes() {
        let cases = [
            "v 1 2 1e30",
            "v\t1e-400  +2 .5 1",
            "f 1 2 3 1 2 3",
            "f 1// 2/ 3",
            "f -1//-1 -2//-1 -3//-1",
            "f +1 2 3",
            "vt 0",
            "vt 0 0 0",
            "usemtl",
            "o",
            "g a b c",
            "s 1",
            "cstype bezier",
            "#f 1",
        ];
        for line in cases {
            assert_eq!(verdict(line), "good", "{line}");
        }
    }
}
