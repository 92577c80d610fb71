//! How deep the stack of a program for a Cortex-M0 can get, by its instructions: what each function takes, and the longest way
//! down from the entry. Functions that call each other in a circle, or what is only known when it runs, have no bound.
//!
//! A function takes at most the sum of all that any of its instructions takes: of `push`, and of `sub sp` by a constant in the
//! instruction or in a register that was loaded before (ARMv6-M Architecture Reference Manual, A5 and A6).

use std::collections::{BTreeMap, BTreeSet};

use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, ObjectSymbol, SymbolKind};

/// A function: what it takes, bytes, and whom it calls.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Function {
    name: String,
    frame: u64,
    calls: Vec<u64>,
}

/// The code of an ELF: its first address, and its halfwords.
struct Code {
    start: u64,
    halfwords: Vec<u16>,
}

impl Code {
    fn at(&self, address: u64) -> Option<u16> {
        self.halfwords.get(usize::try_from(address.checked_sub(self.start)? / 2).ok()?).copied()
    }

    fn word(&self, address: u64) -> Option<u32> {
        Some(u32::from(self.at(address)?) | u32::from(self.at(address + 2)?) << 16)
    }
}

/// The most that the stack takes below the entry, bytes.
///
/// # Errors
/// Why there is no bound, or none can be found.
pub fn bound(bytes: &[u8], entry: &str) -> Result<u64, String> {
    let file = ElfFile32::<Endianness>::parse(bytes).map_err(|error| error.to_string())?;
    let text = file.section_by_name(".text").ok_or("no code")?;
    let data = text.data().map_err(|error| error.to_string())?;
    let halfwords = data.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
    let code = Code { start: text.address(), halfwords };
    let mut functions = BTreeMap::new();
    let mut first = None;
    for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0) {
        let start = symbol.address() & !1;
        let name = symbol.name().map_err(|error| error.to_string())?.to_owned();
        if name == entry {
            first = Some(start);
        }
        functions.insert(start, function(&code, start, symbol.size(), name)?);
    }
    deepest(&functions, first.ok_or("no such entry")?, &mut Vec::new())
}

/// A function's instructions, one after the other, without the words between them that they load.
fn function(code: &Code, start: u64, size: u64, name: String) -> Result<Function, String> {
    let mut found = Function { name, ..Function::default() };
    let (mut loaded, mut words) = ([None; 8], BTreeSet::new());
    let mut address = start;
    while let Some(first) = code.at(address).filter(|_| address < start + size) {
        if words.contains(&address) {
            address += 4;
            continue;
        }
        let is_wide = first >> 11 >= 0b11101;
        match first {
            // push {registers, lr}
            0xb400..=0xb5ff => found.frame += 4 * u64::from((first & 0x1ff).count_ones()),
            // sub sp, #imm
            0xb080..=0xb0ff => found.frame += 4 * u64::from(first & 0x7f),
            // ldr register, [pc, #imm]
            0x4800..=0x4fff => {
                let place = ((address + 4) & !3) + 4 * u64::from(first & 0xff);
                words.insert(place);
                loaded[usize::from(first >> 8 & 7)] = code.word(place);
            }
            // add sp, register: the way to large frames, and back
            _ if first & 0xff87 == 0x4485 => {
                let value = loaded.get(usize::from(first >> 3 & 15)).copied().flatten();
                let value = value.ok_or_else(|| format!("{}: the stack moves by what is not known", found.name))?;
                found.frame += u64::try_from(-i64::from(value.cast_signed())).unwrap_or_default();
            }
            // blx register
            _ if first & 0xff87 == 0x4780 => return Err(format!("{}: calls what is not known", found.name)),
            // b, which may leave the function for good
            0xe000..=0xe7ff => {
                let offset = i64::from(((first & 0x7ff) << 5).cast_signed() >> 4);
                let target = (address + 4).wrapping_add_signed(offset);
                if !(start..start + size).contains(&target) {
                    found.calls.push(target);
                }
            }
            _ => {}
        }
        if is_wide && let Some(second) = code.at(address + 2) {
            if let Some(offset) = branch(first, second) {
                let target = (address + 4).wrapping_add_signed(offset);
                // Into its own midst it is a jump that is too far for `b`.
                if !(start + 1..start + size).contains(&target) {
                    found.calls.push(target);
                }
            }
            address += 2;
        }
        address += 2;
    }
    Ok(found)
}

/// How far `bl` goes; `None` for another instruction.
fn branch(first: u16, second: u16) -> Option<i64> {
    if first >> 11 != 0b11110 || second & 0xd000 != 0xd000 {
        return None;
    }
    let [s, j1, j2] = [first >> 10 & 1, second >> 13 & 1, second >> 11 & 1].map(u32::from);
    let offset = s << 24
        | (1 ^ j1 ^ s) << 23
        | (1 ^ j2 ^ s) << 22
        | u32::from(first & 0x3ff) << 12
        | u32::from(second & 0x7ff) << 1;
    Some(i64::from((offset << 7).cast_signed() >> 7))
}

/// The most that a function and those below it take.
fn deepest(functions: &BTreeMap<u64, Function>, at: u64, above: &mut Vec<u64>) -> Result<u64, String> {
    // A name may stand before the first instruction of a function: the last one that is not behind the address.
    let Some((&start, function)) = functions.range(..=at).next_back() else { return Ok(0) };
    if above.contains(&start) {
        return Err(format!("{} calls itself", function.name));
    }
    above.push(start);
    let mut most = 0;
    for &call in &function.calls {
        most = most.max(deepest(functions, call, above)?);
    }
    above.pop();
    Ok(function.frame + most)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(halfwords: &[u16]) -> Code {
        Code { start: 0x100, halfwords: halfwords.to_vec() }
    }

    fn of(halfwords: &[u16]) -> Result<Function, String> {
        function(&code(halfwords), 0x100, 2 * halfwords.len() as u64, "f".into())
    }

    #[test]
    fn frames_are_read() {
        // push {r4, r5, lr}; sub sp, #24; add sp, #24; pop {r4, r5, pc}
        assert_eq!(of(&[0xb530, 0xb086, 0xb006, 0xbd30]).map(|f| f.frame), Ok(12 + 24));
        // ldr r6, [pc, #0]; add sp, r6; (data) -1024
        assert_eq!(of(&[0x4e00, 0x44b5, 0xfc00, 0xffff]).map(|f| f.frame), Ok(1024));
        assert!(of(&[0x44b5]).is_err(), "by what is not known");
        assert!(of(&[0x4780]).is_err(), "blx r0");
    }

    #[test]
    fn calls_are_read() {
        // bl, to the instruction after it and 0x1000 further; and 2 back from itself.
        assert_eq!((branch(0xf001, 0xf800), branch(0xf7ff, 0xfffd)), (Some(0x1000), Some(-6)));
        assert_eq!(branch(0xf3ef, 0x8000), None, "mrs");
        assert_eq!(of(&[0xf001, 0xf800]).map(|f| f.calls), Ok(vec![0x1104]));
        // bl into its own midst is a jump, and to its own start a circle.
        assert_eq!(of(&[0xb500, 0xf7ff, 0xfffe, 0xbd00]).map(|f| f.calls), Ok(vec![]));
        assert_eq!(of(&[0xb500, 0xf7ff, 0xfffd, 0xbd00]).map(|f| f.calls), Ok(vec![0x100]));
        // b to itself stays.
        assert_eq!(of(&[0xe7fe]).map(|f| f.calls), Ok(vec![]));
    }

    #[test]
    fn the_longest_way_counts_and_circles_have_none() {
        let function = |frame, calls: &[u64]| Function { name: "f".into(), frame, calls: calls.to_vec() };
        let mut functions: BTreeMap<u64, Function> =
            [(0, function(8, &[10, 20])), (10, function(16, &[20])), (20, function(4, &[]))].into();
        assert_eq!(deepest(&functions, 0, &mut Vec::new()), Ok(28));
        functions.insert(20, function(4, &[10]));
        assert!(deepest(&functions, 0, &mut Vec::new()).is_err());
    }
}
