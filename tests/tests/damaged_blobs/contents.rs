//! Triangles, materials, lights and normals that no scene has.

use core_rt::blob::BlobError;
use core_rt::kernel::Kernel;
use core_rt::profile::Need;
use core_rt::record::{Checker, Light, Lustre, Reach};
use core_rt::space::Space;
use tests::blobs::{Draft, sample, sample_with_ids_in_records};
use zerocopy::{FromZeros, IntoBytes};

use crate::{for_every_kernel, refused, verdict};

for_every_kernel!(broken_triangles, broken_ids_in_records, broken_shading);

fn broken_triangles<K: Kernel>() {
    let third = BlobError::Triangle { index: 2 };
    refused::<K>(
        true,
        &[
            (
                "a material that does not exist",
                |d| d.triangles[2] = d.triangle(&K::vertices(&d.triangles[2]), 2).expect("it can be packed"),
                third,
            ),
            (
                "no materials",
                |d| (d.materials, d.header.counts.materials) = (Vec::new(), 0),
                BlobError::Triangle { index: 0 },
            ),
            (
                "a normal that is not that of its corners",
                |d| {
                    // v0, e1, e2, n and meta are thirteen numbers of one width; this is n's first.
                    let width = size_of::<K::Triangle>() / 13;
                    d.triangles[2].as_mut_bytes()[9 * width] ^= 1;
                },
                third,
            ),
            ("a normal beyond the last", |d| d.normal_indices[3 * 2 + 1] = d.header.counts.normals, third),
            (
                "one corner of three without a normal",
                |d| {
                    d.normal_indices[6..9].copy_from_slice(&[0; 3]);
                    d.normal_indices[7] = u16::MAX.into();
                },
                third,
            ),
            ("an id that is not in the file", |d| d.ids[2] = d.header.file_triangles, third),
            ("a file without triangles", |d| d.header.file_triangles = 0, BlobError::Triangle { index: 0 }),
        ],
    );
    // Zeros have no area and lie in a corner of the grid, which some box must be made to hold.
    let mut draft = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    draft.triangles[2] = K::Triangle::new_zeroed();
    let said = verdict::<K>(draft.write().bytes());
    assert!(matches!(said, Err(BlobError::Bounds { .. } | BlobError::Triangle { index: 2 })), "{said:?}");
}

fn broken_ids_in_records<K: Kernel>() {
    let good = sample_with_ids_in_records::<K>(false);
    assert_eq!(verdict::<K>(good.bytes()), Ok(()));
    let renumbered = |number: u32| {
        let mut draft = Draft::<K>::read(good.bytes()).expect("a good blob");
        assert!(draft.ids.is_empty() && draft.header.material_bits == 1);
        draft.triangles[2] = draft.triangle(&K::vertices(&draft.triangles[2]), number).expect("it can be packed");
        verdict::<K>(draft.write().bytes())
    };
    assert_eq!(renumbered(4 << 1 | 1), Ok(()));
    assert_eq!(renumbered(5 << 1), Err(BlobError::Triangle { index: 2 }), "an id that is not in the file");
    let mut draft = Draft::<K>::read(good.bytes()).expect("a good blob");
    draft.header.material_bits = 31;
    assert_eq!(verdict::<K>(draft.write().bytes()), Err(BlobError::Sections), "no bits are left for ids");
    draft.header.material_bits = 2;
    assert!(
        matches!(verdict::<K>(draft.write().bytes()), Err(BlobError::Triangle { .. })),
        "materials that are not there"
    );
}

/// The place in the sample of the light of a kind.
fn light<K: Kernel>(draft: &mut Draft<K>, kind: u32) -> &mut Light {
    draft.lights.iter_mut().find(|light| light.kind == kind).expect("one of each")
}

/// Gives the sample a lustre that changes nothing, and rays that go on.
fn shiny<K: Kernel>(draft: &mut Draft<K>) -> &mut Lustre {
    draft.lustres = vec![Lustre { eta_q28: [1 << 28; 2], ..Lustre::new_zeroed() }];
    (draft.header.counts.lustres, draft.header.max_depth) = (1, 4);
    draft.materials[1].lustre = 1;
    &mut draft.lustres[0]
}

/// Gives the sample a pattern of cubes.
fn checkered<K: Kernel>(draft: &mut Draft<K>) -> &mut Checker {
    draft.checkers = vec![Checker::new_zeroed()];
    draft.header.counts.checkers = 1;
    draft.materials[1].checker = 1;
    &mut draft.checkers[0]
}

/// Gives the sample's point light a reach.
fn reach<K: Kernel>(draft: &mut Draft<K>, mantissa: u16, exponent: i16) {
    light(draft, Light::POINT).reach = Reach { mantissa, exponent };
}

fn broken_shading<K: Kernel>() {
    refused::<K>(
        true,
        &[
            ("a background too bright", |d| d.header.background[1].exponent = 16, BlobError::Shading),
            ("ambient light too dim", |d| d.header.ambient.exponent = -16, BlobError::Shading),
            ("an emission out of range", |d| d.materials[1].emission.exponent = i16::MAX, BlobError::Shading),
            ("a light out of range", |d| d.lights[0].radiance.exponent = i16::MIN, BlobError::Shading),
            (
                "a sky that is not declared",
                |d| d.header.background[1].mantissa[0] ^= 1,
                BlobError::Undeclared(Need::Sky),
            ),
            ("a lustre that does not exist", |d| d.materials[0].lustre = 1, BlobError::Shading),
            (
                "a roughness that is not declared",
                |d| {
                    d.header.needs = d.header.needs.with(Need::Reflection, true).with(Need::Bounces, true);
                    let lustre = shiny(d);
                    (lustre.reflected, lustre.roughness) = ([1; 3], 1);
                },
                BlobError::Undeclared(Need::Roughness),
            ),
            (
                "paths in ambient light",
                |d| {
                    d.header.needs = d.header.needs.with(Need::Paths, true).with(Need::Ambient, true);
                    d.header.ambient.mantissa = [0, 1, 0];
                    // Corners of pixels are in range where all are one point.
                    (d.header.camera.right, d.header.camera.down) = ([0; 3], [0; 3]);
                },
                BlobError::Shading,
            ),
            ("a law of highlights from the future", |d| shiny(d).flags = 8, BlobError::Shading),
            ("highlights that are too bright", |d| shiny(d).gain = 16, BlobError::Shading),
            ("an index of refraction of nothing", |d| shiny(d).eta_q28[1] = 0, BlobError::Shading),
            ("a mirror that is not declared", |d| shiny(d).reflected[2] = 1, BlobError::Undeclared(Need::Reflection)),
            (
                "glass that is not declared",
                |d| {
                    shiny(d).refracted[0] = 1;
                    d.header.needs = d.header.needs.with(Need::Reflection, true);
                },
                BlobError::Undeclared(Need::Refraction),
            ),
            (
                "glass of which it is not declared that it mirrors",
                |d| {
                    shiny(d).refracted[0] = 1;
                    d.header.needs = d.header.needs.with(Need::Refraction, true);
                },
                BlobError::Undeclared(Need::Reflection),
            ),
            ("a highlight that is not declared", |d| shiny(d).specular[1] = 1, BlobError::Undeclared(Need::BlinnPhong)),
            (
                "tinted glass that is not declared",
                |d| shiny(d).shadow[2] = 1,
                BlobError::Undeclared(Need::TintedShadow),
            ),
            (
                "mirror images of mirror images that are not declared",
                |d| {
                    shiny(d).reflected[2] = 1;
                    d.header.needs = d.header.needs.with(Need::Reflection, true);
                },
                BlobError::Undeclared(Need::Bounces),
            ),
            ("metal that is not declared", |d| shiny(d).flags = Lustre::METAL, BlobError::Undeclared(Need::Schlick)),
            ("a checker that does not exist", |d| d.materials[1].checker = 1, BlobError::Shading),
            ("a checker from the future", |d| checkered(d).reserved = 1, BlobError::Shading),
            ("a checker that is not declared", |d| checkered(d).other[0] = 1, BlobError::Undeclared(Need::Checker)),
            ("a light that fades undeclared", |d| reach(d, 1 << 15, 0), BlobError::Undeclared(Need::Falloff)),
            ("a reach that has not all its bits", |d| reach(d, (1 << 15) - 1, 0), BlobError::Shading),
            ("a reach beyond all", |d| reach(d, 1 << 15, 257), BlobError::Shading),
            ("more depth than any scene has", |d| d.header.max_depth = 65, BlobError::Header),
            ("a kind of light from the future", |d| d.lights[1].kind = 2, BlobError::Shading),
            ("a direction of length zero", |d| light(d, Light::DIRECTIONAL).place = [0; 3], BlobError::Shading),
            ("a direction too long", |d| light(d, Light::DIRECTIONAL).place = [i32::MIN; 3], BlobError::Shading),
            ("a direction of length 1.01", |d| light(d, Light::DIRECTIONAL).place = [0, 1_084_479_242, 0], {
                BlobError::Shading
            }),
            ("a light too far off", |d| light(d, Light::POINT).place[2] += K::SPAN, BlobError::Origin),
            ("a light below all", |d| light(d, Light::POINT).place[0] = i32::MIN, BlobError::Origin),
            ("a normal of length zero", |d| d.normals[1] = K::Space::normal([0; 3]), BlobError::Shading),
            ("a normal of length 2", |d| d.normals[0].as_mut_bytes().fill(0x7f), BlobError::Shading),
        ],
    );
}
