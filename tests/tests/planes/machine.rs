//! The modelled machine against the kernel: every value of every ray, from the bits in which the plan has it.

use std::cell::RefCell;

use host_tools::pixel_planes::memory::Transfer;
use host_tools::pixel_planes::picture::Drawn;
use host_tools::pixel_planes::program::{Operation, Shape, Value};
use host_tools::pixel_planes::{Machine, Run};
use planes_rt::colour::Light;
use planes_rt::pixel::{self, Met};
use planes_rt::scene::Scene;
use tests::effort;
use tests::random::SplitMix64;

use crate::scenes::{self, Parts};
use crate::{SIZE, pixels, way};

fn shape(parts: &Parts) -> Shape {
    let settings = parts.settings;
    Shape {
        widths: settings.widths,
        spheres: parts.spheres.len() as u32,
        generations: settings.generations.into(),
        outline: settings.outline,
    }
}

fn run(parts: &Parts) -> Run {
    Run::new(&Machine::default(), &shape(parts)).unwrap()
}

/// A word of a value as a number with a sign, or without.
fn number(bits: u64, width: usize, has_sign: bool) -> i64 {
    let spare = 64 - width;
    if has_sign { ((bits << spare) as i64) >> spare } else { bits as i64 }
}

/// Whether nothing is seen of the rays behind a way.
fn is_dark(scene: &Scene<'_>, way: &[Met]) -> bool {
    let share = |share: u32, mirror: u16| (share * u32::from(mirror) + 1024) >> 11;
    let mirror = |met: &Met| scene.spheres()[met.sphere].surface.mirror;
    (0..3).all(|channel| way.iter().fold(2048, |left, met| share(left, mirror(met)[channel])) == 0)
}

/// Compares all values that the kernel tells of with those of the processors; how many there were.
fn compared(scene: &Scene<'_>, run: &Run, shape: &Shape) -> Result<usize, String> {
    let ways: Vec<(Light, Vec<Met>)> = pixels().map(|pixel| way(scene, pixel)).collect();
    let mut light = vec![[0; 3]; ways.len()];
    let (mut generation, mut count, mut wrong) = (0, 0, None);
    let told = RefCell::new(&mut wrong);
    run.draw_some(scene, shape, 0, &mut light, |step, moment, processors| {
        // What a step about one sphere writes is that of the rays which met it.
        let is_written = |met: &Met| step.operation != Operation::Point || met.sphere == step.sphere;
        let mut expect = |value: Value, of: &dyn Fn(&Met) -> Vec<i64>| {
            let Some(places) = moment.places.get(&value) else { return };
            for (processor, (_, way)) in ways.iter().enumerate() {
                let Some(met) = way.get(generation).filter(|met| is_written(met)) else { continue };
                // The kernel tells of a direction that no ray takes.
                if value == Value::Direction && is_dark(scene, &way[..=generation]) {
                    continue;
                }
                let expected = of(met);
                let width = places.len() / expected.len();
                let parts = places
                    .chunks(width)
                    .map(|part| number(processors.read(part, processor), width, value != Value::Nearest));
                count += 1;
                if !parts.eq(expected.iter().copied()) {
                    **told.borrow_mut() = Some(format!("{value:?} after {} of {processor}", moment.step));
                }
            }
        };
        let triple = |triple: [i16; 3]| triple.map(i64::from).to_vec();
        match step.operation {
            Operation::Enable => expect(Value::Nearest, &|met| vec![met.sphere as i64]),
            Operation::Point => {
                expect(Value::LeastT, &|met| vec![met.t.into()]);
                expect(Value::Origin, &|met| triple(met.point));
            }
            Operation::Reflect => expect(Value::Direction, &|met| triple(met.direction)),
            _ => (),
        }
        let ends = match shape.outline {
            planes_rt::scene::Outline::Nearest => step.operation == Operation::Reflect,
            planes_rt::scene::Outline::Literal => step.operation == Operation::Background,
        };
        generation += usize::from(ends);
    });
    match wrong {
        None if ways.iter().map(|(light, _)| *light).eq(light.iter().copied()) => Ok(count),
        None => Err("the light".into()),
        Some(wrong) => Err(wrong),
    }
}

#[test]
fn the_processors_have_every_value_of_the_kernel_bit_for_bit() {
    let mut random = SplitMix64(208);
    let mut count = 0;
    for _ in 0..40 * effort() {
        let mut parts = scenes::scene(&mut random, 6, SIZE);
        // What the reflection of the literal outline leaves is told after the next spheres.
        parts.settings.outline = planes_rt::scene::Outline::Nearest;
        let scene = parts.scene();
        let found = compared(&scene, &run(&parts), &shape(&parts));
        count += found.unwrap_or_else(|wrong| panic!("{wrong}: {:?}", parts.settings));
    }
    assert!(count > 5000, "{count}");
}

#[test]
fn the_picture_of_the_processors_is_the_kernel_s_and_takes_the_operations_that_were_planned() {
    let mut random = SplitMix64(4096);
    for _ in 0..40 * effort() {
        let parts = scenes::scene(&mut random, 8, SIZE);
        let (scene, run) = (parts.scene(), run(&parts));
        let Drawn { light, enabled, bit_operations } = run.draw(&scene, &shape(&parts), &|_| ());
        let expected: Vec<Light> = pixels().map(|pixel| pixel::trace(&scene, pixel)).collect();
        assert_eq!(light, expected, "{:?}", parts.settings);
        assert_eq!(bit_operations, run.computing);
        assert!(enabled.iter().all(|&count| count <= expected.len() as u64) && enabled[0] == expected.len() as u64);
    }
}

#[test]
fn a_plan_that_forgets_or_mistakes_a_value_is_told() {
    let mut random = SplitMix64(64);
    let (mut told, mut all) = (0, 0);
    while all < 8 {
        let mut parts = scenes::scene(&mut random, 6, SIZE);
        parts.settings.outline = planes_rt::scene::Outline::Nearest;
        let scene = parts.scene();
        if pixels().filter(|&pixel| !way(&scene, pixel).1.is_empty()).count() < 30 {
            continue;
        }
        let mut run = run(&parts);
        // Origins that come from the store have their bits where others belong.
        let returns = run.plan.moments.iter_mut().flat_map(|moment| &mut moment.transfers);
        let is_it = |transfer: &&mut Transfer| !transfer.is_outward && transfer.value == Value::Origin;
        returns.filter(is_it).for_each(|transfer| transfer.places.rotate_left(1));
        all += 1;
        told += usize::from(compared(&scene, &run, &shape(&parts)).is_err());
    }
    assert!(2 * told > all, "{told} of {all}");
}
