//! The header is decoded by a few lines of the tracer's own, and encoded by `postcard`: whatever bytes are given, `postcard`'s
//! decoder makes the same of them.

use core_rt::blob::{Header, PREFIX_SIZE, decode};
use core_rt::exact::{Exact14, Exact29};
use core_rt::hanika::HanikaC;
use core_rt::kernel::Kernel;
use tests::blobs::{Draft, sample, sample_with_spheres};

/// What `postcard` makes of the bytes, if it is all of them.
fn expected(bytes: &[u8]) -> Option<Header> {
    match postcard::take_from_bytes(bytes) {
        Ok((header, [])) => Some(header),
        _ => None,
    }
}

/// The bytes of a good header of a kernel, and of the same with numbers that are as long as can be.
fn encoded<K: Kernel>() -> impl Iterator<Item = Vec<u8>> {
    let blobs = [sample::<K>(false), sample::<K>(true), sample_with_spheres::<K>()];
    blobs.into_iter().flat_map(|blob| {
        let bytes = blob.bytes();
        let size = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        let mut header = Draft::<K>::read(bytes).expect("a good blob").header;
        header.camera.first = [i64::MIN, i64::MAX, -1];
        header.camera.eye = [i32::MIN, i32::MAX, 0];
        (header.size, header.samples, header.root) = ([u16::MAX; 2], u16::MAX, u32::MAX);
        header.source.origin_bits = [u64::MAX; 3];
        (header.ambient.mantissa, header.ambient.exponent) = ([u16::MAX; 3], i16::MIN);
        [bytes[PREFIX_SIZE..PREFIX_SIZE + size].to_vec(), postcard::to_stdvec(&header).expect("memory is all it takes")]
    })
}

#[test]
fn headers_are_what_postcard_makes_of_them() {
    let (mut good, mut bad) = (0, 0);
    let mut agree = |bytes: &[u8]| {
        let found = decode(bytes);
        assert_eq!(found, expected(bytes), "{bytes:02x?}");
        *if found.is_some() { &mut good } else { &mut bad } += 1;
    };
    for bytes in encoded::<Exact14>().chain(encoded::<Exact29>()).chain(encoded::<HanikaC>()) {
        agree(&bytes);
        agree(&[&bytes[..], &[0]].concat());
        for end in 0..bytes.len() {
            agree(&bytes[..end]);
        }
        for place in 0..bytes.len() {
            for value in 0..=u8::MAX {
                let mut other = bytes.clone();
                other[place] = value;
                agree(&other);
                // And with a group more, so that all that follows is elsewhere.
                other.insert(place, 0x80 | value);
                agree(&other);
            }
        }
    }
    assert!(good > 100_000 && bad > 100_000, "{good} {bad}");
}
