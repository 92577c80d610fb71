//! Small programs whose plans are known, and the text's.

use planes_rt::scene::Outline;
use planes_rt::widths::Widths;

use super::*;
use crate::pixel_planes::program::{Operation, Shape, program};

fn step(operation: Operation, reads: &[Value], writes: &[Value], scratch: u32) -> Step {
    let sized = |values: &[Value]| values.iter().map(|&value| (value, 10)).collect();
    Step { operation, sphere: 0, reads: sized(reads), writes: sized(writes), scratch, bit_operations: 100 }
}

fn store(local_bits: u32) -> Store {
    Store { local_bits, backing_bits: 64, block_bits: 32, block_cycles: 60 }
}

/// One value that is not used while another fills the memory.
fn to_and_fro() -> Vec<Step> {
    vec![
        step(Operation::CameraRay, &[], &[Value::Origin], 0),
        step(Operation::Root, &[], &[Value::Root], 15),
        step(Operation::Numerator, &[Value::Root], &[], 0),
        step(Operation::Point, &[Value::Origin], &[], 0),
    ]
}

#[test]
fn what_has_room_stays_and_what_has_none_goes_and_comes_back() {
    let roomy = Plan::new(&to_and_fro(), &store(35), 1).unwrap();
    assert_eq!((roomy.blocks, roomy.waiting, roomy.backing_bits), ([0, 0], 0, 0));
    assert_eq!(roomy.fullest().map(|moment| (moment.step, moment.bits)), Some(("root", 35)));
    let tight = Plan::new(&to_and_fro(), &store(34), 1).unwrap();
    assert_eq!(tight.swapped, BTreeMap::from([(Value::Origin, [1, 1])]));
    // Outward it waits for the step that made it; inward there is room while the memory is emptied.
    assert_eq!((tight.blocks, tight.waiting, tight.backing_bits), ([1, 1], 60, 32));
    assert!(tight.moments[1].held().eq([Value::Root]));
    let transfer = |is_outward| Transfer { value: Value::Origin, is_outward, places: (0..10).collect(), home: 0 };
    let transfers: Vec<&[Transfer]> = tight.moments.iter().map(|moment| moment.transfers.as_slice()).collect();
    assert_eq!(transfers, [&[][..], &[transfer(true)], &[], &[transfer(false)]]);
    let slow = Store { block_cycles: 130, ..store(34) };
    assert_eq!(Plan::new(&to_and_fro(), &slow, 1).unwrap().waiting, 130 + 30);
}

#[test]
fn a_copy_in_the_store_is_not_written_again() {
    let mut steps = to_and_fro();
    steps.extend(to_and_fro().split_off(1));
    let plan = Plan::new(&steps, &store(34), 1).unwrap();
    assert_eq!(plan.swapped, BTreeMap::from([(Value::Origin, [1, 2])]));
    // Made anew in between, it is.
    steps.insert(4, step(Operation::Reflect, &[Value::Origin], &[Value::Origin], 0));
    let plan = Plan::new(&steps, &store(34), 1).unwrap();
    assert_eq!(plan.swapped, BTreeMap::from([(Value::Origin, [2, 2])]));
}

#[test]
fn what_does_not_fit_is_refused_with_its_step() {
    let error = Plan::new(&to_and_fro(), &store(24), 1).unwrap_err();
    assert_eq!(error, PlanError::Step { step: "root", needed: 25, local: 24 });
    let small = Store { backing_bits: 31, ..store(34) };
    assert_eq!(Plan::new(&to_and_fro(), &small, 1), Err(PlanError::Backing { needed: 32, backing: 31 }));
}

#[test]
fn the_text_s_algorithm_fits_208_bits_with_the_ray_swapped_out() {
    for outline in [Outline::Literal, Outline::Nearest] {
        for spheres in [1, 8, 16, 255] {
            let shape = Shape { widths: Widths::PIXEL_PLANES, spheres, generations: 3, outline };
            let plan = Plan::new(&program(&shape), &Store::default(), 1).unwrap();
            assert!(plan.fullest().is_some_and(|moment| moment.bits <= 208));
            let [out, back] = plan.swapped[&Value::Direction];
            assert!(out > 0 && back > 0 && plan.swapped.contains_key(&Value::Origin), "{:?}", plan.swapped);
            let at_the_root = plan.moments.iter().filter(|moment| moment.step == "root");
            // There is room for half of the ray at most.
            for moment in at_the_root {
                assert!(!(moment.places.contains_key(&Value::Origin) && moment.places.contains_key(&Value::Direction)));
            }
            // The remark on the next machine: 256 bytes a pixel. Nothing has to go.
            let roomy = Store { local_bits: 2048, ..Store::default() };
            assert_eq!(Plan::new(&program(&shape), &roomy, 1).unwrap().swapped, BTreeMap::new());
        }
    }
}

#[test]
fn no_two_values_share_a_bit_and_all_have_theirs() {
    let shape = Shape { widths: Widths::PIXEL_PLANES, spheres: 5, generations: 2, outline: Outline::Nearest };
    let plan = Plan::new(&program(&shape), &Store::default(), 1).unwrap();
    for moment in &plan.moments {
        let mut all: Vec<usize> = moment.places.values().chain([&moment.scratch]).flatten().copied().collect();
        assert_eq!(all.len(), moment.bits as usize);
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), moment.bits as usize, "{}", moment.step);
        assert!(all.last().is_none_or(|&last| last < 208));
        assert!(moment.places.iter().all(|(&value, places)| places.len() == shape.bits(value) as usize));
    }
}

#[test]
fn memory_that_is_a_bit_short_of_the_largest_step_is_refused() {
    let shape = Shape { widths: Widths::PIXEL_PLANES, spheres: 4, generations: 2, outline: Outline::Nearest };
    let steps = program(&shape);
    let largest = steps.iter().map(|step| {
        let values: BTreeMap<Value, u32> = step.reads.iter().chain(&step.writes).copied().collect();
        values.values().sum::<u32>() + step.scratch
    });
    let largest = largest.max().unwrap();
    let with = |local_bits| Plan::new(&steps, &Store { local_bits, ..Store::default() }, 1).is_ok();
    assert!(with(largest) && !with(largest - 1));
}
