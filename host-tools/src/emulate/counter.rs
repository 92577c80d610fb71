//! Exact instruction counts, by a plugin that QEMU asks about every block of code: `tests/qemu-plugin`.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use core_rt::profile::Needs;

use super::EmulateError;
use super::costs;
use super::elf::Elf;
use super::machine::{Machine, doubled};
use super::parts::{Part, Range};
use super::repository::Repository;
use crate::files;

/// The version of QEMU that has the plugin's API.
const QEMU: u32 = 10;

/// What the plugin counts for whoever calls it.
const SHARED: &str = "caller";

/// Where no instruction is.
const NOWHERE: u64 = u64::MAX - 1;

/// The plugin, built.
#[derive(Clone, Debug)]
pub struct Counter {
    plugin: PathBuf,
    by: By,
}

/// By what instructions are told apart.
#[derive(Clone, Copy, Debug)]
enum By {
    Nothing,
    Part,
    Need(Needs),
    Routine,
}

/// What was counted.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Counts {
    /// Instructions between the marks.
    pub instructions: u64,
    /// Cycles between the marks, by the name of the model.
    pub cycles: BTreeMap<String, u64>,
    /// Marks without their partner, which there should not be.
    pub unpaired: u64,
    /// From reset to exit.
    pub run: Totals,
    /// What each passage between the marks took, in order of time.
    #[serde(default)]
    pub windows: Vec<Totals>,
    /// Instructions between the marks by range of addresses, if that was asked for; a name may occur more than once.
    #[serde(default)]
    pub symbols: Vec<Named>,
}

/// Instructions of a range of addresses.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Named {
    /// What it is for.
    pub name: String,
    /// How many.
    #[serde(default)]
    pub instructions: u64,
    /// How many, for primary, shadow, mirrored rays and rays through surfaces, if these were told apart.
    pub rays: Option<[u64; 4]>,
}

/// Instructions of a part of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Totals {
    /// How many.
    pub instructions: u64,
}

impl Counter {
    /// The plugin, built if need be.
    ///
    /// # Errors
    /// Why instructions cannot be counted here, for a person; everything else still works.
    pub fn provide(machine: &Machine) -> Result<Self, String> {
        let version = machine.version().map_err(|error| error.to_string())?;
        if version < QEMU {
            return Err(format!("{} is of version {version}, and the counter needs {QEMU}", machine.program()));
        }
        let repository = Repository::find().map_err(|error| error.to_string())?;
        repository.cargo(&["build", "--release", "--package", "qemu-plugin"], &[])?;
        let name = format!("{}qemu_plugin{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
        let path = repository.target().join("release").join(name);
        if path.is_file() {
            Ok(Self { plugin: path, by: By::Nothing })
        } else {
            Err(format!("{}: not built", path.display()))
        }
    }

    /// The same, to count for a [breakdown](super::breakdown) of a firmware with marks of rays.
    #[must_use]
    pub fn by_part(&self) -> Self {
        Self { by: By::Part, ..self.clone() }
    }

    /// The same, to count the instructions of each routine of a firmware, by the name that it was linked under.
    #[must_use]
    pub fn by_routine(&self) -> Self {
        Self { by: By::Routine, ..self.clone() }
    }

    /// The same, to count the instructions of the routines of each need.
    #[must_use]
    pub(super) fn by_need(&self, needs: Needs) -> Self {
        Self { by: By::Need(needs), ..self.clone() }
    }

    /// What QEMU is to be told, for the counts of a firmware to be written to `out`.
    pub(super) fn argument(&self, elf: &Elf, out: &Path) -> Result<OsString, EmulateError> {
        let [begin, end] = elf.window.ok_or_else(|| elf.unfit("no marks between which to count".into()))?;
        let mut argument = doubled(&self.plugin);
        argument.push(format!(",begin={begin:#x},end={end:#x},out="));
        argument.push(doubled(out));
        let list = match self.by {
            By::Nothing => None,
            By::Part => Some(by_part(elf)?),
            By::Need(needs) => Some(costs::ranges(elf, needs, SHARED)?),
            By::Routine => Some(elf.routines()?),
        };
        if let Some(list) = list {
            let parts = out.with_extension("parts");
            files::write_atomically(&parts, list.as_bytes())?;
            argument.push(",symbols=");
            argument.push(doubled(&parts));
            for mark in ["shadow", "lit", "reflection", "refraction", "next"] {
                // A mark that no ray of the scene passes was not linked.
                let address = elf.symbol(&format!("intray_{mark}")).unwrap_or(NOWHERE);
                argument.push(format!(",{mark}={address:#x}"));
            }
        }
        Ok(argument)
    }
}

/// The ranges of an ELF's code by part, as the plugin reads them.
fn by_part(elf: &Elf) -> Result<String, EmulateError> {
    let mut list = String::new();
    for Range { start, size, part } in elf.parts()? {
        // A string takes text.
        let name = part.map_or(SHARED, Part::name);
        let _ = writeln!(list, "{start:#x} {size:#x} {name}");
    }
    Ok(list)
}

impl Counts {
    /// What the plugin has written.
    pub(super) fn read(path: &Path) -> Result<Self, EmulateError> {
        let counts: Self =
            serde_json::from_slice(&files::read(path)?).map_err(|error| EmulateError::Counter(error.to_string()))?;
        match counts.unpaired {
            0 => Ok(counts),
            unpaired => Err(EmulateError::Counter(format!("{unpaired} marks without their partner"))),
        }
    }
}
