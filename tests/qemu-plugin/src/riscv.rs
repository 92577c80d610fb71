//! Which rv32imac instructions can leave a translated block before its end.
//!
//! There is no cycle model: the only chip of interest, the FE310, predicts branches and caches its flash.

/// Whether an instruction, as it lies in memory, does nothing but compute from registers to registers.
///
/// It neither accesses memory, which may fault, nor jumps, traps, or reads a control register.
pub(crate) fn only_computes(code: &[u8]) -> bool {
    match *code {
        [a, b] => compressed_only_computes(u16::from_le_bytes([a, b])),
        // OP-IMM, AUIPC, OP, LUI
        [a, _, _, _] => matches!(a & 0x7f, 0x13 | 0x17 | 0x33 | 0x37),
        _ => false,
    }
}

fn compressed_only_computes(code: u16) -> bool {
    // Quadrant and funct3.
    match (code & 3, code >> 13) {
        // c.addi4spn; c.addi, c.li, c.lui or c.addi16sp, the arithmetic group; c.slli
        (0, 0) | (1, 0 | 2 | 3 | 4) | (2, 0) => true,
        // c.mv and c.add, but not c.jr, c.jalr and c.ebreak, which have no second register
        (2, 4) => code & 0x7c != 0,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_only_computes() {
        for (text, code) in [
            ("c.addi4spn a0, sp, 8", 0x0028u16),
            ("c.addi a0, 1", 0x0505),
            ("c.li a0, 0", 0x4501),
            ("c.lui a0, 1", 0x6505),
            ("c.sub a0, a1", 0x8d0d),
            ("c.slli a0, 2", 0x050a),
            ("c.mv a0, a1", 0x852e),
            ("c.add a0, a1", 0x952e),
        ] {
            assert!(only_computes(&code.to_le_bytes()), "{text}");
        }
        for (text, code) in [
            ("addi a0, a0, 1", 0x0015_0513u32),
            ("auipc a0, 0", 0x0000_0517),
            ("mul a0, a0, a1", 0x02b5_0533),
            ("lui a0, 1", 0x0000_1537),
        ] {
            assert!(only_computes(&code.to_le_bytes()), "{text}");
        }
    }

    #[test]
    fn memory_jumps_traps_and_control_registers_do_more() {
        for (text, code) in [
            ("c.lw a0, 0(a1)", 0x4188u16),
            ("c.sw a0, 0(a1)", 0xc188),
            ("c.jal here", 0x2001),
            ("c.j here", 0xa001),
            ("c.beqz a0, here", 0xc101),
            ("c.bnez a0, here", 0xe101),
            ("c.lwsp a0, 0(sp)", 0x4502),
            ("c.swsp a0, 0(sp)", 0xc02a),
            ("c.jr ra", 0x8082),
            ("c.jalr a0", 0x9502),
            ("c.ebreak", 0x9002),
        ] {
            assert!(!only_computes(&code.to_le_bytes()), "{text}");
        }
        for (text, code) in [
            ("lw a0, 0(a1)", 0x0005_a503u32),
            ("sw a0, 0(a1)", 0x00a5_a023),
            ("amoadd.w a0, a1, (a2)", 0x00b6_252f),
            ("beq a0, a1, here", 0x00b5_0063),
            ("jal ra, here", 0x0000_00ef),
            ("jalr ra, 0(a0)", 0x0005_00e7),
            ("ecall", 0x0000_0073),
            ("csrr a0, mcycle", 0xb000_2573),
            ("fence", 0x0ff0_000f),
        ] {
            assert!(!only_computes(&code.to_le_bytes()), "{text}");
        }
        assert!(!only_computes(&[0x13, 0, 0]));
    }
}
