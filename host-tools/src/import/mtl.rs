//! MTL: what a file says of its materials, by `tobj` behind a check of our own.
//!
//! Nothing that is wrong in a material ends an import: it is said in a warning, and the material
//! keeps its default, so that the picture shows a shape in grey and never silently nothing.

use std::collections::HashMap;

use glam::DVec3;

use super::beside;
use super::error::{ImportError, Warning, reason};
use super::lines::{Check, Checked, Lines, number};
use super::scan::Named;
use super::source::Source;
use super::statement::check;
use crate::model::DEFAULT_DIFFUSE;

/// What an MTL file says of a material; `None` where it says nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Entry {
    /// `Kd`, linear RGB in [0, 1].
    pub diffuse: Option<DVec3>,
    /// `Ke`, linear RGB, not negative.
    pub emission: Option<DVec3>,
    /// `Ks`, linear RGB in [0, 1].
    pub specular: Option<DVec3>,
    /// `Tf`, linear RGB in [0, 1].
    pub filter: Option<DVec3>,
    /// `Ns`, whole, from 1.
    pub exponent: Option<u32>,
    /// `Ni`, in [`IORS`](super::statement::IORS).
    pub ior: Option<f64>,
    /// `Tr`, or 1 - `d`, which holds of both, in [0, 1].
    pub transparency: f64,
    /// `illum`, up to 10.
    pub illum: Option<u8>,
    /// `map_Kd`: a name as in the source.
    pub texture: Option<String>,
}

/// Materials by name. Of two with the same name the later one holds.
pub(super) type Library = HashMap<String, Entry>;

/// Reads the libraries that the OBJ `obj` names.
pub(super) fn read(source: &dyn Source, obj: &str, libraries: &[Named], warnings: &mut Vec<Warning>) -> Library {
    let mut library = Library::new();
    for named in libraries {
        for name in files(source, obj, &named.name) {
            match Lines::open(source, &name) {
                Ok(lines) => library.extend(parse(lines, &name, warnings)),
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

/// Parses the file `name`.
fn parse(lines: Lines<'_>, name: &str, warnings: &mut Vec<Warning>) -> Library {
    let check = MtlCheck { lines, material: None, warnings };
    let mut statements = Checked::new(check);
    let parsed = tobj::load_mtl_buf(&mut statements);
    let MtlCheck { lines, warnings, .. } = statements.check;
    let failure = match (parsed, statements.failure) {
        (Ok((materials, _)), _) => {
            return materials.iter().map(|m| (m.name.clone(), entry(m, name))).collect();
        }
        (Err(_), Some(failure)) => failure.to_string(),
        (Err(error), None) => format!("{}: {error}", lines.file),
    };
    warnings.push(Warning::text(format!("{failure}; its materials are drawn in grey")));
    Library::new()
}

/// What passed the check, of a material in the file `name`.
fn entry(material: &tobj::Material, name: &str) -> Entry {
    // What `tobj` does not know it keeps as text.
    let unknown = |keyword: &str| -> Option<Vec<f64>> {
        material.unknown_param.get(keyword)?.split_whitespace().map(|word| number(word).ok()).collect()
    };
    let opacity = material.dissolve.or_else(|| Some(1.0 - *unknown("Tr")?.first()?));
    Entry {
        diffuse: material.diffuse.map(DVec3::from_array),
        emission: material.emissive.map(DVec3::from_array),
        specular: material.specular.map(DVec3::from_array),
        filter: unknown("Tf").and_then(|filter| Some(DVec3::from_array(filter.try_into().ok()?))),
        exponent: material.shininess.map(|exponent| exponent.round().max(1.0) as u32),
        ior: material.optical_density,
        transparency: 1.0 - opacity.unwrap_or(1.0),
        illum: material.illumination_model,
        texture: material.diffuse_texture.as_deref().map(|texture| beside(name, texture)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Embedded;

    fn library(text: &[u8]) -> (Library, Vec<String>) {
        let files = [("x.mtl", text)];
        let source = Embedded(&files);
        let mut warnings = Vec::new();
        let library = parse(Lines::open(&source, "x.mtl").unwrap(), "s/x.mtl", &mut warnings);
        (library, warnings.iter().map(Warning::to_string).collect())
    }

    #[test]
    fn what_a_file_says_is_read() {
        let (library, warnings) = library(
            b"newmtl a b #1\nKd 0.1 0.2 0.3 # red\nKe 17 12 4\nKs 0.5\nTf 1 0.9 0.8\nillum 7\nNs 96.08\nNi 1.45\nKa nan\n\
              newmtl grey\r\n\tKd .5\r\nd 1\r\nTr 0\r\nnewmtl both\nTr 1\nd 0.75\nnewmtl film\nTr 0.25\nNs 0\n\
              newmtl wood\nmap_Kd a b.png\nnewmtl halo\nd -halo 0.5\nnewmtl dull\nNs 10000\nmap_Kd t\\x.png\n",
        );
        assert_eq!(warnings, Vec::<String>::new());
        let a = Entry {
            diffuse: Some(DVec3::new(0.1, 0.2, 0.3)),
            emission: Some(DVec3::new(17.0, 12.0, 4.0)),
            specular: Some(DVec3::splat(0.5)),
            filter: Some(DVec3::new(1.0, 0.9, 0.8)),
            exponent: Some(96),
            ior: Some(1.45),
            illum: Some(7),
            ..Entry::default()
        };
        assert_eq!(library["a b #1"], a);
        assert_eq!(library["grey"], Entry { diffuse: Some(DVec3::splat(0.5)), ..Entry::default() });
        assert_eq!(library["halo"], Entry::default());
        assert_eq!(library["both"].transparency, 0.25, "d holds");
        assert_eq!(library["film"], Entry { transparency: 0.25, exponent: Some(1), ..Entry::default() });
        assert_eq!(library["wood"].texture.as_deref(), Some("s/a b.png"));
        assert_eq!(library["dull"].texture.as_deref(), Some("s/t/x.png"));
    }

    #[test]
    fn options_of_textures_are_ignored_and_said() {
        let file = |text: &str| {
            let (library, warnings) = library(format!("newmtl m\nmap_Kd {text}").as_bytes());
            (library["m"].texture.clone(), warnings.join("|"))
        };
        let said = |message: &str| format!("built-in x.mtl:2: map_Kd of material `m`: {message}");
        let scaled = file("-s 2 2 1 -clamp on 3 woods.png");
        assert_eq!(scaled, (Some("s/3 woods.png".into()), said("options are ignored: -s, -clamp")));
        let absent = said("a file name is missing; drawn without a texture");
        assert_eq!(file(""), (None, absent.clone()));
        assert_eq!(file("-clamp"), (None, absent));
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
            let m = &library["m"];
            let (diffuse, emission) = (m.diffuse.unwrap_or(DVec3::splat(0.8)), m.emission.unwrap_or_default());
            assert_eq!((diffuse, emission), (DVec3::splat(0.8), DVec3::ZERO), "{expected}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_cut_or_left_out() {
        let cases: [(&[u8], &str, Entry); 9] = [
            (b"Ns 20000", "Ns of material `m` is 20000, and is cut to 10000", {
                Entry { exponent: Some(10_000), ..Entry::default() }
            }),
            (b"Ns -3", "Ns of material `m`: -3 is below 0; drawn with 50", {
                Entry { exponent: Some(50), ..Entry::default() }
            }),
            (b"Ns junk", "Ns of material `m`: `junk` is not a number; drawn with 50", {
                Entry { exponent: Some(50), ..Entry::default() }
            }),
            (b"Ni 0", "Ni of material `m`: 0 is below 0.1; drawn with 1.5", {
                Entry { ior: Some(1.5), ..Entry::default() }
            }),
            (b"Ni inf", "Ni of material `m`: `inf` is not a finite number; drawn with 1.5", {
                Entry { ior: Some(1.5), ..Entry::default() }
            }),
            (b"d 1.5", "d of material `m` is 1.5, and is cut to 1", Entry::default()),
            (b"Tr nan", "Tr of material `m`: `nan` is not a finite number; drawn with 0", Entry::default()),
            (b"illum 11", "illum of material `m`: `11` is not from 0 to 10; ignored", Entry::default()),
            (b"Ks 2 0 0", "Ks of material `m` is over 1, and is cut to 1", {
                Entry { specular: Some(DVec3::X), ..Entry::default() }
            }),
        ];
        for (line, expected, entry) in cases {
            let (library, warnings) = library(&[b"newmtl m\n", line].concat());
            assert_eq!(warnings, [format!("built-in x.mtl:2: {expected}")]);
            assert_eq!(library["m"], entry, "{expected}");
        }
    }

    #[test]
    fn more_than_all_light_is_cut() {
        let (library, warnings) = library(b"newmtl m\nKd 0.5 1 1.5\n");
        assert_eq!(warnings, ["built-in x.mtl:2: Kd of material `m` is over 1, and is cut to 1"]);
        assert_eq!(library["m"].diffuse, Some(DVec3::new(0.5, 1.0, 1.0)));
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
