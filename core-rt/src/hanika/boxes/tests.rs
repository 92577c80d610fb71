use super::super::ray::{Ray, T_END};
use super::super::testing::Random;
use super::*;
use crate::kernel::{ANY_OCTANT, octant};

fn enter<S: Slab>(ray: &Ray<S>, planes: &Planes, limit: i32) -> Option<i32> {
    ray.slab.enter::<ANY_OCTANT>(ray.origin, planes, limit)
}

const WIDEST: i64 = (1 << 29) + (1 << 7);

const fn shifts(c_bits: u8, d_bits: u8) -> Arithmetic {
    Arithmetic { c_bits, d_bits, edge_shift: 0, epsilon: 4 }
}

/// The report's listing as it is printed: near and far by the direction's sign, an early end after each axis. In 128
/// bits, so that nothing overflows where the kernel would.
fn listing(
    settings: Arithmetic,
    least: i64,
    origin: Triple<i64>,
    direction: Triple<i64>,
    bounds: Planes,
    limit: i32,
) -> Option<i32> {
    let n = 1i128 << (31 + settings.c_bits);
    let sign = direction.map(|c| usize::from(c < 0));
    let inverse = direction.map(|c| match c {
        c if c.abs() >= least => n / i128::from(c),
        c if c < 0 => -n / i128::from(least),
        _ => n / i128::from(least),
    });
    let at = |side: usize, axis: usize| {
        (i128::from(i64::from(bounds[side][axis]) - origin[axis]) >> settings.d_bits) * inverse[axis]
    };
    let (t_min_x, t_max_y) = (at(sign[0], 0), at(1 - sign[1], 1));
    if t_min_x > t_max_y {
        return None;
    }
    let (t_max_x, t_min_y) = (at(1 - sign[0], 0), at(sign[1], 1));
    if t_max_x < t_min_y {
        return None;
    }
    let t_min = t_min_x.max(t_min_y);
    let t_max_z = at(1 - sign[2], 2);
    if t_min > t_max_z {
        return None;
    }
    let t_max = t_max_x.min(t_max_y);
    let t_min_z = at(sign[2], 2);
    if t_max < t_min_z {
        return None;
    }
    let (t_min, t_max) = (t_min.max(t_min_z), t_max.min(t_max_z));
    let t = t_min >> (settings.c_bits - settings.d_bits);
    let in_range = t <= i128::from(i32::MAX) && t >= -i128::from(i32::MAX);
    (t_min <= t_max && in_range && t_max >= 0 && t <= i128::from(limit)).then_some(t as i32)
}

/// A ray and a box that it goes through or by, at all sizes up to the ends of the ranges.
fn case(random: &mut Random) -> (Triple<i64>, Triple<i64>, Bounds) {
    let (a, b) = (random.vertex(), random.vertex());
    let flat = random.within(0, 3) as usize;
    let b = [0, 1, 2].map(|axis| if axis == flat { a[axis] } else { b[axis] });
    let bounds = Bounds::of(&[a, b, a]);
    let origin = [0, 1, 2].map(|axis| {
        let span = WIDEST - 16;
        random.within(i64::from(bounds.high[axis]) - span, i64::from(bounds.low[axis]) + span)
    });
    let target = [0, 1, 2].map(|axis| random.within(bounds.low[axis].into(), bounds.high[axis].into()));
    let aimed = [0, 1, 2].map(|axis| target[axis] - origin[axis]);
    let direction = match random.within(0, 3) {
        0 => [0; 3].map(|_| random.sized(31)),
        1 => [aimed[0], random.sized(5), random.sized(5)],
        _ => aimed,
    };
    (origin, direction, bounds)
}

fn agrees<const LEAST: i64>(settings: Arithmetic, seed: u64) {
    let mut random = Random(seed);
    let mut entered = 0;
    for _ in 0..20_000 {
        let (origin, direction, bounds) = case(&mut random);
        let Some(ray) = Ray::<TightSlab<LEAST>>::new(settings, origin, direction, 0) else { continue };
        let planes = planes::<TightSlab<LEAST>>(bounds);
        let limit = random.sized(30).unsigned_abs() as i32;
        for limit in [T_END, limit] {
            let expected = listing(settings, LEAST, origin, ray.direction, planes, limit);
            let found = ray.slab.enter::<ANY_OCTANT>(origin, &planes, limit);
            assert_eq!(found, expected, "{settings:?} {origin:?} {:?} {planes:?} {limit}", ray.direction);
            entered += u32::from(found.is_some());
        }
    }
    assert!(entered > 1000, "{settings:?}: {entered}");
}

/// Overflow is trapped, so this holds the products at the ends of all ranges too.
#[test]
fn the_tight_test_is_the_listing_for_every_c_and_d() {
    for c_bits in 0..=28 {
        agrees::<1>(shifts(c_bits, c_bits), c_bits.into());
        for unused in 0..=c_bits.min(6) {
            agrees::<16>(shifts(c_bits, c_bits - unused), u64::from(c_bits) << 8 | u64::from(unused));
        }
    }
}

/// The largest products there are: differences of the whole range, over the smallest components.
#[test]
fn the_largest_products_fit() {
    for component in [0, 1, -1, 15, 16, 17, -16] {
        for far in [0, (1 << 29) - 1] {
            for settings in [shifts(28, 28), shifts(12, 12), shifts(0, 0)] {
                let slab = TightSlab::<1>::new(settings, [component, i64::from(i32::MAX), component]);
                let _ = slab.enter::<ANY_OCTANT>([far - WIDEST; 3], &[[far as u32; 3]; 2], T_END);
                let _ = slab.enter::<ANY_OCTANT>([far + WIDEST; 3], &[[far as u32; 3]; 2], T_END);
            }
            for settings in [shifts(28, 22), shifts(15, 9), shifts(6, 0)] {
                let slab = TightSlab::<16>::new(settings, [component, i64::from(i32::MIN), component]);
                let _ = slab.enter::<ANY_OCTANT>([far - WIDEST; 3], &[[far as u32; 3]; 2], T_END);
                let _ = slab.enter::<ANY_OCTANT>([far + WIDEST; 3], &[[far as u32; 3]; 2], T_END);
            }
        }
    }
}

/// Rays whose point at a whole t is in the box, to the last unit, enter it not beyond that t. The report's tests lose
/// some, so this has teeth.
#[test]
fn the_conservative_test_loses_nothing() {
    let mut random = Random(9);
    let mut lost = [0; 2];
    let count = 1_000_000;
    for _ in 0..count {
        let (_, direction, mut bounds) = case(&mut random);
        if random.within(0, 1) == 0 {
            bounds.high = bounds.low.map(|c| c + random.within(0, 3) as i32);
        }
        let aimed = Ray::<ConservativeSlab>::new(shifts(0, 0), [0; 3], direction, 0);
        let Some(aimed) = aimed else { continue };
        let t = random.within(1, 1 << 28);
        // The origin from which t leads into the box: what is left of the unit is within it, too.
        let inside = [0, 1, 2].map(|axis| random.within(bounds.low[axis].into(), bounds.high[axis].into()));
        let origin = [0, 1, 2].map(|axis| inside[axis] - ((t * aimed.direction[axis]) >> 31));
        let ray = Ray { origin, ..aimed };
        let entry = enter(&ray, &planes::<ConservativeSlab>(bounds), t as i32);
        assert!(entry.is_some_and(|entry| i64::from(entry) <= t), "{ray:?} {bounds:?} {t}: {entry:?}");
        let plain = Ray::<TightSlab<1>>::of_unit(shifts(12, 12), origin, ray.direction, 0);
        let refined = Ray::<TightSlab<16>>::of_unit(shifts(15, 9), origin, ray.direction, 0);
        lost[0] += u32::from(enter(&plain, &planes::<TightSlab<1>>(bounds), T_END).is_none());
        lost[1] += u32::from(enter(&refined, &planes::<TightSlab<16>>(bounds), T_END).is_none());
    }
    assert!(lost[0] > lost[1] && lost[1] > count / 100, "{lost:?} of {count}");
}

/// Near and far planes that are chosen when the code is compiled are the ones that are chosen when it runs.
#[test]
fn octants_are_one_test() {
    let mut random = Random(12);
    let (mut entered, mut apart) = (0, 0);
    for _ in 0..20_000 {
        let (origin, direction, bounds) = case(&mut random);
        let Some(ray) = Ray::<ConservativeSlab>::new(shifts(0, 0), origin, direction, 0) else { continue };
        let planes = planes::<ConservativeSlab>(bounds);
        let slab = ray.slab;
        let (right, wrong) = match octant(ray.direction) {
            0 => (slab.enter::<0>(origin, &planes, T_END), slab.enter::<7>(origin, &planes, T_END)),
            1 => (slab.enter::<1>(origin, &planes, T_END), slab.enter::<6>(origin, &planes, T_END)),
            2 => (slab.enter::<2>(origin, &planes, T_END), slab.enter::<5>(origin, &planes, T_END)),
            3 => (slab.enter::<3>(origin, &planes, T_END), slab.enter::<4>(origin, &planes, T_END)),
            4 => (slab.enter::<4>(origin, &planes, T_END), slab.enter::<3>(origin, &planes, T_END)),
            5 => (slab.enter::<5>(origin, &planes, T_END), slab.enter::<2>(origin, &planes, T_END)),
            6 => (slab.enter::<6>(origin, &planes, T_END), slab.enter::<1>(origin, &planes, T_END)),
            _ => (slab.enter::<7>(origin, &planes, T_END), slab.enter::<0>(origin, &planes, T_END)),
        };
        assert_eq!(right, enter(&ray, &planes, T_END), "{ray:?} {bounds:?}");
        entered += u32::from(right.is_some());
        apart += u32::from(right != wrong);
    }
    assert!(entered > 5000 && apart > 5000, "{entered} {apart}");
}

/// What the proof that the tree loses nothing stands on.
#[test]
fn the_conservative_test_is_monotone() {
    let mut random = Random(10);
    for _ in 0..200_000 {
        let (origin, direction, bounds) = case(&mut random);
        let Some(ray) = Ray::<ConservativeSlab>::new(shifts(0, 0), origin, direction, 0) else { continue };
        let limit = random.within(1, T_END.into()) as i32;
        let Some(entry) = ray.slab.enter::<ANY_OCTANT>(origin, &planes::<ConservativeSlab>(bounds), limit) else {
            continue;
        };
        let other = random.vertex();
        let larger = bounds.union(&Bounds { low: other, high: other });
        let later = random.within(limit.into(), T_END.into()) as i32;
        let found = ray.slab.enter::<ANY_OCTANT>(origin, &planes::<ConservativeSlab>(larger), later);
        assert!(found.is_some_and(|found| found <= entry), "{origin:?} {ray:?} {bounds:?} {larger:?}");
    }
}

#[test]
fn boxes_come_back_and_others_are_nowhere() {
    let mut random = Random(11);
    for _ in 0..1000 {
        let (_, _, made) = case(&mut random);
        assert_eq!(bounds::<ConservativeSlab>(planes::<ConservativeSlab>(made)), made);
        assert_eq!(bounds::<TightSlab<1>>(planes::<TightSlab<1>>(made)), made);
    }
    for plane in [0, 9, u32::MAX, 1 << 31, (1 << 31) - 1] {
        let found = bounds::<ConservativeSlab>([[plane; 3]; 2]);
        let off = |c: i32| !(16..(1 << 29) - 16).contains(&c);
        assert!(found.low.iter().chain(&found.high).any(|&c| off(c)), "{found:?}");
    }
}
