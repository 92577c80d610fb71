//! The host: the benches, whose kernels take turns within every round.

use std::process::{Command, Stdio};

/// Each with what it shows.
const BENCHES: [(&str, &str); 2] = [
    (
        "host",
        "Camera rays by one thread: `exact29` by vector units over scalar `f32`, and over `f32` in the same layout; and all cores \
         over a loop that touches no memory.",
    ),
    (
        "kernels",
        "Whole pictures by one thread and scalar code: the time of each kernel over that of `f32` in the same round, the median \
         of the rounds and their spread.",
    ),
];

/// What the benches print, as parts of the document.
///
/// # Errors
/// Where one cannot be built or run.
pub(crate) fn measure(quick: bool) -> Result<String, String> {
    let mut text = "## Host\n\n".to_owned();
    for (bench, what) in BENCHES {
        let mut command = Command::new(env!("CARGO"));
        command.args(["bench", "--quiet", "-p", "tests", "--bench", bench]).stderr(Stdio::inherit());
        if quick {
            command.args(["--", "--size", "96", "--rounds", "1"]);
        }
        let output = command.output().map_err(|error| format!("cargo: {error}"))?;
        if !output.status.success() {
            return Err(format!("cargo bench -p tests --bench {bench} failed"));
        }
        text += &format!("{what}\n\n{}\n", String::from_utf8_lossy(&output.stdout));
    }
    Ok(text)
}
