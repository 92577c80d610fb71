//! What checks need beside cargo, and how each is got.

use std::path::Path;

use crate::task::{Failure, Task};

/// Something that a step cannot do without.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tool {
    /// What it is.
    pub(crate) name: &'static str,
    /// How to get it by hand.
    pub(crate) hint: &'static str,
    /// Whether it is there.
    pub(crate) is_present: fn() -> bool,
    /// Gets it where that can be done without asking, and does nothing elsewhere.
    pub(crate) install: fn() -> Result<(), Failure>,
}

impl Tool {
    /// Whether it is there now, installed if need be.
    ///
    /// # Errors
    /// Where an installation that should work did not.
    pub(crate) fn provide(&self) -> Result<bool, Failure> {
        if (self.is_present)() {
            return Ok(true);
        }
        println!("{} is missing", self.name);
        (self.install)()?;
        Ok((self.is_present)())
    }
}

/// Installs what is missing of several tools.
///
/// # Errors
/// Where an installation that should work did not, and where something could not be had, with how to get it by hand.
pub(crate) fn provide_all(tools: &[Tool]) -> Result<(), String> {
    let mut missing = Vec::new();
    for tool in tools {
        if !tool.provide().map_err(|failure| failure.reason)? {
            missing.push(format!("there is no {} (get it by: {})", tool.name, tool.hint));
        }
    }
    if missing.is_empty() { Ok(()) } else { Err(missing.join("\n")) }
}

/// For formatting.
pub(crate) const RUSTFMT: Tool = Tool {
    name: "rustfmt",
    hint: "rustup component add rustfmt",
    is_present: || succeeds("cargo fmt --version"),
    install: || rustup("component add rustfmt"),
};

/// For lints.
pub(crate) const CLIPPY: Tool = Tool {
    name: "clippy",
    hint: "rustup component add clippy",
    is_present: || succeeds("cargo clippy --version"),
    install: || rustup("component add clippy"),
};

/// The standard library for a Cortex-M0.
pub(crate) const THUMBV6M: Tool = Tool {
    name: "thumbv6m-none-eabi",
    hint: "rustup target add thumbv6m-none-eabi",
    is_present: || has_target("thumbv6m-none-eabi"),
    install: || rustup("target add thumbv6m-none-eabi"),
};

/// The standard library for RISC-V chips.
pub(crate) const RISCV32IMAC: Tool = Tool {
    name: "riscv32imac-unknown-none-elf",
    hint: "rustup target add riscv32imac-unknown-none-elf",
    is_present: || has_target("riscv32imac-unknown-none-elf"),
    install: || rustup("target add riscv32imac-unknown-none-elf"),
};

/// The other opinion on how two pictures differ; `magick` since version 7, `convert` before.
pub(crate) const IMAGEMAGICK: Tool = Tool {
    name: "ImageMagick",
    hint: "apt-get install imagemagick",
    is_present: || {
        // Other programs bear these names too.
        let says_so = |line| Task::new(line).answer().is_some_and(|text| text.starts_with("Version: ImageMagick"));
        says_so("magick -version") || says_so("convert -version")
    },
    install: || {
        apt("imagemagick");
        Ok(())
    },
};

/// The browser that a report's page is opened in.
pub(crate) const CHROMIUM: Tool = Tool {
    name: "Chromium",
    hint: "apt-get install chromium",
    is_present: || {
        ["chromium", "chromium-browser", "google-chrome"].iter().any(|name| succeeds(&format!("{name} --version")))
    },
    install: || {
        apt("chromium");
        Ok(())
    },
};

/// The display that the window of `intray view` is tested on.
pub(crate) const XVFB: Tool = Tool {
    name: "Xvfb",
    hint: "apt-get install xvfb",
    // Even help ends as a failure: what counts is that it starts.
    is_present: || std::process::Command::new("Xvfb").arg("-help").output().is_ok(),
    install: || {
        apt("xvfb");
        Ok(())
    },
};

/// What libFuzzer's instrumentation needs. Never installed unasked: it is a second compiler.
pub(crate) const NIGHTLY: Tool = Tool {
    name: "nightly Rust",
    hint: "rustup toolchain install nightly",
    is_present: || succeeds("rustup run nightly cargo --version"),
    install: || Ok(()),
};

/// The fuzzer's driver, if it is there.
pub(crate) const CARGO_FUZZ: Tool = Tool {
    name: "cargo-fuzz",
    hint: "cargo install cargo-fuzz --locked",
    is_present: || succeeds("cargo fuzz --version"),
    install: || Ok(()),
};

/// The same, for those who ask for it: it takes minutes to build.
pub(crate) const CARGO_FUZZ_INSTALLED: Tool =
    Tool { install: || Task::new("cargo install cargo-fuzz --locked").run(), ..CARGO_FUZZ };

fn succeeds(line: &str) -> bool {
    Task::new(line).answer().is_some()
}

/// Asks rustc and not rustup, so that other packagings of Rust count too.
fn has_target(target: &str) -> bool {
    let folder = Task::new(&format!("rustc --print target-libdir --target {target}")).answer();
    folder.is_some_and(|folder| Path::new(&folder).is_dir())
}

/// What installed the compiler must be able to install its parts: a failure here is one of the whole run.
fn rustup(arguments: &str) -> Result<(), Failure> {
    if succeeds("rustup --version") { Task::new(&format!("rustup {arguments}")).run() } else { Ok(()) }
}

/// Without root or network the package stays absent, which whoever asked for it finds and reports.
fn apt(package: &str) {
    if can_apt() {
        let install = || apt_get(&format!("install --yes --no-install-recommends {package}"));
        if let Err(failure) = apt_get("update").and_then(|()| install()) {
            println!("{}", failure.reason);
        }
    }
}

/// Whether packages can be installed without asking.
pub(crate) fn can_apt() -> bool {
    Task::new("id -u").answer().as_deref() == Some("0") && succeeds("apt-get --version")
}

/// Runs `apt-get`, which then asks no questions.
///
/// # Errors
/// Where it fails.
pub(crate) fn apt_get(arguments: &str) -> Result<(), Failure> {
    Task::new(&format!("apt-get {arguments}")).with("DEBIAN_FRONTEND", "noninteractive").run()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_told_from_inventions() {
        let version = Task::new("rustc --version --verbose").answer().unwrap();
        let host = version.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
        assert!(has_target(host));
        assert!(!has_target("no-such-target"));
        // Known to rustc, but without a standard library.
        assert!(!has_target("avr-none"));
    }

    #[test]
    fn a_tool_is_installed_only_where_it_is_missing() {
        let refuse = || Err(Failure { command: "install".into(), reason: "refused".into() });
        let there = Tool { is_present: || true, install: refuse, ..RUSTFMT };
        assert!(there.provide().is_ok_and(|present| present));
        assert!(Tool { is_present: || false, ..there }.provide().is_err());
        let absent = Tool { is_present: || false, install: || Ok(()), ..RUSTFMT };
        assert!(absent.provide().is_ok_and(|present| !present));

        assert_eq!(provide_all(&[there, there]), Ok(()));
        let message = "there is no rustfmt (get it by: rustup component add rustfmt)".to_owned();
        assert_eq!(provide_all(&[there, absent, there]), Err(message));
    }
}
