//! Real chips through `probe-rs`, by the command line of its versions from 0.30.

use std::ffi::OsString;
use std::fs;
use std::io::ErrorKind;
use std::process::{Command, ExitStatus, Output, Stdio};
use std::time::{Duration, Instant};

use firmware_rt::board::Board;
use firmware_rt::frame::CHANNEL;
use firmware_rt::status::Status;

use super::FlashError;
use super::digits::Digits;
use super::image::pieces;
use crate::emulate::elf::Elf;
use crate::emulate::frames::Frames;
use crate::emulate::process::{Process, Tail};
use crate::emulate::{EmulateError, Observer, Outcome};

const PROGRAM: &str = "probe-rs";

/// How long the program may go on after the last line of the log: it reads the channels once more and ends, but after a
/// fault, where the chip can say nothing to it.
const GRACE: Duration = Duration::from_secs(3);

/// What the last line of the log has before the status.
const END: &str = "the end, status ";

/// What the program says where it sees no probe, by verb and version.
const NO_PROBE: [&str; 4] =
    ["No debug probes were found", "No connected probes were found", "No probe was found", "Probe not found"];

/// A board on a debug probe.
#[derive(Clone, Copy, Debug)]
pub struct Probe<'a> {
    /// The board.
    pub board: &'static Board,
    /// Which probe, as `probe-rs --probe` has it; `None` for the only one.
    pub selector: Option<&'a str>,
}

impl Probe<'_> {
    /// Checks that the program is there and that it sees a probe, so that nothing is built in vain.
    ///
    /// # Errors
    /// [`FlashError::NoProbeRs`], [`FlashError::NoProbe`].
    pub fn check(&self) -> Result<(), FlashError> {
        self.finish("list", Command::new(PROGRAM).arg("list"))
    }

    /// Puts a blob into its place in the flash.
    ///
    /// # Errors
    /// Where the program cannot, or where the blob has no place there.
    pub fn download(&self, elf: &Elf, blob: &[u8]) -> Result<(), FlashError> {
        pieces(self.board, elf, blob)?;
        let folder = folder()?;
        let path = folder.path().join("scene.blob");
        fs::write(&path, blob).map_err(EmulateError::folder)?;
        let start = elf.blob_place.map_or(0, |place| place.start);
        let mut command = self.command("download");
        command.args(["--disable-progressbars", "--binary-format", "bin", "--base-address"]);
        self.finish("download", command.arg(format!("{start:#x}")).arg(path))
    }

    /// Puts firmware into the flash, runs it to its end, at most for `limit`, and receives its picture.
    ///
    /// # Errors
    /// Where the program cannot, the time is up, or the firmware ends in anything but a whole picture.
    pub fn run(&self, elf: &Elf, limit: Duration, observer: &mut impl Observer) -> Result<Outcome, FlashError> {
        let folder = folder()?;
        let [frames_file, log_file] = ["frames", "log"].map(|name| folder.path().join(name));
        let mut command = self.command("run");
        // Firmware says of faults itself, if it is let.
        command.args(["--disable-progressbars", "--no-catch-hardfault", "--no-timestamps", "--log-format", "{L} {s}"]);
        for (channel, file) in [(CHANNEL, &frames_file), ("defmt", &log_file)] {
            let mut value = OsString::from(format!("{channel}="));
            value.push(file);
            command.arg("--target-output-file").arg(value);
        }
        command.arg(elf.path());

        let (mut digits, mut frames) = (Digits::default(), Frames::default());
        let mut log = Log { file: Tail::new(&log_file), rest: Vec::new(), ended: None };
        let mut process = Process::start(command, &frames_file, limit).map_err(|error| self.unstarted(error))?;
        while let Some(received) = process.listen()? {
            log.read(observer)?;
            observer.pixels(frames.take(&digits.take(&received.frames)?)?);
            if log.ended.is_some_and(|(_, when)| when.elapsed() > GRACE) {
                break;
            }
        }
        match log.ended.map(|(status, _)| status) {
            Some(Some(Status::Done)) => {}
            Some(Some(status)) => return Err(EmulateError::Firmware { board: self.board.name, status }.into()),
            Some(None) => return Err(EmulateError::Damaged("the log ends with a status that there is not").into()),
            None => return Err(self.failed("run", process.status(), process.complaints())),
        }
        let (picture, report) = frames.finish()?;
        Ok(Outcome { picture, report, counts: None })
    }

    fn command(&self, verb: &str) -> Command {
        let mut command = Command::new(PROGRAM);
        command.args([verb, "--non-interactive", "--chip", self.board.probe_rs_chip]);
        if let Some(selector) = self.selector {
            command.args(["--probe", selector]);
        }
        command
    }

    /// Runs the program to its end, which must be a good one.
    fn finish(&self, verb: &'static str, command: &mut Command) -> Result<(), FlashError> {
        let output = command.stdin(Stdio::null()).output();
        let start = |source| self.unstarted(EmulateError::Start { program: PROGRAM.into(), source });
        let Output { status, stdout, stderr } = output.map_err(start)?;
        let [said, complaints] = [stdout, stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        if status.success() && !says_none(&said) {
            Ok(())
        } else {
            Err(self.failed(verb, status, &(complaints + &said)))
        }
    }

    fn unstarted(&self, error: EmulateError) -> FlashError {
        match error {
            EmulateError::Start { source, .. } if source.kind() == ErrorKind::NotFound => {
                FlashError::NoProbeRs { help: self.help() }
            }
            error => error.into(),
        }
    }

    fn failed(&self, verb: &'static str, status: ExitStatus, complaints: &str) -> FlashError {
        match says_none(complaints) {
            true => FlashError::NoProbe { help: self.help() },
            false => FlashError::ProbeRs { verb, status: status.to_string(), complaints: complaints.trim().to_owned() },
        }
    }

    /// What does without a probe.
    fn help(&self) -> String {
        match self.board.uf2_family {
            Some(_) => "; without one, `--uf2 FILE` writes what can be dragged to the board's own drive".into(),
            None => String::new(),
        }
    }
}

fn says_none(text: &str) -> bool {
    NO_PROBE.iter().any(|words| text.contains(words))
}

fn folder() -> Result<tempfile::TempDir, EmulateError> {
    tempfile::Builder::new().prefix("intray-").tempdir().map_err(EmulateError::folder)
}

/// The firmware's log, which probe-rs has decoded.
struct Log {
    file: Tail,
    /// A line that is not whole yet.
    rest: Vec<u8>,
    /// The status that its last line has, if it is one, and when that came.
    ended: Option<(Option<Status>, Instant)>,
}

impl Log {
    /// Gives the whole lines that have come to `observer`.
    fn read(&mut self, observer: &mut impl Observer) -> Result<(), EmulateError> {
        self.rest.extend(self.file.read().map_err(EmulateError::folder)?);
        let Some(end) = self.rest.iter().rposition(|&byte| byte == b'\n') else { return Ok(()) };
        let whole: Vec<u8> = self.rest.drain(..=end).collect();
        for line in String::from_utf8_lossy(&whole).lines() {
            observer.log(line);
            if let Some((_, status)) = line.split_once(END) {
                self.ended = Some((status.trim().parse().ok().and_then(Status::from_code), Instant::now()));
            }
        }
        Ok(())
    }
}
