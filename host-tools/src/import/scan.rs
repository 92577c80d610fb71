//! The check of every statement of an OBJ file, and what they say: lists, and faces as fans of triangles by their places there.
//!
//! A fault is told with its line. What is kept of a file is what a scene is made of, in its final size: a large one is most of the
//! memory that preparing it takes.

use std::collections::{BTreeMap, HashMap};
use std::num::IntErrorKind;

use glam::{DVec2, DVec3};

use super::LARGEST;
use super::error::{ImportError, excerpt};
use super::lines::{Lines, Statement, number};
use crate::model::Triangle;

/// Reads the statements of a file, and checks them.
pub(super) fn scan(mut lines: Lines<'_>) -> Result<Faces, ImportError> {
    let mut faces = Faces::default();
    while let Some(statement) = lines.next()? {
        let line = statement.line;
        let checked = faces.statement(&statement);
        checked.map_err(|message| ImportError::line(&lines.file, line, message))?;
    }
    if lines.is_empty() {
        return Err(ImportError::Empty { file: lines.file });
    }
    faces.references().map_err(|(line, message)| ImportError::line(&lines.file, line, message))?;
    if faces.triangles.is_empty() {
        return Err(ImportError::NoFaces { file: lines.file });
    }
    Ok(faces)
}

/// The three lists that a corner `v/vt/vn` indexes, in that order.
const LISTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Of a corner, its place in each of the [`LISTS`].
type Corner = [Option<u32>; 3];

/// The places of a triangle without texture coordinates.
pub(super) const UNPLACED: [u32; 3] = [u32::MAX; 3];

/// What the statements so far have said.
#[derive(Default)]
pub(super) struct Faces {
    /// The vertices.
    pub positions: Vec<DVec3>,
    /// The texture coordinates.
    pub coordinates: Vec<DVec2>,
    /// The normals, of any length.
    pub normals: Vec<DVec3>,
    /// The largest index into each of the [`LISTS`], and its line. A face may stand before its vertices.
    furthest: [(u64, u64); 3],
    /// Fans of the faces, in file order, by places in the lists; with normals where all corners of the face have one. Their
    /// materials are places in `materials`.
    pub triangles: Vec<Triangle>,
    /// The places of their texture coordinates, or [`UNPLACED`]; not of all, where the last have none.
    pub uvs: Vec<[u32; 3]>,
    /// The corners of the last face, whose memory is used again.
    corners: Vec<Corner>,
    /// The `usemtl` in force, and its index in `materials` once a face has used it.
    current: (Named, Option<u32>),
    /// The materials of the faces, in order of first use.
    pub materials: Vec<Named>,
    known: HashMap<String, u32>,
    /// The arguments of `mtllib`.
    pub libraries: Vec<Named>,
    /// The colours of vertices.
    pub colours: Colours,
    /// Keywords that we do not render, and the line of the first of each.
    pub ignored: BTreeMap<String, u64>,
}

/// The colours of vertices: the first vertex decides for all whether there are any.
#[derive(Default)]
pub(super) struct Colours {
    /// Whether the first vertex has one; `None` before there was a vertex.
    are_given: Option<bool>,
    /// One for each vertex, where they are given.
    all: Vec<DVec3>,
    /// The line of the first that is not from 0 to 1, or that comes after vertices without one.
    pub unusable: Option<u64>,
}

impl Colours {
    /// Takes note of a vertex.
    fn vertex(&mut self, words: &[&str], line: u64) {
        let given = words.get(3..6);
        let share = |word: &str| number(word).ok().filter(|share| (0.0..=1.0).contains(share));
        let colour = given.and_then(|c| Some(DVec3::new(share(c[0])?, share(c[1])?, share(c[2])?)));
        let are_given = *self.are_given.get_or_insert(colour.is_some());
        if given.is_some() && (colour.is_none() || !are_given) {
            self.unusable.get_or_insert(line);
        }
        if are_given {
            self.all.push(colour.unwrap_or(DVec3::ONE));
        }
    }

    /// The colour of each vertex; `None` where there are none that can be used.
    pub(super) fn usable(&self) -> Option<&[DVec3]> {
        (self.are_given == Some(true) && self.unusable.is_none()).then_some(&self.all)
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

impl Faces {
    /// How many of each of the [`LISTS`] there are.
    fn counts(&self) -> [usize; 3] {
        [self.positions.len(), self.coordinates.len(), self.normals.len()]
    }

    /// Takes note of a statement.
    ///
    /// # Errors
    /// Says what is wrong with it.
    fn statement(&mut self, statement: &Statement<'_>) -> Result<(), String> {
        let words: Vec<&str> = statement.words().collect();
        match statement.keyword() {
            "v" => {
                // Beyond x, y and z comes a weight, which says nothing here, or a colour.
                self.positions.push(numbers(&words, 3, LARGEST)?.into());
                self.colours.vertex(&words, statement.line);
            }
            "vt" => self.coordinates.push(numbers(&words, 1, f64::MAX)?.into()),
            "vn" => self.normals.push(numbers(&words, 3, f64::MAX)?.into()),
            "f" => self.face(&words, statement.line)?,
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

    /// A face as a fan: corners (0, i, i + 1).
    fn face(&mut self, words: &[&str], line: u64) -> Result<(), String> {
        if words.len() < 3 {
            return Err(format!("a face of {} corners; it needs at least 3", words.len()));
        }
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in words {
            corners.push(self.corner(word, line)?);
        }
        // Three corners a triangle are numbered in 32 bits.
        if self.triangles.len() + words.len() - 2 > u32::MAX as usize / 3 {
            return Err("more triangles than 32-bit indices can number".into());
        }
        let material = self.material();
        let [textured, smooth] = [1, 2].map(|list| corners.iter().all(|corner| corner[list].is_some()));
        for pair in corners[1..].windows(2) {
            let places = |list: usize| [corners[0], pair[0], pair[1]].map(|corner| corner[list].unwrap_or(u32::MAX));
            if textured {
                self.uvs.resize(self.triangles.len(), UNPLACED);
                self.uvs.push(places(1));
            }
            self.triangles.push(Triangle { vertices: places(0), normals: smooth.then(|| places(2)), material });
        }
        self.corners = corners;
        Ok(())
    }

    /// Checks `v`, `v/vt`, `v//vn` or `v/vt/vn`; what it refers to.
    fn corner(&mut self, corner: &str, line: u64) -> Result<Corner, String> {
        let mut given = [None; 3];
        let counts = self.counts();
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
            let count = counts[list] as u64;
            let place = match index {
                0 => {
                    return Err(format!("{name} index 0; indices count from 1, or back from -1"));
                }
                1.. => {
                    let furthest = &mut self.furthest[list];
                    if index as u64 > furthest.0 {
                        *furthest = (index as u64, line);
                    }
                    index as u64 - 1
                }
                _ if index.unsigned_abs() > count => {
                    return Err(format!("{name} index {index}, but there are {count} before it"));
                }
                _ => count - index.unsigned_abs(),
            };
            // What is more than a list holds is refused at the end of the file.
            given[list] = Some(place.min(u32::MAX.into()) as u32);
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
        for ((name, (index, line)), count) in LISTS.into_iter().zip(self.furthest).zip(self.counts()) {
            if index > count as u64 {
                return Err((line, format!("{name} index {index}, but the file has {count}")));
            }
            if index > u64::from(u32::MAX) {
                return Err((line, format!("{name} index {index}, which is beyond 32 bits")));
            }
        }
        Ok(())
    }
}

/// The first `N` of some numbers, 0 for those that are not there; checks that there are enough words, and that all are finite
/// numbers of at most `largest`.
fn numbers<const N: usize>(words: &[&str], least: usize, largest: f64) -> Result<[f64; N], String> {
    if words.len() < least {
        return Err(format!("too few numbers: {} of at least {least}", words.len()));
    }
    let mut numbers = [0.0; N];
    for (place, word) in words.iter().enumerate() {
        let number = number(word)?;
        if number.abs() > largest {
            return Err(format!("`{}` is beyond {largest:e}", excerpt(word)));
        }
        if let Some(slot) = numbers.get_mut(place) {
            *slot = number;
        }
    }
    Ok(numbers)
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
        match scan(Lines::open(&source, "x").unwrap()) {
            Err(error) => error.to_string().replace("built-in x:5: ", ""),
            Ok(_) => "good".into(),
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
