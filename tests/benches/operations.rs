//! What one box pair and one triangle cost each kernel, on rays that meet about half of what they are tested with.
//!
//! `cargo bench -p tests --bench operations`. Compare figures of one run only; `--bench kernels` takes ratios.

use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::{HanikaC, HanikaCons};
use core_rt::kernel::{ANY_OCTANT, Bounds, Kernel, NONE, Vertices};
use core_rt::num::Word;
use divan::Bencher;
use divan::counter::ItemsCount;
use float_rt::{Float32, Float64};
use tests::random::SplitMix64;

const COUNT: usize = 1024;

fn main() {
    divan::main();
}

/// Rays from random places towards random points of random triangles' boxes.
fn work<K: Kernel>() -> Vec<(K::Ray, K::Node, K::Triangle)> {
    let mut random = SplitMix64(1);
    // Within what every budget on differences allows.
    let last = (1i64 << (K::GRID_BITS - 1)) - 1;
    let settings = K::settle(&core_rt::arithmetic::Knobs::default(), core::iter::empty())
        .and_then(|arithmetic| K::settings(&arithmetic))
        .expect("defaults are good");
    let point = |random: &mut SplitMix64| [(); 3].map(|()| random.within([i64::from(K::MARGIN), last]));
    core::iter::from_fn(|| {
        let [a, b, c, origin, target] = [(); 5].map(|()| point(&mut random));
        let vertices: Vertices = [a, b, c].map(|v| v.map(|c| c as i32));
        let word = |v: [i64; 3]| v.map(|c| K::Word::from_i32(c as i32));
        // A second draw where a triangle has no area or a ray no direction.
        let made = K::triangle(settings, &vertices, 0).zip({
            let aim = [0, 1, 2].map(|i| (target[i] + a[i]) / 2 - origin[i]);
            K::ray(settings, word(origin), word(aim), NONE)
        });
        Some(made.map(|(triangle, ray)| (ray, K::node([Bounds::of(&vertices); 2], [0; 2]), triangle)))
    })
    .flatten()
    .take(COUNT)
    .collect()
}

#[divan::bench(types = [Float32, Float64, Exact14, Exact20, Exact29, HanikaC, HanikaCons])]
fn boxes<K: Kernel>(bencher: Bencher<'_, '_>) {
    let work = work::<K>();
    bencher.counter(ItemsCount::new(2 * COUNT)).bench_local(|| {
        let enters = |ray, node| {
            let path = K::path(ray);
            K::enter::<ANY_OCTANT>(&path, node, 0, K::reach(ray, &path)).is_some()
        };
        work.iter().filter(|(ray, node, _)| enters(ray, node)).count()
    });
}

#[divan::bench(types = [Float32, Float64, Exact14, Exact20, Exact29, HanikaC, HanikaCons])]
fn triangles<K: Kernel>(bencher: Bencher<'_, '_>) {
    let work = work::<K>();
    bencher
        .counter(ItemsCount::new(COUNT))
        .bench_local(|| work.iter().filter(|(ray, _, triangle)| K::intersect(ray, triangle).is_some()).count());
}
