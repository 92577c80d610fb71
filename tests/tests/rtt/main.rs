//! Firmware that reaches the host by RTT, as on a real board: QEMU without semihosting, and its gdb stub as the probe.
//!
//! Boards that cannot be emulated here are skipped, with a line that says so.
#![cfg(unix)]

mod gdb;

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use firmware_rt::board::{Board, MICROBIT};
use gdb::Gdb;
use host_tools::builtin;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::{Transport, Wanted};
use host_tools::emulate::frames::Frames;
use host_tools::emulate::log::Log;
use host_tools::engine;
use host_tools::flash::digits::Digits;
use host_tools::import::{Embedded, load_from};
use host_tools::prepare::{Blob, Options};
use tests::boards::boards;

/// More than either board needs.
const LIMIT: Duration = Duration::from_secs(60);

/// QEMU loads no raw file that is larger than the machine's RAM.
const PIECE: usize = 1 << 14;

/// The built-in scene, small.
fn blob() -> Blob {
    let mut model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    model.render.size = [32, 24];
    engine::by_name("exact14").unwrap().prepare(&model, &Options::default()).unwrap().blob
}

fn firmware(board: &'static Board, blob: &[u8]) -> Elf {
    Wanted { board, blob, hits: None, count: false }.provide_over(Transport::Rtt).unwrap()
}

/// A board that nothing but the probe reaches.
struct Running {
    qemu: Child,
    probe: Gdb,
}

impl Running {
    fn start(board: &Board, elf: &Elf, blob: &[u8], folder: &Path) -> Self {
        let (program, machine): (_, &[_]) = match *board {
            MICROBIT => ("qemu-system-arm", &["-M", "microbit"]),
            _ => ("qemu-system-riscv32", &["-M", "sifive_e,revb=true", "-bios", "none"]),
        };
        let socket = folder.join("gdb");
        let mut command = Command::new(program);
        command.args(machine).args(["-nographic", "-monitor", "none", "-serial", "none", "-S", "-gdb"]);
        command.arg(format!("unix:{},server=on,wait=off", socket.display())).arg("-kernel").arg(elf.path());
        let start = elf.blob_place.expect("a place for the blob").start;
        for (address, piece) in (start..).step_by(PIECE).zip(blob.chunks(PIECE)) {
            let file = folder.join(format!("{address:x}"));
            std::fs::write(&file, piece).unwrap();
            command.arg("-device").arg(format!("loader,file={},addr={address:#x},force-raw=on", file.display()));
        }
        let qemu = command.stdin(Stdio::null()).spawn().unwrap();
        Self { qemu, probe: Gdb::connect(&socket) }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It waits for ever once it has ended.
        self.qemu.kill().unwrap();
        self.qemu.wait().unwrap();
    }
}

/// RTT's control block: an identifier of 16 bytes, the numbers of channels up and down, and 24 bytes a channel.
struct Rtt {
    address: u32,
}

impl Rtt {
    /// What a channel has had since it was last read; nothing before the chip has set it up.
    fn take(&self, probe: &mut Gdb, channel: u32) -> Vec<u8> {
        if probe.read(self.address, 16) != *b"SEGGER RTT\0\0\0\0\0\0" {
            return Vec::new();
        }
        assert_eq!(probe.word(self.address + 16), 2);
        let place = self.address + 24 + 24 * channel;
        let [buffer, size, write, read] = [4, 8, 12, 16].map(|offset| probe.word(place + offset));
        let bytes = if read <= write {
            probe.read(buffer + read, (write - read) as usize)
        } else {
            [probe.read(buffer + read, (size - read) as usize), probe.read(buffer, write as usize)].concat()
        };
        probe.set_word(place + 16, write);
        bytes
    }
}

/// What comes over both channels until the log says that it is the end, and nothing more afterwards.
fn heard(board: &'static Board, elf: &Elf, blob: &[u8]) -> (Vec<String>, Frames) {
    let folder = tempfile::tempdir().unwrap();
    let Running { probe, .. } = &mut Running::start(board, elf, blob, folder.path());
    let rtt = Rtt { address: elf.symbol("_SEGGER_RTT").unwrap() as u32 };
    let (mut lines, mut frames, mut log) = (Vec::<String>::new(), Frames::default(), Log::new(elf).unwrap());
    let mut digits = Digits::default();
    let begin = Instant::now();
    while lines.last().is_none_or(|line| !line.contains("the end, status")) {
        assert!(begin.elapsed() < LIMIT, "{lines:?}");
        probe.run_for(Duration::from_millis(2));
        log.take(&rtt.take(probe, 0), &mut |line| lines.push(line.into()));
        frames.take(&digits.take(&rtt.take(probe, 1)).unwrap()).unwrap();
    }
    // A breakpoint that no debugger takes has become a fault by then, of which nothing is to be said.
    probe.run_for(Duration::from_millis(50));
    assert_eq!([rtt.take(probe, 0), rtt.take(probe, 1)], [const { Vec::<u8>::new() }; 2]);
    assert_eq!(lines.iter().filter(|line| line.contains("the end, status")).count(), 1, "{lines:?}");
    (lines, frames)
}

#[test]
fn the_picture_comes_by_rtt_and_is_the_hosts() {
    let blob = blob();
    let expected = engine::by_name("exact14").unwrap().render(blob.bytes(), [8, 8], &|_| ()).unwrap().picture;
    for board in boards() {
        let (lines, frames) = heard(board, &firmware(board, blob.bytes()), blob.bytes());
        assert_eq!(lines[0], format!("info  {}: a blob of {} bytes for exact14", board.name, blob.bytes().len()));
        assert_eq!(lines.last().unwrap(), "info  the end, status 0");
        assert_eq!(frames.finish().unwrap().0, expected, "{}", board.name);
    }
}

#[test]
fn a_damaged_blob_is_told_of_by_rtt() {
    let blob = blob();
    let mut damaged = blob.bytes().to_vec();
    damaged[blob.bytes().len() / 2] ^= 1;
    for board in boards() {
        let (lines, frames) = heard(board, &firmware(board, blob.bytes()), &damaged);
        assert!(lines[1].starts_with("error the blob was refused: damaged"), "{lines:?}");
        assert_eq!(lines.last().unwrap(), "info  the end, status 10");
        assert!(frames.finish().is_err());
    }
}

#[test]
fn buffers_are_in_ram_and_everything_fits() {
    let blob = blob();
    for board in boards() {
        let elf = firmware(board, blob.bytes());
        let ram = u64::from(board.ram.start)..u64::from(board.ram.end());
        assert!(elf.symbol("_SEGGER_RTT").is_some_and(|address| ram.contains(&address)), "{}", board.name);
        assert_eq!(elf.symbol("_SEGGER"), None);
        assert!((10_000..u64::from(board.code(14).length)).contains(&elf.text_bytes), "{}", elf.text_bytes);
        // The buffers alone are 1280; the stack has memory of its own.
        assert!((1280..u64::from(board.ram.length)).contains(&elf.static_bytes), "{}", elf.static_bytes);
        let by_semihosting = Wanted { board, blob: blob.bytes(), hits: None, count: false }.provide().unwrap();
        assert_eq!(by_semihosting.symbol("_SEGGER_RTT"), None);
        println!("{}: {} bytes of text, {} of RAM", board.name, elf.text_bytes, elf.static_bytes);
    }
}
