//! Steps, run one after the other until one fails.

use std::time::Instant;

use crate::task::{Failure, Task};
use crate::tool::Tool;

/// A task, and what it cannot do without.
#[derive(Debug)]
pub(crate) struct Step {
    /// What it does, in a few words.
    pub(crate) title: String,
    /// It is skipped where one of them cannot be had.
    pub(crate) tools: &'static [Tool],
    /// What is run.
    pub(crate) task: Task,
}

/// What became of all steps, none of which failed.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Summary {
    /// How many were run.
    pub(crate) passed: usize,
    /// Titles of those that were not, and how to get what they lack.
    pub(crate) skipped: Vec<String>,
}

impl Step {
    /// A step that needs nothing but cargo.
    pub(crate) fn new(title: impl Into<String>, task: Task) -> Self {
        Self { title: title.into(), tools: &[], task }
    }

    /// The step with what it cannot do without.
    pub(crate) fn needing(self, tools: &'static [Tool]) -> Self {
        Self { tools, ..self }
    }

    /// The first tool that cannot be had.
    fn lacks(&self) -> Result<Option<&'static Tool>, Failure> {
        for tool in self.tools {
            if !tool.provide()? {
                return Ok(Some(tool));
            }
        }
        Ok(None)
    }
}

/// Runs the steps, saying before and after each what it is and how long it took.
///
/// # Errors
/// The first failure; the steps after it are not run.
pub(crate) fn run(steps: &[Step]) -> Result<Summary, Failure> {
    let mut summary = Summary::default();
    for (number, step) in (1..).zip(steps) {
        let heading = format!("[{number}/{}] {}", steps.len(), step.title);
        println!("{heading}: {}", step.task);
        let start = Instant::now();
        let outcome = match step.lacks() {
            Ok(None) => step.task.run().map(|()| None),
            other => other,
        };
        let seconds = start.elapsed().as_secs_f64();
        match outcome {
            Ok(None) => {
                summary.passed += 1;
                println!("{heading}: passed in {seconds:.1} s");
            }
            Ok(Some(Tool { name, hint, .. })) => {
                println!("{heading}: skipped, there is no {name} (get it by: {hint})");
                summary.skipped.push(format!("{} ({hint})", step.title));
            }
            Err(failure) => {
                println!("{heading}: FAILED after {seconds:.1} s");
                return Err(failure);
            }
        }
    }
    Ok(summary)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "rustc --version";
    const BAD: &str = "rustc --no-such-flag";

    fn step(line: &str) -> Step {
        Step::new("a step", Task::new(line))
    }

    #[test]
    fn all_steps_that_can_be_run_are_counted() {
        const UNICORN: Tool = Tool { name: "unicorn", hint: "wait", is_present: || false, install: || Ok(()) };
        // Were the second one run, it would fail.
        let summary = run(&[step(GOOD), step(BAD).needing(&[UNICORN]), step(GOOD)]).unwrap();
        assert_eq!(summary, Summary { passed: 2, skipped: vec!["a step (wait)".into()] });
    }

    #[test]
    fn the_first_failure_ends_the_run_and_names_its_command() {
        let failure = run(&[step(GOOD), step(BAD), step("no-such-program-anywhere")]).unwrap_err();
        assert_eq!(failure.command, BAD);
    }

    #[test]
    fn an_installation_that_fails_is_a_failure_and_not_a_skip() {
        const BROKEN: Tool =
            Tool { name: "broken", hint: "mend it", is_present: || false, install: || Task::new(BAD).run() };
        assert_eq!(run(&[step(GOOD).needing(&[BROKEN])]).unwrap_err().command, BAD);
    }
}
