//! How many cycles an ARMv6-M instruction takes, by its class, on a Cortex-M0 and a Cortex-M0+.
//!
//! A model, not a measurement: the instruction timings of the two technical reference manuals (ARM DDI 0432C and
//! DDI 0484C, table 3-1) for memory without wait states and the multiplier of one cycle. Flash with wait states, the
//! single-cycle I/O port, exception entry and return, and time spent asleep are not in it; SVC, BKPT and undefined
//! instructions, for which the manuals give no figure, take 1.

/// Instructions that the timing tables treat alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// From registers to registers, the program counter not among them.
    Register,
    /// One load or store.
    LoadStore,
    /// LDM, STM, PUSH, and POP of so many registers without the program counter.
    Multiple(u32),
    /// POP of so many registers, the program counter among them.
    Return(u32),
    /// A conditional branch.
    ConditionalBranch,
    /// B, BX, BLX, and what else writes the program counter.
    Branch,
    /// BL.
    Call,
    /// MRS, MSR, and the barriers.
    System,
    /// WFE and WFI.
    Wait,
    /// Everything else.
    Other,
}

/// The cycles that differ between the cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Model {
    /// What it is called in the output.
    pub(crate) name: &'static str,
    branch: u32,
    call: u32,
    /// POP with the program counter, besides one cycle a register.
    pop_return: u32,
    system: u32,
}

/// All models.
pub(crate) const MODELS: [Model; 2] = [
    Model { name: "cortex-m0", branch: 3, call: 4, pop_return: 4, system: 4 },
    Model { name: "cortex-m0plus", branch: 2, call: 3, pop_return: 3, system: 3 },
];

impl Model {
    /// Cycles of an instruction; of a conditional branch, when it is taken.
    pub(crate) fn cycles(&self, class: Class) -> u32 {
        match class {
            Class::Register | Class::Other => 1,
            Class::LoadStore | Class::Wait => 2,
            Class::Multiple(registers) => 1 + registers,
            Class::Return(registers) => self.pop_return + registers,
            Class::ConditionalBranch | Class::Branch => self.branch,
            Class::Call => self.call,
            Class::System => self.system,
        }
    }

    /// What a conditional branch saves by falling through.
    pub(crate) fn saved_by_falling_through(&self) -> u32 {
        self.branch - 1
    }
}

impl Class {
    /// Of an instruction as it lies in memory, 2 or 4 bytes.
    pub(crate) fn of(code: &[u8]) -> Self {
        match *code {
            [a, b] => Self::of_halfword(u16::from_le_bytes([a, b])),
            [a, b, c, d] => Self::of_halfwords(u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d])),
            _ => Self::Other,
        }
    }

    fn of_halfword(code: u16) -> Self {
        let registers = |mask: u16| (code & mask).count_ones();
        // The destination of the instructions that reach the upper registers.
        let writes_pc = code & 0x87 == 0x87;
        match code >> 8 {
            0x00..=0x43 | 0x45 => Self::Register,
            0x44 | 0x46 if !writes_pc => Self::Register,
            0x44 | 0x46 | 0x47 => Self::Branch,
            0x48..=0x9f => Self::LoadStore,
            0xa0..=0xb0 | 0xb2 => Self::Register,
            0xb4 | 0xb5 | 0xbc => Self::Multiple(registers(0x1ff)),
            0xba if code & 0xc0 != 0x80 => Self::Register,
            0xbd => Self::Return(registers(0x1ff)),
            0xbf if code == 0xbf00 => Self::Register,
            0xbf if matches!(code, 0xbf20 | 0xbf30) => Self::Wait,
            0xc0..=0xcf => Self::Multiple(registers(0xff)),
            0xd0..=0xdd => Self::ConditionalBranch,
            0xe0..=0xe7 => Self::Branch,
            _ => Self::Other,
        }
    }

    fn of_halfwords(first: u16, second: u16) -> Self {
        match (first, second) {
            (0xf000..=0xf7ff, 0xd000..=0xdfff | 0xf000..=0xffff) => Self::Call,
            (0xf380..=0xf38f | 0xf3bf | 0xf3ef, 0x8000..=0x8fff) => Self::System,
            _ => Self::Other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(code: u16) -> Class {
        Class::of(&code.to_le_bytes())
    }

    fn of_both(first: u16, second: u16) -> Class {
        Class::of(&[first.to_le_bytes(), second.to_le_bytes()].concat())
    }

    #[test]
    fn instructions_fall_into_their_classes() {
        let cases = [
            ("lsls r1, r2, #3", 0x00d1, Class::Register),
            ("movs r0, #5", 0x2005, Class::Register),
            ("muls r0, r1, r0", 0x4348, Class::Register),
            ("add r8, r9", 0x44c8, Class::Register),
            ("add pc, r0", 0x4487, Class::Branch),
            ("cmp pc, r0", 0x4587, Class::Register),
            ("mov r7, r8", 0x4647, Class::Register),
            ("mov r15, r14", 0x46f7, Class::Branch),
            ("mov r8, r7", 0x46b8, Class::Register),
            ("bx lr", 0x4770, Class::Branch),
            ("blx r3", 0x4798, Class::Branch),
            ("ldr r0, [pc, #0]", 0x4800, Class::LoadStore),
            ("strb r0, [r1, r2]", 0x5488, Class::LoadStore),
            ("ldrsh r0, [r1, r2]", 0x5e88, Class::LoadStore),
            ("ldrh r0, [r1, #62]", 0x8fc8, Class::LoadStore),
            ("ldr r7, [sp, #1020]", 0x9fff, Class::LoadStore),
            ("adr r0, here", 0xa000, Class::Register),
            ("sub sp, #16", 0xb084, Class::Register),
            ("uxtb r0, r1", 0xb2c8, Class::Register),
            ("push {r4, r5, lr}", 0xb530, Class::Multiple(3)),
            ("cpsid i", 0xb672, Class::Other),
            ("rev r0, r1", 0xba08, Class::Register),
            ("hlt #0", 0xba80, Class::Other),
            ("pop {r4-r7}", 0xbcf0, Class::Multiple(4)),
            ("pop {r4, r5, pc}", 0xbd30, Class::Return(3)),
            ("bkpt #0xab", 0xbeab, Class::Other),
            ("nop", 0xbf00, Class::Register),
            ("yield", 0xbf10, Class::Other),
            ("wfi", 0xbf30, Class::Wait),
            ("stm r0!, {r1-r3}", 0xc00e, Class::Multiple(3)),
            ("ldm r7!, {r0-r6}", 0xcf7f, Class::Multiple(7)),
            ("beq here", 0xd0fe, Class::ConditionalBranch),
            ("ble here", 0xddfe, Class::ConditionalBranch),
            ("udf #0", 0xde00, Class::Other),
            ("svc #0", 0xdf00, Class::Other),
            ("b here", 0xe7fe, Class::Branch),
        ];
        for (text, code, class) in cases {
            assert_eq!(of(code), class, "{text}");
        }
    }

    #[test]
    fn the_six_32_bit_instructions_are_known() {
        assert_eq!(of_both(0xf000, 0xf800), Class::Call); // bl, forwards
        assert_eq!(of_both(0xf7ff, 0xfffe), Class::Call); // bl, backwards
        assert_eq!(of_both(0xf000, 0xd001), Class::Call); // bl, far forwards
        assert_eq!(of_both(0xf381, 0x8808), Class::System); // msr msp, r1
        assert_eq!(of_both(0xf3ef, 0x8010), Class::System); // mrs r0, primask
        assert_eq!(of_both(0xf3bf, 0x8f5f), Class::System); // dmb
        assert_eq!(of_both(0xf3bf, 0x8f4f), Class::System); // dsb
        assert_eq!(of_both(0xf3bf, 0x8f6f), Class::System); // isb
        assert_eq!(of_both(0xf7f0, 0xa000), Class::Other); // udf.w
        assert_eq!(Class::of(&[0; 3]), Class::Other);
    }

    #[test]
    fn cycles_are_those_of_the_manuals() {
        let both = |class| MODELS.map(|model| model.cycles(class));
        assert_eq!(both(Class::Register), [1, 1]);
        assert_eq!(both(Class::LoadStore), [2, 2]);
        assert_eq!(both(Class::Multiple(3)), [4, 4]);
        assert_eq!(both(Class::Return(3)), [7, 6]);
        assert_eq!(both(Class::Branch), [3, 2]);
        assert_eq!(both(Class::Call), [4, 3]);
        assert_eq!(both(Class::System), [4, 3]);
        assert_eq!(both(Class::Wait), [2, 2]);
        assert_eq!(both(Class::ConditionalBranch), [3, 2]);
        assert_eq!(MODELS.map(|model| model.saved_by_falling_through()), [2, 1]);
    }
}
