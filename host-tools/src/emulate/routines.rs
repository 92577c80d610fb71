//! Routines of needs: which code of a firmware is there because a scene asked for something.
//!
//! The optimiser inlines most of them, so symbols say little. Debug information has the functions that each instruction was
//! inlined from: where one of them is a routine of a need, the instruction is.

use std::collections::{BTreeMap, BTreeSet};

use addr2line::Context;
use addr2line::gimli::{Dwarf, EndianSlice, Error, LittleEndian, SectionId};
use core_rt::profile::{Need, Needs};
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, SectionKind};

/// What is in a file's path, the function (any of the file, if none is named), and the needs each of which asks for it.
///
/// A need that is only a branch has no routine: emission, ambient light, linear pixels, widths, several lights.
const ROUTINES: [(&str, Option<&str>, &[Need]); 50] = {
    use Need::*;
    [
        ("core-rt/src/bvh.rs", Some("any"), &[Shadows]),
        ("core-rt/src/mesh.rs", Some("assemble"), &[SharedVertices]),
        ("core-rt/src/light.rs", Some("passed"), &[TintedShadow]),
        ("core-rt/src/whitted.rs", Some("go_on"), &[Reflection, Refraction]),
        ("core-rt/src/onward.rs", Some("turned"), &[Reflection, Refraction]),
        ("core-rt/src/onward.rs", Some("shares"), &[Reflection, Refraction]),
        ("core-rt/src/onward.rs", Some("strewn"), &[Paths, Roughness]),
        ("core-rt/src/path.rs", None, &[Paths]),
        ("core-rt/src/random.rs", None, &[Paths, Roughness]),
        ("core-rt/src/num/circle.rs", None, &[Paths, Roughness]),
        ("core-rt/src/space/grid", Some("anywhere"), &[Paths, Roughness]),
        ("core-rt/src/space/grid", Some("strewn"), &[Paths, Roughness]),
        ("core-rt/src/shade.rs", Some("lobe"), &[BlinnPhong, Phong]),
        ("core-rt/src/num/power.rs", None, &[BlinnPhong, Phong]),
        ("core-rt/src/scene.rs", Some("normals"), &[SmoothNormals]),
        ("core-rt/src/samples.rs", None, &[Supersampling, Paths]),
        ("core-rt/src/camera.rs", Some("through"), &[Supersampling, Paths]),
        ("core-rt/src/camera.rs", Some("parallel"), &[Orthographic]),
        ("core-rt/src/camera.rs", Some("along"), &[Orthographic]),
        ("core-rt/src/colour.rs", Some("mean"), &[Supersampling, Paths]),
        ("core-rt/src/colour.rs", Some("doubled"), &[BlinnPhong, Phong, Paths]),
        ("core-rt/src/colour.rs", Some("tinted"), &[TintedShadow]),
        ("core-rt/src/colour.rs", Some("times"), &[Falloff]),
        ("core-rt/src/colour.rs", Some("encode_gray"), &[Gray8]),
        ("core-rt/src/format.rs", Some("rgb565"), &[Rgb565]),
        ("core-rt/src/srgb.rs", Some("encode"), &[Srgb]),
        ("core-rt/src/srgb.rs", Some("decode"), &[Texture]),
        ("core-rt/src/texture.rs", Some("around"), &[Bilinear]),
        ("core-rt/src/texture.rs", Some("mix"), &[Bilinear]),
        ("core-rt/src/texture.rs", None, &[Texture]),
        ("core-rt/src/albedo.rs", Some("texel"), &[Texture]),
        ("core-rt/src/paint.rs", Some("uvs_of"), &[Texture]),
        ("core-rt/src/paint.rs", Some("colours_of"), &[VertexColours]),
        ("core-rt/src/exact/sphere.rs", None, &[Spheres]),
        ("core-rt/src/exact/frustum.rs", Some("around"), &[Spheres]),
        ("core-rt/src/bvh/together.rs", Some("put_spheres"), &[Spheres]),
        ("core-rt/src/sphere.rs", None, &[Spheres]),
        ("core-rt/src/num/rsqrt.rs", Some("isqrt_u64"), &[Spheres]),
        ("core-rt/src/space.rs", Some("fresnel_q16"), &[Schlick]),
        ("core-rt/src/space.rs", Some("faded"), &[Falloff]),
        ("core-rt/src/space/grid", Some("interpolate"), &[SmoothNormals]),
        ("core-rt/src/space/grid", Some("lift"), &[SmoothNormals]),
        ("core-rt/src/space/grid", Some("blend"), &[Texture, VertexColours]),
        ("core-rt/src/space/grid", Some("reflect"), &[Reflection, Phong, Paths]),
        ("core-rt/src/space/grid", Some("refract"), &[Refraction]),
        ("core-rt/src/space/grid", Some("halfway"), &[BlinnPhong]),
        ("core-rt/src/space/grid", Some("faded"), &[Falloff]),
        ("core-rt/src/space/grid", Some("altitude"), &[Sky]),
        ("core-rt/src/space/grid", Some("is_odd"), &[Checker]),
        ("core-rt/src/space/grid", Some("longest"), &[Checker]),
    ]
};

/// The needs that ask for a function of a file; none where everything does.
#[must_use]
pub fn asked_by(file: &str, function: &str) -> Option<&'static [Need]> {
    let file = file.replace('\\', "/");
    let is_it = |&&(part, name, _): &&(&str, Option<&str>, &[Need])| {
        file.contains(part) && name.is_none_or(|name| name == function)
    };
    ROUTINES.iter().find(is_it).map(|&(.., needs)| needs)
}

/// The last name of a path in Rust, without closures and type arguments.
fn last_name(path: &str) -> &str {
    let mut path = path;
    while let Some(outer) = path.strip_suffix('}').and_then(|path| path.rsplit_once("::{")) {
        path = outer.0.trim_end_matches("::{");
        path = path.strip_suffix("::").unwrap_or(path);
    }
    let path = if path.ends_with('>') { path.rsplit_once("::<").map_or(path, |(name, _)| name) } else { path };
    path.rsplit_once("::").map_or(path, |(_, name)| name)
}

/// A run of bytes of code that are there for needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Routine {
    /// The address of the first.
    pub start: u64,
    /// How many.
    pub size: u64,
    /// The needs any of which asks for them.
    pub needs: &'static [Need],
    /// The routine's name.
    pub name: String,
}

/// The shortest instruction of either chip, bytes.
const STEP: usize = 2;

/// All code of an ELF that is there for needs, in order of the addresses.
///
/// # Errors
/// What is wrong with its debug information.
pub fn routines(bytes: &[u8]) -> Result<Vec<Routine>, String> {
    let file = ElfFile32::<Endianness>::parse(bytes).map_err(|error| error.to_string())?;
    let section = |id: SectionId| -> Result<_, Error> {
        let data = file.section_by_name(id.name()).and_then(|section| section.data().ok());
        Ok(EndianSlice::new(data.unwrap_or_default(), LittleEndian))
    };
    let context = Dwarf::load(section).and_then(Context::from_dwarf).map_err(|error| error.to_string())?;
    let mut routines: Vec<Routine> = Vec::new();
    let mut is_described = false;
    for section in file.sections().filter(|section| section.kind() == SectionKind::Text) {
        for start in (section.address()..section.address() + section.size()).step_by(STEP) {
            let mut frames = context.find_frames(start).skip_all_loads().map_err(|error: Error| error.to_string())?;
            let mut found = None;
            while let Some(frame) = frames.next().map_err(|error| error.to_string())? {
                let Some((file, function)) = frame.location.and_then(|at| at.file).zip(frame.function) else {
                    continue;
                };
                is_described = true;
                let name = function.raw_name().map_err(|error| error.to_string())?;
                let path = format!("{:#}", rustc_demangle::demangle(&name));
                let name = last_name(&path);
                // The innermost: what a routine has inlined may be there for less than all of it.
                if let (None, Some(needs)) = (&found, asked_by(file, name)) {
                    found = Some((needs, name.to_owned()));
                }
            }
            let Some((needs, name)) = found else { continue };
            match routines.last_mut() {
                Some(last) if last.name == name && last.start + last.size == start => last.size += STEP as u64,
                _ => routines.push(Routine { start, size: STEP as u64, needs, name }),
            }
        }
    }
    if is_described { Ok(routines) } else { Err("there is no debug information to look at".into()) }
}

/// The names of routines for which nothing of a profile asks.
#[must_use]
pub fn superfluous(routines: &[Routine], profile: Needs) -> BTreeSet<&str> {
    let is_asked_for = |routine: &&Routine| !routine.needs.iter().any(|&need| profile.has(need));
    routines.iter().filter(is_asked_for).map(|routine| routine.name.as_str()).collect()
}

/// The bytes of code by the first need of a profile that asks for them.
#[must_use]
pub fn bytes(routines: &[Routine], profile: Needs) -> BTreeMap<u32, u64> {
    let mut bytes = BTreeMap::new();
    for routine in routines {
        if let Some(need) = routine.needs.iter().find(|&&need| profile.has(need)) {
            *bytes.entry(need.bit()).or_default() += routine.size;
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_last_of_their_paths() {
        for (path, name) in [
            ("core_rt::light::passed", "passed"),
            ("core_rt::light::passed::{{closure}}", "passed"),
            ("core_rt::light::passed::{closure#0}::{closure#1}", "passed"),
            ("<core_rt::space::grid14::Grid14 as core_rt::space::Space>::refract", "refract"),
            ("core_rt::albedo::texel::<probe::This>", "texel"),
            ("_start", "_start"),
        ] {
            assert_eq!(last_name(path), name, "{path}");
        }
    }

    #[test]
    fn routines_are_told_by_file_and_function() {
        let names = |file, function| asked_by(file, function).map(<[Need]>::to_vec);
        assert_eq!(names("/a/core-rt/src/light.rs", "passed"), Some(vec![Need::TintedShadow]));
        assert_eq!(names("/a/core-rt/src/light.rs", "arriving"), None);
        assert_eq!(names("C:\\core-rt\\src\\texture.rs", "mix"), Some(vec![Need::Bilinear]));
        assert_eq!(names("/a/core-rt/src/texture.rs", "place"), Some(vec![Need::Texture]));
    }

    #[test]
    fn what_is_not_described_is_refused() {
        assert!(routines(b"text").is_err());
    }
}
