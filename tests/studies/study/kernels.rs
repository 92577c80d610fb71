//! What is asked of kernels: pictures by name, and by type what no picture shows.

use std::hint::black_box;
use std::time::Instant;

use core_rt::bvh::{Intersect, Waiting};
use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::{HanikaC, HanikaCd, HanikaCons};
use core_rt::kernel::{Kernel, NONE, Vertices};
use core_rt::num::Triple;
use core_rt::profile::Full;
use core_rt::render::{Tile, Workspace, render_tile};
use core_rt::scene::{MAX_BRANCHES, MAX_DEPTH, Scene};
use core_rt::stats::NoStats;
use float_rt::{Float32, Float64};
use host_tools::engine::{self, Engine};
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::prepare::{Blob, Options};
use rayon::prelude::*;

/// A kernel.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    /// Its name.
    pub(crate) name: &'static str,
    /// Whether its tree loses no hit, so that nothing may change with the tree.
    pub(crate) is_exact: bool,
    /// The triangle of the file that each pixel sees, or [`NONE`].
    pub(crate) seen: fn(&Blob) -> Vec<u32>,
    /// See [`SelfHits`].
    pub(crate) self_hits: fn(&Blob) -> SelfHits,
    /// What renders a part of the picture on this thread.
    pub(crate) drawer: for<'a> fn(&'a Blob) -> Drawer<'a>,
}

/// Renders a part of a picture.
pub(crate) type Drawer<'a> = Box<dyn Fn() + 'a>;

/// All kernels, the report's first.
pub(crate) fn all() -> [Entry; 8] {
    [
        entry::<HanikaC>(false),
        entry::<HanikaCd>(false),
        entry::<HanikaCons>(false),
        entry::<Exact29>(true),
        entry::<Exact20>(true),
        entry::<Exact14>(true),
        entry::<Float32>(false),
        entry::<Float64>(false),
    ]
}

/// The kernel of a name.
pub(crate) fn by_name(name: &str) -> Entry {
    all().into_iter().find(|entry| entry.name == name).expect("a kernel of this name")
}

fn entry<K: Kernel>(is_exact: bool) -> Entry {
    Entry { name: K::NAME, is_exact, seen: seen::<K>, self_hits: self_hits::<K>, drawer: drawer::<K> }
}

fn engine(name: &str) -> &'static dyn Engine {
    engine::by_name(name).expect("a kernel of this name")
}

/// A scene's blob for a kernel.
pub(crate) fn blob(kernel: &str, model: &Model, options: &Options) -> Blob {
    engine(kernel).prepare(model, options).expect("every kernel holds the studies' scenes").blob
}

/// The grid units that a unit of a scene has in a kernel.
pub(crate) fn scale(kernel: &str, model: &Model) -> f64 {
    engine(kernel).prepare(model, &Options::default()).expect("every kernel holds the studies' scenes").grid.scale
}

/// A scene's picture by a kernel.
pub(crate) fn picture(kernel: &str, model: &Model, options: &Options) -> Picture {
    drawn(kernel, &blob(kernel, model, options))
}

/// The picture of a blob.
pub(crate) fn drawn(kernel: &str, blob: &Blob) -> Picture {
    engine(kernel).render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

fn view<K: Kernel>(blob: &Blob) -> Scene<'_, Full<K>> {
    Scene::new_checked(blob.bytes()).expect("a blob just made")
}

/// What each camera ray's nearest hit becomes.
fn each_hit<K: Kernel, T: Send>(
    scene: &Scene<'_, Full<K>>,
    of: impl Fn(&K::Ray, u32) -> T + Send + Sync,
) -> impl ParallelIterator<Item = Option<T>> {
    let [width, height] = scene.frame.size.map(u32::from);
    (0..width * height).into_par_iter().map(move |pixel| {
        let (x, y) = ((pixel % width) as u16, (pixel / width) as u16);
        let ray = K::primary(scene.settings, &scene.camera, x, y)?;
        let mut stack = heapless::Vec::<Waiting<K>, MAX_DEPTH>::new();
        let hit = scene.bvh.closest(&ray, &mut stack, &mut NoStats);
        (hit != NONE).then(|| of(&ray, hit))
    })
}

fn seen<K: Kernel>(blob: &Blob) -> Vec<u32> {
    let scene = view::<K>(blob);
    each_hit(&scene, |_, hit| scene.bvh.id(hit)).map(|id| id.unwrap_or(NONE)).collect()
}

/// Shadow rays that leave a convex closed mesh, from a face that is seen from outside and faces the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SelfHits {
    /// How many there are.
    pub(crate) rays: u64,
    /// How many the mesh blocks, though it cannot.
    pub(crate) blocked: u64,
}

impl SelfHits {
    /// The sum.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self { rays: self.rays + other.rays, blocked: self.blocked + other.blocked }
    }
}

/// Whether a point is in front of a triangle, exactly: determinants are below 3 * 2^30 * 2^61.
fn faces(&[a, b, c]: &Vertices, point: Triple<i32>) -> bool {
    let from = |to: Triple<i32>| [0, 1, 2].map(|axis| i128::from(to[axis]) - i128::from(a[axis]));
    let (e1, e2, p) = (from(b), from(c), from(point));
    let normal = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        e1[j] * e2[k] - e1[k] * e2[j]
    });
    normal.iter().zip(p).map(|(n, p)| n * p).sum::<i128>() > 0
}

fn self_hits<K: Kernel>(blob: &Blob) -> SelfHits {
    let scene = view::<K>(blob);
    let eye = Scene::<Full<K>>::header(blob.bytes()).expect("it was read").camera.eye;
    let of = |ray: &K::Ray, hit: u32| {
        let triangle = &scene.bvh.triangles.records[hit as usize];
        let vertices = K::vertices(triangle);
        let mut found = SelfHits::default();
        if !faces(&vertices, eye) {
            return found;
        }
        let surface = K::resolve(ray, triangle);
        for light in scene.shading.lights.iter().filter(|light| faces(&vertices, light.place)) {
            // No primitive is passed over: the distance alone must do.
            let Some(shadow) = K::segment(scene.settings, &surface, light.place, NONE) else { continue };
            let mut stack = heapless::Vec::<Waiting<K>, MAX_DEPTH>::new();
            found.rays += 1;
            found.blocked += u64::from(scene.bvh.any(&shadow, &mut stack, &mut NoStats, |_| true));
        }
        found
    };
    each_hit(&scene, of).flatten().reduce(SelfHits::default, SelfHits::plus)
}

/// Tiles of a timed picture, spread over it.
const TIMED_TILES: usize = 48;

fn drawer<K: Kernel>(blob: &Blob) -> Drawer<'_> {
    const SIDE: u16 = 16;
    let scene = view::<K>(blob);
    Box::new(move || {
        let mut stack = heapless::Vec::<Waiting<K>, MAX_DEPTH>::new();
        let (mut hits, mut pixels) = ([0; 256], [0; 3 * 256]);
        let mut branches = heapless::Vec::<_, { MAX_BRANCHES + 1 }>::new();
        let mut workspace =
            Workspace { stack: &mut stack, branches: &mut branches, hits: &mut hits, pixels: &mut pixels };
        let tiles: Vec<Tile> = Tile::of(scene.frame.size, [SIDE; 2]).collect();
        // Odd, so that they are not all in one column.
        for tile in tiles.iter().step_by((tiles.len() / TIMED_TILES) | 1) {
            let drawn = render_tile(&scene, *tile, &mut workspace, &mut NoStats);
            black_box(drawn.expect("the workspace has room"));
        }
    })
}

/// The time of each drawer as a ratio to the first's: the median over rounds in which each has a turn. `None` without rounds.
pub(crate) fn times(drawers: &[Drawer<'_>], rounds: usize) -> Vec<Option<f64>> {
    let mut ratios = vec![Vec::new(); drawers.len()];
    for round in 0..rounds {
        let mut seconds = vec![0.0; drawers.len()];
        for turn in 0..drawers.len() {
            // Nobody is always behind the same one.
            let place = (turn + round) % drawers.len();
            let begin = Instant::now();
            drawers[place]();
            seconds[place] = begin.elapsed().as_secs_f64();
        }
        for (ratios, time) in ratios.iter_mut().zip(&seconds) {
            ratios.push(time / seconds[0]);
        }
    }
    ratios.iter_mut().map(|ratios| median(ratios)).collect()
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// The geometric mean; `None` of none, or where one was not measured.
pub(crate) fn geometric_mean(values: impl IntoIterator<Item = Option<f64>>) -> Option<f64> {
    let logarithms = values.into_iter().map(|value| value.map(libm::log)).collect::<Option<Vec<f64>>>()?;
    let count = logarithms.len() as f64;
    (!logarithms.is_empty()).then(|| libm::exp(logarithms.iter().sum::<f64>() / count))
}
