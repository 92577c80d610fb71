//! The database's chips: none is lost, each is one kind of chip, and our table does not contradict it.

use std::collections::BTreeMap;

use chip_fit::core::{Core, Isa};
use chip_fit::database::{self, Chip, Kind};
use chip_fit::table::{ROWS, Row, by_name};
use probe_rs::config::{CoreType, Registry};

/// By kind: a version of probe-rs with other chips changes these, and is to be looked at.
const COUNTS: [(Kind, usize); 5] =
    [(Kind::Integer, 1784), (Kind::Float, 502), (Kind::Unknown, 2033), (Kind::Unmapped, 21), (Kind::Foreign, 39)];

#[test]
fn no_chip_is_lost_and_each_is_of_one_kind() {
    let mut names = BTreeMap::new();
    let registry = Registry::from_builtin_families();
    for chip in registry.families().iter().flat_map(|family| &family.variants) {
        *names.entry(chip.name.clone()).or_insert(0) += 1;
    }
    let chips = database::chips();
    assert_eq!(chips.len(), names.values().sum::<usize>());
    for chip in &chips {
        *names.get_mut(&chip.name).unwrap() -= 1;
    }
    assert!(names.values().all(|&left| left == 0));
    let found = Kind::ALL.map(|kind| (kind, chips.iter().filter(|chip| chip.kind() == kind).count()));
    assert_eq!(found, COUNTS);
    assert_eq!(found.iter().map(|(_, count)| count).sum::<usize>(), chips.len());
}

/// Kinds from the database alone, without the table: what it can say by core type.
#[test]
fn kinds_agree_with_core_types() {
    for chip in database::chips() {
        let is_small = chip.cores.iter().all(|core| matches!(core, CoreType::Armv6m | CoreType::Armv7m));
        let is_arm_m = chip.cores.iter().all(|core| core.is_cortex_m());
        let is_riscv = chip.cores.iter().all(|core| matches!(core, CoreType::Riscv));
        let kind = chip.kind();
        match kind {
            // Small cores have no FPU and all others are known only by the table.
            Kind::Integer => assert!(is_small || chip.known.is_some(), "{}", chip.name),
            Kind::Float => assert!(!is_small && chip.known.is_some(), "{}", chip.name),
            Kind::Unknown => assert!(!is_small && (is_arm_m || is_riscv), "{}", chip.name),
            Kind::Unmapped => assert!(chip.flash == 0 || chip.ram == 0, "{}", chip.name),
            Kind::Foreign => assert!(!is_arm_m, "{}", chip.name),
        }
        if is_small {
            assert!(matches!(kind, Kind::Integer | Kind::Unmapped), "{}: {kind:?}", chip.name);
            assert_eq!(chip.isa(), Some(Isa::Thumbv6m));
        }
    }
}

/// What a row has of a core that the database's type is not.
fn contradiction(row: &Row, chips: &[Chip]) -> Option<String> {
    let of_row: Vec<&Chip> = chips
        .iter()
        .filter(|chip| chip.name.to_lowercase().starts_with(&row.prefix.to_lowercase()))
        .filter(|chip| chip.known.is_none_or(|known| known.prefix.len() <= row.prefix.len()))
        .collect();
    let types: &[CoreType] = match row.core {
        Core::CortexM0 | Core::CortexM0Plus => &[CoreType::Armv6m],
        Core::CortexM3 => &[CoreType::Armv7m],
        Core::CortexM4 | Core::CortexM4F | Core::CortexM7F => &[CoreType::Armv7em],
        Core::CortexM23 | Core::CortexM33F => &[CoreType::Armv8m],
        Core::Rv32imc | Core::Rv32imac | Core::Rv32imafc | Core::Rv32ec => &[CoreType::Riscv],
    };
    let Some(odd) = of_row.iter().find(|chip| !types.contains(&chip.cores[0])) else {
        return of_row.is_empty().then(|| format!("{}: no chip is called so", row.prefix));
    };
    Some(format!("{}: {} is {:?}", row.prefix, odd.name, odd.cores))
}

#[test]
fn every_row_is_of_chips_that_there_are_with_cores_of_its_type() {
    let chips = database::chips();
    for row in &ROWS {
        assert_eq!(contradiction(row, &chips), None);
        assert!((8..=480).contains(&row.clock_mhz), "{row:?}");
        assert_eq!(by_name(row.prefix), Some(row), "a beginning stands twice");
    }
    let row = |prefix, core| Row { prefix, core, clock_mhz: 48, flash_is_apart: false };
    for (bad, reason) in [
        (row("STM32F0", Core::CortexM3), "STM32F0: STM32F030C6 is [Armv6m]"),
        (row("nRF52832", Core::CortexM0), "nRF52832: nRF52832_xxAA is [Armv7em]"),
        (row("fe310", Core::CortexM0), "fe310: fe310-g002 is [Riscv]"),
        (row("Z80", Core::CortexM0), "Z80: no chip is called so"),
    ] {
        assert_eq!(contradiction(&bad, &chips).as_deref(), Some(reason));
    }
}

/// Chips by their data sheets.
#[test]
fn real_chips_are_as_their_data_sheets_say() {
    let chips = database::chips();
    for (name, core, kind, flash, ram, clock) in [
        ("RP2040", "Cortex-M0+", Kind::Integer, None, 264, 133),
        ("nRF51822_xxAA", "Cortex-M0", Kind::Integer, Some(256), 16, 16),
        ("nRF51822_xxAB", "Cortex-M0", Kind::Integer, Some(128), 16, 16),
        ("fe310-g002", "rv32imac", Kind::Integer, None, 16, 320),
        ("STM32F030F4", "Cortex-M0", Kind::Integer, Some(16), 4, 48),
        ("STM32F072RB", "Cortex-M0", Kind::Integer, Some(128), 16, 48),
        ("STM32G0B1RE", "Cortex-M0+", Kind::Integer, Some(512), 144, 64),
        ("STM32F103C8", "Cortex-M3", Kind::Integer, Some(64), 20, 72),
        ("ATSAMD21G18A", "Cortex-M0+", Kind::Integer, Some(256), 32, 48),
        ("nRF52810_xxAA", "Cortex-M4", Kind::Integer, Some(192), 24, 64),
        ("nRF52832_xxAA", "Cortex-M4F", Kind::Float, Some(512), 64, 64),
        ("CH32V003F4P6", "rv32ec", Kind::Foreign, Some(16), 2, 48),
    ] {
        let chip = database::find(&chips, name).unwrap();
        let row = chip.known.unwrap();
        assert_eq!((chip.core().as_str(), chip.kind(), row.clock_mhz), (core, kind, clock), "{name}");
        assert_eq!((chip.ram >> 10, row.flash_is_apart), (ram, flash.is_none()), "{name}");
        assert!(flash.is_none_or(|flash| chip.flash >> 10 == flash), "{name}: {}", chip.flash);
    }
}

#[test]
fn names_are_found_in_any_case_and_by_package_and_else_the_nearest_are_offered() {
    let chips = database::chips();
    let find = |name: &str| database::find(&chips, name);
    assert_eq!(find("rp2040").map(|chip| chip.name.as_str()), Ok("RP2040"));
    let with_packages =
        chips.iter().find(|chip| chip.packages.iter().any(|name| name.len() > chip.name.len())).unwrap();
    let package = with_packages.packages.iter().find(|name| **name != with_packages.name).unwrap();
    assert!(find(&package.to_lowercase()).is_ok_and(|chip| chip.packages.contains(package)), "{package}");
    // A transposition, a beginning, one letter too many, and nothing at all.
    assert_eq!(find("RP2400").unwrap_err()[0], "RP2040");
    assert!(find("nrf51822").unwrap_err()[..3].iter().all(|name| name.starts_with("nRF51822_xx")));
    assert_eq!(find("fe310-g0002").unwrap_err()[0], "fe310-g002");
    assert_eq!(find("").unwrap_err().len(), 5);
}

/// What is not in the database is not in the answers either.
#[test]
fn chips_of_no_use_are_of_their_own_kind() {
    let chips = database::chips();
    let kind = |name| database::find(&chips, name).unwrap().kind();
    assert_eq!(["Cortex-M0", "riscv"].map(kind), [Kind::Unmapped; 2], "they stand for any chip with such a core");
    assert_eq!(["riscv64", "CH32V003F4P6"].map(kind), [Kind::Foreign; 2]);
    assert_eq!(kind("STM32H743ZI"), Kind::Unknown);
}
