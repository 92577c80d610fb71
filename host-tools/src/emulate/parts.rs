//! Parts of a firmware: which instruction is for what, by the sources that it was compiled from.
//!
//! An instruction belongs to a chain of functions, each inlined into the next, and each of a file. The innermost file that
//! says what its code is for decides; arithmetic, and whatever libraries have, is for whom it was inlined into. Where it was
//! not inlined, it is for whoever calls it, which only a run can tell.

use addr2line::Context;
use addr2line::gimli::{Dwarf, EndianSlice, Error, LittleEndian, SectionId};
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, SectionKind};
use serde::Serialize;

/// What instructions are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// From node to node: box tests, the stack, the order of hits.
    Traversal,
    /// Triangles and spheres: their tests, and the point and the normal of a hit.
    Intersection,
    /// From a hit to bytes: materials, lights, directions of rays that go on, tone.
    Shading,
    /// Rays and pixels: from the camera or a direction to a prepared ray, and places in a tile.
    Rays,
    /// What tells the kinds of ray apart; a firmware that is not broken down has none.
    Marks,
    /// The rest: the edges of what is measured.
    Other,
}

/// All parts, in the order of a table's rows.
pub const PARTS: [Part; 6] = [Part::Traversal, Part::Intersection, Part::Shading, Part::Rays, Part::Marks, Part::Other];

impl Part {
    /// Its name, as in [`Part::by_name`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Traversal => "traversal",
            Self::Intersection => "intersection",
            Self::Shading => "shading",
            Self::Rays => "rays",
            Self::Marks => "marks",
            Self::Other => "other",
        }
    }

    /// The part of a name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        PARTS.into_iter().find(|part| part.name() == name)
    }

    /// What the instruction is for whose chain of functions stands in these files, the innermost first; `None` where it is
    /// for whoever calls the outermost.
    #[must_use]
    pub fn of<'a>(files: impl IntoIterator<Item = &'a str>) -> Option<Self> {
        files.into_iter().find_map(decided)
    }
}

/// What files are for, by the end of their paths; all others serve whoever calls them.
const DECIDED: [(&str, Part); 30] = [
    ("-rt/src/bvh.rs", Part::Traversal),
    ("/boxes.rs", Part::Traversal),
    ("/triangle.rs", Part::Intersection),
    ("/sphere.rs", Part::Intersection),
    ("/resolve.rs", Part::Intersection),
    ("core-rt/src/shade.rs", Part::Shading),
    ("core-rt/src/light.rs", Part::Shading),
    ("core-rt/src/whitted.rs", Part::Shading),
    ("core-rt/src/onward.rs", Part::Shading),
    ("core-rt/src/path.rs", Part::Shading),
    ("core-rt/src/random.rs", Part::Shading),
    ("core-rt/src/albedo.rs", Part::Shading),
    ("core-rt/src/texture.rs", Part::Shading),
    ("core-rt/src/paint.rs", Part::Shading),
    ("core-rt/src/srgb.rs", Part::Shading),
    ("/colour.rs", Part::Shading),
    ("/space.rs", Part::Shading),
    ("/grid14.rs", Part::Shading),
    ("/grid29.rs", Part::Shading),
    ("/optics.rs", Part::Shading),
    ("hanika/shading.rs", Part::Shading),
    ("/ray.rs", Part::Rays),
    ("core-rt/src/camera.rs", Part::Rays),
    ("core-rt/src/render.rs", Part::Rays),
    ("core-rt/src/samples.rs", Part::Rays),
    ("core-rt/src/format.rs", Part::Rays),
    ("firmware-rt/src/hits.rs", Part::Rays),
    ("firmware-rt/src/marks.rs", Part::Marks),
    ("firmware-rt/src/run.rs", Part::Other),
    ("firmware-rt/src/window.rs", Part::Other),
];

/// The folders of this project's code on chips.
const FOLDERS: [&str; 3] = ["core-rt/src/", "float-rt/src/", "firmware-rt/src/"];

fn decided(file: &str) -> Option<Part> {
    let file = file.replace('\\', "/");
    if !FOLDERS.iter().any(|folder| file.contains(folder)) {
        return None;
    }
    DECIDED.into_iter().find(|(end, _)| file.ends_with(end)).map(|(_, part)| part)
}

/// A run of bytes that are for one thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// The address of the first.
    pub start: u64,
    /// How many.
    pub size: u64,
    /// What they are for; `None` for whoever calls them.
    pub part: Option<Part>,
}

/// The shortest instruction of either chip, bytes.
const STEP: usize = 2;

/// What all code of an ELF is for, in order of the addresses.
///
/// # Errors
/// What is wrong with its debug information.
pub fn parts(file: &ElfFile32<'_, Endianness>) -> Result<Vec<Range>, String> {
    let section = |id: SectionId| -> Result<_, Error> {
        let data = file.section_by_name(id.name()).and_then(|section| section.data().ok());
        Ok(EndianSlice::new(data.unwrap_or_default(), LittleEndian))
    };
    let context = Dwarf::load(section).and_then(Context::from_dwarf).map_err(|error| error.to_string())?;
    let mut ranges: Vec<Range> = Vec::new();
    for section in file.sections().filter(|section| section.kind() == SectionKind::Text) {
        for start in (section.address()..section.address() + section.size()).step_by(STEP) {
            let part = part_at(&context, start).map_err(|error| error.to_string())?;
            match ranges.last_mut() {
                Some(last) if last.part == part && last.start + last.size == start => last.size += STEP as u64,
                _ => ranges.push(Range { start, size: STEP as u64, part }),
            }
        }
    }
    Ok(ranges)
}

fn part_at(context: &Context<EndianSlice<'_, LittleEndian>>, address: u64) -> Result<Option<Part>, Error> {
    let mut frames = context.find_frames(address).skip_all_loads()?;
    let mut files = Vec::new();
    while let Some(frame) = frames.next()? {
        files.extend(frame.location.and_then(|location| location.file));
    }
    Ok(Part::of(files))
}
