//! A page in headless Chromium, and what a probe finds in it.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// What the probe finds.
#[derive(Debug, Deserialize)]
pub(crate) struct Found {
    /// What scripts threw, and what they refer to in vain.
    pub(crate) errors: Vec<String>,
    /// Labels of plots that lie on others or outside.
    pub(crate) crowded: Vec<String>,
    /// Figures that are shown and not of the first scene and metric, or the other way round; and all.
    pub(crate) astray: usize,
    pub(crate) figures: usize,
    /// Tables by their names.
    pub(crate) tables: BTreeMap<String, Table>,
    /// What a person reads.
    pub(crate) text: String,
    /// The names of all elements.
    pub(crate) elements: BTreeSet<String>,
    /// The texts of each plot.
    pub(crate) plots: Vec<Vec<String>>,
    /// What was fetched.
    pub(crate) loaded: Vec<String>,
    /// Whether each picture is one.
    pub(crate) pictures: Vec<bool>,
    /// Whether the page is wider than its window.
    pub(crate) wide: bool,
}

/// A table as it is shown.
#[derive(Debug, Deserialize)]
pub(crate) struct Table {
    pub(crate) headers: Vec<String>,
    pub(crate) rows: Vec<Line>,
}

/// A row of it, with its index in the report if it has one.
#[derive(Debug, Deserialize)]
pub(crate) struct Line {
    pub(crate) row: Option<usize>,
    pub(crate) cells: Vec<String>,
}

impl Table {
    /// The column of that header.
    pub(crate) fn column(&self, header: &str) -> usize {
        self.headers
            .iter()
            .position(|title| title == header)
            .unwrap_or_else(|| panic!("no {header} in {:?}", self.headers))
    }

    /// The report's rows in the order that is shown.
    pub(crate) fn order(&self) -> Vec<usize> {
        self.rows.iter().filter_map(|line| line.row).collect()
    }
}

/// The name under which Chromium is installed.
pub(crate) fn chromium() -> Option<&'static str> {
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(|name| {
        let version = Command::new(name).arg("--version").output();
        version.is_ok_and(|said| said.status.success() && String::from_utf8_lossy(&said.stdout).contains("Chrom"))
    })
}

const ERRORS: &str = "<script>window.probeErrors = [];\
    addEventListener('error', (event) => probeErrors.push(event.message || event.target.outerHTML), true);</script>";

/// Opens a page with what follows `#` in its address, in a window of 1200 or of `width` pixels.
pub(crate) fn open(program: &str, page: &str, fragment: &str, width: u32) -> Found {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("index.html");
    let (before, after) = page.split_once("<head>").unwrap();
    let probe = include_str!("probe.js");
    std::fs::write(&path, format!("{before}<head>{ERRORS}{after}<script>{probe}</script>")).unwrap();
    let said = Command::new(program)
        // A container's root has no sandbox, and the page is our own.
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"])
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .arg(format!("--window-size={width},900"))
        .arg("--dump-dom")
        .arg(format!("file://{}#{fragment}", path.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8(said.stdout).unwrap();
    let found = dom.split_once(r#"id="found">"#).and_then(|(_, rest)| rest.split_once("</script>"));
    let (json, _) = found.unwrap_or_else(|| panic!("no answer: {}", String::from_utf8_lossy(&said.stderr)));
    serde_json::from_str(json).unwrap()
}
