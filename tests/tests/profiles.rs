//! A profile leaves out code and changes nothing: without any one need, whatever can do without it is drawn as it is with
//! everything, bit for bit. A firmware has just what its scene needs, and the host has all of it.

use std::marker::PhantomData;

use core_rt::blob::BlobError;
use core_rt::bvh::InPlace;
use core_rt::exact::Exact14;
use core_rt::hanika::HanikaC;
use core_rt::kernel::Kernel;
use core_rt::profile::{Full, Needs, Prefer, Profile};
use core_rt::scene::Scene;
use glam::DVec3;
use host_tools::model::{Background, Material, MaterialKind, Model, Sphere};
use host_tools::prepare::{Options, prepare};
use host_tools::render::render;
use host_tools::stress::cases;
use tests::scenes;

/// All but the need of a bit.
#[derive(Clone, Copy, Debug, Default)]
struct Without<K, const BIT: u32>(PhantomData<K>);

impl<K: Kernel, const BIT: u32> Profile for Without<K, BIT> {
    type Kernel = K;
    type Walk<'a> = InPlace;
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

/// The bits, and the pictures without each need.
macro_rules! needs {
    ($($bit:literal)*) => {
        const BITS: &[u32] = &[$($bit),*];

        fn without_each<K: Kernel>(blob: &[u8]) -> [Option<u32>; BITS.len()] {
            [$(picture::<Without<K, $bit>>(blob)),*]
        }
    };
}
needs!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36);

/// A sphere that lets all light pass, where it can: seen from outside at a flat angle it mirrors, and has no mirror's weight.
fn bubble() -> Model {
    let material = Material {
        kind: MaterialKind::Dielectric,
        colour: DVec3::ONE,
        ior: 0.6,
        weights: Some([0.0, 0.0, 0.0, 1.0]),
        ..Material::default()
    };
    Model {
        spheres: vec![Sphere { centre: DVec3::new(0.0, 0.0, -3.0), radius: 1.0, material: 0 }],
        materials: vec![material],
        background: Background::Sky { bottom: DVec3::X, top: DVec3::new(0.0, 0.5, 1.0) },
        ..Model::default()
    }
}

/// Under how many profiles each bit's absence was no hindrance, over all scenes.
fn check<K: Kernel>() {
    assert_eq!(Needs::ALL.bits(), BITS.iter().fold(0, |all, bit| all | 1 << bit), "a new need is to be tried too");
    let (mut tried, mut shared) = ([0; BITS.len()], 0);
    let of_cases = cases::all().into_iter().filter(|case| matches!(case.name, "ior-10" | "hall-of-mirrors"));
    let of_cases = of_cases.map(|case| (case.name, (case.subject)().model));
    let by_chance = scenes::pixels().into_iter().filter(|(name, _)| matches!(*name, "paths" | "rough"));
    for (name, mut model) in scenes::all().into_iter().chain(by_chance).chain(of_cases).chain([("a bubble", bubble())])
    {
        model.render.size = [64, 48];
        let stored = |prefer| prepare::<K>(&model, &Options { prefer, ..Options::default() }).expect("it fits").blob;
        let (blob, small) = (stored(Prefer::Speed), stored(Prefer::Size));
        let full = picture::<Full<K>>(blob.bytes()).expect("it has everything");
        assert_eq!(picture::<Full<K>>(small.bytes()), Some(full), "{} {name}: both layouts", K::NAME);
        if small != blob {
            shared += 1;
            assert!(small.bytes().len() < blob.bytes().len(), "{} {name}", K::NAME);
            let found = picture::<Without<K, 29>>(small.bytes());
            assert_eq!(found, Some(full), "{} draws {name} otherwise with shared vertices", K::NAME);
        }
        for (place, found) in without_each::<K>(blob.bytes()).into_iter().enumerate() {
            if let Some(found) = found {
                let bit = BITS[place];
                tried[place] += 1;
                assert_eq!(found, full, "{} draws {name} otherwise without the need of bit {bit}", K::NAME);
            }
        }
    }
    println!("{}: scenes that did without each need: {tried:?}", K::NAME);
    assert!(shared > 5, "{shared} scenes with shared vertices");
    assert!(tried.iter().filter(|&&count| count > 0).count() > 20, "{tried:?}");
}

#[test]
fn exact14_draws_the_same_without_what_a_scene_needs_not() {
    check::<Exact14>();
}

#[test]
fn hanika_c_draws_the_same_without_what_a_scene_needs_not() {
    check::<HanikaC>();
}
