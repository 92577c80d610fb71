//! What QEMU calls.

use std::collections::HashMap;
use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use crate::api::{Block, Entry, Id, Info, Qemu, VERSION};
use crate::arguments::Arguments;
use crate::isa::Isa;
use crate::ledger::Ledger;
use crate::rays::{MARKS, Mark};
use crate::symbols::Symbols;

/// The version of the API that QEMU compares with its own before it calls anything.
#[unsafe(no_mangle)]
#[allow(non_upper_case_globals, reason = "QEMU looks for this name")]
pub(crate) static qemu_plugin_version: c_int = VERSION;

/// Numbers on one scoreboard.
const CHUNK: usize = 1024;

/// Where no instruction can be.
const NOWHERE: u64 = 1;

/// All that lasts from one call to the next.
struct Plugin {
    qemu: Qemu,
    begin: u64,
    end: u64,
    marks: Vec<(u64, Mark)>,
    out: PathBuf,
    /// Where the last block ends, if it ended with a conditional branch, and else nowhere.
    fall_through: Entry,
    /// One more than the index of the symbol that was executed last and is not shared; 0 for none.
    caller: Entry,
    /// Taken by the report.
    state: Mutex<Option<State>>,
}

struct State {
    ledger: Ledger,
    /// The numbers behind the ledger's counters.
    entries: Vec<&'static [Entry]>,
    /// Runs of shared routines: their addresses and instructions.
    shared: Vec<(u64, Vec<Vec<u8>>)>,
    /// Their counters by run and caller.
    callers: HashMap<(usize, u64), usize>,
}

static PLUGIN: OnceLock<Plugin> = OnceLock::new();

/// Starts the plugin: 0 if it could be started.
///
/// # Safety
/// To be called by QEMU's loader only.
#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn qemu_plugin_install(
    id: Id,
    info: *const Info,
    argc: c_int,
    argv: *const *const c_char,
) -> c_int {
    // SAFETY: QEMU passes a valid `info`, and `argc` strings that live as long as the plugin.
    let installed = unsafe {
        let words = (0..usize::try_from(argc).unwrap_or(0)).map(|index| CStr::from_ptr(*argv.add(index)).to_str());
        install(&*info, words.collect::<Result<Vec<_>, _>>().map_err(|_| "arguments must be UTF-8".to_owned()))
    };
    match installed {
        Ok(plugin) => {
            plugin.qemu.register(id, on_translation, on_exit);
            0
        }
        Err(message) => {
            eprintln!("qemu-plugin: {message}");
            1
        }
    }
}

/// # Safety
/// As for [`qemu_plugin_install`].
unsafe fn install(info: &Info, words: Result<Vec<&str>, String>) -> Result<&'static Plugin, String> {
    let (oldest, newest) = (info.oldest_version, info.version);
    if !(oldest..=newest).contains(&VERSION) {
        return Err(format!(
            "this QEMU has versions {oldest} to {newest} of the plugin API, and version {VERSION} is needed (QEMU 10.0)"
        ));
    }
    if !info.is_system || info.cpus != 1 {
        return Err("it counts on machines with one CPU only".into());
    }
    // SAFETY: QEMU passes a valid string.
    let target = unsafe { CStr::from_ptr(info.target_name) }.to_string_lossy();
    let isa = Isa::of_target(&target).ok_or_else(|| format!("it counts on arm and riscv32, not on {target}"))?;

    let Arguments { begin, end, symbols, marks, out } = Arguments::parse(words?)?;
    let of = |path: &Path, error: String| format!("{}: {error}", path.display());
    let symbols = match symbols {
        None => Symbols::default(),
        Some(path) => {
            let text = std::fs::read_to_string(&path).map_err(|error| of(&path, error.to_string()))?;
            Symbols::parse(&text).map_err(|error| of(&path, error))?
        }
    };
    // Counts of an earlier run must not be taken for those of this one.
    std::fs::write(&out, "").map_err(|error| of(&out, error.to_string()))?;

    // SAFETY: the version was checked above.
    let qemu = unsafe { Qemu::find() }.map_err(|error| format!("this QEMU is not as it says: {error}"))?;
    let [fall_through, caller] = [(); 2].map(|()| qemu.entries(1).next());
    let (fall_through, caller) = fall_through.zip(caller).ok_or("no scoreboard")?;
    let ledger = Ledger::new(isa, symbols, !marks.is_empty());
    let state = State { ledger, entries: Vec::new(), shared: Vec::new(), callers: HashMap::new() };
    let state = Mutex::new(Some(state));
    Ok(PLUGIN.get_or_init(|| Plugin { qemu, begin, end, marks, out, fall_through, caller, state }))
}

/// Instruments a block.
unsafe extern "C" fn on_translation(_: Id, block: *mut Block) {
    let Some(plugin) = PLUGIN.get() else { return };
    // SAFETY: QEMU is calling about this block.
    plugin.with_state(|state| unsafe { state.instrument(plugin, block) });
}

/// Before the instruction where a window begins.
unsafe extern "C" fn on_begin(_: c_uint, _: *mut c_void) {
    let Some(plugin) = PLUGIN.get() else { return };
    plugin.with_state(|state| {
        let now = state.read(&plugin.qemu);
        state.ledger.begin(now);
    });
}

/// Before the instruction where it ends.
unsafe extern "C" fn on_end(_: c_uint, _: *mut c_void) {
    let Some(plugin) = PLUGIN.get() else { return };
    plugin.with_state(|state| {
        let now = state.read(&plugin.qemu);
        state.ledger.end(&now);
    });
}

/// Before the first instruction of a mark, whose number among all `mark` is.
unsafe extern "C" fn on_mark(_: c_uint, mark: *mut c_void) {
    let (Some(plugin), Some(&mark)) = (PLUGIN.get(), MARKS.get(mark.addr())) else { return };
    plugin.with_state(|state| {
        let now = state.read(&plugin.qemu);
        state.ledger.pass(mark, &now);
    });
}

/// Before a block that a conditional branch fell through to.
unsafe extern "C" fn on_fall_through(cpu: c_uint, entry: *mut c_void) {
    let Some(plugin) = PLUGIN.get() else { return };
    // SAFETY: it was registered with a reference to a leaked entry.
    plugin.qemu.increment(unsafe { *entry.cast::<Entry>() }, cpu);
}

/// Before a run of a shared routine, whose number `run` is.
unsafe extern "C" fn on_shared(cpu: c_uint, run: *mut c_void) {
    let Some(plugin) = PLUGIN.get() else { return };
    plugin.with_state(|state| {
        let entry = state.called(&plugin.qemu, run.addr(), plugin.qemu.get(plugin.caller));
        plugin.qemu.increment(entry, cpu);
    });
}

/// Writes the report.
unsafe extern "C" fn on_exit(_: Id, _: *mut c_void) {
    let Some(plugin) = PLUGIN.get() else { return };
    let state = plugin.state.lock().unwrap_or_else(PoisonError::into_inner).take();
    let Some(state) = state else { return };
    let now = state.read(&plugin.qemu);
    let written = serde_json::to_string(&state.ledger.report(&now))
        .map_err(std::io::Error::from)
        .and_then(|json| std::fs::write(&plugin.out, json + "\n"));
    if let Err(error) = written {
        eprintln!("qemu-plugin: {}: {error}", plugin.out.display());
    }
}

impl Plugin {
    fn with_state(&self, action: impl FnOnce(&mut State)) {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).as_mut().map(action);
    }
}

impl State {
    /// How all counters stand.
    fn read(&self, qemu: &Qemu) -> Vec<u64> {
        let entries = self.entries.iter().copied().flatten();
        entries.take(self.ledger.counters()).map(|&entry| qemu.get(entry)).collect()
    }

    /// The number behind a counter.
    fn entry(&mut self, qemu: &Qemu, counter: usize) -> &'static Entry {
        while self.entries.len() * CHUNK <= counter {
            // Leaked, for translated code refers to them until QEMU ends.
            self.entries.push(qemu.entries(CHUNK).collect::<Vec<_>>().leak());
        }
        &self.entries[counter / CHUNK][counter % CHUNK]
    }

    /// The number that counts a run of a shared routine for one caller.
    fn called(&mut self, qemu: &Qemu, run: usize, caller: u64) -> Entry {
        let counter = match self.callers.get(&(run, caller)) {
            Some(&counter) => counter,
            None => {
                let (address, code) = self.shared[run].clone();
                let caller_symbol = usize::try_from(caller).ok().and_then(|caller| caller.checked_sub(1));
                let counter = self.ledger.run(address, code, caller_symbol);
                self.callers.insert((run, caller), counter);
                counter
            }
        };
        *self.entry(qemu, counter)
    }

    /// Registers all that is to be done when the block is executed.
    ///
    /// # Safety
    /// The block must be the one that QEMU is calling about.
    unsafe fn instrument(&mut self, plugin: &'static Plugin, block: *mut Block) {
        let qemu = &plugin.qemu;
        let isa = self.ledger.isa();
        // SAFETY: the caller's.
        let instructions = unsafe { qemu.instructions(block) };

        // Branches count as taken, and the block that one falls through to tells the others. Whatever comes first after
        // the branch clears the mark: that block, or any block elsewhere that was jumped to.
        if let Some(&(_, address, _)) = instructions.first().filter(|_| isa.has_model()) {
            let counter = self.ledger.fall_through(address);
            let condition = (plugin.fall_through, address, NOWHERE);
            let entry = self.entry(qemu, counter);
            // SAFETY: the caller's.
            unsafe { qemu.call_if(block, condition, on_fall_through, entry) };
        }

        let mark = |address| plugin.marks.iter().find(|&&(at, _)| at == address).map(|&(_, mark)| mark);
        let edge = |address| address == plugin.begin || address == plugin.end || mark(address).is_some();
        let runs = instructions.chunk_by(|(_, _, code), (_, next, _)| !isa.may_leave(code) && !edge(*next));
        for run in runs {
            let (first, address, _) = run[0];
            let code: Vec<_> = run.iter().map(|(.., code)| code.clone()).collect();
            let is_shared = self.ledger.is_shared(self.ledger.symbol(address));
            let symbols = run.iter().rev().map(|&(_, address, _)| self.ledger.symbol(address));
            let last = symbols.into_iter().find(|&symbol| !self.ledger.is_shared(symbol));
            let entry = if is_shared {
                self.shared.push((address, code));
                None
            } else {
                let counter = self.ledger.run(address, code, None);
                Some(*self.entry(qemu, counter))
            };
            // SAFETY: the instruction is one of the block. The call comes before the addition, so that the one at the
            // beginning of a window is counted and the one at its end is not.
            unsafe {
                if address == plugin.begin {
                    qemu.call(first, on_begin, std::ptr::null_mut());
                } else if address == plugin.end {
                    qemu.call(first, on_end, std::ptr::null_mut());
                } else if let Some(mark) = mark(address) {
                    qemu.call(first, on_mark, std::ptr::without_provenance_mut(mark as usize));
                }
                match entry {
                    Some(entry) => qemu.count(first, entry),
                    None => qemu.call(first, on_shared, std::ptr::without_provenance_mut(self.shared.len() - 1)),
                }
                if let Some(last) = last {
                    qemu.store(first, plugin.caller, last.map_or(0, |symbol| symbol as u64 + 1));
                }
            }
        }

        if let Some((last, address, code)) = instructions.last().filter(|(.., code)| isa.is_conditional(code)) {
            // SAFETY: the instruction is one of the block.
            unsafe { qemu.store(*last, plugin.fall_through, address + code.len() as u64) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(info: &Info) -> String {
        // SAFETY: the name is a string; nothing else is asked of QEMU before the arguments, which are missing.
        unsafe { install(info, Ok(Vec::new())) }.err().unwrap()
    }

    #[test]
    fn what_it_cannot_count_on_is_refused() {
        let fits = || Info { target_name: c"arm".as_ptr(), oldest_version: 2, version: 4, is_system: true, cpus: 1 };
        assert_eq!(refusal(&fits()), "begin= is missing");
        let older = refusal(&Info { version: 3, ..fits() });
        assert!(older.contains("versions 2 to 3 of the plugin API, and version 4 is needed"), "{older}");
        let newer = refusal(&Info { oldest_version: 6, version: 7, ..fits() });
        assert!(newer.contains("versions 6 to 7"), "{newer}");
        assert!(refusal(&Info { is_system: false, ..fits() }).contains("one CPU only"));
        assert!(refusal(&Info { cpus: 2, ..fits() }).contains("one CPU only"));
        let other = refusal(&Info { target_name: c"aarch64".as_ptr(), ..fits() });
        assert!(other.ends_with("not on aarch64"), "{other}");
    }
}
