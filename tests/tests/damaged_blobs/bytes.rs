//! Damage that knows nothing of the format: lengths, bits, addresses.

use core_rt::blob::{BlobError, PREFIX_SIZE};
use core_rt::kernel::Kernel;
use host_tools::prepare::Blob;
use tests::blobs::{repaired, sample, sample_with_spheres};

use crate::{for_every_kernel, verdict};

for_every_kernel!(
    cut_anywhere,
    every_byte_flipped,
    every_byte_flipped_and_signed_again,
    followed_by_something,
    misaligned
);

fn samples<K: Kernel>() -> [Blob; 3] {
    [sample::<K>(false), sample::<K>(true), sample_with_spheres::<K>()]
}

fn cut_anywhere<K: Kernel>() {
    for blob in samples::<K>() {
        let whole = blob.bytes();
        for length in 0..whole.len() {
            let expected = if length < PREFIX_SIZE { 32 } else { whole.len() as u64 };
            let cut = Blob::from_bytes(&whole[..length]);
            assert_eq!(verdict::<K>(cut.bytes()), Err(BlobError::Truncated { expected, found: length as u64 }));
            let signed = repaired(&whole[..length], K::ID);
            let said = verdict::<K>(signed.bytes());
            assert!(matches!(said, Err(BlobError::Header | BlobError::Sections)), "{length}: {said:?}");
        }
    }
}

/// The bytes with one of them changed, in the nine ways that are tried.
fn flips(bytes: &[u8]) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let masks = (0..8).map(|bit| 1 << bit).chain([0xff]);
    (0..bytes.len()).flat_map(move |place| {
        masks.clone().map(move |mask: u8| {
            let mut flipped = bytes.to_vec();
            flipped[place] ^= mask;
            (place, flipped)
        })
    })
}

fn every_byte_flipped<K: Kernel>() {
    for blob in samples::<K>() {
        for (place, flipped) in flips(blob.bytes()) {
            let said = verdict::<K>(Blob::from_bytes(&flipped).bytes());
            let as_expected = match (place, said) {
                (0..8, said) => said == Err(BlobError::Foreign),
                (8..10, Err(BlobError::Version { .. })) => true,
                (10..12, Err(BlobError::Kernel { expected, .. })) => expected == K::ID,
                (16..20, Err(BlobError::Truncated { .. } | BlobError::Oversized { .. })) => true,
                (12..16 | 20.., Err(BlobError::Checksum { stated, computed })) => stated != computed,
                _ => false,
            };
            assert!(as_expected, "byte {place}: {said:?}");
        }
    }
}

fn every_byte_flipped_and_signed_again<K: Kernel>() {
    for blob in samples::<K>() {
        let mut accepted = 0;
        for (_, flipped) in flips(blob.bytes()) {
            accepted += u32::from(verdict::<K>(repaired(&flipped, K::ID).bytes()).is_ok());
        }
        // A colour may be any, and what was repaired is as it was; geometry may be hardly anything else.
        assert!((100..4_000).contains(&accepted), "{accepted} were accepted");
    }
}

fn followed_by_something<K: Kernel>() {
    for blob in samples::<K>() {
        for more in 1..=16 {
            let longer = [blob.bytes(), &vec![0; more]].concat();
            let (expected, found) = (blob.bytes().len() as u64, longer.len() as u64);
            let said = verdict::<K>(Blob::from_bytes(&longer).bytes());
            assert_eq!(said, Err(BlobError::Oversized { expected, found }));
            // The old checksum is then in a section's place, or in the trailer's.
            let said = verdict::<K>(repaired(&longer, K::ID).bytes());
            assert!(matches!(said, Err(BlobError::Header | BlobError::Sections)), "{more}: {said:?}");
        }
    }
}

fn misaligned<K: Kernel>() {
    let blob = sample::<K>(false);
    for offset in 1..8 {
        let moved = Blob::from_bytes(&[&vec![0; offset], blob.bytes()].concat());
        assert_eq!(verdict::<K>(&moved.bytes()[offset..]), Err(BlobError::Misaligned));
    }
}
