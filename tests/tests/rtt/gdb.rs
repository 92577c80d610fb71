//! A debug probe, as far as RTT needs one: QEMU's gdb stub, by the remote serial protocol, reads and writes the memory of a
//! chip that it has halted.

use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

/// How long an answer may take.
const LIMIT: Duration = Duration::from_secs(20);

/// A connection to a stub.
pub(crate) struct Gdb(UnixStream);

impl Gdb {
    /// Waits for the stub; the chip is halted.
    pub(crate) fn connect(socket: &Path) -> Self {
        let begin = Instant::now();
        loop {
            match UnixStream::connect(socket) {
                Ok(stream) => {
                    stream.set_read_timeout(Some(LIMIT)).unwrap();
                    return Self(stream);
                }
                Err(error) if begin.elapsed() > LIMIT => panic!("{}: {error}", socket.display()),
                Err(_) => std::thread::sleep(Duration::from_millis(10)),
            }
        }
    }

    /// Lets the chip run for so long.
    pub(crate) fn run_for(&mut self, time: Duration) {
        self.send("c");
        std::thread::sleep(time);
        self.0.write_all(&[3]).unwrap();
        let stopped = self.receive();
        assert!(stopped.starts_with(['T', 'S']), "{stopped}");
    }

    pub(crate) fn read(&mut self, address: u32, length: usize) -> Vec<u8> {
        // A packet of the stub's takes 4096 digits.
        let mut bytes = Vec::new();
        while bytes.len() < length {
            let count = (length - bytes.len()).min(1024);
            self.send(&format!("m{:x},{count:x}", address as usize + bytes.len()));
            let digits = self.receive();
            assert_eq!(digits.len(), 2 * count, "{digits}");
            bytes.extend((0..count).map(|i| u8::from_str_radix(&digits[2 * i..2 * i + 2], 16).unwrap()));
        }
        bytes
    }

    pub(crate) fn word(&mut self, address: u32) -> u32 {
        u32::from_le_bytes(self.read(address, 4).try_into().unwrap())
    }

    pub(crate) fn set_word(&mut self, address: u32, word: u32) {
        self.send(&format!("M{address:x},4:{:08x}", word.swap_bytes()));
        assert_eq!(self.receive(), "OK");
    }

    fn send(&mut self, packet: &str) {
        let sum = packet.bytes().fold(0u8, u8::wrapping_add);
        self.0.write_all(format!("${packet}#{sum:02x}").as_bytes()).unwrap();
        assert_eq!(self.byte(), b'+');
    }

    fn receive(&mut self) -> String {
        assert_eq!(self.byte(), b'$');
        let packet: Vec<u8> = std::iter::from_fn(|| Some(self.byte()).filter(|&byte| byte != b'#')).collect();
        let stated = [self.byte(), self.byte()];
        let sum = packet.iter().fold(0u8, |sum, &byte| sum.wrapping_add(byte));
        assert_eq!(stated, *format!("{sum:02x}").as_bytes());
        self.0.write_all(b"+").unwrap();
        String::from_utf8(packet).unwrap()
    }

    fn byte(&mut self) -> u8 {
        let mut byte = [0];
        self.0.read_exact(&mut byte).unwrap();
        byte[0]
    }
}
