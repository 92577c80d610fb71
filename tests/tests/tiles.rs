//! Rays that walk the tree together, beside those that walk it one by one: the same hits, all of them, for tiles of every size
//! and cameras that look for trouble. And the bounds that this rests on, beside the exact numbers.

use core_rt::bvh::{Bvh, Intersect, Waiting};
use core_rt::camera::Camera;
use core_rt::exact::{Exact, Frustum, Width, Width14, Width20, Width29, Width29In};
use core_rt::kernel::{Bounds, Kernel, NONE, Vertices};
use core_rt::mesh::Mesh;
use core_rt::profile::{Full, Profile};
use core_rt::render::Tile;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::section::Integers;
use core_rt::sphere::Ball;
use core_rt::stats::NoStats;
use core_rt::tile::{Beam, Edges, Footprint, Linear, ROOM, SIDE};
use host_tools::prepare::{self, Options};
use host_tools::tree::{self, TreeOptions};
use rayon::prelude::*;
use tests::random::SplitMix64;
use tests::{meshes, scenes, views};

/// The widest tile that is tried.
const TILES: [[u16; 2]; 8] = [[1, 1], [16, 16], [8, 8], [3, 5], [17, 33], [64, 2], [1, 64], [64, 64]];

/// The nearest hits of a picture, tile by tile.
fn together<P: Profile>(
    bvh: &Bvh<'_, P>,
    camera: Option<&Camera<<P::Kernel as Kernel>::Word>>,
    ray: impl Fn([u16; 2]) -> Option<<P::Kernel as Kernel>::Ray>,
    size: [u16; 2],
    tile: [u16; 2],
) -> Vec<u32> {
    let mut stack = heapless::Vec::<Waiting<P::Kernel>, MAX_DEPTH>::new();
    let mut picture = vec![7; usize::from(size[0]) * usize::from(size[1])];
    for tile in Tile::of(size, tile) {
        let mut hits = vec![7; tile.pixels()];
        bvh.closest_tile(camera, &ray, tile, &mut hits, &mut [0; ROOM], &mut stack, &mut NoStats);
        for ([x, y], hit) in tile.places().zip(hits) {
            picture[usize::from(y) * usize::from(size[0]) + usize::from(x)] = hit;
        }
    }
    picture
}

/// The nearest hits of a picture, ray by ray.
fn alone<P: Profile>(
    bvh: &Bvh<'_, P>,
    ray: impl Fn([u16; 2]) -> Option<<P::Kernel as Kernel>::Ray>,
    [width, height]: [u16; 2],
) -> Vec<u32> {
    let mut stack = heapless::Vec::<Waiting<P::Kernel>, MAX_DEPTH>::new();
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    places.map(|place| ray(place).map_or(NONE, |ray| bvh.closest(&ray, &mut stack, &mut NoStats))).collect()
}

fn goldens<K: Kernel>() {
    for (name, model) in scenes::all().into_iter().chain(scenes::pixels()) {
        for model in [scenes::matt(model.clone()), model] {
            let prepared = prepare::prepare::<K>(&model, &Options::default()).expect("goldens fit every kernel");
            let scene = Scene::<Full<K>>::new_checked(prepared.blob.bytes()).expect("a blob just made");
            let ray = |[x, y]: [u16; 2]| scene.primary(&scene.camera, x, y);
            let expected = alone(&scene.bvh, ray, scene.frame.size);
            for tile in TILES {
                let found = together(&scene.bvh, scene.shared_origin(), ray, scene.frame.size, tile);
                assert!(found == expected, "{name} by {}, tiles of {tile:?}", K::NAME);
            }
        }
    }
}

#[test]
fn goldens_have_the_hits_of_single_rays() {
    goldens::<Exact<Width14>>();
    goldens::<Exact<Width20>>();
    goldens::<Exact<Width29>>();
}

/// Triangles of a grid, as the kernel may hold them.
fn on_grid<W: Width>(triangles: &[[[i64; 3]; 3]]) -> Vec<Vertices> {
    let last = (1i64 << W::GRID_BITS) - 1 - i64::from(W::MARGIN);
    let snapped = triangles.iter().map(|t| t.map(|v| v.map(|c| c.clamp(W::MARGIN.into(), last) as i32)));
    snapped.filter(|corners| Exact::<W>::triangle((), corners, 0).is_some()).collect()
}

/// Compares all rays of many views of a mesh; how many rays there were, how many hit, and how many were in a beam.
fn compare<W: Width>(name: &str, mesh: &[Vertices], leaf_max: u32, rays: u64, seed: u64) -> [u64; 3] {
    let options = TreeOptions { leaf_max, leaf_always: leaf_max != 8, ..TreeOptions::default() };
    let mut random = SplitMix64(seed);
    // On corners: some stick out of the mesh, some are in it, and rays start in some.
    let ball = |_| {
        let centre = mesh[random.below(mesh.len() as u64) as usize][0];
        let wall = centre.iter().map(|&c| c.min((1 << W::GRID_BITS) - 1 - c)).min().unwrap_or(0) - W::MARGIN;
        Ball { centre, radius: (wall >> random.below(8)).max(Exact::<W>::RADIUS_MIN) }
    };
    let balls: Vec<_> = (0..seed % 4).map(ball).filter(Ball::fits::<Exact<W>>).collect();
    let flat = tree::build_mixed(mesh.iter().map(Bounds::of), balls.iter().map(Ball::bounds), options);
    let nodes: Vec<_> = flat.nodes.iter().map(|n| Exact::<W>::node(n.boxes, n.children)).collect();
    let triangle = |&i: &u32| Exact::<W>::triangle((), &mesh[i as usize], 0).expect("on the grid, with area");
    let (of_triangles, of_balls) = flat.order.split_at(mesh.len());
    let records: Vec<_> = of_triangles.iter().map(triangle).collect();
    let sphere = |&i: &u32| Exact::<W>::sphere(&balls[i as usize - mesh.len()], 0).expect("it fits");
    let spheres: Vec<_> = of_balls.iter().map(sphere).collect();
    let bvh = Bvh::<Full<Exact<W>>> {
        root: flat.root,
        nodes: &nodes,
        triangles: Mesh::whole((), &records),
        spheres: &spheres,
        ids: Integers::Wide(&flat.order),
    };
    let mut sums = [0; 3];
    while sums[0] < rays {
        let (camera, size) = views::view::<Exact<W>>(mesh, &mut random);
        let ray = |[x, y]: [u16; 2]| Exact::<W>::primary((), &camera, x, y);
        let expected = alone(&bvh, ray, size);
        let tile = TILES[random.below(TILES.len() as u64) as usize];
        let found = together(&bvh, Some(&camera), ray, size, tile);
        let differing = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
        let first = found.iter().zip(&expected).position(|(a, b)| a != b).map(|place| {
            let ray = ray([place as u16 % size[0], place as u16 / size[0]]);
            let hit =
                |hit: u32| records.get(hit as usize).map(|record| (hit, Exact::<W>::intersect(&ray.unwrap(), record)));
            (place, hit(found[place]), hit(expected[place]))
        });
        assert_eq!(
            differing,
            0,
            "{} on {name}, leaves to {leaf_max}: {camera:?} {size:?} by {tile:?}: {first:?}",
            W::NAME
        );
        sums[0] += expected.len() as u64;
        sums[1] += expected.iter().filter(|&&hit| hit != NONE).count() as u64;
        let beams = Tile::of(size, [SIDE; 2]).filter(|&tile| Frustum::<W>::new(&camera, tile).is_some());
        sums[2] += beams.map(|tile| tile.pixels() as u64).sum::<u64>();
    }
    sums
}

fn random<W: Width>(rays: u64) {
    let rays = if tests::effort() > 1 { 10_000_000 } else { rays };
    let meshes = meshes::all(W::GRID_BITS);
    let each = rays / (3 * meshes.len() as u64) + 1;
    let cases: Vec<_> = meshes.iter().flat_map(|mesh| [1, 8, 64].map(|leaf_max| (mesh, leaf_max))).collect();
    let sums = cases.par_iter().enumerate().map(|(seed, ((name, triangles), leaf_max))| {
        let sums = compare::<W>(name, &on_grid::<W>(triangles), *leaf_max, each, seed as u64);
        println!("{} on {name}, leaves to {leaf_max}: {sums:?} rays, hits, and rays in beams", W::NAME);
        sums
    });
    let [rays, hits, beams] = sums.reduce(|| [0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    assert!(hits * 5 > rays && beams * 2 > rays, "{rays} rays, {hits} hits, {beams} in beams: little was compared");
}

#[test]
fn exact14_has_the_hits_of_single_rays() {
    random::<Width14>(2_000_000);
}

#[test]
fn exact20_has_the_hits_of_single_rays() {
    random::<Width20>(400_000);
}

#[test]
fn exact29_has_the_hits_of_single_rays() {
    random::<Width29>(400_000);
}

#[test]
fn exact29_as_on_chips_has_the_hits_of_single_rays() {
    random::<Width29In<true>>(400_000);
}

/// What footprints said of triangles and pixels, beside what is so.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    pixels: u64,
    hits: u64,
    uncertain: u64,
    /// Hits that are left out without the band.
    lost_without_band: u64,
    /// How near a nearness came to its band.
    nearness_error: f64,
}

/// Every triangle of meshes in every pixel of tiles.
fn footprints<W>(views: usize) -> Tally
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let mut tally = Tally::default();
    for (seed, (name, triangles)) in meshes::all(W::GRID_BITS).iter().enumerate() {
        let mesh = on_grid::<W>(triangles);
        let mut random = SplitMix64(seed as u64);
        for _ in 0..views {
            let (camera, size) = views::view::<Exact<W>>(&mesh, &mut random);
            let Some(tile) = Tile::of(size, [SIDE; 2]).next() else { continue };
            let Some(beam) = Frustum::<W>::new(&camera, tile) else { continue };
            for corners in mesh.iter().step_by(7) {
                let triangle = Exact::<W>::triangle((), corners, 0).expect("on the grid, with area");
                let mut edges = Edges::default();
                let footprint = beam.footprint(corners, &mut edges);
                for [x, y] in tile.places() {
                    let ray = Exact::<W>::primary((), &camera, x, y).expect("in a beam no direction is zero");
                    let depth = Exact::<W>::intersect(&ray, &triangle);
                    let at = |linear: &Linear| {
                        let (x, y) = (i64::from(x - tile.x), i64::from(y - tile.y));
                        i64::from(linear.first) + x * i64::from(linear.right) + y * i64::from(linear.down)
                    };
                    let context =
                        || format!("{} on {name}: {camera:?} {size:?} {corners:?} {edges:?} {x} {y}", W::NAME);
                    tally.pixels += 1;
                    tally.hits += u64::from(depth.is_some());
                    match footprint {
                        Footprint::Unknown => continue,
                        Footprint::Nothing => {
                            assert!(depth.is_none(), "{}", context());
                            continue;
                        }
                        Footprint::Edges => {}
                    }
                    let values = edges.edges.each_ref().map(|edge| at(&edge.line));
                    let above =
                        |share: i64| (0..3).all(|i| values[i] >= i64::from(edges.edges[i].uncertain) * share / 2);
                    assert!(above(0) || depth.is_none(), "left out: {}", context());
                    assert!(!above(2) || depth.is_some(), "not hit: {}", context());
                    tally.uncertain += u64::from(above(0) && !above(2));
                    tally.lost_without_band += u64::from(!above(1) && depth.is_some());
                    if let Some(depth) = depth {
                        // By how much the direction was scaled.
                        let largest = |v: [W::Word; 3]| v.map(|c| c.into().abs()).into_iter().max().unwrap_or(1) as f64;
                        let scale = largest(ray.direction) / largest(camera.direction(x, y));
                        let (numerator, denominator): (i128, i128) = (depth.numerator.into(), depth.denominator.into());
                        let units = W::GRID_BITS as i32 - 15 - (W::DIRECTION_BITS as i32 - 13) + 18;
                        let nearness = denominator as f64 / numerator as f64 / scale * f64::from(units).exp2();
                        let found = at(&edges.nearness) as f64;
                        let error = (found - nearness * f64::from(1u32 << edges.shift)).abs();
                        let share = error / f64::from(edges.band);
                        assert!(share <= 1.0, "nearness {share}: {}", context());
                        tally.nearness_error = tally.nearness_error.max(share);
                    }
                }
            }
        }
    }
    println!("{}: {tally:?}", W::NAME);
    tally
}

/// Nothing that is hit is left out, nothing that counts as hit is missed, and depths are within their bands. The bands are
/// not for show: without them hits would be lost.
#[test]
fn footprints_are_true_within_their_bands() {
    for tally in [footprints::<Width14>(300), footprints::<Width20>(100), footprints::<Width29>(100)] {
        assert!(tally.hits > 10_000 && tally.uncertain > 1000, "{tally:?}");
        assert!(tally.lost_without_band > 100, "{tally:?}");
        assert!(tally.nearness_error > 0.1, "{tally:?}");
    }
}
