//! Chips, as [probe-rs](https://probe.rs) knows them: their cores and their memory.

use probe_rs::config::{self, CoreType, MemoryRegion, Registry};
use serde::Serialize;

use crate::core::{Core, Isa};
use crate::table::{self, Row};

/// A chip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chip {
    /// Its name.
    pub name: String,
    /// The names under which its packages are sold.
    pub packages: Vec<String>,
    /// Its family's name.
    pub family: String,
    /// The types of its cores, as the database has them.
    pub cores: Vec<CoreType>,
    /// What our table knows of it.
    pub known: Option<&'static Row>,
    /// Bytes of its largest run of flash, 0 if it has none.
    pub flash: u64,
    /// Bytes of its largest run of RAM, 0 if it has none.
    pub ram: u64,
}

/// What a chip is to a program without floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// It has no FPU.
    Integer,
    /// It has one.
    Float,
    /// Whether it has one is not known here.
    Unknown,
    /// Its memory is not known.
    Unmapped,
    /// It runs neither of the instruction sets that firmware is built for.
    Foreign,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Integer, Self::Float, Self::Unknown, Self::Unmapped, Self::Foreign];
}

impl Chip {
    fn new(family: &str, chip: &config::Chip) -> Self {
        let first = chip.cores.first().map_or("", |core| core.name.as_str());
        let of_first = |cores: &[String]| cores.iter().any(|core| core == first);
        let flash = chip.memory_map.iter().filter_map(MemoryRegion::as_nvm_region);
        let flash = flash.filter(|region| of_first(&region.cores) && !region.is_alias && region.is_readable());
        let ram = chip.memory_map.iter().filter_map(MemoryRegion::as_ram_region);
        let ram = ram.filter(|region| of_first(&region.cores) && !region.is_alias && region.is_writable());
        Self {
            name: chip.name.clone(),
            packages: chip.package_variants.clone(),
            family: family.trim_end_matches(" Series").into(),
            cores: chip.cores.iter().map(|core| core.core_type).collect(),
            known: table::by_name(&chip.name),
            flash: largest_run(flash.map(|region| [region.range.start, region.range.end]).collect()),
            ram: largest_run(ram.map(|region| [region.range.start, region.range.end]).collect()),
        }
    }

    /// What it is.
    #[must_use]
    pub fn kind(&self) -> Kind {
        let known = self.known.map(|row| row.core);
        let kind = match self.isa() {
            None => Kind::Foreign,
            Some(_) if known.is_some_and(Core::has_fpu) => Kind::Float,
            Some(_) if known.is_some() || self.cores.iter().all(|&core| is_integer(core)) => Kind::Integer,
            Some(_) => Kind::Unknown,
        };
        if kind != Kind::Foreign && (self.flash == 0 || self.ram == 0) { Kind::Unmapped } else { kind }
    }

    /// The firmware that it runs; `None` where it runs neither. A RISC-V of which nothing is known is taken to run ours.
    #[must_use]
    pub fn isa(&self) -> Option<Isa> {
        if let Some(row) = self.known {
            return row.core.isa();
        }
        match self.cores.first()? {
            core if core.is_cortex_m() => Some(Isa::Thumbv6m),
            CoreType::Riscv => Some(Isa::Rv32imac),
            _ => None,
        }
    }

    /// The name of its core: exactly if it is known, else what the database calls it.
    #[must_use]
    pub fn core(&self) -> String {
        if let Some(row) = self.known {
            return row.core.name().into();
        }
        let mut names: Vec<_> = self.cores.iter().map(|core| format!("{core:?}").to_lowercase()).collect();
        names.dedup();
        names.join(" and ")
    }
}

/// Whether a core is without an FPU, whatever chip it is in.
fn is_integer(core: CoreType) -> bool {
    matches!(core, CoreType::Armv6m | CoreType::Armv7m)
}

/// The length of the longest run of addresses in ranges that may touch and overlap.
fn largest_run(mut ranges: Vec<[u64; 2]>) -> u64 {
    ranges.sort_unstable();
    let mut largest = 0;
    let mut run = [0; 2];
    for [start, end] in ranges {
        run = if start <= run[1] { [run[0], run[1].max(end)] } else { [start, end] };
        largest = largest.max(run[1] - run[0]);
    }
    largest
}

/// All chips of the database, in the order of their names.
#[must_use]
pub fn chips() -> Vec<Chip> {
    let registry = Registry::from_builtin_families();
    let families = registry.families().iter();
    let mut chips: Vec<Chip> =
        families.flat_map(|family| family.variants.iter().map(|chip| Chip::new(&family.name, chip))).collect();
    chips.sort_by(|a, b| (&a.name, &a.family).cmp(&(&b.name, &b.family)));
    chips
}

/// The chip of a name, or of a package's name, in any case; the names that are nearest where there is none.
///
/// # Errors
/// The nearest names.
pub fn find<'a>(chips: &'a [Chip], name: &str) -> Result<&'a Chip, Vec<&'a str>> {
    /// How many names are offered.
    const NEAREST: usize = 5;
    let is_asked = |known: &str| known.eq_ignore_ascii_case(name);
    let by = |is: &dyn Fn(&Chip) -> bool| chips.iter().find(|chip| is(chip));
    let found =
        by(&|chip| is_asked(&chip.name)).or_else(|| by(&|chip| chip.packages.iter().any(|name| is_asked(name))));
    found.ok_or_else(|| {
        let asked = name.to_lowercase();
        // A name that goes on is likelier meant than one with other letters.
        let apart = |known: &str| {
            let known = known.to_lowercase();
            (!known.starts_with(&asked), strsim::damerau_levenshtein(&known, &asked), known)
        };
        let mut nearest: Vec<&str> = chips.iter().map(|chip| chip.name.as_str()).collect();
        nearest.sort_by_cached_key(|known| apart(known));
        nearest.truncate(NEAREST);
        nearest
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_put_together_where_they_touch() {
        assert_eq!(largest_run(vec![]), 0);
        assert_eq!(largest_run(vec![[0x2000, 0x3000], [0, 0x800]]), 0x1000);
        assert_eq!(largest_run(vec![[0x3000, 0x4000], [0x2000, 0x3000], [0, 0x1fff]]), 0x2000);
        assert_eq!(largest_run(vec![[0, 0x100], [0x80, 0xc0], [0xc0, 0x180]]), 0x180);
        assert_eq!(largest_run(vec![[0, 0x100], [0x101, 0x102]]), 0x100, "a byte apart");
    }
}
