//! What each operation of shading costs on each chip, exactly, and that the one that all others use is cheap.
//!
//! The program is `firmware_rt::costs`. Boards for which QEMU or the compiler's library is absent are skipped, with a line
//! that says so.

use std::time::Duration;

use firmware_rt::costs::{CALLS, OPERATIONS};
use host_tools::emulate::Run;
use tests::boards::{counted, program};

/// The most that normalising a vector may take, instructions: on a chip that multiplies 32 bits by 32 to 32 alone, and on
/// one that has the upper half too.
const NORMALISE: [(&str, u64); 2] = [("microbit", 150), ("hifive1", 120)];

/// What calls of an operation cost, ascending.
#[derive(Clone, Debug)]
struct Costs(Vec<u64>);

impl Costs {
    /// From the instructions of the calls, and of as many that answer at once.
    fn new(calls: &[u64], nothing: &[u64]) -> Self {
        let mut costs: Vec<u64> = calls.iter().zip(nothing).map(|(call, nothing)| call - nothing).collect();
        costs.sort_unstable();
        Self(costs)
    }

    fn mean(&self) -> f64 {
        self.0.iter().sum::<u64>() as f64 / self.0.len() as f64
    }

    fn ends(&self) -> [u64; 2] {
        [self.0[0], self.0[self.0.len() - 1]]
    }
}

/// What is wrong with what an operation costs at most.
fn complaint(board: &str, operation: &str, most: u64) -> Option<String> {
    let (_, limit) = NORMALISE.into_iter().find(|&(name, _)| name == board).expect("every board has a limit");
    let is_dear = operation == "normalise" && most > limit;
    is_dear.then(|| format!("{operation} takes {most} instructions on {board}, and may take {limit}"))
}

#[test]
fn normalising_is_cheap() {
    for (board, counter) in counted() {
        let elf = program(board, "costs");
        let limit = Duration::from_secs(60);
        let counts =
            Run { board, elf: &elf, blob: None, counter: Some(&counter), limit }.count().expect("it ends well");
        let windows: Vec<u64> = counts.windows.iter().map(|window| window.instructions).collect();
        assert_eq!(windows.len(), OPERATIONS.len() * 2 * CALLS);
        println!("{}: instructions, mean (least to most)", board.name);
        for (operation, windows) in OPERATIONS.into_iter().zip(windows.chunks(2 * CALLS)) {
            let (calls, nothing) = windows.split_at(CALLS);
            let costs = Costs::new(calls, nothing);
            let [least, most] = costs.ends();
            println!("  {operation:16} {:6.1} ({least} to {most})", costs.mean());
            // Whatever is counted, an operation has instructions of its own.
            assert!(least > 0, "{operation}");
            assert_eq!(complaint(board.name, operation, most), None);
        }
    }
}

#[test]
fn costs_are_differences() {
    let costs = Costs::new(&[30, 20, 40], &[10, 10, 10]);
    assert_eq!((costs.mean(), costs.ends()), (20.0, [10, 30]));
}

#[test]
fn one_instruction_too_many_is_noticed() {
    for (board, limit) in NORMALISE {
        assert_eq!(complaint(board, OPERATIONS[0], limit), None);
        assert!(complaint(board, OPERATIONS[0], limit + 1).is_some_and(|text| text.contains(board)));
        assert_eq!(complaint(board, OPERATIONS[1], limit + 1), None);
    }
}
