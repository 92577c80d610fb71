//! The machine that the tracer of 1994 was written for: renderers of 128 x 128 processors that work on single bits, all on the
//! same instruction, each with 208 bits of memory and a slower store behind it.
//!
//! Its program does not depend on what is seen: every sphere is looked at in every generation, and a mask says whose results
//! count. So one [`program`](mod@program) stands for all pixels, its [`memory`] can be planned beforehand, and its time is a sum.
//!
//! H. Fuchs et al., "Pixel-Planes 5: A Heterogeneous Multiprocessor Graphics System Using Processor-Enhanced Memories", 1989;
//! L. Kesteloot, "Real Time Ray Tracing on Pixel-Planes 5", 1994. Neither the clock nor what an operation on a bit takes stands
//! in the latter: they are arguments.

pub mod arithmetic;
pub mod memory;
pub mod picture;
pub mod plot;
pub mod processors;
pub mod program;

use memory::{Plan, PlanError, Store};
use program::{Shape, Step, program};

/// Pixels of a side of a region, and processors of a side of a renderer.
pub const REGION: u32 = 128;

/// What the machine is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// The memory of a processor.
    pub store: Store,
    /// Cycles that an operation on one bit takes.
    pub cycles_per_bit: u64,
    /// Cycles a second.
    pub clock_hz: f64,
}

impl Default for Machine {
    /// 208 bits, 40 MHz, and a bit a cycle; a block of the store takes as long as eight additions of 32 bits.
    fn default() -> Self {
        Self { store: Store::default(), cycles_per_bit: 1, clock_hz: 40e6 }
    }
}

/// What the machine makes of a scene's shape.
#[derive(Clone, Debug)]
pub struct Run {
    /// What is done, step by step.
    pub steps: Vec<Step>,
    /// Where values are then.
    pub plan: Plan,
    /// Cycles in which processors compute, for a region.
    pub computing: u64,
    /// Cycles in which they wait for the store.
    pub waiting: u64,
    clock_hz: f64,
}

impl Run {
    /// Plans a region.
    ///
    /// # Errors
    /// Where a step does not fit the memory.
    pub fn new(machine: &Machine, shape: &Shape) -> Result<Self, PlanError> {
        let steps = program(shape);
        let plan = Plan::new(&steps, &machine.store, machine.cycles_per_bit)?;
        let computing = steps.iter().map(|step| step.bit_operations * machine.cycles_per_bit).sum();
        let waiting = plan.waiting;
        Ok(Self { steps, plan, computing, waiting, clock_hz: machine.clock_hz })
    }

    /// Frames a second of a picture by so many renderers, which take turns at its regions.
    #[must_use]
    pub fn frames_a_second(&self, size: [u32; 2], renderers: u32) -> f64 {
        let turns = regions(size).div_ceil(renderers.max(1));
        self.clock_hz / (f64::from(turns) * (self.computing + self.waiting) as f64)
    }
}

/// Regions of a picture.
#[must_use]
pub fn regions([width, height]: [u32; 2]) -> u32 {
    width.div_ceil(REGION) * height.div_ceil(REGION)
}
