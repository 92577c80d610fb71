//! What an ELF for a chip has linked that it should not have, by the names of its symbols.
//!
//! A chip without an FPU has no instruction for a float: however much is inlined, each operation is a call of one of the
//! compiler's routines, and their library takes no part in the optimisation across crates, so that they keep their names.
//! A panic ends in functions of core's that are never inlined. Text is made by functions that are called through
//! pointers, which are not inlined either. A linker that drops sections drops whatever nothing refers to: what has a
//! symbol can be reached.
//!
//! One thing has no symbol: a division of 128 bits, which the compiler expands in place for chips of 32 bits.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display, Formatter};

use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSymbol, SymbolKind};

/// What a symbol gives away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Category {
    /// Arithmetic with floats, or text of one.
    SoftFloat,
    /// A way to panic.
    Panic,
    /// Values as text.
    Formatting,
    /// A division of 64 bits, or of 128.
    WideDivision,
}

/// The symbols of each category, demangled; none is empty.
pub type Found = BTreeMap<Category, BTreeSet<String>>;

/// Why symbols cannot be looked at.
#[derive(Clone, Copy, Debug)]
pub enum SymbolsError {
    /// It is no 32-bit ELF.
    Elf(object::Error),
    /// It has no functions' names.
    Stripped,
}

impl Display for SymbolsError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Elf(error) => write!(f, "not a 32-bit ELF: {error}"),
            Self::Stripped => f.write_str("there is no function's symbol to look at"),
        }
    }
}

impl std::error::Error for SymbolsError {}

/// The symbols of an ELF that belong to a category.
///
/// # Errors
/// Where it is no 32-bit ELF. Where it has no names, which would pass for innocence.
pub fn find(elf: &[u8]) -> Result<Found, SymbolsError> {
    let file = ElfFile32::<Endianness>::parse(elf).map_err(SymbolsError::Elf)?;
    if !file.symbols().any(|symbol| symbol.kind() == SymbolKind::Text) {
        return Err(SymbolsError::Stripped);
    }
    let mut found = Found::new();
    for name in file.symbols().filter_map(|symbol| symbol.name().ok()) {
        let name = format!("{:#}", rustc_demangle::demangle(name));
        if let Some(category) = category(&name) {
            found.entry(category).or_default().insert(name);
        }
    }
    Ok(found)
}

/// What a demangled symbol gives away, if anything.
#[must_use]
pub fn category(name: &str) -> Option<Category> {
    let last = name.rsplit("::").next().unwrap_or(name);
    let is_one_of = |parts: &[&str]| parts.iter().any(|part| name.contains(part));
    let fails = name.starts_with("core::") && last.contains("_fail");
    if is_libgcc_float(last)
        || is_eabi_float(last)
        || is_libm(name)
        || is_one_of(&["compiler_builtins::float::", "::flt2dec::", "::dec2flt::", "core::fmt::float::"])
    {
        Some(Category::SoftFloat)
    } else if last.contains("panic") || fails || is_one_of(&["core::panicking::", "rust_begin_unwind"]) {
        Some(Category::Panic)
    } else if name.contains("core::fmt::") {
        Some(Category::Formatting)
    } else if is_wide_division(last) {
        Some(Category::WideDivision)
    } else {
        None
    }
}

/// `__`, an operation, one or two machine modes, and sometimes the number of operands: "Routines for floating point
/// emulation", GCC Internals. `vfp` is behind those that ask for registers of an FPU.
fn is_libgcc_float(name: &str) -> bool {
    const OPERATIONS: [&str; 20] = [
        "add", "sub", "mul", "div", "neg", "powi", "eq", "ne", "lt", "le", "gt", "ge", "cmp", "unord", "float",
        "floatun", "fix", "fixuns", "extend", "trunc",
    ];
    // Half, single, double, extended, quadruple; complex single, complex double.
    const FLOATS: [&str; 7] = ["hf", "sf", "df", "xf", "tf", "sc", "dc"];
    const INTEGERS: [&str; 3] = ["si", "di", "ti"];
    let are_modes = |modes: &str| {
        let (first, second) = modes.split_at_checked(2).unwrap_or_default();
        let is_mode = |mode| FLOATS.contains(&mode) || INTEGERS.contains(&mode);
        is_mode(first)
            && (second.is_empty() || is_mode(second))
            && (FLOATS.contains(&first) || FLOATS.contains(&second))
    };
    if ["__gnu_h2f_ieee", "__gnu_f2h_ieee"].contains(&name) {
        return true;
    }
    let Some(name) = name.strip_prefix("__") else { return false };
    let name = name.strip_suffix("vfp").unwrap_or(name).trim_end_matches(['2', '3']);
    OPERATIONS.iter().any(|operation| name.strip_prefix(operation).is_some_and(are_modes))
}

/// Arithmetic and comparisons of f and d, those that answer in flags, and conversions from anything to anything: "Run-time
/// ABI for the Arm Architecture", 4.1.
fn is_eabi_float(name: &str) -> bool {
    const OPERATIONS: [&str; 8] = ["add", "sub", "rsub", "mul", "div", "neg", "cmp", "rcmp"];
    const NUMBERS: [&str; 7] = ["h", "f", "d", "i", "ui", "l", "ul"];
    let Some(name) = name.strip_prefix("__aeabi_") else { return false };
    if let Some((from, to)) = name.split_once('2') {
        // `z` is for rounding towards zero, `_alt` for the alternative half.
        let to = to.trim_end_matches("_alt").trim_end_matches('z');
        return NUMBERS.contains(&from) && NUMBERS.contains(&to);
    }
    let operation = name.strip_prefix('c').unwrap_or(name).strip_prefix(['f', 'd']);
    operation.is_some_and(|name| OPERATIONS.iter().any(|operation| name.starts_with(operation)))
}

/// The functions of C's `math.h`, in C or by the crate `libm`. The compiler calls some for operations: `%` is `fmod`.
fn is_libm(name: &str) -> bool {
    const FUNCTIONS: [&str; 43] = [
        "acos",
        "asin",
        "atan",
        "atan2",
        "cbrt",
        "ceil",
        "copysign",
        "cos",
        "cosh",
        "erf",
        "erfc",
        "exp",
        "exp2",
        "expm1",
        "fabs",
        "fdim",
        "floor",
        "fma",
        "fmax",
        "fmaximum",
        "fmin",
        "fminimum",
        "fmod",
        "hypot",
        "ldexp",
        "lgamma",
        "log",
        "log10",
        "log1p",
        "log2",
        "pow",
        "rint",
        "round",
        "roundeven",
        "sin",
        "sinh",
        "sqrt",
        "tan",
        "tanh",
        "tgamma",
        "trunc",
        "exp10",
        "remainder",
    ];
    let plain = name.strip_suffix("_r").unwrap_or(name);
    let is_function = |suffix| plain.strip_suffix(suffix).is_some_and(|function| FUNCTIONS.contains(&function));
    name.starts_with("libm::") || ["", "f", "f16", "f128"].into_iter().any(is_function)
}

fn is_wide_division(name: &str) -> bool {
    let name = name.trim_end_matches(['3', '4']);
    let is_libgcc = ["di", "ti"].iter().any(|mode| {
        let operation = name.strip_prefix("__").and_then(|name| name.strip_suffix(mode));
        operation.is_some_and(|name| ["div", "mod", "divmod"].contains(&name.strip_prefix('u').unwrap_or(name)))
    });
    is_libgcc || ["__aeabi_ldivmod", "__aeabi_uldivmod"].contains(&name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_all(names: &str, expected: Option<Category>) {
        for name in names.split_whitespace() {
            assert_eq!(category(name), expected, "{name}");
        }
    }

    #[test]
    fn routines_for_floats_are_known() {
        assert_all(
            "__addsf3 __subdf3 __mulsf3 __divdf3 __divsf3vfp __negsf2 __powidf2 __eqsf2 __unorddf2 __floatsisf \
             __floatundidf __fixsfsi __fixunsdfdi __extendsfdf2 __truncdfsf2 __muldc3 __gnu_h2f_ieee fmodf sqrt lgammaf_r \
             __aeabi_fadd __aeabi_fsub __aeabi_frsub __aeabi_dmul __aeabi_ddiv __aeabi_fneg __aeabi_fcmpeq \
             __aeabi_cfrcmple __aeabi_cdcmpeq __aeabi_i2f __aeabi_ul2d __aeabi_f2iz __aeabi_d2ulz __aeabi_d2f __aeabi_f2h \
             compiler_builtins::float::add::__addsf3 libm::math::sqrtf::sqrtf core::fmt::float::float_to_decimal \
             core::num::flt2dec::strategy::dragon::mul_pow10 core::num::imp::dec2flt::parse::parse_number",
            Some(Category::SoftFloat),
        );
    }

    #[test]
    fn panics_and_text_are_known() {
        assert_all(
            "core::panicking::panic_fmt core::panicking::panic_bounds_check core::option::unwrap_failed \
             core::option::expect_failed core::result::unwrap_failed core::slice::index::slice_end_index_len_fail \
             core::cell::panic_already_borrowed __rustc::rust_begin_unwind probe_panicked",
            Some(Category::Panic),
        );
        for name in ["core::fmt::write", "<u32 as core::fmt::Display>::fmt", "<core::fmt::Formatter>::pad_integral"] {
            assert_eq!(category(name), Some(Category::Formatting), "{name}");
        }
    }

    #[test]
    fn wide_divisions_are_known() {
        assert_all(
            "__udivdi3 __divdi3 __umoddi3 __moddi3 __udivmoddi4 __divmoddi4 __udivti3 __aeabi_ldivmod __aeabi_uldivmod",
            Some(Category::WideDivision),
        );
    }

    #[test]
    fn integers_are_innocent() {
        assert_all(
            "__udivsi3 __udivmodsi4 __muldi3 __ashldi3 __clzsi2 __negdi2 __aeabi_lmul __aeabi_idiv __aeabi_uidivmod \
             __aeabi_lcmp __aeabi_ldiv0 __aeabi_memcpy memcpy _start main __data_sfdf core_rt::num::round \
             core_rt::render::render_tile _defmt_acquire",
            None,
        );
    }

    #[test]
    fn what_cannot_be_looked_at_is_refused() {
        assert!(matches!(find(b"text"), Err(SymbolsError::Elf(_))));
        // The header of an ELF, 32 bits, little-endian, version 1, and nothing else.
        let mut stripped = [0; 52];
        stripped[..7].copy_from_slice(b"\x7fELF\x01\x01\x01");
        assert!(matches!(find(&stripped), Err(SymbolsError::Stripped)));
    }
}
