//! Rendering code alone, linked for a board, to see how large it is: programs of the package `probe`, which are never run.

use std::fs::{self, File};
use std::path::Path;

use core_rt::profile::{Need, Needs, Prefer};
use firmware_rt::board::Board;
use firmware_rt::build::{BLOB_VARIABLE, NEEDS_VARIABLE};

use super::EmulateError;
use super::elf::Elf;
use super::firmware::cargo_profile;
use super::repository::Repository;

/// A program that checks a blob and renders it.
pub const WHOLE: &str = "probe";

/// A program that renders what was checked elsewhere.
pub const DRAWING: &str = "drawing";

/// A program that does nothing: what others have more is their own.
pub const EMPTY: &str = "empty";

/// One point light on matt, flat triangles, without shadows, to linear RGB888: no scene that is lit needs less.
pub const SMALLEST: Needs = Needs::NONE
    .with(Need::WholeTriangles, true)
    .with(Need::IdsInRecords, true)
    .with(Need::PointLight, true)
    .with(Need::Linear, true)
    .with(Need::Rgb888, true);

/// All that Whitted's tracing of sharp mirrors may need, to sRGB and RGB888: what is left out are paths and what is rough, other
/// cameras, outputs and wider indices.
pub const WHITTED: Needs = Needs::ALL
    .without(Need::Linear)
    .without(Need::WideIds)
    .without(Need::WideNormals)
    .without(Need::WideUvs)
    .without(Need::SharedVertices)
    .without(Need::IdsInRecords)
    .without(Need::Orthographic)
    .without(Need::Rgb565)
    .without(Need::Gray8)
    .without(Need::Paths)
    .without(Need::Roughness);

/// Needs without which a need means nothing.
const fn presupposed(need: Need) -> &'static [Need] {
    match need {
        Need::TintedShadow => &[Need::Shadows],
        Need::WideNormals => &[Need::SmoothNormals],
        Need::Schlick | Need::Bounces | Need::Roughness => &[Need::Reflection],
        Need::Bilinear | Need::WideUvs => &[Need::Texture],
        _ => &[],
    }
}

/// Two profiles that a need tells apart: the [smallest](SMALLEST) with what the need presupposes, and that with the need, which
/// takes the place of another kind of light or of pixels. `None` for a need of the smallest.
#[must_use]
pub fn alone(need: Need) -> Option<[Needs; 2]> {
    if SMALLEST.has(need) {
        return None;
    }
    // Only records of triangles have ids in them.
    let smallest = match need {
        Need::SharedVertices | Need::Spheres | Need::WideIds => {
            SMALLEST.without(Need::IdsInRecords).with(Need::Ids, true)
        }
        _ => SMALLEST,
    };
    let without = presupposed(need).iter().fold(smallest, |needs, &other| needs.with(other, true));
    let replaced = match need {
        Need::DirectionalLight => Some(Need::PointLight),
        Need::Srgb => Some(Need::Linear),
        Need::SharedVertices => Some(Need::WholeTriangles),
        Need::Ids => Some(Need::IdsInRecords),
        Need::Rgb565 | Need::Gray8 => Some(Need::Rgb888),
        _ => None,
    };
    let with = replaced.map_or(without, |other| without.without(other)).with(need, true);
    Some([without, with])
}

/// A profile without a need, and without those that mean nothing then.
#[must_use]
pub fn without(profile: Needs, need: Need) -> Needs {
    let is_void = |other: Need| other == need || presupposed(other).contains(&need);
    Need::ALL.into_iter().filter(|&other| is_void(other)).fold(profile, Needs::without)
}

/// Which program is wanted, and how.
#[derive(Clone, Copy, Debug)]
pub struct Probe<'a> {
    /// The board whose chip it is for.
    pub board: &'static Board,
    /// Its name in the package.
    pub program: &'a str,
    /// What it is compiled for.
    pub prefer: Prefer,
    /// The blob that its kernel and its profile come from; the default one if none is given.
    pub blob: Option<&'a Path>,
    /// Other needs than the blob's.
    pub needs: Option<Needs>,
}

impl Probe<'_> {
    /// The program, built.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn provide(&self) -> Result<Elf, EmulateError> {
        super::firmware::check_board(self.board)?;
        let repository = Repository::find()?;
        let folder = repository.target().join("firmware");
        fs::create_dir_all(&folder).map_err(EmulateError::folder)?;
        // One at a time: cargo has one place for all profiles of a program.
        let lock = File::create(folder.join("probe-lock")).and_then(|file| file.lock().map(|()| file));
        let _lock = lock.map_err(EmulateError::folder)?;
        let profile = cargo_profile(self.prefer);
        let target = self.board.target;
        let arguments =
            ["build", "--package", "probe", "--bin", self.program, "--profile", profile, "--target", target];
        let variables = [
            (BLOB_VARIABLE, self.blob.map(Path::as_os_str).unwrap_or_default().to_owned()),
            (NEEDS_VARIABLE, self.needs.map(|needs| format!("{:x}", needs.bits())).unwrap_or_default().into()),
        ];
        repository
            .cargo(&arguments, &variables)
            .map_err(|output| EmulateError::Build { package: "probe".into(), output })?;
        Elf::read(&repository.target().join(target).join(profile).join(self.program), self.board)
    }

    /// The bytes of code and constants that it has more than an empty program.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn size(&self) -> Result<u64, EmulateError> {
        let empty = Probe { program: EMPTY, blob: None, needs: None, ..*self }.provide()?;
        Ok(self.provide()?.text_bytes.saturating_sub(empty.text_bytes))
    }
}
