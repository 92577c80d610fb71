//! A process that is listened to, and that ends in time.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::EmulateError;

/// How long to wait for output before looking at the file.
const TICK: Duration = Duration::from_millis(20);

/// The most of a process's complaints that is kept.
const COMPLAINTS: u64 = 1 << 16;

/// A running process, its output, and a file that it writes.
#[derive(Debug)]
pub struct Process {
    name: String,
    child: Child,
    output: Receiver<Vec<u8>>,
    complaints: Option<JoinHandle<String>>,
    said: String,
    file: Tail,
    deadline: Instant,
    limit: Duration,
    status: Option<ExitStatus>,
}

/// What has come since it was last asked for.
#[derive(Debug, Default)]
pub struct Received {
    /// From standard output.
    pub output: Vec<u8>,
    /// From the file.
    pub frames: Vec<u8>,
}

impl Process {
    /// Starts a process that writes to `file`, and has `limit` to end.
    ///
    /// # Errors
    /// Where it cannot be started.
    pub fn start(mut command: Command, file: &Path, limit: Duration) -> Result<Self, EmulateError> {
        let name = command.get_program().to_string_lossy().into_owned();
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|source| EmulateError::Start { program: name.clone(), source })?;
        let (sender, output) = channel();
        if let Some(mut stdout) = child.stdout.take() {
            std::thread::spawn(move || {
                let mut buffer = [0; 4096];
                while let Ok(count @ 1..) = stdout.read(&mut buffer) {
                    if sender.send(buffer[..count].to_vec()).is_err() {
                        return;
                    }
                }
            });
        }
        let complaints = child.stderr.take().map(|stderr| {
            std::thread::spawn(move || {
                let mut bytes = Vec::new();
                // What was read before an error is still worth showing.
                let _ = stderr.take(COMPLAINTS).read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        let deadline = Instant::now() + limit;
        let file = Tail::new(file);
        Ok(Self { name, child, output, complaints, said: String::new(), file, deadline, limit, status: None })
    }

    /// What has come; `None` once the process has ended and everything has been given.
    ///
    /// # Errors
    /// Where the time is up; the process is then ended. Where the file cannot be read.
    pub fn listen(&mut self) -> Result<Option<Received>, EmulateError> {
        if self.status.is_some() {
            return Ok(None);
        }
        let mut output = Vec::new();
        let closed = match self.output.recv_timeout(TICK) {
            Ok(bytes) => {
                output = bytes;
                false
            }
            Err(RecvTimeoutError::Timeout) => false,
            Err(RecvTimeoutError::Disconnected) => true,
        };
        if closed {
            // Standard output is closed, so that the end is near. A process that closes it and goes on is not waited for.
            self.status = self.child.try_wait().map_err(|source| self.failed(source))?;
            if self.status.is_none() {
                std::thread::sleep(TICK);
            } else if let Some(thread) = self.complaints.take() {
                self.said = thread.join().unwrap_or_default();
            }
        }
        if self.status.is_none() && Instant::now() >= self.deadline {
            return Err(EmulateError::Timeout { program: self.name.clone(), limit: self.limit });
        }
        // Read after the process was seen to have ended, so that nothing is missed.
        let frames = self.file.read().map_err(|source| self.failed(source))?;
        Ok(Some(Received { output, frames }))
    }

    /// How it ended; a success before it has.
    #[must_use]
    pub fn status(&self) -> ExitStatus {
        self.status.unwrap_or_default()
    }

    /// What it said on standard error, once it has ended.
    #[must_use]
    pub fn complaints(&self) -> &str {
        &self.said
    }

    fn failed(&self, source: std::io::Error) -> EmulateError {
        EmulateError::Start { program: self.name.clone(), source }
    }
}

impl Drop for Process {
    /// Nothing runs on that nobody listens to.
    fn drop(&mut self) {
        if self.status.is_none() {
            // It may have ended just now, and then there is nothing to do.
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// A file that grows, and may not be there yet.
#[derive(Debug)]
pub struct Tail {
    path: PathBuf,
    file: Option<File>,
}

impl Tail {
    /// From its beginning.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self { path: path.into(), file: None }
    }

    /// What has been added.
    ///
    /// # Errors
    /// The system's.
    pub fn read(&mut self) -> std::io::Result<Vec<u8>> {
        if self.file.is_none() {
            match File::open(&self.path) {
                Ok(file) => self.file = Some(file),
                Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
                Err(error) => return Err(error),
            }
        }
        let mut bytes = Vec::new();
        if let Some(file) = &mut self.file {
            file.read_to_end(&mut bytes)?;
        }
        Ok(bytes)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Runs a script to its end; what came by both ways, and the process.
    fn shell(script: &str, limit: Duration) -> (Result<Received, EmulateError>, Process) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        let mut command = Command::new("sh");
        command.args(["-c", script]).current_dir(folder.path());
        let mut process = Process::start(command, &file, limit).unwrap();
        let mut all = Received::default();
        let result = loop {
            match process.listen() {
                Ok(Some(received)) => {
                    all.output.extend(received.output);
                    all.frames.extend(received.frames);
                }
                Ok(None) => break Ok(all),
                Err(error) => break Err(error),
            }
        };
        (result, process)
    }

    #[test]
    fn everything_is_heard_and_the_status_is_kept() {
        let script = "echo one; printf a > file; sleep 0.1; printf b >> file; echo two; echo no >&2; exit 14";
        let (received, process) = shell(script, Duration::from_secs(60));
        let Received { output, frames } = received.unwrap();
        assert_eq!((output.as_slice(), frames.as_slice()), (&b"one\ntwo\n"[..], &b"ab"[..]));
        assert_eq!((process.status().code(), process.complaints()), (Some(14), "no\n"));
    }

    #[test]
    fn what_does_not_end_is_ended() {
        let begin = Instant::now();
        let (received, process) = shell("exec sleep 60", Duration::from_millis(200));
        assert!(matches!(received, Err(EmulateError::Timeout { .. })));
        drop(process);
        assert!(begin.elapsed() < Duration::from_secs(30));
    }
}
