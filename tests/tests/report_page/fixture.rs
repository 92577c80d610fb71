//! A report with awkward values: zero and equal errors, points that failed, kernels that crowd, names that are markup.

use host_tools::compare::{Comparison, compare};
use host_tools::picture::Picture;
use host_tools::report::row::{
    Cause, Causes, Cost, Instructions, Machine, Measured, Outcome, Point, Row, SCHEMA, Study, Time,
};
use host_tools::report::{MachineFacts, Report, SceneFacts};
use std::path::Path;

/// Names that would end an attribute, an element or the script, if they were let.
pub(crate) const SCENES: [&str; 2] = [r#"<&">'s"#, "plain"];
pub(crate) const KERNELS: [&str; 7] =
    ["exact14", "exact20", "exact29", r#"k<u>&amp;""#, "hanika-cons-with-a-long-name", "f32", "f64"];
pub(crate) const REASON: &str = "</td></script><script>throw 1</script> is \"too large\" & <blink>heavy</blink>";
const SIZE: [u32; 2] = [40, 32];

/// The report, with its pictures written to `folder`; that of the last kernel in the second scene is not.
pub(crate) fn report(folder: &Path) -> Report {
    let mut rows = Vec::new();
    for (number, scene) in SCENES.into_iter().enumerate() {
        let truth = Picture::from_fn(SIZE[0], SIZE[1], |x, y| [(5 * x) as u8, (7 * y) as u8, 99]);
        truth.write_png(&folder.join(format!("{number}.png"))).unwrap();
        for machine in [Machine::Host, Machine::Rv32imac, Machine::Thumbv6m] {
            for (index, kernel) in KERNELS.into_iter().enumerate() {
                let point = point(scene, Study::Kernels, kernel, machine);
                // f64 is equal to the reference; two others are equal to each other.
                let wrong = [9, 2, 2, 1001, 100, 11, 0][index];
                let picture = Picture::from_fn(SIZE[0], SIZE[1], |x, y| {
                    let [r, g, b] = truth.pixels()[(y * SIZE[0] + x) as usize];
                    if y * SIZE[0] + x < wrong { [!r, g, b] } else { [r, g, b] }
                });
                let name = format!("{number}-{index}.png");
                if (number, index) != (1, 6) {
                    picture.write_png(&folder.join(&name)).unwrap();
                }
                let error = compare(&truth, &picture).unwrap();
                let cost = cost(machine, 1000 + 3 * index as u64 * (10 - index as u64));
                let measured = measured(error, cost, 30 + index as u64, [name, format!("{number}.png")]);
                let unfit = machine == Machine::Thumbv6m && kernel == "f64";
                rows.push(Row { point, outcome: if unfit { Outcome::Failed(REASON.into()) } else { measured } });
            }
        }
    }
    rows.extend(studies());
    Report {
        schema: SCHEMA.into(),
        command: r#"intray report 'a<b>&"c".obj' -o out"#.into(),
        machine: MachineFacts { cpu: "A<B> & C".into(), cores: 1, os: "none".into() },
        versions: [("intray".into(), "0.1.0".into()), ("tool<1>".into(), "\"2\"".into())].into(),
        scenes: SCENES.into_iter().chain(["bad<i>"]).map(scene).collect(),
        rows,
        notes: vec!["There is no <i>QEMU</i>.".into()],
    }
}

fn scene(name: &str) -> SceneFacts {
    let failed = name.starts_with("bad").then(|| "bad<i>: line 3 has <no> vertex".to_owned());
    SceneFacts { name: name.into(), path: format!("{name}.obj"), triangles: 1234, spheres: 0, failed }
}

fn point(scene: &str, study: Study, kernel: &str, machine: Machine) -> Point {
    Point {
        scene: scene.into(),
        study,
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
    }
}

/// One point of each other study and each value, with errors from none at all to everything.
fn studies() -> Vec<Row> {
    let mut rows = Vec::new();
    for machine in [Machine::Host, Machine::Thumbv6m] {
        for kernel in &KERNELS[..5] {
            for step in 0..4u32 {
                let own = |study| point(SCENES[0], study, kernel, machine);
                let setting = (step > 0).then_some(step);
                let knob = setting.map(|step| step as u8);
                for (point, primitives) in [
                    (Point { leaf: setting, ..own(Study::Leaf) }, 30),
                    (Point { grid_bits: setting, ..own(Study::Grid) }, 30),
                    (Point { knobs: [knob, Some(9), None], ..own(Study::C) }, 30),
                    (Point { knobs: [Some(12), knob, None], ..own(Study::D) }, 30),
                    (Point { knobs: [None, None, knob], ..own(Study::E) }, 30),
                    (Point { samples: 1 << step, ..own(Study::Samples) }, 30),
                    (Point { depth: step, ..own(Study::Depth) }, 30),
                    (Point { size: [40 << step, 32 << step], ..own(Study::Size) }, 30),
                    (Point { triangles: Some(10 << step), ..own(Study::Triangles) }, u64::from(10u32 << step)),
                ] {
                    let error = Comparison {
                        max_abs: 1,
                        mean_abs: 0.0,
                        rmse: f64::from(step) * 1e-7,
                        psnr: (step > 0).then_some(90.0 + f64::from(step)),
                        ssim: 1.0 - f64::from(step) * 0.25,
                        flip: f64::from(step) / 3.0,
                        over_1: 1280,
                        over_4: u64::from(step) * 400,
                        over_64: u64::from(step),
                    };
                    let cost = cost(machine, primitives * (1 + u64::from(step)));
                    let measured = measured(error, cost, primitives, ["none.png".into(), "none.png".into()]);
                    let unfit = step == 2 && *kernel == "exact14";
                    rows.push(Row {
                        point,
                        outcome: if unfit { Outcome::Failed("does not fit".into()) } else { measured },
                    });
                }
            }
        }
    }
    rows
}

fn cost(machine: Machine, work: u64) -> Cost {
    if machine == Machine::Host {
        let ratio = work as f64 / 1000.0;
        return Cost::Time(Time { seconds: 1e-6 * work as f64, ratio: [0.99 * ratio, ratio, 1.01 * ratio], rounds: 3 });
    }
    let cycles = [("a <model>".to_owned(), 2 * work)].into();
    Cost::Instructions(Instructions { instructions: 1000 * work, cycles, text_bytes: 4096, ram_bytes: 2048 })
}

fn measured(error: Comparison, cost: Cost, primitives: u64, [picture, truth]: [String; 2]) -> Outcome {
    let cause = Cause { pixels: error.over_1, over_4: error.over_4, over_64: error.over_64 };
    Outcome::Measured(Box::new(Measured {
        error,
        causes: Causes { shadow: cause, ..Causes::default() },
        cost,
        blob_bytes: 40 * primitives,
        primitives,
        rays: 1300,
        box_tests: 13_000,
        triangle_tests: 2600,
        image_crc32: "0123abcd".into(),
        picture,
        truth,
    }))
}
