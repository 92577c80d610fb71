//! What a sweep is made with: the computer, the program, the tools.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};

use firmware_rt::board::BOARDS;

use super::MachineFacts;
use crate::emulate::machine::Machine;
use crate::files;

/// This computer.
#[must_use]
pub fn machine() -> MachineFacts {
    // Linux has it in a file; elsewhere the architecture has to do.
    let info = files::read(Path::new("/proc/cpuinfo")).unwrap_or_default();
    let info = String::from_utf8_lossy(&info);
    let named = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    MachineFacts {
        cpu: named.map_or(std::env::consts::ARCH, |(_, name)| name.trim()).into(),
        cores: std::thread::available_parallelism().map_or(1, |cores| cores.get() as u32),
        os: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
    }
}

/// The versions of the program and of the tools that there are.
#[must_use]
pub fn versions() -> BTreeMap<String, String> {
    let tools = BOARDS.into_iter().filter_map(|board| Some(Machine::of(board).ok()?.program()));
    let tools = std::iter::once("rustc").chain(tools);
    let found = tools.filter_map(|tool| Some((tool.to_owned(), version(tool)?)));
    found.chain([("intray".to_owned(), env!("CARGO_PKG_VERSION").to_owned())]).collect()
}

/// The version of this program, and the CRC-32 of its file.
#[must_use]
pub fn program() -> String {
    let file = std::env::current_exe().ok().and_then(|path| files::read(&path).ok());
    let crc = file.map_or("unknown".into(), |bytes| format!("{:08x}", core_rt::blob::crc32(&bytes)));
    format!("intray {}, {crc}", env!("CARGO_PKG_VERSION"))
}

/// The first line of what a tool says of its version, without its name.
fn version(tool: &str) -> Option<String> {
    let output = Command::new(tool).arg("--version").stdin(Stdio::null()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let words = text.lines().next()?.split_whitespace();
    let version = words.skip_while(|word| !word.starts_with(|c: char| c.is_ascii_digit()));
    Some(version.collect::<Vec<_>>().join(" "))
}
