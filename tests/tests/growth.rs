//! The cost of a ray grows no faster than the logarithm of the number of triangles: on chips by instructions, on the host by
//! box and triangle tests. `cargo xtask speed` shows more of it, up to a million triangles and by time.

use core_rt::exact::Exact29;
use core_rt::scene::Scene;
use core_rt::stats::Counts;
use firmware_rt::hits::Way;
use host_tools::model::{Model, RenderSettings};
use host_tools::prepare::{Options, prepare};
use tests::boards::counted;
use tests::chips::Job;
use tests::growth::{Line, SIDES, find, mesh};

/// The meshes that fit every board.
const ON_CHIPS: usize = 6;

fn model(side: i32, size: [u32; 2]) -> Model {
    let model = mesh(side);
    Model { render: RenderSettings { size, ..model.render }, ..model }
}

#[test]
fn rays_on_chips() {
    for (board, counter) in counted() {
        let cost = |&side: &i32| {
            let model = model(side, [64, 48]);
            let counts = Job::new(board, &model, "exact14", Some(Way::Single)).counts(&counter);
            (model.triangles.len(), counts.instructions as f64)
        };
        let line = Line { name: board.name.into(), points: SIDES[..ON_CHIPS].iter().map(cost).collect() };
        println!("{line:?} {:?}", line.steps());
        assert!(line.is_logarithmic(), "{line:?}");
    }
}

#[test]
fn rays_on_the_host() {
    let tests = |&side: &i32| {
        let model = model(side, [160, 120]);
        let mut counts = Counts::default();
        let blob = prepare::<Exact29>(&model, &Options::default()).expect("it fits").blob;
        find(&Scene::new_checked(blob.bytes()).expect("a blob just made"), &mut counts);
        (model.triangles.len(), (counts.box_tests + counts.triangle_tests) as f64)
    };
    let line = Line { name: "tests".into(), points: SIDES[..11].iter().map(tests).collect() };
    println!("{line:?} {:?}", line.steps());
    assert!(line.is_logarithmic(), "{line:?}");
}

#[test]
fn what_grows_faster_is_noticed() {
    let line = |cost: &dyn Fn(f64) -> f64| {
        let points = (7..20).map(|bits| (1 << bits, cost(f64::from(1 << bits))));
        Line { name: String::new(), points: points.collect() }
    };
    assert!(line(&|n| 5.0 + 3.0 * libm::log2(n)).steps().map(|step| (step * 100.0) as i64) == [11; 2]);
    assert!(!line(&|n| n).is_logarithmic());
    assert!(!line(&|n| libm::pow(n, 0.1)).is_logarithmic());
    assert!(line(&|n| libm::sqrt(libm::log2(n))).is_logarithmic());
}
