//! Spheres beside the lanes of `exact29`: hit or miss without error, and t between bounds, without the wide root of the kernel's test.
//!
//! As in `core_rt::exact`'s test, with S = o - centre, t = (-b -+ sqrt(b^2 - a c)) / a for a = D . D, b = S . D and c = S . S - r^2, and
//! all signs are those of whole numbers.
//!
//! | value | bound | fits |
//! | --- | --- | --- |
//! | S | < 2^30 | what lanes hold of rays |
//! | a | 2^60 to 3 * 2^62 | `u64` |
//! | b | < 3 * 2^61 | `i64` |
//! | c | < 3 * 2^60 | `i64` |
//! | b^2, a c | < 9 * 2^122 each | `i128` |
//!
//! **Root.** The discriminant is below 2^127, h its upper 64 bits or less, so that it is h 2^(2k) and less than 2^(2k) more, k <= 32. With q =
//! floor(sqrt(h)) the root is from q 2^k to (q + 1) 2^k, and so are its roundings to whole numbers. It is below |b| outside, and at most r |D| inside, so that
//! sums fit.
//!
//! **Bounds.** So the numerator of t is n to n + 2^32. With A = floor(a / 2^32) >= 2^28 and x = floor(n / 2), t in Q31 is at least x / (A + 1), whose floor
//! is the lower bound, and at most (x + 1 + 2^31) / A. That is more by x / (A (A + 1)), which is at most 4 since t <= 1/2 is 2^30, and by (1 + 2^31) / A < 9;
//! and by less than 1 for the floor.

use core_rt::exact::{Exact29, Ray, Width29};
use core_rt::kernel::Kernel;
use core_rt::num::{BitLength, dot, isqrt_u64, sub};

use super::exact29::Between;

/// By how much the greater one is more.
const WIDTH: i64 = 4 + 9 + 1;

/// Where a ray that lanes hold hits a sphere, before `end`; `leaves` says that it starts on it.
#[inline]
pub(super) fn hit(ray: &Ray<Width29>, sphere: &<Exact29 as Kernel>::Sphere, leaves: bool, end: i64) -> Option<Between> {
    let ball = Exact29::ball(sphere);
    let s = sub(ray.origin, ball.centre.map(i64::from));
    let (b, radius) = (dot(s, ray.direction), i64::from(ball.radius));
    let c = dot(s, s) - radius * radius;
    let outside = c > 0;
    // One that starts on the sphere and is outside never meets it again; others are before it, or on it, and go on inside.
    if c >= 0 && (leaves || b >= 0) {
        return None;
    }
    let a: u64 = ray.direction.iter().map(|&d| (d * d).cast_unsigned()).sum();
    let discriminant = i128::from(b) * i128::from(b) - i128::from(a) * i128::from(c);
    let discriminant = u128::try_from(discriminant).ok()?;
    let k = discriminant.bit_length().saturating_sub(u64::BITS).div_ceil(2);
    let root = isqrt_u64((discriminant >> (2 * k)) as u64);
    let nearer = if outside { -b - ((root + 1) << k).cast_signed() } else { (root << k).cast_signed() - b };
    let least = ((nearer.max(0) >> 1).cast_unsigned() / ((a >> 32) + 1)).cast_signed();
    if least + WIDTH < end {
        return Some([least, least + WIDTH]);
    }
    // Whether that is within the ray's reach the kernel says.
    Exact29::intersect_sphere(ray, sphere, leaves).map(|depth| Exact29::span(&depth).ends())
}

#[cfg(test)]
mod tests {
    use core_rt::exact::{Depth, Width};
    use core_rt::kernel::NONE;
    use core_rt::sphere::Ball;

    use super::*;

    /// What is between: a t, exactly.
    fn is_between(depth: &Depth<Width29>, [least, most]: Between) -> bool {
        let t = depth.numerator << Width29::T_BITS;
        (i128::from(least) * depth.denominator..=i128::from(most) * depth.denominator).contains(&t)
    }

    /// Numbers that look like none.
    struct Numbers(u64);

    impl Numbers {
        fn below(&mut self, end: i64) -> i64 {
            self.0 = (self.0 ^ self.0 >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9).wrapping_add(0x9e37_79b9_7f4a_7c15);
            ((u128::from(self.0 ^ self.0 >> 32) * end as u128) >> 64) as i64
        }
    }

    /// The kernel's test and this one; whether they hit.
    fn agree(origin: [i64; 3], direction: [i64; 3], ball: Ball, leaves: bool) -> bool {
        let sphere = Exact29::sphere(&ball, 0).expect("on the grid");
        let ray = Ray::<Width29>::new(origin, direction, NONE).expect("a direction");
        let exact = Exact29::intersect_sphere(&ray, &sphere, leaves);
        let found = hit(&ray, &sphere, leaves, i64::MAX);
        assert_eq!(exact.is_some(), found.is_some(), "{ray:?} {ball:?} {leaves}");
        for (depth, between) in exact.iter().zip(found) {
            assert!(is_between(depth, between), "{ray:?} {ball:?} {leaves}: {depth:?} {between:?}");
        }
        exact.is_some()
    }

    #[test]
    fn hits_are_the_kernels_and_between_their_bounds() {
        let mut numbers = Numbers(1);
        let last = (1 << 29) - 1 - i64::from(Exact29::MARGIN);
        let mut hits = 0;
        for round in 0..200_000 {
            let radius = 2 + (numbers.below(1 << 28) >> numbers.below(27)).min(last / 2 - 8);
            let room = last - 2 * radius - i64::from(Exact29::MARGIN);
            let centre = [0; 3].map(|_| i64::from(Exact29::MARGIN) + radius + numbers.below(room + 1));
            let ball = Ball { centre: centre.map(|c| c as i32), radius: radius as i32 };
            // On the sphere, near it, or anywhere that the kernel sees it from.
            let far = [1, 2, 2 * radius, 1 << 28][round % 4];
            let origin = centre.map(|c| c + (numbers.below(2 * far + 1) - far));
            let origin = if round % 3 == 0 { [centre[0] + radius, centre[1], centre[2]] } else { origin };
            // Towards a point in or about the sphere: a tangent, where it is an end of a diameter.
            let aim = centre.map(|c| c + [-radius, 0, radius, numbers.below(3 * radius) - radius][round / 7 % 4]);
            let direction = [0, 1, 2].map(|axis| aim[axis] - origin[axis] + numbers.below(3) - 1);
            if direction != [0; 3] {
                hits += u32::from(agree(origin, direction, ball, round % 5 == 0));
            }
        }
        assert!((50_000..190_000).contains(&hits), "{hits} of 200,000 hit");
    }

    /// The ends of the table: the largest sphere and the smallest, from as far off as can be, at a tangent and a step beside it.
    #[test]
    fn the_ends_of_the_ranges_agree() {
        let (margin, end) = (i64::from(Exact29::MARGIN), (1i64 << 29) - 1 - i64::from(Exact29::MARGIN));
        let middle = (margin + end) / 2;
        for (centre, radius) in [([middle; 3], middle - margin), ([margin + 2; 3], 2), ([end - 2; 3], 2)] {
            let ball = Ball { centre: centre.map(|c| c as i32), radius: radius as i32 };
            let span = i64::from(Exact29::SPAN);
            let (near, far) = (centre[0] + radius - span, centre[0] - radius + span);
            let mut hits = [0; 2];
            for corner in 0..8 {
                let origin = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { near } else { far });
                let towards = [0, 1, 2].map(|axis| centre[axis] - origin[axis]);
                for step in -1..=1 {
                    hits[0] += u32::from(agree(origin, towards.map(|c| c + step), ball, false));
                }
                // Along an axis, through an end of a diameter: it touches.
                let beside = [origin[0], centre[1] + radius, centre[2]];
                for (step, touches) in [(-1, true), (0, true), (1, false)] {
                    let origin = [beside[0], beside[1] + step, beside[2]];
                    let is_hit = agree(origin, [centre[0] - origin[0], 0, 0], ball, false);
                    assert_eq!(is_hit, touches, "{origin:?} {ball:?}");
                    hits[1] += u32::from(is_hit);
                }
            }
            assert!(hits[0] >= 8 && hits[1] == 16, "{hits:?}");
        }
    }

    /// What begins within the reach is told by bounds, and what ends there by the kernel.
    #[test]
    fn a_reach_ends_where_the_kernels_does() {
        let ball = Ball { centre: [1 << 28; 3], radius: 1 << 20 };
        let sphere = Exact29::sphere(&ball, 0).expect("on the grid");
        let mut found = [0; 2];
        for step in -40..=40 {
            let origin = [(1 << 28) - (1 << 20) - (1 << 24) + step, 1 << 28, 1 << 28];
            let ray = Ray::<Width29>::segment(origin, [origin[0] + (1 << 24), origin[1], origin[2]], NONE);
            let ray = ray.expect("two points");
            let end = 1 << (Width29::T_BITS as i32 + ray.reach.expect("a segment has one"));
            let exact = Exact29::intersect_sphere(&ray, &sphere, false);
            assert_eq!(hit(&ray, &sphere, false, end).is_some(), exact.is_some(), "{step}");
            found[usize::from(exact.is_some())] += 1;
        }
        assert!(found.iter().all(|&count| count > 30), "{found:?}");
    }
}
