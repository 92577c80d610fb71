//! Corners, vertices and material numbers that no mesh with shared vertices has.

use core_rt::blob::BlobError;
use core_rt::kernel::Kernel;
use core_rt::profile::{Need, Needs};
use tests::blobs::{Draft, sample, sample_with_shared_vertices};

use crate::{Damage, for_every_kernel, refused_of, verdict};

for_every_kernel!(samples_share, broken_corners, undecided_layouts);

fn samples_share<K: Kernel>() {
    for smooth in [false, true] {
        let blob = sample_with_shared_vertices::<K>(smooth);
        let draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
        assert!(draft.triangles.is_empty() && draft.corners.len() == 15 && draft.numbers.len() == 5);
        assert_eq!(draft.vertices.len(), 8);
        assert_eq!(verdict::<K>(blob.bytes()), Ok(()));
        assert_eq!(draft.write(), blob);
    }
}

fn broken_corners<K: Kernel>() {
    let cases: &[Damage<K>] = &[
        ("a corner beyond the last vertex", |d| d.corners[7] = 8, BlobError::Triangle { index: 2 }),
        ("a triangle without area", |d| d.corners[7] = d.corners[6], BlobError::Triangle { index: 2 }),
        ("a material that does not exist", |d| d.numbers[2] = 2, BlobError::Triangle { index: 2 }),
        ("an id that is not in the file", |d| d.ids[2] = d.header.file_triangles, BlobError::Triangle { index: 2 }),
        ("a vertex too few", |d| d.header.counts.vertices -= 1, BlobError::Sections),
    ];
    let blob = sample_with_shared_vertices::<K>(false);
    refused_of(&blob, cases);
    // A vertex off the grid is outside every box, or makes a triangle that the kernel has not.
    for corner in 0..15 {
        let mut draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
        let vertex = draft.corners[corner] as usize;
        draft.vertices[vertex] = K::vertex([K::MARGIN - 1; 3]);
        let said = verdict::<K>(draft.write().bytes());
        assert!(matches!(said, Err(BlobError::Bounds { .. })), "{corner}: {said:?}");
    }
}

fn with<K: Kernel>(draft: &mut Draft<K>, need: Need, wanted: bool) {
    let bits = draft.header.needs.bits();
    draft.header.needs = Needs::from_bits(if wanted { bits | need as u64 } else { bits & !(need as u64) });
}

fn undecided_layouts<K: Kernel>() {
    let neither: Damage<K> = (
        "triangles of no layout",
        |d| {
            with(d, Need::SharedVertices, false);
            with(d, Need::WholeTriangles, false);
        },
        BlobError::Sections,
    );
    let both: Damage<K> = (
        "triangles of two layouts",
        |d| {
            with(d, Need::SharedVertices, true);
            with(d, Need::WholeTriangles, true);
        },
        BlobError::Sections,
    );
    let no_vertices: Damage<K> = (
        "shared vertices that are not there",
        |d| (d.vertices, d.header.counts.vertices) = (Vec::new(), 0),
        BlobError::Sections,
    );
    refused_of(&sample::<K>(false), &[neither, both]);
    refused_of(&sample_with_shared_vertices::<K>(false), &[neither, both, no_vertices]);
}
