//! thin
use std::hint::black_box;
use std::time::Instant;

use clap::Parser;
use core_rt::bvh::{Intersect, Waiting};
use core_rt::exact::Exact29;
use core_rt::kernel::{Kernel, NONE};
use core_rt::profile::Full;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::{Counts, NoStats};
use exact_simd::Tree;
use float_rt::Float32;
use host_tools::prepare::{Options, prepare};
use tests::scenes;

#[derive(Debug, Parser)]
struct Arguments {
    #[arg(long, default_value_t = 384)]
    size: u32,
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    names: Vec<String>,
    #[arg(long, hide = true)]
    bench: bool,
}

fn rays<K: Kernel>(scene: &Scene<'_, Full<K>>) -> Vec<K::Ray> {
    let [w, h] = scene.frame.size;
    (0..h).flat_map(|y| (0..w).map(move |x| [x, y])).filter_map(|[x, y]| scene.primary(&scene.camera, x, y)).collect()
}

#[inline(never)]
fn plain<K: Kernel>(scene: &Scene<'_, Full<K>>, rays: &[K::Ray]) -> u64 {
    let mut stack = heapless::Vec::<Waiting<K>, MAX_DEPTH>::new();
    rays.iter().map(|ray| u64::from(black_box(scene.bvh.closest(ray, &mut stack, &mut NoStats)) != NONE)).sum()
}

fn main() {
    let arguments = Arguments::parse();
    let size = [arguments.size; 2];
    let names: Vec<&str> = if arguments.names.is_empty() {
        vec!["bunny/bunny_smooth.obj", "sponza-dabrovic/scene.toml", "coffee/coffee.obj", "teapot/teapot.obj", "suzanne/suzanne.obj", "cornell-box/scene.toml", "demo"]
    } else {
        arguments.names.iter().map(String::as_str).collect()
    };
    let mut logs = [0.0; 4];
    for name in &names {
        let model = scenes::named(name, size).unwrap();
        let options = Options::default();
        let fb = prepare::<Float32>(&model, &options).unwrap().blob;
        let eb = prepare::<Exact29>(&model, &options).unwrap().blob;
        let f = Scene::<Full<Float32>>::new_checked(fb.bytes()).unwrap();
        let e = Scene::<Full<Exact29>>::new_checked(eb.bytes()).unwrap();
        let begin = Instant::now();
        let tree = Tree::new(&e.bvh).unwrap();
        let built = begin.elapsed().as_secs_f64();
        let (fr, er) = (rays(&f), rays(&e));
        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let mut wrong = 0;
        let (mut c, mut d) = (Counts::default(), Counts::default());
        for ray in &er {
            wrong += u32::from(tree.closest(&e.bvh, ray, &mut c) != e.bvh.closest(ray, &mut stack, &mut d));
        }
        let mut times = vec![vec![]; 4];
        for _ in 0..arguments.rounds {
            let mut time = |which: usize, run: &dyn Fn() -> u64| {
                let begin = Instant::now();
                black_box(run());
                times[which].push(begin.elapsed().as_secs_f64() / er.len() as f64 * 1e9);
            };
            time(0, &|| plain(&f, &fr));
            time(1, &|| plain(&e, &er));
            time(2, &|| er.iter().map(|ray| u64::from(tree.closest(&e.bvh, ray, &mut NoStats) != NONE)).sum());
        }
        let median = |v: &[f64]| { let mut v = v.to_vec(); v.sort_by(f64::total_cmp); v[v.len() / 2] };
        let ratio = |w: usize| median(&times[w].iter().zip(&times[0]).map(|(a, b)| a / b).collect::<Vec<_>>());
        for w in 1..3 { logs[w] += ratio(w).ln(); }
        let n = er.len() as f64;
        println!("{name}: f32 {:.0} ns, exact29 {:.2}, wide {:.2}; wrong {wrong}; built {built:.3} s; boxes {:.1} {:.1} triangles {:.1} {:.1}", median(&times[0]), ratio(1), ratio(2),
            d.box_tests as f64 / n, c.box_tests as f64 / n, d.triangle_tests as f64 / n, c.triangle_tests as f64 / n);
    }
    println!("mean {:.3} {:.3}", (logs[1] / names.len() as f64).exp(), (logs[2] / names.len() as f64).exp());
}
