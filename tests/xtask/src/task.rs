//! A command line: run with its output shown, and printed as a shell would take it.

use std::fmt::{Display, Formatter};
use std::process::{Command, Stdio};

/// A program, its arguments, and what is added to its environment.
#[derive(Clone, Debug)]
pub(crate) struct Task {
    program: String,
    arguments: Vec<String>,
    environment: Vec<(&'static str, &'static str)>,
}

/// A task that did not end well.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The command line.
    pub(crate) command: String,
    /// What became of it.
    pub(crate) reason: String,
}

impl Task {
    /// From a line of words without spaces in them.
    pub(crate) fn new(line: &str) -> Self {
        let mut words = line.split_whitespace().map(str::to_owned);
        Self { program: words.next().unwrap_or_default(), arguments: words.collect(), environment: Vec::new() }
    }

    /// The task with one more variable in its environment.
    pub(crate) fn with(mut self, name: &'static str, value: &'static str) -> Self {
        self.environment.push((name, value));
        self
    }

    /// Runs it; its output goes where this program's goes.
    ///
    /// # Errors
    /// Where it cannot be started, or ends with anything but success.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let failure = |reason| Failure { command: self.to_string(), reason };
        match self.command().status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(failure(format!("{} ended with {status}", self.program))),
            Err(error) => Err(failure(format!("{} cannot be started: {error}", self.program))),
        }
    }

    /// What it prints, if it succeeds; for asking what is there, so nothing is shown.
    pub(crate) fn answer(&self) -> Option<String> {
        let output = self.command().stdin(Stdio::null()).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).envs(self.environment.iter().copied());
        command
    }
}

impl Display for Task {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        for (name, value) in &self.environment {
            write!(f, "{name}='{value}' ")?;
        }
        f.write_str(&self.program)?;
        self.arguments.iter().try_for_each(|argument| write!(f, " {argument}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_printed_as_it_would_be_typed() {
        let task = Task::new("cargo  doc --no-deps").with("RUSTDOCFLAGS", "-D warnings");
        assert_eq!(task.to_string(), "RUSTDOCFLAGS='-D warnings' cargo doc --no-deps");
    }

    #[test]
    fn success_and_both_kinds_of_failure_are_told_apart() {
        assert!(Task::new("rustc --version").run().is_ok());
        let refused = Task::new("rustc --no-such-flag").run().unwrap_err();
        assert_eq!(refused.command, "rustc --no-such-flag");
        assert!(refused.reason.contains("ended with"), "{}", refused.reason);
        let absent = Task::new("no-such-program-anywhere").run().unwrap_err();
        assert!(absent.reason.contains("cannot be started"), "{}", absent.reason);
    }

    #[test]
    fn answers_come_from_successful_tasks_only() {
        assert!(Task::new("rustc --version").answer().is_some_and(|text| text.starts_with("rustc ")));
        assert!(Task::new("rustc --no-such-flag").answer().is_none());
        assert!(Task::new("no-such-program-anywhere").answer().is_none());
    }
}
