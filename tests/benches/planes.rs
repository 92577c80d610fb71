//! The tracer of 1994 pixel by pixel and in lockstep: one thread, 16 spheres, the same picture.
//!
//! The ways take turns within every round, and a ratio is taken within its round; what is printed is the median of the rounds.
//!
//! `cargo bench -p tests --bench planes`

use std::hint::black_box;
use std::time::Instant;

use host_tools::planes::{Way, light};
use planes_rt::camera::{Camera, FRACTION_BITS, Linear};
use planes_rt::colour::Surface;
use planes_rt::scene::{Outline, Scene, Settings, Sphere};
use planes_rt::widths::Widths;
use planes_simd::Lockstep;

const SIZE: [u16; 2] = [640, 512];
const ROUNDS: usize = 31;

/// 4 x 4 spheres that mirror each other.
fn spheres() -> Vec<Sphere> {
    let sphere = |i: i16| Sphere {
        centre: [i % 4 * 200 - 300, i / 4 * 200 - 300, i * 37 % 200 - 100],
        radius: 90,
        surface: Surface {
            lit: [2000, 3000, 1000],
            own: [100; 3],
            mirror: [if i % 2 == 0 { 1200 } else { 400 }; 3],
            roughness: 0,
            matt: [0; 3],
        },
    };
    (0..16).map(sphere).collect()
}

fn main() {
    let spheres = spheres();
    let unit = 1 << FRACTION_BITS;
    let camera = Camera {
        origin: Linear::constant([0, 0, 900]),
        direction: Linear { first: [-320 * unit, 256 * unit, -600 * unit], right: [unit, 0, 0], down: [0, -unit, 0] },
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for outline in [Outline::Nearest, Outline::Literal] {
        let settings =
            Settings { widths: Widths::PIXEL_PLANES, size: SIZE, generations: 3, outline, samples: 1, paths: false };
        let scene = Scene::new_checked(&spheres, [1000, 1400, 1000], [300, 400, 500], camera, settings);
        let scene = scene.expect("in range");
        let seconds = |way| {
            let begin = Instant::now();
            black_box(pool.install(|| light(&scene, way, &|_| ())));
            begin.elapsed().as_secs_f64()
        };
        let units = [Lockstep::PORTABLE, Lockstep::detected()];
        assert!(
            units.iter().all(|&unit| light(&scene, Way::Lanes(unit), &|_| ()) == light(&scene, Way::Pixels, &|_| ()))
        );
        // Seconds of pixel by pixel, and how much faster each unit is.
        let rounds: [[f64; 3]; ROUNDS] = std::array::from_fn(|_| {
            let pixels = seconds(Way::Pixels);
            let [portable, detected] = units.map(|unit| pixels / seconds(Way::Lanes(unit)));
            [pixels, portable, detected]
        });
        let [pixels, ratios @ ..]: [f64; 3] = [0, 1, 2].map(|figure| median(rounds.map(|round| round[figure])));
        println!("{outline:?}: pixel by pixel {:.1} ms", 1e3 * pixels);
        for (unit, ratio) in units.into_iter().zip(ratios) {
            println!("  lockstep, {}: {ratio:.2} times as fast", unit.name());
        }
    }
}

fn median(mut values: [f64; ROUNDS]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[ROUNDS / 2]
}
