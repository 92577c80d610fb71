//! Exact instruction counts under QEMU: a TCG plugin for `qemu-system-arm` and `qemu-system-riscv32`, version 10 or later.
//!
//! ```text
//! cargo build --release -p qemu-plugin
//!
//! qemu-system-arm -M microbit -nographic -monitor none -serial none \
//!     -semihosting-config enable=on,target=native -kernel ELF \
//!     -plugin target/release/libqemu_plugin.so,begin=0x1c4,end=0x1c8,symbols=SYMBOLS,out=COUNTS.json
//! ```
//!
//! # Arguments
//! - `begin`, `end`: addresses of two instructions, `0x` and hexadecimal digits; bit 0, which marks Thumb functions in
//!   symbol tables, is ignored. Counting starts with the instruction at `begin`, which is counted, and stops before the
//!   one at `end`, which is not. Between two empty functions that are called at both ends it so takes in, besides what
//!   they enclose, the return from the first and the call of the second. (The compiler may merge functions with equal
//!   bodies: let each contain a different `asm!` comment.) A window may be opened any number of times.
//! - `out`: the file that the counts are written to. It is emptied at the start, and filled when QEMU exits, by
//!   semihosting or by a signal that it handles, such as SIGTERM.
//! - `symbols` (optional): a file of lines `ADDRESS SIZE NAME`, both numbers as above, the name to the end of the line. An
//!   instruction belongs to the last symbol that starts at or before it, if that reaches so far; of several that start
//!   at one address the first line counts. The instructions of symbols called `caller` are counted for the symbol that was
//!   executed last before them: they are routines that many parts of a program call.
//!
//! - `shadow`, `lit`, `reflection`, `refraction`, `next` (optional, all or none): addresses of the first instructions of five
//!   functions, which a program calls to tell which [kind of ray](rays) it follows.
//!
//! A comma in a path is doubled, as always on QEMU's command line. What is wrong with the arguments, or with the version
//! of QEMU, is said on stderr, and QEMU exits with status 1 before the guest starts.
//!
//! # Output
//! One JSON object:
//! - `target`: `arm` or `riscv32`.
//! - `instructions`, `cycles`: sums over all windows. `cycles` is an object with one number per [cycle model](thumb),
//!   `cortex-m0` and `cortex-m0plus`; empty for RISC-V.
//! - `windows`: an array with `instructions` and `cycles` of each window, in order of time.
//! - `unpaired`: how often `begin` was met in an open window (which goes on) or `end` outside one (which is ignored), plus
//!   1 if the last window was still open at the exit (which closes it), and how often marks of rays were out of order. 0
//!   unless something is wrong.
//! - `symbols`: an array with `name`, `instructions` and `cycles` of each symbol within the windows, in the file's order; and
//!   with `rays`, the instructions for primary, shadow, reflected and refracted rays, where these are marked.
//! - `elsewhere`: `instructions` and `cycles` within the windows but outside all symbols.
//! - `run`: `instructions` and `cycles` from reset to exit.
//!
//! # What is counted
//! An instruction counts when it starts, so one that faults does too, and one that waits or traps into the semihosting
//! counts once. The numbers are the same on every run of a program that neither takes interrupts nor polls a clock.
//!
//! # How
//! A translated block is cut into [runs](ledger) of instructions none of which but the last can leave the block, and an
//! inline addition counts how often each run starts. Everything else follows at exit from these counts and the code. A run
//! of a shared routine has a counter for each symbol that it is executed for: what is not shared leaves its symbol where
//! the next shared run finds it. At each mark of a ray, what the counters rose since the last is the old kind's.

mod api;
mod arguments;
mod isa;
mod ledger;
mod plugin;
mod rays;
mod riscv;
mod symbols;
mod thumb;
