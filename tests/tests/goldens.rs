//! Bit-exact pictures: no tolerance, for any number of threads and any tile. `INTRAY_BLESS=1` renews them; look at the
//! difference before it is committed. The same files are compared in every build profile and on every machine.

use std::path::PathBuf;

use host_tools::compare::difference;
use host_tools::engine::ENGINES;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::tree::TreeOptions;
use tests::scenes;

fn golden(scene: &str, kernel: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("goldens").join(format!("{scene}-{kernel}.png"))
}

/// Whether two pictures are the same; where they are not, the number of pixels that differ.
fn check(found: &Picture, expected: &Picture) -> Result<(), String> {
    if found == expected {
        return Ok(());
    }
    match difference(found, expected) {
        Err(sizes) => Err(sizes.to_string()),
        Ok(gray) => {
            let count = gray.pixels().iter().filter(|pixel| pixel[0] > 0).count();
            Err(format!("{count} pixels differ"))
        }
    }
}

#[test]
fn pictures_are_the_golden_ones_for_any_threads_and_tiles() {
    let bless = std::env::var_os("INTRAY_BLESS").is_some();
    let mut failures = Vec::new();
    for (name, model) in scenes::all().into_iter().chain(scenes::pixels()) {
        for engine in ENGINES {
            let prepared = engine.prepare(&model, &Options::default()).expect("goldens fit every kernel");
            let blob = prepared.blob.bytes();
            let picture = |threads: usize, tile: [u16; 2]| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                pool.install(|| engine.render(blob, tile, &|_| {})).expect("a blob just made").picture
            };
            let one = picture(1, [u16::MAX, u16::MAX]);
            for (threads, tile) in [(1, [1, 1]), (2, [16, 16]), (3, [7, 64]), (2, [64, 1])] {
                if picture(threads, tile) != one {
                    failures.push(format!("{name}, {}: {threads} threads, tiles of {tile:?} differ", engine.name()));
                }
            }
            let path = golden(name, engine.name());
            if bless {
                one.write_png(&path).expect("a golden can be written");
            }
            let expected = Picture::read_png(&path).expect("a golden");
            if let Err(why) = check(&one, &expected) {
                failures.push(format!("{name}, {}: {why}", engine.name()));
            }
        }
    }
    assert!(failures.is_empty(), "INTRAY_BLESS=1 renews goldens\n{}", failures.join("\n"));
}

/// The exact kernels' pictures do not depend on the tree.
#[test]
fn pictures_do_not_depend_on_the_leaf_threshold() {
    for (name, model) in scenes::all() {
        for engine in ENGINES.into_iter().filter(|engine| engine.name().starts_with("exact")) {
            let picture = |leaf_max: u32| {
                let tree = TreeOptions { leaf_max, leaf_always: true, ..TreeOptions::default() };
                let prepared = engine.prepare(&model, &Options { tree, ..Options::default() }).expect("it fits");
                engine.render(prepared.blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
            };
            let expected = picture(1);
            for leaf_max in [2, 7, 64] {
                assert_eq!(check(&picture(leaf_max), &expected), Ok(()), "{name}, {}, {leaf_max}", engine.name());
            }
        }
    }
}

#[test]
fn one_pixel_off_by_one_is_noticed() {
    let expected = Picture::new(8, 8);
    let mut found = expected.clone();
    found.pixels_mut()[9][2] += 1;
    assert_eq!(check(&found, &expected), Err("1 pixels differ".into()));
    assert!(check(&Picture::new(8, 7), &expected).is_err());
}
