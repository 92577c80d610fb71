//! QEMU for the emulated boards, by apt where that can be done.
//!
//! Version 10 is needed, for its plugin API. Debian 12 has 7.2, which moreover cannot be installed beside an installed
//! `qemu-utils` of its backports; so the packages come from whichever suite has a version that suffices, and the backports
//! are added to apt's sources, from the machine's own mirror, where none does.

use std::fs;
use std::path::{Path, PathBuf};

use crate::task::{Failure, Task};
use crate::tool::{Tool, apt_get, can_apt};

/// The emulators of both boards.
pub(crate) const QEMU: Tool = Tool {
    name: "QEMU 10 or later",
    hint: "apt-get install -t bookworm-backports qemu-system-arm qemu-system-riscv on Debian 12, without -t from 13 on, \
           and elsewhere any QEMU of version 10 with qemu-system-arm and qemu-system-riscv32",
    is_present: || ["qemu-system-arm", "qemu-system-riscv32"].into_iter().all(suffices),
    install: || {
        // Like any package: who asked for it finds and reports that it is absent.
        if can_apt() {
            by_apt().unwrap_or_else(|failure| println!("{}", failure.reason));
        }
        Ok(())
    },
};

/// The oldest version whose plugin API suffices.
const OLDEST: u32 = 10;

/// Where apt is told what there is.
const SOURCES: &str = "/etc/apt/sources.list.d";

fn suffices(program: &str) -> bool {
    let says = Task::new(&format!("{program} --version")).answer();
    let version = says.as_deref().and_then(|text| text.split_once("version ")).map(|(_, version)| version);
    version.and_then(major).is_some_and(|major| major >= OLDEST)
}

/// The first number of a version, be it QEMU's own or that of a Debian package.
fn major(version: &str) -> Option<u32> {
    let upstream = version.split_once(':').map_or(version, |(_, upstream)| upstream);
    upstream.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

fn by_apt() -> Result<(), Failure> {
    apt_get("update")?;
    let found = match suite_of("qemu-system-arm") {
        Some(suite) => Some(suite),
        None => {
            add_backports()?;
            suite_of("qemu-system-arm")
        }
    };
    let Some(suite) = found else { return Ok(()) };
    // It was a part of qemu-system-misc once.
    let riscv = if suite_of("qemu-system-riscv").is_some() { "qemu-system-riscv" } else { "qemu-system-misc" };
    apt_get(&format!("install --yes --no-install-recommends -t {suite} qemu-system-arm {riscv}"))
}

/// The suite of the oldest version that suffices, the one nearest to what else is installed.
fn suite_of(package: &str) -> Option<String> {
    oldest_suite(&Task::new(&format!("apt-cache madison {package}")).answer()?)
}

/// From lines `package | version | mirror suite/component architecture Packages`, the newest version first.
fn oldest_suite(listing: &str) -> Option<String> {
    let suite = |line: &str| {
        let mut fields = line.split('|').skip(1);
        major(fields.next()?.trim()).filter(|&major| major >= OLDEST)?;
        let suite = fields.next()?.split_whitespace().nth(1)?.split('/').next()?;
        Some(suite.to_owned())
    };
    listing.lines().rev().find_map(suite)
}

/// Adds the backports of this Debian, and takes them away again if the mirror does not have them.
fn add_backports() -> Result<(), Failure> {
    let codename = fs::read_to_string("/etc/os-release").ok().and_then(|text| debian_codename(&text));
    let source = codename.and_then(|codename| {
        sources().into_iter().find_map(|path| {
            let form = path.extension()?.to_str()?;
            let text = backports(&fs::read_to_string(&path).ok()?, form, &codename)?;
            Some((Path::new(SOURCES).join(format!("{codename}-backports.{form}")), text))
        })
    });
    let Some((path, text)) = source else { return Ok(()) };
    println!("adding {}", path.display());
    if let Err(error) = fs::write(&path, text) {
        return Err(Failure { command: format!("writing {}", path.display()), reason: error.to_string() });
    }
    apt_get("update").inspect_err(|_| {
        println!("removing {}", path.display());
        // Where even that fails, apt says at its next use what is wrong with which file.
        fs::remove_file(&path).ok();
    })
}

/// All files that apt is told by.
fn sources() -> Vec<PathBuf> {
    let listed = fs::read_dir(SOURCES).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = listed.collect();
    files.sort();
    files.push("/etc/apt/sources.list".into());
    files
}

/// From `/etc/os-release`; none for what only descends from Debian.
fn debian_codename(text: &str) -> Option<String> {
    let value = |name: &str| {
        let value = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix('='))?;
        Some(value.trim_matches('"').to_owned())
    };
    value("ID").filter(|id| id == "debian").and_then(|_| value("VERSION_CODENAME"))
}

/// The entry for the backports, in the form of a file that has one for the release itself; none if it has not.
fn backports(text: &str, form: &str, codename: &str) -> Option<String> {
    match form {
        "sources" => text.split("\n\n").find_map(|stanza| deb822_backports(stanza, codename)),
        "list" => text.lines().find_map(|line| one_line_backports(line, codename)),
        _ => None,
    }
}

/// From a stanza of fields, of which those that name a key or options are kept.
fn deb822_backports(stanza: &str, codename: &str) -> Option<String> {
    let suites = format!("{codename}-backports");
    let mut entry = String::new();
    let mut has_release = false;
    // Whether the field in whose lines we are is kept.
    let mut kept = true;
    for line in stanza.lines().filter(|line| !line.starts_with('#')) {
        if let Some((field, value)) = line.split_once(':').filter(|_| !line.starts_with([' ', '\t'])) {
            let replaced = match field.to_ascii_lowercase().as_str() {
                "enabled" if value.trim() == "no" => return None,
                "types" if !value.split_whitespace().any(|kind| kind == "deb") => return None,
                "types" => Some("deb"),
                "suites" => {
                    has_release |= value.split_whitespace().any(|suite| suite == codename);
                    Some(suites.as_str())
                }
                "components" => Some("main"),
                _ => None,
            };
            kept = replaced.is_none();
            if let Some(value) = replaced {
                entry += &format!("{field}: {value}\n");
            }
        }
        if kept {
            entry += &format!("{line}\n");
        }
    }
    has_release.then_some(entry)
}

/// From `deb [options] mirror suite components`.
fn one_line_backports(line: &str, codename: &str) -> Option<String> {
    let rest = line.trim().strip_prefix("deb ")?.trim_start();
    let (options, rest) = match rest.strip_prefix('[') {
        Some(rest) => rest.split_once(']').map(|(options, rest)| (format!("[{options}] "), rest))?,
        None => (String::new(), rest),
    };
    let mut words = rest.split_whitespace();
    let (mirror, suite) = (words.next()?, words.next()?);
    (suite == codename).then(|| format!("deb {options}{mirror} {codename}-backports main\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_programs_and_packages() {
        for (version, number) in [
            ("10.0.2 (Debian 1:10.0.2+ds-2)", Some(10)),
            ("1:7.2+dfsg-7+deb12u18", Some(7)),
            ("1:10.0.2+ds-2+deb13u1~bpo12+1", Some(10)),
            ("11.0.50", Some(11)),
            ("(none)", None),
        ] {
            assert_eq!(major(version.split(" (").next().unwrap()), number, "{version}");
        }
    }

    #[test]
    fn the_suite_is_the_nearest_that_suffices() {
        let old = " qemu-system-arm | 1:7.2+dfsg-7 | http://mirror.example/debian bookworm/main amd64 Packages\n";
        let new = " qemu-system-arm | 1:10.0.2+ds-2 | http://mirror.example/debian trixie/main amd64 Packages\n";
        let backport = " qemu-system-arm | 1:10.1.0~bpo | http://mirror.example/debian later/main amd64 Packages\n";
        assert_eq!(oldest_suite(old), None);
        assert_eq!(oldest_suite(&[new, old].concat()).as_deref(), Some("trixie"));
        assert_eq!(oldest_suite(&[backport, new].concat()).as_deref(), Some("trixie"));
        assert_eq!(oldest_suite(""), None);
    }

    #[test]
    fn debian_is_told_from_its_descendants() {
        let debian = "PRETTY_NAME=\"Debian\"\nVERSION_CODENAME=bookworm\nID=debian\n";
        assert_eq!(debian_codename(debian).as_deref(), Some("bookworm"));
        assert_eq!(debian_codename(&debian.replace("ID=debian", "ID=ubuntu\nID_LIKE=debian")), None);
    }

    #[test]
    fn backports_come_from_where_the_release_comes_from() {
        let stanzas = "Types: deb\nURIs: http://security.example\nSuites: bookworm-security\nComponents: main\n\n\
                       Types: deb deb-src\n# a comment\nURIs: http://mirror.example/debian\n\
                       Suites: bookworm\n bookworm-updates\nComponents: main contrib\nSigned-By:\n -----BEGIN\n .\n key\n";
        let expected = "Types: deb\nURIs: http://mirror.example/debian\nSuites: bookworm-backports\nComponents: main\n\
                        Signed-By:\n -----BEGIN\n .\n key\n";
        assert_eq!(backports(stanzas, "sources", "bookworm").as_deref(), Some(expected));
        assert_eq!(backports(stanzas, "sources", "trixie"), None);
        assert_eq!(backports(&stanzas.replace("deb deb-src", "deb-src"), "sources", "bookworm"), None);
        assert_eq!(backports(&stanzas.replace("# a comment", "Enabled: no"), "sources", "bookworm"), None);

        let lines = "# deb http://off.example bookworm main\n\
                     deb http://security.example bookworm-security main\n\
                     deb [arch=amd64 signed-by=/key] http://mirror.example/debian bookworm main contrib\n";
        let expected = "deb [arch=amd64 signed-by=/key] http://mirror.example/debian bookworm-backports main\n";
        assert_eq!(backports(lines, "list", "bookworm").as_deref(), Some(expected));
        let plain = "deb http://mirror.example bookworm main";
        let expected = "deb http://mirror.example bookworm-backports main\n";
        assert_eq!(backports(plain, "list", "bookworm").as_deref(), Some(expected));
        assert_eq!(backports(lines, "list", "trixie"), None);
        assert_eq!(backports(lines, "disabled", "bookworm"), None);
    }
}
