//! The page of a report in a real browser: that its script runs, its tables sort, its labels are apart, its names are text
//! and nothing is fetched. Where there is no Chromium, this says that it skips, and nothing else does.

mod browser;
mod fixture;

use browser::{Found, open};
use host_tools::report::Report;
use host_tools::report::page::page;
use host_tools::report::row::{Cost, Measured, Outcome, Study};

/// What is wrong with a page of this report, as the browser shows it.
fn faults(report: &Report, page: &str, found: &Found) -> Vec<String> {
    let mut faults: Vec<String> = found.errors.iter().map(|error| format!("script: {error}")).collect();
    faults.extend(found.crowded.iter().cloned());
    faults.extend(found.loaded.iter().map(|address| format!("fetched: {address}")));
    faults.extend(
        ["http:", "https:", "<link", "@import", "url("]
            .into_iter()
            .filter(|word| page.contains(word))
            .map(|word| format!("{word} is in the page")),
    );
    for element in ["u", "b", "blink"] {
        if found.elements.contains(element) {
            faults.push(format!("a name became the element <{element}>"));
        }
    }
    let mut rows: Vec<usize> = found.tables.values().flat_map(|table| table.order()).collect();
    rows.sort_unstable();
    if rows != (0..report.rows.len()).collect::<Vec<_>>() {
        faults.push(format!("the tables have the rows {rows:?}"));
    }
    for (name, line) in found.tables.iter().flat_map(|(name, table)| table.rows.iter().map(move |line| (name, line))) {
        let Some(row) = line.row.and_then(|row| report.rows.get(row)) else { continue };
        let has = |text: &str| line.cells.iter().any(|cell| cell == text);
        let failed = match &row.outcome {
            Outcome::Failed(reason) => !has(reason),
            Outcome::Measured(measured) => !has(&measured.image_crc32),
        };
        if failed || !has(&row.point.scene) || !has(&row.point.kernel) {
            faults.push(format!("{name} does not say what row {:?} is", line.row));
        }
    }
    let said = [&report.command, &report.schema, &report.machine.cpu].into_iter().chain(&report.notes);
    let failed = report.scenes.iter().filter_map(|scene| scene.failed.as_ref());
    for text in said.chain(failed).chain(report.versions.keys()) {
        if !found.text.contains(text) {
            faults.push(format!("{text} is not said"));
        }
    }
    let named = |kernel: &str| found.plots.iter().filter(|texts| texts.iter().any(|text| text == kernel)).count();
    // In each plot of error against cost: two scenes by six metrics by three machines and the blob, less what failed.
    faults.extend(
        fixture::KERNELS
            .into_iter()
            .filter(|kernel| named(kernel) < 2 * 6 * 3)
            .map(|kernel| format!("{kernel} has no name")),
    );
    if found.figures == 0 || found.astray > 0 {
        faults.push(format!("{} of {} figures are shown or hidden though not so chosen", found.astray, found.figures));
    }
    if found.pictures.contains(&false) || found.pictures.is_empty() {
        faults.push("a picture is none".into());
    }
    if found.wide {
        faults.push("the page is wider than its window".into());
    }
    faults
}

/// The rows of the kernels' table by a number that some of them have: those first, in its order, then the others.
fn expected(report: &Report, number: fn(&Measured) -> Option<f64>, down: bool) -> Vec<usize> {
    let drawn = report.rows.iter().enumerate().filter_map(|(index, row)| match &row.outcome {
        Outcome::Measured(measured) if row.point.study == Study::Kernels => Some((index, number(measured))),
        _ => None,
    });
    let (mut with, without): (Vec<_>, Vec<_>) = drawn.partition(|(_, number)| number.is_some());
    with.sort_by(|a, b| {
        let order = a.1.partial_cmp(&b.1).unwrap();
        if down { order.reverse() } else { order }
    });
    with.into_iter().chain(without).map(|(index, _)| index).collect()
}

fn seconds(measured: &Measured) -> Option<f64> {
    match &measured.cost {
        Cost::Time(time) => Some(time.seconds),
        Cost::Instructions(_) => None,
    }
}

#[test]
fn a_page_does_in_a_browser_what_it_promises() {
    let Some(chromium) = browser::chromium() else {
        println!("skipped: Chromium is not installed (apt-get install chromium)");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let report = fixture::report(folder.path());
    let page = page(&report, folder.path()).unwrap();

    let found = open(chromium, &page, "", 1200);
    assert_eq!(faults(&report, &page, &found), [""; 0]);
    assert!(found.text.contains("1-6.png: no such file"), "a picture that is missing is not named");
    let narrow = open(chromium, &page, "", 500);
    assert_eq!(faults(&report, &page, &narrow), [""; 0]);

    let table = &found.tables["table-kernels"];
    assert_eq!(table.order(), expected(&report, |_| None, false));
    type Number = fn(&Measured) -> Option<f64>;
    let columns: [(&str, Number); 3] = [
        ("over 64, %", |measured| Some(measured.error.over_64 as f64)),
        ("PSNR, dB", |measured| Some(measured.error.psnr.unwrap_or(f64::INFINITY))),
        ("time", seconds),
    ];
    for (header, number) in columns {
        for down in [false, true] {
            let fragment = format!("sort=table-kernels,{}{}", table.column(header), if down { ",down" } else { "" });
            let sorted = open(chromium, &page, &fragment, 1200);
            assert_eq!(sorted.errors, [""; 0], "{fragment}");
            assert_eq!(sorted.tables["table-kernels"].order(), expected(&report, number, down), "{fragment}");
        }
    }
    let sorted = open(chromium, &page, &format!("sort=table-failed,{}", 2), 1200);
    let kernels: Vec<&str> = sorted.tables["table-failed"].rows.iter().map(|line| line.cells[2].as_str()).collect();
    assert!(kernels.len() > 2 && kernels.is_sorted(), "{kernels:?}");
    // Addresses of nothing do nothing.
    for fragment in ["sort=table-none,1", "sort=table-kernels,99", "sort=,", "summary"] {
        assert_eq!(open(chromium, &page, fragment, 1200).errors, [""; 0], "{fragment}");
    }

    // What is broken is found.
    let broken = |what: &str, old: &str, new: &str| {
        assert!(page.contains(old), "{what}");
        let page = page.replacen(old, new, 1);
        let faults = faults(&report, &page, &open(chromium, &page, "", 1200));
        assert!(faults.iter().any(|fault| fault.contains(what)), "{what}: {faults:?}");
    };
    broken("script: ", "</main>", "</main><script>nothing()</script>");
    broken("script: ", "const sort =", "const sort = const");
    broken("became the element <u>", "k&lt;u&gt;&amp;amp;&quot;", "k<u>&amp;amp;&quot;</u>");
    broken("the tables have the rows", "data-row=\"3\"", "data-row=\"2\"");
    broken("does not say what row", "<td>host</td><td>exact29</td>", "<td>host</td><td>exact92</td>");
    broken("fetched: ", "</main>", "</main><img src=\"other.png\">");
    broken("http: is in the page", "</main>", "</main><a href=\"http://example.org\">more</a>");
    broken("is not said", "There is no &lt;i&gt;", "There is no ");
    broken("figures are shown", "body:has(", "body:none(");
    broken("a picture is none", "base64,iVBOR", "base64,AAAA");
    broken("page is wider", "overflow: auto; max-height", "max-height");
    let name = "font-size=\"12\" opacity=\"1\" fill=\"#010101\">exact20</text>";
    broken("lies on", name, &format!("{name}<text x=\"0\" y=\"0\">over</text><text x=\"4\" y=\"0\">this</text>"));
}
