//! What is left of products of 64 bits, and of divisions, where a Cortex-M0 spends its time: the former are calls of 37
//! instructions there, the latter of hundreds.
//!
//! Exact decisions take such products where no word tells, so there are some. Divisions there are none.

use firmware_rt::board::MICROBIT;
use firmware_rt::hits::Way;
use host_tools::emulate::counter::Counts;
use tests::boards;
use tests::chips::{Job, scene};

/// The compiler's routines for products that are wider than a word.
const PRODUCTS: [&str; 3] = ["__aeabi_lmul", "__muldi3", "__multi3"];

/// Parts of the names of those that divide.
const DIVISIONS: [&str; 4] = ["div", "mod", "rem", "quot"];

/// Shares of instructions, in millionths: of wide products, and of divisions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shares {
    products: u64,
    divisions: u64,
}

impl Shares {
    fn of(counts: &Counts) -> Self {
        let share = |is: &dyn Fn(&str) -> bool| {
            let found: u64 = counts.symbols.iter().filter(|s| is(&s.name)).map(|s| s.instructions).sum();
            found * 1_000_000 / counts.instructions
        };
        Self {
            products: share(&|name| PRODUCTS.contains(&name)),
            divisions: share(&|name| {
                // The compiler's own: what is called by an ABI's name, or is a part of its library.
                let is_runtime = name.starts_with("__") || name.contains("compiler_builtins");
                is_runtime && DIVISIONS.iter().any(|part| name.contains(part))
            }),
        }
    }

    /// Whether they are few enough.
    fn complaint(self, products: u64) -> Option<String> {
        let is_fine = self.products <= products && self.divisions == 0;
        (!is_fine).then(|| format!("{self:?}, and products may be {products} millionths"))
    }
}

#[test]
fn there_is_little_wide_arithmetic_on_the_hot_path() {
    let Some((board, counter)) = boards::counted().find(|&(board, _)| *board == MICROBIT) else { return };
    let counter = counter.by_routine();
    let shares = |name, kernel, size, hits| {
        let counts = Job::new(board, &scene(name, size), kernel, hits).counts(&counter);
        let known: u64 = counts.symbols.iter().map(|symbol| symbol.instructions).sum();
        assert!(known * 100 >= counts.instructions * 99, "{known} of {} instructions have names", counts.instructions);
        let shares = Shares::of(&counts);
        println!("{name} by {kernel}, {hits:?}: {shares:?}, in millionths");
        shares
    };
    // Nearest hits: what the filter, or a bound of t, does not decide.
    for hits in [Way::Single, Way::Tile] {
        assert_eq!(shares("bench-1k", "exact14", [80, 64], Some(hits)).complaint(2_000), None);
    }
    // Pictures: points of hits have more bits than a word's product, and whether a ray meets a sphere is told by a difference of
    // squares of dot products, of which raystones has little else.
    for (name, size, products) in [("built-in", [48, 36], 20_000), ("raystones", [40, 20], 100_000)] {
        assert_eq!(shares(name, "exact14", size, None).complaint(products), None);
    }
    // Where words are of 64 bits, there are many.
    assert_ne!(shares("bench-1k", "exact29", [40, 32], Some(Way::Single)).complaint(2_000), None);
}

#[test]
fn a_division_is_noticed() {
    let shares = Shares { products: 0, divisions: 1 };
    assert!(shares.complaint(1_000).is_some_and(|text| text.contains("divisions: 1")));
    assert!(Shares { products: 1_001, divisions: 0 }.complaint(1_000).is_some());
    assert_eq!(Shares { products: 1_000, divisions: 0 }.complaint(1_000), None);
}
