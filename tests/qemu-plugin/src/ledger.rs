//! Sums from counters.
//!
//! A *counter* says how often something happened since reset, and has a cost that each time adds. Two things are counted:
//! that a *run* was started, a sequence of instructions all of which are executed once the first one is, and that a
//! conditional branch fell through, which corrects the cost that its run has as a taken one. Sums over a window are the
//! differences of the counters between its ends, times their costs.

use std::collections::{BTreeMap, HashMap};

use serde::Serialize;

use crate::isa::{Cost, Isa};
use crate::rays::{KINDS, Mark, Rays};
use crate::symbols::Symbols;

/// What a counter counts. Translating code anew, or from the middle of a block, gives equal events equal counters.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Event {
    /// The start of a run, by its address and its instructions; code in RAM may change. For a routine that is shared, the
    /// symbol that called it.
    Run(u64, Vec<Vec<u8>>, Option<usize>),
    /// That the conditional branch before this address was not taken.
    FallThrough(u64),
}

/// Counters and windows.
#[derive(Debug)]
pub(crate) struct Ledger {
    isa: Isa,
    symbols: Symbols,
    counters: HashMap<Event, usize>,
    /// The costs of each counter by symbol.
    costs: Vec<Vec<(Option<usize>, Cost)>>,
    /// The counters when the open window began.
    open: Option<Vec<u64>>,
    /// By how much each counter rose within all windows.
    inside: Vec<u64>,
    windows: Vec<Cost>,
    unpaired: u64,
    /// Where rays are marked.
    rays: Option<Rays>,
}

/// The output.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    target: &'static str,
    #[serde(flatten)]
    sum: Tally,
    windows: Vec<Tally>,
    unpaired: u64,
    symbols: Vec<Named>,
    elsewhere: Tally,
    run: Tally,
}

/// Instructions, and cycles by model.
#[derive(Debug, Serialize)]
struct Tally {
    instructions: i64,
    cycles: BTreeMap<&'static str, i64>,
}

/// What belongs to a symbol.
#[derive(Debug, Serialize)]
struct Named {
    name: String,
    #[serde(flatten)]
    tally: Tally,
    /// The instructions for each kind of ray.
    #[serde(skip_serializing_if = "Option::is_none")]
    rays: Option<[i64; KINDS]>,
}

impl Ledger {
    /// Without counters.
    pub(crate) fn new(isa: Isa, symbols: Symbols, has_rays: bool) -> Self {
        Self {
            isa,
            symbols,
            counters: HashMap::new(),
            costs: Vec::new(),
            open: None,
            inside: Vec::new(),
            windows: Vec::new(),
            unpaired: 0,
            rays: has_rays.then(Rays::default),
        }
    }

    /// The instruction set.
    pub(crate) fn isa(&self) -> Isa {
        self.isa
    }

    /// How many counters there are.
    pub(crate) fn counters(&self) -> usize {
        self.costs.len()
    }

    /// The counter of a run of instructions that lie one after the other from an address on. Those of shared routines are
    /// counted for the symbol before them, at first for `caller`.
    pub(crate) fn run(&mut self, address: u64, code: Vec<Vec<u8>>, caller: Option<usize>) -> usize {
        let mut costs: BTreeMap<Option<usize>, Cost> = BTreeMap::new();
        let (mut at, mut last) = (address, caller);
        for instruction in &code {
            let symbol = self.symbols.at(at);
            if !self.is_shared(symbol) {
                last = symbol;
            }
            costs.entry(last).or_default().add(self.isa.cost(instruction), 1);
            at += instruction.len() as u64;
        }
        self.counter(Event::Run(address, code, caller), costs.into_iter().collect())
    }

    /// The symbol that an instruction belongs to.
    pub(crate) fn symbol(&self, address: u64) -> Option<usize> {
        self.symbols.at(address)
    }

    /// Whether a symbol's instructions are counted for whoever calls it.
    pub(crate) fn is_shared(&self, symbol: Option<usize>) -> bool {
        symbol.is_some_and(|symbol| self.symbols.is_shared(symbol))
    }

    /// The counter of how often the conditional branch right before an address fell through to it.
    pub(crate) fn fall_through(&mut self, address: u64) -> usize {
        let branch = self.symbols.at(address.wrapping_sub(1));
        self.counter(Event::FallThrough(address), vec![(branch, self.isa.fall_through())])
    }

    fn counter(&mut self, event: Event, costs: Vec<(Option<usize>, Cost)>) -> usize {
        *self.counters.entry(event).or_insert_with(|| {
            self.costs.push(costs);
            self.costs.len() - 1
        })
    }

    /// Opens a window, the counters standing as given.
    pub(crate) fn begin(&mut self, now: Vec<u64>) {
        if self.open.is_some() {
            self.unpaired += 1;
        } else {
            if let Some(rays) = &mut self.rays {
                rays.begin(&now);
            }
            self.open = Some(now);
        }
    }

    /// Closes the window, the counters standing as given.
    pub(crate) fn end(&mut self, now: &[u64]) {
        let Some(before) = self.open.take() else {
            self.unpaired += 1;
            return;
        };
        if let Some(rays) = &mut self.rays {
            self.unpaired += u64::from(!rays.end(now));
        }
        self.inside.resize(now.len(), 0);
        let mut window = Cost::default();
        for (counter, &value) in now.iter().enumerate() {
            // What was translated since stood at 0.
            let rise = value - before.get(counter).copied().unwrap_or(0);
            self.inside[counter] += rise;
            self.costs[counter].iter().for_each(|&(_, cost)| window.add(cost, rise as i64));
        }
        self.windows.push(window);
    }

    /// A mark of a ray is passed, the counters standing as given; outside the windows none counts.
    pub(crate) fn pass(&mut self, mark: Mark, now: &[u64]) {
        if let (Some(rays), Some(_)) = (&mut self.rays, &self.open) {
            self.unpaired += u64::from(!rays.pass(mark, now));
        }
    }

    /// The sums at exit, the counters standing as given.
    pub(crate) fn report(mut self, now: &[u64]) -> Report {
        if self.open.is_some() {
            self.end(now);
            self.unpaired += 1;
        }
        let mut run = Cost::default();
        for (costs, &times) in self.costs.iter().zip(now) {
            costs.iter().for_each(|&(_, cost)| run.add(cost, times as i64));
        }
        let mut elsewhere = Cost::default();
        let mut by_symbol = vec![Cost::default(); self.symbols.names().len()];
        for (costs, &times) in self.costs.iter().zip(&self.inside) {
            for &(symbol, cost) in costs {
                symbol.map_or(&mut elsewhere, |index| &mut by_symbol[index]).add(cost, times as i64);
            }
        }
        let mut by_ray = vec![[0; KINDS]; self.symbols.names().len()];
        if let Some(rays) = &self.rays {
            for (counter, costs) in self.costs.iter().enumerate() {
                let rises = rays.rises(counter);
                for (symbol, cost) in costs.iter().filter_map(|&(symbol, cost)| Some((symbol?, cost))) {
                    for (sum, rise) in by_ray[symbol].iter_mut().zip(rises) {
                        *sum += cost.instructions * rise as i64;
                    }
                }
            }
        }
        let mut sum = Cost::default();
        self.windows.iter().for_each(|&window| sum.add(window, 1));

        let tally = |cost: Cost| Tally {
            instructions: cost.instructions,
            cycles: self.isa.models().zip(cost.cycles).collect(),
        };
        let names = self.symbols.names().iter().cloned();
        Report {
            target: self.isa.target(),
            sum: tally(sum),
            windows: self.windows.iter().copied().map(tally).collect(),
            unpaired: self.unpaired,
            symbols: names
                .zip(by_symbol)
                .zip(by_ray)
                .map(|((name, cost), by_ray)| Named {
                    name,
                    tally: tally(cost),
                    rays: self.rays.as_ref().map(|_| by_ray),
                })
                .collect(),
            elsewhere: tally(elsewhere),
            run: tally(run),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    const ADDS: [u8; 2] = [0x01, 0x30];
    const BNE: [u8; 2] = [0xfc, 0xd1];

    fn ledger(symbols: &str) -> Ledger {
        Ledger::new(Isa::Thumb, Symbols::parse(symbols).unwrap(), false)
    }

    fn report(ledger: Ledger, now: &[u64]) -> Value {
        serde_json::to_value(ledger.report(now)).unwrap()
    }

    #[test]
    fn equal_events_share_a_counter() {
        let mut ledger = ledger("");
        let run = ledger.run(0x40, vec![ADDS.to_vec()], None);
        assert_eq!(ledger.run(0x40, vec![ADDS.to_vec()], None), run);
        assert_ne!(ledger.run(0x42, vec![ADDS.to_vec()], None), run);
        assert_ne!(ledger.run(0x40, vec![BNE.to_vec()], None), run);
        assert_ne!(ledger.fall_through(0x40), run);
        assert_eq!(ledger.fall_through(0x40), ledger.fall_through(0x40));
        assert_eq!(ledger.counters(), 4);
    }

    #[test]
    fn windows_are_differences_and_symbols_split_them() {
        let mut ledger = ledger("0x40 0x2 head\n0x42 0x2 branch\n");
        ledger.run(0x40, vec![ADDS.to_vec(), BNE.to_vec()], None);
        ledger.begin(vec![5]);
        ledger.fall_through(0x44);
        ledger.run(0x44, vec![ADDS.to_vec()], None);
        // 10 times around, the branch falling through at the last.
        ledger.end(&[15, 1, 1]);
        ledger.begin(vec![15, 1, 1]);
        ledger.end(&[15, 1, 3]);
        let head = json!({"name": "head", "instructions": 10, "cycles": {"cortex-m0": 10, "cortex-m0plus": 10}});
        let branch = json!({"name": "branch", "instructions": 10, "cycles": {"cortex-m0": 28, "cortex-m0plus": 19}});
        let expected = json!({
            "target": "arm",
            "instructions": 23,
            "cycles": {"cortex-m0": 41, "cortex-m0plus": 32},
            "windows": [
                {"instructions": 21, "cycles": {"cortex-m0": 39, "cortex-m0plus": 30}},
                {"instructions": 2, "cycles": {"cortex-m0": 2, "cortex-m0plus": 2}},
            ],
            "unpaired": 0,
            "symbols": [head, branch],
            "elsewhere": {"instructions": 3, "cycles": {"cortex-m0": 3, "cortex-m0plus": 3}},
            "run": {"instructions": 34, "cycles": {"cortex-m0": 62, "cortex-m0plus": 48}},
        });
        assert_eq!(report(ledger, &[15, 1, 4]), expected);
    }

    #[test]
    fn shared_routines_are_counted_for_their_callers() {
        let mut ledger = ledger("0x40 0x2 one\n0x50 0x4 caller\n0x60 0x2 two\n");
        assert_eq!([0x40, 0x50, 0x60, 0x70].map(|at| ledger.is_shared(ledger.symbol(at))), [false, true, false, false]);
        let routine = || vec![ADDS.to_vec(), ADDS.to_vec()];
        let counters = [Some(0), Some(2), None].map(|caller| ledger.run(0x50, routine(), caller));
        assert_eq!(counters, [0, 1, 2]);
        ledger.begin(vec![0; 3]);
        ledger.end(&[1, 10, 100]);
        let report = report(ledger, &[1, 10, 100]);
        let by_symbol: Vec<_> = (0..3).map(|index| &report["symbols"][index]["instructions"]).collect();
        assert_eq!(
            (by_symbol, &report["elsewhere"]["instructions"]),
            (vec![&json!(2), &json!(0), &json!(20)], &json!(200))
        );
    }

    #[test]
    fn kinds_of_rays_split_symbols() {
        let mut ledger = Ledger::new(Isa::Thumb, Symbols::parse("0x40 0x2 head\n").unwrap(), true);
        ledger.run(0x40, vec![ADDS.to_vec(), BNE.to_vec()], None);
        ledger.pass(Mark::Shadow, &[3]); // outside
        ledger.begin(vec![5]);
        ledger.pass(Mark::Shadow, &[7]);
        ledger.pass(Mark::Lit, &[12]);
        ledger.end(&[13]);
        let report = report(ledger, &[20]);
        assert_eq!((&report["symbols"][0]["rays"], &report["unpaired"]), (&json!([3, 5, 0, 0]), &json!(0)));
    }

    #[test]
    fn ends_without_their_other_are_told() {
        let open = |edges: &[bool]| {
            let mut ledger = ledger("");
            ledger.run(0x40, vec![ADDS.to_vec()], None);
            for (time, &begins) in (1..).zip(edges) {
                if begins { ledger.begin(vec![time]) } else { ledger.end(&[time]) }
            }
            let report = report(ledger, &[9]);
            (report["unpaired"].as_u64().unwrap(), report["instructions"].as_i64().unwrap())
        };
        assert_eq!(open(&[]), (0, 0));
        assert_eq!(open(&[true, false]), (0, 1));
        assert_eq!(open(&[false, true, false]), (1, 1));
        // The second begin changes nothing.
        assert_eq!(open(&[true, true, false]), (1, 2));
        // Open until the exit.
        assert_eq!(open(&[true]), (1, 8));
    }
}
