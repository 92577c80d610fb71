//! The part of QEMU's TCG plugin API, version 4, that counting needs (`include/qemu/qemu-plugin.h` of QEMU 10.0).
//!
//! The functions are in the emulator's own executable. They are looked up at run time and not linked against: an older
//! emulator then gets as far as comparing versions, and says so, instead of failing on the first name it does not have.

use std::ffi::{c_char, c_int, c_uint, c_void};

#[cfg(unix)]
use libloading::os::unix::Library;
#[cfg(windows)]
use libloading::os::windows::Library;

/// The version of the API that this is written for.
pub(crate) const VERSION: c_int = 4;

/// What QEMU knows the plugin by.
pub(crate) type Id = u64;

/// The beginning of `qemu_info_t`, which only QEMU makes.
#[repr(C)]
#[derive(Debug)]
pub(crate) struct Info {
    pub(crate) target_name: *const c_char,
    pub(crate) oldest_version: c_int,
    pub(crate) version: c_int,
    pub(crate) is_system: bool,
    pub(crate) cpus: c_int,
}

/// `struct qemu_plugin_tb`: a block while it is translated.
#[repr(C)]
pub(crate) struct Block {
    opaque: [u8; 0],
}

/// `struct qemu_plugin_insn`: an instruction of it.
#[repr(C)]
pub(crate) struct Instruction {
    opaque: [u8; 0],
}

/// `struct qemu_plugin_scoreboard`: memory per CPU.
#[repr(C)]
struct Scoreboard {
    opaque: [u8; 0],
}

/// `qemu_plugin_u64`: a number on a scoreboard.
#[repr(C)]
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    scoreboard: *mut Scoreboard,
    offset: usize,
}

// SAFETY: a scoreboard is never freed, and QEMU's functions on it may be called from any thread.
unsafe impl Send for Entry {}
// SAFETY: as above; an entry itself is not changed.
unsafe impl Sync for Entry {}

/// Called with the plugin when a block is translated.
pub(crate) type OnTranslation = unsafe extern "C" fn(Id, *mut Block);
/// Called with the number of the CPU when guest code is executed.
pub(crate) type OnExecution = unsafe extern "C" fn(c_uint, *mut c_void);
/// Called when QEMU exits.
pub(crate) type OnExit = unsafe extern "C" fn(Id, *mut c_void);

const CB_NO_REGS: c_int = 0;
const INLINE_ADD_U64: c_int = 0;
const INLINE_STORE_U64: c_int = 1;
const COND_EQ: c_int = 2;

/// Declares the functions by their names without `qemu_plugin_`, and how to find them all.
macro_rules! functions {
    ($($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// QEMU's functions.
        pub(crate) struct Qemu {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Qemu {
            /// Finds them in the running executable.
            ///
            /// # Errors
            /// The first one that is not there.
            ///
            /// # Safety
            /// What runs must be a QEMU whose plugin API is compatible with [`VERSION`].
            pub(crate) unsafe fn find() -> Result<Self, String> {
                let executable = Library::this();
                #[cfg(windows)]
                let executable = executable.map_err(|error| error.to_string())?;
                Ok(Self {
                    $($name: {
                        let name = concat!("qemu_plugin_", stringify!($name));
                        // SAFETY: the caller warrants the version, which fixes the type of each name.
                        *unsafe { executable.get(name.as_bytes()) }.map_err(|_| format!("it has no {name}"))?
                    },)*
                })
            }
        }
    };
}

functions! {
    register_vcpu_tb_trans_cb: fn(Id, OnTranslation);
    register_atexit_cb: fn(Id, OnExit, *mut c_void);
    tb_n_insns: fn(*const Block) -> usize;
    tb_get_insn: fn(*const Block, usize) -> *mut Instruction;
    insn_vaddr: fn(*const Instruction) -> u64;
    insn_data: fn(*const Instruction, *mut c_void, usize) -> usize;
    scoreboard_new: fn(usize) -> *mut Scoreboard;
    u64_get: fn(Entry, c_uint) -> u64;
    u64_add: fn(Entry, c_uint, u64);
    register_vcpu_insn_exec_inline_per_vcpu: fn(*mut Instruction, c_int, Entry, u64);
    register_vcpu_insn_exec_cb: fn(*mut Instruction, OnExecution, c_int, *mut c_void);
    register_vcpu_tb_exec_inline_per_vcpu: fn(*mut Block, c_int, Entry, u64);
    register_vcpu_tb_exec_cond_cb: fn(*mut Block, OnExecution, c_int, c_int, Entry, u64, *mut c_void);
}

/// The longest instruction of either guest, in bytes.
const MAX_LENGTH: usize = 4;

impl Qemu {
    /// Registers what is called when a block is translated, and what when QEMU exits.
    pub(crate) fn register(&self, id: Id, on_translation: OnTranslation, on_exit: OnExit) {
        // SAFETY: functions of a library that is never unloaded, and no data.
        unsafe {
            (self.register_vcpu_tb_trans_cb)(id, on_translation);
            (self.register_atexit_cb)(id, on_exit, std::ptr::null_mut());
        }
    }

    /// So many numbers, all 0.
    pub(crate) fn entries(&self, count: usize) -> impl Iterator<Item = Entry> {
        // SAFETY: QEMU allocates and clears the memory, and ends the program where it cannot.
        let scoreboard = unsafe { (self.scoreboard_new)(count * size_of::<u64>()) };
        (0..count).map(move |index| Entry { scoreboard, offset: index * size_of::<u64>() })
    }

    /// A number of the first CPU.
    pub(crate) fn get(&self, entry: Entry) -> u64 {
        // SAFETY: entries come from `entries` only, and there is a first CPU.
        unsafe { (self.u64_get)(entry, 0) }
    }

    /// Adds 1 to a number of a CPU that is calling.
    pub(crate) fn increment(&self, entry: Entry, cpu: c_uint) {
        // SAFETY: entries come from `entries` only; the CPU exists, since it is calling.
        unsafe { (self.u64_add)(entry, cpu, 1) }
    }

    /// The instructions of a block with their addresses and bytes.
    ///
    /// # Safety
    /// The block must be the one that QEMU is calling about. The instructions are valid during that call.
    pub(crate) unsafe fn instructions(&self, block: *mut Block) -> Vec<(*mut Instruction, u64, Vec<u8>)> {
        // SAFETY: the block is valid, the index below the count, and the buffer as long as is said.
        unsafe {
            let instruction = |index| {
                let instruction = (self.tb_get_insn)(block, index);
                let mut code = [0; MAX_LENGTH];
                let length = (self.insn_data)(instruction, code.as_mut_ptr().cast(), MAX_LENGTH);
                (instruction, (self.insn_vaddr)(instruction), code[..length].to_vec())
            };
            (0..(self.tb_n_insns)(block)).map(instruction).collect()
        }
    }

    /// Adds 1 to a number before an instruction.
    ///
    /// # Safety
    /// The instruction must be valid, as of [`Self::instructions`].
    pub(crate) unsafe fn count(&self, instruction: *mut Instruction, entry: Entry) {
        // SAFETY: the caller's.
        unsafe { (self.register_vcpu_insn_exec_inline_per_vcpu)(instruction, INLINE_ADD_U64, entry, 1) }
    }

    /// Stores a number before an instruction.
    ///
    /// # Safety
    /// The instruction must be valid, as of [`Self::instructions`].
    pub(crate) unsafe fn store(&self, instruction: *mut Instruction, entry: Entry, value: u64) {
        // SAFETY: the caller's.
        unsafe { (self.register_vcpu_insn_exec_inline_per_vcpu)(instruction, INLINE_STORE_U64, entry, value) }
    }

    /// Calls a function with `data` before an instruction.
    ///
    /// # Safety
    /// The instruction must be valid, as of [`Self::instructions`].
    pub(crate) unsafe fn call(&self, instruction: *mut Instruction, function: OnExecution, data: *mut c_void) {
        // SAFETY: the caller's.
        unsafe { (self.register_vcpu_insn_exec_cb)(instruction, function, CB_NO_REGS, data) }
    }

    /// Before a block, calls a function with a number's place if another number has a value, then stores one there.
    ///
    /// # Safety
    /// The block must be the one that QEMU is calling about.
    pub(crate) unsafe fn call_if(
        &self,
        block: *mut Block,
        (tested, value, stored): (Entry, u64, u64),
        function: OnExecution,
        place: &'static Entry,
    ) {
        let place = std::ptr::from_ref(place).cast_mut().cast();
        // SAFETY: the caller's; callbacks of a block are run in the order in which they are registered.
        unsafe {
            (self.register_vcpu_tb_exec_cond_cb)(block, function, CB_NO_REGS, COND_EQ, tested, value, place);
            (self.register_vcpu_tb_exec_inline_per_vcpu)(block, INLINE_STORE_U64, tested, stored);
        }
    }
}
