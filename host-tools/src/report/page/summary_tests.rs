use super::*;
use crate::compare::Comparison;
use crate::report::row::{Causes, Instructions, Time};
use crate::report::{MachineFacts, Report, SceneFacts};

const SIZE: [u32; 2] = [100, 100];

fn row(kernel: &str, machine: Machine, over_64: u64, cost: Cost) -> Row {
    let point = Point {
        scene: "demo".into(),
        study: Study::Kernels,
        kernel: kernel.into(),
        machine,
        size: SIZE,
        samples: 1,
        depth: 4,
        leaf: None,
        grid_bits: None,
        triangles: None,
        knobs: [None; 3],
        reference_samples: None,
    };
    let error = Comparison {
        max_abs: 0,
        mean_abs: 0.0,
        rmse: 0.0,
        psnr: None,
        ssim: 1.0,
        flip: 0.0,
        over_1: over_64,
        over_4: over_64,
        over_64,
    };
    let measured = Measured {
        error,
        causes: Causes::default(),
        cost,
        blob_bytes: 1,
        primitives: 1,
        rays: 1000,
        box_tests: 1,
        triangle_tests: 1,
        image_crc32: String::new(),
        picture: String::new(),
        truth: String::new(),
    };
    Row { point, outcome: Outcome::Measured(Box::new(measured)) }
}

fn chip(kernel: &str, over_64: u64, thousands: u64) -> Row {
    let work = Instructions { instructions: 1000 * thousands, cycles: [].into(), text_bytes: 1, ram_bytes: 1 };
    row(kernel, Machine::Thumbv6m, over_64, Cost::Instructions(work))
}

fn host(kernel: &str, over_64: u64, ratio: [f64; 3]) -> Row {
    row(kernel, Machine::Host, over_64, Cost::Time(Time { seconds: 0.0123, ratio, rounds: 5 }))
}

fn failed(kernel: &str, reason: &str) -> Row {
    Row { outcome: Outcome::Failed(reason.into()), ..chip(kernel, 0, 1) }
}

fn said(rows: &[Row]) -> String {
    let rows: Vec<&Row> = rows.iter().collect();
    sentence(&rows)
}

#[test]
fn what_is_on_the_front_is_said_from_the_quickest_on() {
    let rows =
        [chip("hanika-c", 900, 5000), chip("exact14", 24, 4590), chip("exact29", 0, 9900), chip("f32", 1, 69_309)];
    assert_eq!(
        said(&rows),
        "For demo at 100x100 on a Cortex-M0 (thumbv6m), exact14 takes 4,590 instructions a ray and is 15.1 times as fast as \
         soft-float f32, at 0.240 % of pixels over 64 (f32: 0.0100 %); exact29 is 7.00 times as fast, with none."
    );
}

#[test]
fn a_time_has_its_spread() {
    let rows = [host("exact20", 7, [0.80, 0.8, 1.0]), host("f32", 7, [1.0; 3])];
    assert_eq!(
        said(&rows),
        "For demo at 100x100 on one thread of the host, exact20 takes 12.3 ms and is 1.25 times as fast as f32 (1.00 to 1.25 \
         in 5 rounds), at 0.0700 % of pixels over 64 (as many as f32)."
    );
    // The ratio is known without a row of f32.
    assert_eq!(
        said(&rows[..1]),
        "For demo at 100x100 on one thread of the host, exact20 takes 12.3 ms and is 1.25 times as fast as f32 (1.00 to 1.25 \
         in 5 rounds), at 0.0700 % of pixels over 64."
    );
}

#[test]
fn an_f32_that_is_missing_or_failed_is_named() {
    let place = "For demo at 100x100 on a Cortex-M0 (thumbv6m)";
    let alone = [chip("exact14", 24, 4590)];
    let taken = format!("{place}, exact14 takes 4,590 instructions a ray at 0.240 % of pixels over 64");
    assert_eq!(said(&alone), format!("{taken}; soft-float f32 was not measured."));
    let broken = [chip("exact14", 24, 4590), failed("f32", "too large")];
    assert_eq!(said(&broken), format!("{taken}; soft-float f32 could not draw it (too large)."));
}

#[test]
fn without_an_integer_kernel_nothing_is_praised() {
    let place = "For demo at 100x100 on a Cortex-M0 (thumbv6m)";
    assert_eq!(said(&[chip("f32", 1, 10)]), format!("{place}, no integer kernel was measured."));
    let rows = [chip("f32", 1, 10), failed("exact29", "too large")];
    assert_eq!(said(&rows), format!("{place}, no integer kernel could draw it (exact29: too large)."));
}

#[test]
fn equal_and_worse_are_said_as_such() {
    let place = "For demo at 100x100 on a Cortex-M0 (thumbv6m)";
    let rows = [chip("exact14", 0, 1001), chip("f32", 0, 1000)];
    assert_eq!(
        said(&rows),
        format!(
            "{place}, exact14 takes 1,001 instructions a ray and is as fast as soft-float f32, with no pixel over 64 (as \
             many as f32)."
        )
    );
    let rows = [chip("exact14", 10_000, 2000), chip("f32", 0, 1000)];
    assert_eq!(
        said(&rows),
        format!(
            "{place}, exact14 takes 2,000 instructions a ray and is 0.500 times as fast as soft-float f32, at 100 % of \
             pixels over 64 (f32: 0 %); none of the integer kernels has as few of them as f32."
        )
    );
}

fn report(rows: Vec<Row>) -> Report {
    let scene = |name: &str, failed: Option<String>| SceneFacts {
        name: name.into(),
        path: name.into(),
        triangles: 1,
        spheres: 0,
        failed,
    };
    Report {
        schema: String::new(),
        command: String::new(),
        machine: MachineFacts { cpu: String::new(), cores: 1, os: String::new() },
        versions: [].into(),
        scenes: vec![scene("demo", None), scene("bare", None), scene("bad", Some("damaged".into()))],
        rows,
        notes: vec![],
    }
}

#[test]
fn every_readable_scene_has_its_sentences() {
    let mut larger = chip("exact14", 1, 10);
    larger.point.size = [200, 100];
    let report = report(vec![chip("exact14", 1, 10), larger, host("exact14", 1, [1.0; 3])]);
    let said = sentences(&Context::new(&report));
    let counts: Vec<(&str, usize)> = said.iter().map(|(scene, said)| (scene.as_str(), said.len())).collect();
    assert_eq!(counts, [("demo", 3), ("bare", 0)]);
    assert!(said[0].1[0].contains("host") && said[0].1[1].contains("100x100") && said[0].1[2].contains("200x100"));
}

#[test]
fn all_scenes_together_are_of_kernels_that_drew_them_all() {
    let in_bare = |mut row: Row| {
        row.point.scene = "bare".into();
        row
    };
    let rows = vec![
        chip("exact14", 100, 10),
        chip("exact20", 0, 10),
        chip("f32", 0, 100),
        in_bare(chip("exact14", 200, 10)),
        in_bare(failed("exact20", "too large")),
        in_bare(chip("f32", 0, 400)),
    ];
    let report = report(rows);
    let overview = crate::report::page::overview::overview(&report, &Context::new(&report).kernels);
    let said = over_all(&overview);
    let expected = "Over 2 scenes on a Cortex-M0 (thumbv6m), exact14 is 20.0 times as fast as soft-float f32 (10.0 to 40.0), \
                    with at most 2.00 % of pixels over 64 in any.";
    assert_eq!(said, [expected]);
}
