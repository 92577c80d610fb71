use planes_rt::camera::*;
use planes_rt::colour::*;
use planes_rt::pixel;
use planes_rt::scene::*;
use planes_rt::widths::*;
use planes_simd::Lockstep;
use std::hint::black_box;
use std::time::Instant;
const W: u16 = 640;
const H: u16 = 512;
fn tile<const N: usize>(l: Lockstep, s: &Scene<'_>, w: u16) -> Vec<Light> {
    let h = N as u16 / w;
    let mut out = vec![[0u16; 3]; W as usize * H as usize];
    for ty in (0..H).step_by(h.into()) {
        for tx in (0..W).step_by(w.into()) {
            let px: [[u16; 2]; N] = std::array::from_fn(|i| [tx + i as u16 % w, ty + i as u16 / w]);
            let li = l.trace(s, &px);
            for (p, c) in px.iter().zip(li) {
                out[p[1] as usize * W as usize + p[0] as usize] = c;
            }
        }
    }
    out
}
fn main() {
    let u = 1 << FRACTION_BITS;
    let spheres: Vec<Sphere> = (0..16)
        .map(|i: i16| Sphere {
            centre: [(i % 4) * 200 - 300, (i / 4) * 200 - 300, (i * 37) % 200 - 100],
            radius: 90,
            surface: Surface {
                lit: [2000, 3000, 1000],
                own: [100; 3],
                mirror: [if i % 2 == 0 { 1200 } else { 400 }; 3],
            },
        })
        .collect();
    let camera = Camera {
        origin: Linear::constant([0, 0, 900]),
        direction: Linear { first: [-320 * u, 256 * u, -600 * u], right: [u, 0, 0], down: [0, -u, 0] },
    };
    for outline in [Outline::Nearest, Outline::Literal] {
        let s = Settings { widths: Widths::PIXEL_PLANES, size: [W, H], generations: 3, outline };
        let scene = Scene::new_checked(&spheres, [1000, 1400, 1000], [300, 400, 500], camera, s).unwrap();
        let time = |f: &mut dyn FnMut() -> Vec<Light>| {
            (0..7)
                .map(|_| {
                    let t = Instant::now();
                    black_box(f());
                    t.elapsed().as_secs_f64() * 1e3
                })
                .fold(1e9, f64::min)
        };
        let mut by_pixel =
            || (0..H).flat_map(|y| (0..W).map(move |x| [x, y])).map(|p| pixel::trace(&scene, p)).collect::<Vec<_>>();
        let reference = by_pixel();
        let l = Lockstep::detected();
        let mut best = [1e9f64; 4];
        for _ in 0..40 {
            let mut go = |k: usize, f: &mut dyn FnMut() -> Vec<Light>| {
                let t = Instant::now();
                assert!(black_box(f()) == reference || false);
                best[k] = best[k].min(t.elapsed().as_secs_f64() * 1e3);
            };
            if std::env::args().count() < 2 {
                go(0, &mut by_pixel);
                go(1, &mut || tile::<8>(l, &scene, 4));
                go(3, &mut || tile::<32>(l, &scene, 8));
            }
            go(2, &mut || tile::<16>(l, &scene, 4));
        }
        println!("{outline:?} {best:.1?} {:.2?}", best.map(|b| best[0] / b));
        let _ = &time;
    }
}
