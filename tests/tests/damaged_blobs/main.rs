//! Blobs that were cut, flipped, added to or made up: each is refused by name, or it is a scene that renders.
//!
//! Overflow checks are on in the profile that tests run under: where an accepted scene makes the core compute beyond
//! its ranges, the test fails.

mod bytes;
mod cameras;
mod contents;
mod extremes;
mod headers;
mod paint;
mod shared;
mod spheres;
mod trees;

use core_rt::blob::BlobError;
use core_rt::kernel::Kernel;
use core_rt::profile::Full;
use core_rt::scene::Scene;
use host_tools::prepare::Blob;
use tests::blobs::{Draft, corners, sample};

/// Makes tests of functions that are generic over the kernel, one for each kernel.
macro_rules! for_every_kernel {
    ($($name:ident),* $(,)?) => {
        mod exact14 { $(#[test] fn $name() { super::$name::<core_rt::exact::Exact14>(); })* }
        mod exact20 { $(#[test] fn $name() { super::$name::<core_rt::exact::Exact20>(); })* }
        mod exact29 { $(#[test] fn $name() { super::$name::<core_rt::exact::Exact29>(); })* }
    };
}
use for_every_kernel;

for_every_kernel!(samples_are_good);

/// What is said of a blob; of an accepted one, after it has rendered.
fn verdict<K: Kernel>(bytes: &[u8]) -> Result<(), BlobError> {
    let scene = Scene::<Full<K>>::new_checked(bytes)?;
    corners(&scene);
    Ok(())
}

/// What is done to a blob, in words and in deed, and what is to be said of it.
type Damage<K> = (&'static str, fn(&mut Draft<K>), BlobError);

/// Asserts what is said of the sample with each of some changes made to it.
fn refused<K: Kernel>(smooth: bool, cases: &[Damage<K>]) {
    refused_of(&sample::<K>(smooth), cases);
}

/// Asserts what is said of a good blob with each of some changes made to it.
fn refused_of<K: Kernel>(good: &Blob, cases: &[Damage<K>]) {
    for (name, damage, expected) in cases {
        let mut draft = Draft::read(good.bytes()).expect("a good blob");
        damage(&mut draft);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(*expected), "{name}");
    }
}

fn samples_are_good<K: Kernel>() {
    for blob in [sample::<K>(false), sample::<K>(true)] {
        assert_eq!(verdict::<K>(blob.bytes()), Ok(()));
        let draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
        assert_eq!(draft.write(), blob, "taken apart and put together");
        assert_eq!((draft.nodes.len(), draft.triangles.len(), draft.lights.len()), (4, 5, 2));
    }
}
