//! Where values are: in a processor's own memory, or in the store behind it.
//!
//! Before each step there must be room for what it reads, writes and needs in between. Values that nothing reads again are
//! forgotten; of the others those go out whose next use is farthest (L. Belady, "A Study of Replacement Algorithms for a
//! Virtual-Storage Computer", 1966), and where the store has them as they are, without being written again.
//!
//! Transfers overlap the step before, one after the other: outward if it does not use the value, inward if it leaves room for it.
//! What does not end with that step is waited for.
//!
//! A processor takes each bit from wherever the instruction says, so a value lies in any bits that are free, the lowest first.

use std::collections::{BTreeMap, BTreeSet};

use super::arithmetic::Places;
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

/// A value on its way between the memory and the store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// What.
    pub value: Value,
    /// To the store, or from it.
    pub is_outward: bool,
    /// Its bits in the memory.
    pub places: Vec<usize>,
    /// Its first bit in the store.
    pub home: usize,
}

/// What is in a processor's memory during a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moment {
    /// The step.
    pub step: &'static str,
    /// What went and came before it, in this order.
    pub transfers: Vec<Transfer>,
    /// Where the values are.
    pub places: Places,
    /// What the step has beside them.
    pub scratch: Vec<usize>,
    /// All bits that are used.
    pub bits: u32,
}

impl Moment {
    /// The values in the memory.
    pub fn held(&self) -> impl Iterator<Item = Value> {
        self.places.keys().copied()
    }
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
            held: Places::new(),
            free: (0..store.local_bits as usize).collect(),
            stored: BTreeSet::new(),
            homes: BTreeMap::new(),
            end: 0,
            plan: Self { moments: Vec::new(), swapped: BTreeMap::new(), backing_bits: 0, blocks: [0; 2], waiting: 0 },
        };
        for (number, step) in steps.iter().enumerate() {
            let before = number.checked_sub(1).map(|before| &steps[before]);
            planner.step(step, before, &uses[number], cycles_per_bit)?;
        }
        let needed = planner.end;
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
    /// Values in the processor's memory.
    held: Places,
    /// What is left of it.
    free: BTreeSet<usize>,
    /// Values that the store has as they are.
    stored: BTreeSet<Value>,
    /// The places that values have in the store, and the end of the last, in whole blocks.
    homes: BTreeMap<Value, u32>,
    end: u32,
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
            return Err(PlanError::Step { step: step.operation.name(), needed, local });
        }
        // What nobody reads again is forgotten.
        let free = &mut self.free;
        self.held.retain(|value, places| {
            let is_kept = wanted.contains_key(value) || next.contains_key(value);
            if !is_kept {
                free.extend(places.iter());
            }
            is_kept
        });
        let was_free = local.saturating_sub(self.plan.moments.last().map_or(0, |moment| moment.bits));
        let (mut overlapping, mut blocking, mut room) = (0, 0, was_free);
        let mut transfers = Vec::new();
        while needed + self.others(&wanted) > local {
            let others = self.held.keys().filter(|value| !wanted.contains_key(value));
            let Some(value) = others.max_by_key(|value| next.get(value)).copied() else { break };
            let places = self.held.remove(&value).unwrap_or_default();
            self.free.extend(&places);
            let home = self.home(value, places.len());
            if self.stored.insert(value) {
                let blocks = self.count(value, places.len(), 0);
                let is_used = before.is_some_and(|before| uses(before, value));
                *(if is_used { &mut blocking } else { &mut overlapping }) += blocks;
                transfers.push(Transfer { value, is_outward: true, places, home });
            }
        }
        for (&value, &bits) in &wanted {
            if self.held.contains_key(&value) {
                continue;
            }
            let places = self.allocate(bits);
            if step.reads.iter().any(|(read, _)| *read == value) {
                let blocks = self.count(value, places.len(), 1);
                let has_room = bits <= room;
                room -= if has_room { bits } else { 0 };
                *(if has_room { &mut overlapping } else { &mut blocking }) += blocks;
                let home = self.home(value, places.len());
                transfers.push(Transfer { value, is_outward: false, places: places.clone(), home });
            }
            self.held.insert(value, places);
        }
        for (value, _) in &step.writes {
            self.stored.remove(value);
        }
        let hidden = before.map_or(0, |before| before.bit_operations * cycles_per_bit);
        let cycles = |blocks: u64| blocks * self.store.block_cycles;
        self.plan.waiting += cycles(blocking) + cycles(overlapping).saturating_sub(hidden);
        let scratch: Vec<usize> = self.free.iter().take(step.scratch as usize).copied().collect();
        let bits = (self.held.values().map(Vec::len).sum::<usize>() + scratch.len()) as u32;
        let places = self.held.clone();
        self.plan.moments.push(Moment { step: step.operation.name(), transfers, places, scratch, bits });
        Ok(())
    }

    /// Bits of what is held and not wanted.
    fn others(&self, wanted: &BTreeMap<Value, u32>) -> u32 {
        let others = self.held.iter().filter(|(value, _)| !wanted.contains_key(value));
        others.map(|(_, places)| places.len() as u32).sum()
    }

    /// Takes the lowest bits that are free.
    fn allocate(&mut self, bits: u32) -> Vec<usize> {
        (0..bits).filter_map(|_| self.free.pop_first()).collect()
    }

    /// Where a value of so many bits is in the store.
    fn home(&mut self, value: Value, bits: usize) -> usize {
        let end = &mut self.end;
        let home = *self.homes.entry(value).or_insert_with(|| {
            let home = *end;
            *end += (bits as u32).next_multiple_of(self.store.block_bits);
            home
        });
        home as usize
    }

    /// Counts a transfer, outward (0) or inward (1); its blocks.
    fn count(&mut self, value: Value, bits: usize, way: usize) -> u64 {
        let blocks = (bits as u64).div_ceil(self.store.block_bits.into());
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
