//! The kernel that is chosen for a scene: close enough to the reference, no dearer than it need be, and chosen by what is there
//! to see.

use glam::DVec3;
use host_tools::choose::auto::{self, auto};
use host_tools::choose::budget::{Budget, search};
use host_tools::choose::engines;
use host_tools::compare::{Comparison, compare};
use host_tools::engine::Engine;
use host_tools::model::Model;
use host_tools::prepare::{Options, losses};
use host_tools::reference::Reference;
use tests::scenes;

fn apart(engine: &dyn Engine, model: &Model, options: &Options) -> Comparison {
    let prepared = engine.prepare(model, options).expect("it fits");
    let picture = engine.render(prepared.blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture;
    compare(&picture, &Reference::new(model).picture(&|_| {})).expect("one size")
}

fn demo(size: [u32; 2]) -> Model {
    let (_, mut model) = scenes::all().swap_remove(0);
    model.render.size = size;
    model
}

/// What it promises: three pixels of a thousand at most over 64, and no shape lost. A cheaper kernel was left only for a reason.
#[test]
fn the_kernel_that_is_chosen_will_do() {
    let mut chosen = Vec::new();
    for size in [[160, 128], [480, 384]] {
        for (name, model) in scenes::with_shared(size) {
            let choice = auto(&model);
            let apart = apart(choice.engine, &model, &Options::default());
            println!("{name} at {size:?}: {choice}; over 64 in {}", apart.over_64);
            assert!(apart.over_64 * 1000 <= 3 * u64::from(size[0] * size[1]), "{name} at {size:?}: {}", apart.over_64);
            let (last, others) = choice.findings.split_last().expect("there are kernels");
            assert_eq!(last.kernel, choice.engine.name());
            assert!(others.iter().all(|finding| finding.loses || finding.moved > Some(auto::MOST)));
            let grid = choice.engine.grid(&model, None).expect("it has one");
            let (bits, radius) = (choice.engine.grid_bits(), choice.engine.radius_min());
            assert_eq!(losses(choice.engine.name(), bits, radius, &model, &grid), [], "{name}");
            chosen.push(choice.engine.name());
        }
    }
    chosen.sort_unstable();
    chosen.dedup();
    assert!(chosen.len() > 1, "always {chosen:?}");
}

/// The same scene, seen from closer and closer, or ever smaller before the same wall, needs ever more bits.
#[test]
fn more_to_see_needs_more_bits() {
    assert_eq!(auto(&demo([160, 128])).engine.name(), "exact14");
    assert_eq!(auto(&demo([4096, 3072])).engine.name(), "exact20");
    let mut far = demo([160, 128]);
    // A ground a million times as wide as what stands on it.
    let material = far.triangles[0].material;
    let first = far.positions.len() as u32;
    far.positions.extend([[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, z]| DVec3::new(x * 1e6, -3.0, z * 1e6)));
    far.triangles.push(host_tools::model::Triangle {
        vertices: [first, first + 1, first + 2],
        normals: None,
        material,
    });
    if !far.uvs.is_empty() {
        far.uvs.push(None);
    }
    assert_eq!(auto(&far).engine.name(), "exact29");
}

/// What a search chooses is inside the budget, measured apart, and what is cheaper is not.
#[test]
fn the_search_ends_at_the_edge_of_the_budget() {
    for (text, kernel) in [("over_64<1%@80x64", "exact14"), ("over_64<=9,over_4<0.1%@160x128", "exact20")] {
        let budget: Budget = text.parse().expect("a budget");
        let model = demo([160, 120]);
        let mut told = 0;
        let found = search(&model, &Options::default(), &budget, &mut |_| told += 1);
        found.tries.iter().for_each(|tried| println!("{text}: {tried}"));
        assert_eq!(told, found.tries.len());
        let (engine, bits) = found.chosen.expect("there is one");
        assert_eq!(engine.name(), kernel);
        let mut model = model;
        model.render.size = budget.size.expect("it has one");
        let pixels = f64::from(model.render.size[0] * model.render.size[1]);
        let inside = |engine: &dyn Engine, bits| {
            let apart = apart(engine, &model, &Options { grid_bits: Some(bits), ..Options::default() });
            match kernel {
                "exact14" => (apart.over_64 as f64) < 0.01 * pixels,
                _ => apart.over_64 <= 9 && (apart.over_4 as f64) < 0.001 * pixels,
            }
        };
        assert!(inside(engine, bits));
        assert!(!inside(engine, bits - 1), "{text}: a coarser grid would do");
        let cheaper = engines().take_while(|cheaper| cheaper.id() != engine.id());
        assert!(
            cheaper.into_iter().all(|cheaper| !inside(cheaper, cheaper.grid_bits())),
            "{text}: a cheaper kernel would do"
        );
    }
    let none: Budget = "psnr>500".parse().expect("a budget");
    let found = search(&demo([40, 30]), &Options::default(), &none, &mut |_| ());
    assert!(found.chosen.is_none());
    assert_eq!(found.tries.len(), engines().count());
}
