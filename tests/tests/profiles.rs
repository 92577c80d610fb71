//! A profile leaves out code and changes nothing: without any one need, whatever can do without it is drawn as it is with
//! everything, bit for bit. A firmware has just what its scene needs, and the host has all of it.

use std::marker::PhantomData;

use core_rt::blob::BlobError;
use core_rt::exact::Exact14;
use core_rt::hanika::HanikaC;
use core_rt::kernel::Kernel;
use core_rt::profile::{Full, Needs, Profile};
use core_rt::scene::Scene;
use host_tools::prepare::{Options, prepare};
use host_tools::render::render;
use host_tools::stress::cases;
use tests::scenes;

/// All but the need of a bit.
#[derive(Clone, Copy, Debug, Default)]
struct Without<K, const BIT: u32>(PhantomData<K>);

impl<K: Kernel, const BIT: u32> Profile for Without<K, BIT> {
    type Kernel = K;
    const NEEDS: Needs = Needs::from_bits(Needs::ALL.bits() & !(1 << BIT));
}

/// The picture under a profile, if that suffices.
fn picture<P: Profile>(blob: &[u8]) -> Option<u32> {
    match Scene::<P>::new_checked(blob) {
        Ok(scene) => Some(render(&scene, [16, 16], &|_| {}).picture.crc32()),
        Err(BlobError::Missing(_)) => None,
        Err(error) => panic!("{error}"),
    }
}

/// The pictures without each need.
macro_rules! without_each {
    ($kernel:ty, $blob:expr, $($bit:literal)*) => { [$(($bit, picture::<Without<$kernel, $bit>>($blob))),*] };
}

/// Under how many profiles each bit's absence was no hindrance, over all scenes.
fn check<K: Kernel>(pictures: impl Fn(&[u8]) -> [(u32, Option<u32>); 31]) {
    let mut tried = [0; 32];
    let of_cases = cases::all().into_iter().filter(|case| matches!(case.name, "ior-10" | "hall-of-mirrors"));
    let of_cases = of_cases.map(|case| (case.name, (case.subject)().model));
    for (name, mut model) in scenes::all().into_iter().chain(of_cases) {
        model.render.size = [64, 48];
        let blob = prepare::<K>(&model, &Options::default()).expect("it fits").blob;
        let full = picture::<Full<K>>(blob.bytes()).expect("it has everything");
        let found = pictures(blob.bytes());
        let bits = found.iter().fold(0, |bits, (bit, _)| bits | 1 << bit);
        assert_eq!(Needs::ALL.bits(), bits, "a new need is to be tried too");
        for (bit, found) in found {
            if let Some(found) = found {
                tried[bit as usize] += 1;
                assert_eq!(found, full, "{} draws {name} otherwise without the need of bit {bit}", K::NAME);
            }
        }
    }
    println!("{}: scenes that did without each need: {tried:?}", K::NAME);
    assert!(tried.iter().filter(|&&count| count > 0).count() > 20, "{tried:?}");
}

#[test]
fn exact14_draws_the_same_without_what_a_scene_needs_not() {
    check::<Exact14>(
        |blob| without_each!(Exact14, blob, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 30 31),
    );
}

#[test]
fn hanika_c_draws_the_same_without_what_a_scene_needs_not() {
    check::<HanikaC>(
        |blob| without_each!(HanikaC, blob, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 30 31),
    );
}
