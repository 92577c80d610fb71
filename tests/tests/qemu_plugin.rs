//! Counts of the QEMU plugin on programs that were assembled by hand, and so counted by hand.

use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// A machine and the address that its programs lie at.
#[derive(Clone, Copy)]
struct Machine {
    qemu: &'static str,
    arguments: &'static [&'static str],
    base: u32,
}

const MICROBIT: Machine = Machine { qemu: "qemu-system-arm", arguments: &["-M", "microbit"], base: 0 };

const HIFIVE1: Machine = Machine {
    qemu: "qemu-system-riscv32",
    arguments: &["-M", "sifive_e,revb=true", "-bios", "none"],
    base: 0x2001_0000,
};

/// More than any of these programs needs, on any machine.
const TIME_LIMIT: Duration = Duration::from_secs(60);

impl Machine {
    /// Whether a QEMU with the plugin API of this plugin is there; if not, says so in one line.
    fn is_there(self) -> bool {
        let version = Command::new(self.qemu).arg("--version").output().ok().and_then(|output| {
            let text = String::from_utf8(output.stdout).ok()?;
            text.split("version ").nth(1)?.split('.').next()?.parse::<u32>().ok()
        });
        let there = version.is_some_and(|major| major >= 10);
        if !there {
            println!("skipped: there is no {} of version 10 or later (cargo xtask setup)", self.qemu);
        }
        there
    }

    /// Runs a program under the plugin until it exits.
    fn run(self, program: &[u16], arguments: &str, folder: &Path) -> Output {
        let image = folder.join("image.bin");
        let bytes: Vec<u8> = program.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(&image, bytes).unwrap();
        let mut child = Command::new(self.qemu)
            .args(self.arguments)
            .args("-nographic -monitor none -serial none -semihosting-config enable=on,target=native".split(' '))
            .arg("-device")
            .arg(format!("loader,file={},addr={:#x},force-raw=on", image.display(), self.base))
            .arg("-plugin")
            .arg(format!("{},{arguments}", PLUGIN.display()))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if start.elapsed() > TIME_LIMIT {
                child.kill().unwrap();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        child.wait_with_output().unwrap()
    }

    /// The report on a program that exits with success, which is the same on a second run.
    fn count(self, program: &[u16], [begin, end]: [u32; 2], symbols: &[(u32, u32, &str)]) -> Value {
        let folder = tempfile::tempdir().unwrap();
        let [list, out] = ["symbols", "out.json"].map(|name| folder.path().join(name));
        let lines = symbols.iter().fold(String::new(), |mut lines, (address, size, name)| {
            writeln!(lines, "{address:#x} {size:#x} {name}").unwrap();
            lines
        });
        std::fs::write(&list, lines).unwrap();
        let arguments = format!("begin={begin:#x},end={end:#x},symbols={},out={}", list.display(), out.display());
        let [first, second] = [(), ()].map(|()| {
            let output = self.run(program, &arguments, folder.path());
            assert!(output.status.success(), "{}: {}", output.status, String::from_utf8_lossy(&output.stderr));
            std::fs::read_to_string(&out).unwrap()
        });
        assert_eq!(first, second);
        serde_json::from_str(&first).unwrap()
    }
}

/// The plugin, built by the cargo that runs this.
static PLUGIN: LazyLock<PathBuf> = LazyLock::new(|| {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()))
        .args(["build", "--package", "qemu-plugin", "--message-format", "json"])
        .stderr(Stdio::inherit())
        .output()
        .unwrap();
    assert!(output.status.success());
    let messages = String::from_utf8(output.stdout).unwrap();
    messages
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap())
        .filter(|message| message["target"]["name"] == "qemu_plugin" && message["filenames"].is_array())
        .find_map(|message| message["filenames"][0].as_str().map(PathBuf::from))
        .unwrap()
});

/// A program for the Cortex-M0: 16 vectors, then code at 0x40.
fn cortex_m0(hard_fault: u16, code: &[u16]) -> Vec<u16> {
    let mut program = vec![0; 32];
    // Stack pointer, reset, non-maskable interrupt, hard fault; bit 0 marks Thumb code.
    program[..8].copy_from_slice(&[0x1000, 0x2000, 0x41, 0, 0, 0, hard_fault | 1, 0]);
    program.extend(code);
    program
}

fn tally(instructions: i64, cortex_m0: i64, cortex_m0plus: i64) -> Value {
    json!({"instructions": instructions, "cycles": {"cortex-m0": cortex_m0, "cortex-m0plus": cortex_m0plus}})
}

fn named(name: &str, mut tally: Value) -> Value {
    tally["name"] = name.into();
    tally
}

#[rustfmt::skip]
const LOOPS: [u16; 14] = [
    0x2402,             // 40         movs r4, #2
    0x2203,             // 42 again:  movs r2, #3
    0x2000,             // 44 begin:  movs r0, #0
    0x3001,             // 46 loop:   adds r0, #1
    0x3a01,             // 48         subs r2, #1
    0xd1fc,             // 4a         bne loop
    0x3c01,             // 4c end:    subs r4, #1
    0xd1f8,             // 4e         bne again
    0x2018,             // 50         movs r0, #0x18
    0x4901,             // 52         ldr r1, application_exit
    0xbeab,             // 54         bkpt #0xab
    0xbf00,             // 56         nop
    0x0026, 0x0002,     // 58 application_exit: .word 0x20026
];

#[test]
fn windows_are_counted_to_the_instruction() {
    if !MICROBIT.is_there() {
        return;
    }
    let program = cortex_m0(0, &LOOPS);
    // movs once; adds, subs and bne three times, of which bne is taken twice.
    let window = tally(1 + 3 * 3, 1 + 3 * 2 + (3 + 3 + 1), 1 + 3 * 2 + (2 + 2 + 1));
    let expected = json!({
        "target": "arm",
        "instructions": 20,
        "cycles": {"cortex-m0": 28, "cortex-m0plus": 24},
        "windows": [window, window],
        "unpaired": 0,
        "symbols": [],
        "elsewhere": tally(20, 28, 24),
        // Besides: 1 movs; movs, subs, bne twice, the latter taken once; movs, ldr, bkpt.
        "run": tally(20 + 1 + 6 + 3, 28 + 1 + 4 + 4 + 4, 24 + 1 + 4 + 3 + 4),
    });
    assert_eq!(MICROBIT.count(&program, [0x45, 0x4d], &[]), expected);

    // The other way round, once the end comes first, and the last window is open at the exit.
    let report = MICROBIT.count(&program, [0x4c, 0x44], &[]);
    assert_eq!(report["windows"], json!([tally(3, 5, 4), tally(2 + 3, 2 + 4, 2 + 4)]));
    assert_eq!(report["unpaired"], 2);
    // An edge that is never met.
    let report = MICROBIT.count(&program, [0x44, 0x56], &[]);
    assert_eq!((&report["windows"][0]["instructions"], &report["unpaired"]), (&json!(28), &json!(2)));
}

#[rustfmt::skip]
const CALLS: [u16; 26] = [
    0x4d0b,             // 40         ldr r5, uart_enable
    0xf000, 0xf810,     // 42 begin:  bl callee
    0xbf00,             // 46         nop
    0x6829,             // 48         ldr r1, [r5]
    0x3101,             // 4a         adds r1, #1
    0x9100,             // 4c         str r1, [sp]
    0x4349,             // 4e         muls r1, r1, r1
    0xe000,             // 50         b next
    0xde00,             // 52         udf #0
    0x4289,             // 54 next:   cmp r1, r1
    0xd102,             // 56         bne end
    0xf3ef, 0x8010,     // 58         mrs r0, primask
    0xbf00,             // 5c         nop
    0xbf00,             // 5e end:    nop
    0x2018,             // 60         movs r0, #0x18
    0x4902,             // 62         ldr r1, application_exit
    0xbeab,             // 64         bkpt #0xab
    0xb570,             // 66 callee: push {r4-r6, lr}
    0xbd70,             // 68         pop {r4-r6, pc}
    0xbf00,             // 6a         nop
    0x0026, 0x0002,     // 6c application_exit: .word 0x20026
    0x2500, 0x4000,     // 70 uart_enable: .word 0x40002500
];

#[test]
fn device_registers_in_the_middle_of_a_block_do_not_count_twice() {
    if !MICROBIT.is_there() {
        return;
    }
    // QEMU translates and enters a block anew when it finds that one of its loads reads a device, as that at 48 does.
    let callee = tally(2, 5 + 8, 5 + 7);
    let caller = tally(11, 4 + 1 + 2 + 1 + 2 + 1 + 3 + 1 + 1 + 4 + 1, 3 + 1 + 2 + 1 + 2 + 1 + 2 + 1 + 1 + 3 + 1);
    let report = MICROBIT.count(&cortex_m0(0, &CALLS), [0x42, 0x5e], &[(0x67, 4, "callee"), (0x42, 0x24, "a caller")]);
    assert_eq!(report["windows"], json!([tally(13, 34, 30)]));
    assert_eq!(report["symbols"], json!([named("callee", callee), named("a caller", caller)]));
    assert_eq!(report["elsewhere"], tally(0, 0, 0));
    // What the symbols do not cover is elsewhere.
    let report = MICROBIT.count(&cortex_m0(0, &CALLS), [0x42, 0x5e], &[(0x66, 2, "push")]);
    assert_eq!(report["symbols"], json!([named("push", tally(1, 5, 5))]));
    assert_eq!(report["elsewhere"], tally(12, 29, 25));
}

#[rustfmt::skip]
const FAULT: [u16; 16] = [
    0x4e06,             // 40         ldr r6, nothing
    0xbf00,             // 42         nop
    0x2000,             // 44 begin:  movs r0, #0
    0x6831,             // 46         ldr r1, [r6]
    0x3001,             // 48         adds r0, #1
    0x3001,             // 4a         adds r0, #1
    0x3201,             // 4c hard_fault: adds r2, #1
    0xbf00,             // 4e end:    nop
    0x2018,             // 50         movs r0, #0x18
    0x4901,             // 52         ldr r1, application_exit
    0xbeab,             // 54         bkpt #0xab
    0xbf00,             // 56         nop
    0x0026, 0x0002,     // 58 application_exit: .word 0x20026
    0x0000, 0x6000,     // 5c nothing: .word 0x60000000
];

#[test]
fn what_a_fault_skips_does_not_count() {
    if !MICROBIT.is_there() {
        return;
    }
    let report = MICROBIT.count(&cortex_m0(0x4c, &FAULT), [0x44, 0x4e], &[]);
    assert_eq!(report["windows"], json!([tally(3, 4, 4)]));
}

#[rustfmt::skip]
const RISCV: [u16; 36] = [
    0x428d,             // 00         li t0, 3
    0x3637, 0x1001,     // 02         lui a2, 0x10013
    0x1137, 0x8000,     // 06         lui sp, 0x80001
    0x1141,             // 0a         addi sp, sp, -16
    0x4501,             // 0c begin:  li a0, 0
    0x0505,             // 0e loop:   addi a0, a0, 1
    0x12fd,             // 10         addi t0, t0, -1
    0x9ee3, 0xfe02,     // 12         bnez t0, loop
    0x420c,             // 16         lw a1, 0(a2)
    0x05b3, 0x02a5,     // 18         mul a1, a0, a0
    0xc208,             // 1c         sw a0, 0(a2)
    0xc02e,             // 1e         sw a1, 0(sp)
    0x0505,             // 20         addi a0, a0, 1
    0x0001,             // 22 end:    nop
    0x0013, 0x0000,     // 24         nop
    0x0013, 0x0000,     // 28         nop
    0x0013, 0x0000,     // 2c         nop
    0x0513, 0x0180,     // 30         li a0, 0x18
    0x05b7, 0x0002,     // 34         lui a1, 0x20
    0x8593, 0x0265,     // 38         addi a1, a1, 0x26
    0x1013, 0x01f0,     // 3c         slli zero, zero, 0x1f
    0x0073, 0x0010,     // 40         ebreak
    0x5013, 0x4070,     // 44         srai zero, zero, 7
];

#[test]
fn riscv_is_counted_without_cycles() {
    if !HIFIVE1.is_there() {
        return;
    }
    let tally = |instructions| json!({"instructions": instructions, "cycles": {}});
    // The load and the store in the middle of the block reach the UART.
    let window = 1 + 3 * 3 + 5;
    let symbols = [(0x2001_000e, 8, "loop"), (0x2001_0018, 4, "square")];
    let expected = json!({
        "target": "riscv32",
        "instructions": window,
        "cycles": {},
        "windows": [tally(window)],
        "unpaired": 0,
        "symbols": [named("loop", tally(9)), named("square", tally(1))],
        "elsewhere": tally(window - 10),
        // Besides: 2 of the boot ROM's, 4 before the window and 9 after it, the last of which is ebreak.
        "run": tally(2 + 4 + window + 9),
    });
    assert_eq!(HIFIVE1.count(&RISCV, [0x2001_000c, 0x2001_0022], &symbols), expected);
}

#[test]
fn wrong_arguments_end_qemu_with_a_message() {
    if !MICROBIT.is_there() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("begin=0x44,out=o", "end= is missing"),
        ("begin=44,end=0x4c,out=o", "\"44\" is not 0x and hexadecimal digits"),
        ("begin=0x44,end=0x4c,out=/no/such/folder/o", "/no/such/folder/o: "),
        ("begin=0x44,end=0x4c,symbols=/no/such/file,out=o", "/no/such/file: "),
    ];
    for (arguments, message) in cases {
        let output = MICROBIT.run(&cortex_m0(0, &LOOPS), arguments, folder.path());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(&format!("qemu-plugin: {message}")), "{said}");
    }
}
