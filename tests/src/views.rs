//! Cameras that look for trouble: on vertices and in the mesh, through needles' eyes and almost all round, turned any way
//! and along axes, with steps of whole units and of parts of one.

use core_rt::camera::{Camera, CameraHeader, Use};
use core_rt::kernel::{Kernel, Vertices};

use crate::random::SplitMix64;

/// A camera for a picture of a size, which the kernel holds, onto a mesh that is not empty.
pub fn view<K: Kernel>(mesh: &[Vertices], random: &mut SplitMix64) -> (Camera<K::Word>, [u16; 2]) {
    let coordinates = || mesh.as_flattened().as_flattened().iter().map(|&c| i64::from(c));
    let (low, high) = (coordinates().min().unwrap_or(0), coordinates().max().unwrap_or(0));
    let (span, side) = (i64::from(K::SPAN), 1i64 << K::GRID_BITS);
    let reach = [(high - span).max(-side), (low + span).min(2 * side)];
    loop {
        let size = [0; 2].map(|_| random.within([1, 40]) as u16);
        let vertex = |random: &mut SplitMix64| mesh[random.below(mesh.len() as u64) as usize][random.below(3) as usize];
        let eye = match random.below(4) {
            0 => [0; 3].map(|_| random.within(reach) as i32),
            1 => vertex(random),
            2 => vertex(random).map(|c| (i64::from(c) + random.within([-20, 20])).clamp(reach[0], reach[1]) as i32),
            // On a side of the room that there is.
            _ => {
                let mut eye = [0; 3].map(|_| random.within([low, high]) as i32);
                eye[random.below(3) as usize] = reach[usize::from(random.coin())] as i32;
                eye
            }
        };
        let along = match random.below(4) {
            0 => {
                let mut along = [0; 3];
                along[random.below(3) as usize] = if random.coin() { 1 << 20 } else { -1 << 20 };
                along
            }
            1 => [0; 3].map(|_| random.within([-1 << 20, 1 << 20])),
            _ => {
                let to = vertex(random);
                [0, 1, 2].map(|axis| i64::from(to[axis]) - i64::from(eye[axis]))
            }
        };
        let largest = along.map(i64::abs).into_iter().max().unwrap_or(0);
        if largest == 0 {
            continue;
        }
        let fraction_bits = random.within([0, 17]) as u8;
        let one = 1i64 << (K::DIRECTION_BITS - 1 + u32::from(fraction_bits) - random.below(2) as u32);
        let middle = along.map(|c| (i128::from(c) * i128::from(one) / i128::from(largest)) as i64);
        // From a thousandth of a right angle to most of one.
        let step = (one >> random.below(11)) / i64::from(size[0].max(size[1]));
        let turned = |random: &mut SplitMix64| match random.below(3) {
            0 => {
                let mut step_along = [0; 3];
                step_along[random.below(3) as usize] = step;
                step_along
            }
            _ => [0; 3].map(|_| random.within([-step, step])),
        };
        let (right, down) = (turned(random), turned(random));
        let [x, y] = size.map(|side| i64::from(side) / 2);
        let first = [0, 1, 2].map(|axis| middle[axis] - x * right[axis] - y * down[axis]);
        let header = CameraHeader { eye, along: [0; 3], first, right, down, fraction_bits };
        if let Some(camera) = Camera::new::<K>(&header, Use { size, parallel: false, sampled: false }) {
            return (camera, size);
        }
    }
}
