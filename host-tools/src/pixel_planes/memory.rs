//! Where values are: in a processor's own memory, or in the store behind it.
//!
//! Before each step there must be room for what it reads, writes and needs in between. Values that nothing reads again are
//! forgotten; of the others those go out whose next use is farthest (L. Belady, "A Study of Replacement Algorithms for a
//! Virtual-Storage Computer", 1966), and where the store has them as they are, without being written again.
//!
//! Transfers overlap the step before, one after the other: outward if it does not use the value, inward if it leaves room for it.
//! What does not end with that step is waited for.

use std::collections::{BTreeMap, BTreeSet};

use super::program::{Step, Value};

/// The memory of a processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Store {
    /// Bits that it works on.
    pub local_bits: u32,
    /// Bits behind them.
    pub backing_bits: u32,
    /// Bits of a block, in which the store is read and written.
    pub block_bits: u32,
    /// Cycles that a block takes.
    pub block_cycles: u64,
}

impl Default for Store {
    fn default() -> Self {
        Self { local_bits: 208, backing_bits: 4096, block_bits: 32, block_cycles: 256 }
    }
}

/// Why a program cannot be planned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// A step alone takes more than there is.
    #[error("`{step}` needs {needed} bits at once, and a processor has {local}; widen it or narrow the words")]
    Step {
        /// Its name.
        step: &'static str,
        /// What it reads, writes and needs in between.
        needed: u32,
        /// What there is.
        local: u32,
    },
    /// What is swapped out takes more than the store has.
    #[error("{needed} bits are swapped out, and the backing store has {backing}")]
    Backing {
        /// In whole blocks.
        needed: u32,
        /// What there is.
        backing: u32,
    },
}

/// What is in a processor's memory during a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moment {
    /// The step.
    pub step: &'static str,
    /// The values.
    pub held: Vec<Value>,
    /// Their bits, and those in between.
    pub bits: u32,
}

/// A plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// What is where, step by step; what is not held and read again is in the store.
    pub moments: Vec<Moment>,
    /// How often each value that had to go was written to the store and read from it.
    pub swapped: BTreeMap<Value, [u64; 2]>,
    /// Bits of the store that are used, in whole blocks.
    pub backing_bits: u32,
    /// Blocks written and read.
    pub blocks: [u64; 2],
    /// Cycles in which processors wait for them.
    pub waiting: u64,
}

impl Plan {
    /// Plans a program.
    ///
    /// # Errors
    /// Where it does not fit.
    pub fn new(steps: &[Step], store: &Store, cycles_per_bit: u64) -> Result<Self, PlanError> {
        let uses = next_reads(steps);
        let mut planner = Planner {
            store: *store,
            held: BTreeMap::new(),
            stored: BTreeSet::new(),
            homes: BTreeMap::new(),
            plan: Self { moments: Vec::new(), swapped: BTreeMap::new(), backing_bits: 0, blocks: [0; 2], waiting: 0 },
        };
        for (number, step) in steps.iter().enumerate() {
            let before = number.checked_sub(1).map(|before| &steps[before]);
            planner.step(step, before, &uses[number], cycles_per_bit)?;
        }
        let needed = planner.homes.values().map(|bits| bits.div_ceil(store.block_bits) * store.block_bits).sum();
        if needed > store.backing_bits {
            return Err(PlanError::Backing { needed, backing: store.backing_bits });
        }
        planner.plan.backing_bits = needed;
        Ok(planner.plan)
    }

    /// The fullest moment.
    #[must_use]
    pub fn fullest(&self) -> Option<&Moment> {
        self.moments.iter().reduce(|most, moment| if moment.bits > most.bits { moment } else { most })
    }
}

/// For each step, the steps after it that read a value next, before it is made anew; absent where none does.
fn next_reads(steps: &[Step]) -> Vec<BTreeMap<Value, usize>> {
    let mut next = BTreeMap::new();
    let mut all = vec![BTreeMap::new(); steps.len()];
    for (number, step) in steps.iter().enumerate().rev() {
        all[number] = next.clone();
        for (value, _) in &step.writes {
            next.remove(value);
        }
        for (value, _) in &step.reads {
            next.insert(*value, number);
        }
    }
    all
}

struct Planner {
    store: Store,
    /// Values in the processor's memory, and their bits.
    held: BTreeMap<Value, u32>,
    /// Values that the store has as they are.
    stored: BTreeSet<Value>,
    /// Values that have a place in the store, and their bits.
    homes: BTreeMap<Value, u32>,
    plan: Plan,
}

impl Planner {
    fn step(
        &mut self,
        step: &Step,
        before: Option<&Step>,
        next: &BTreeMap<Value, usize>,
        cycles_per_bit: u64,
    ) -> Result<(), PlanError> {
        let wanted: BTreeMap<Value, u32> = step.reads.iter().chain(&step.writes).copied().collect();
        let needed = wanted.values().sum::<u32>() + step.scratch;
        let local = self.store.local_bits;
        if needed > local {
            return Err(PlanError::Step { step: step.name, needed, local });
        }
        // What nobody reads again is forgotten.
        self.held.retain(|value, _| wanted.contains_key(value) || next.contains_key(value));
        let was_free = local.saturating_sub(self.plan.moments.last().map_or(0, |moment| moment.bits));
        let (mut overlapping, mut blocking, mut room) = (0, 0, was_free);
        while needed + self.others(&wanted) > local {
            let others = self.held.iter().filter(|(value, _)| !wanted.contains_key(value));
            let farthest = others.max_by_key(|(value, _)| next.get(value)).map(|(value, bits)| (*value, *bits));
            let Some((value, bits)) = farthest else { break };
            self.held.remove(&value);
            self.homes.insert(value, bits);
            if self.stored.insert(value) {
                let blocks = self.transfer(value, bits, 0);
                let is_used = before.is_some_and(|before| uses(before, value));
                *(if is_used { &mut blocking } else { &mut overlapping }) += blocks;
            }
        }
        for &(value, bits) in &step.reads {
            if !self.held.contains_key(&value) {
                let blocks = self.transfer(value, bits, 1);
                let has_room = bits <= room;
                room -= if has_room { bits } else { 0 };
                *(if has_room { &mut overlapping } else { &mut blocking }) += blocks;
            }
        }
        self.held.extend(&wanted);
        for (value, _) in &step.writes {
            self.stored.remove(value);
        }
        let hidden = before.map_or(0, |before| before.bit_operations * cycles_per_bit);
        let cycles = |blocks: u64| blocks * self.store.block_cycles;
        self.plan.waiting += cycles(blocking) + cycles(overlapping).saturating_sub(hidden);
        let held: Vec<Value> = self.held.keys().copied().collect();
        let bits = self.held.values().sum::<u32>() + step.scratch;
        self.plan.moments.push(Moment { step: step.name, held, bits });
        Ok(())
    }

    /// Bits of what is held and not wanted.
    fn others(&self, wanted: &BTreeMap<Value, u32>) -> u32 {
        self.held.iter().filter(|(value, _)| !wanted.contains_key(value)).map(|(_, bits)| bits).sum()
    }

    /// Counts a transfer, outward (0) or inward (1); its blocks.
    fn transfer(&mut self, value: Value, bits: u32, way: usize) -> u64 {
        let blocks = u64::from(bits.div_ceil(self.store.block_bits));
        self.plan.swapped.entry(value).or_default()[way] += 1;
        self.plan.blocks[way] += blocks;
        blocks
    }
}

/// Whether a step touches a value.
fn uses(step: &Step, value: Value) -> bool {
    step.reads.iter().chain(&step.writes).any(|(other, _)| *other == value)
}

#[cfg(test)]
mod tests;
