//! A small scene that is painted: textures of every kind, and colours of vertices.

use std::io::Cursor;

use core_rt::kernel::Kernel;
use host_tools::import::{Embedded, load_from};
use host_tools::model::Model;
use host_tools::prepare::{Blob, Options, prepare};
use host_tools::tree::TreeOptions;
use image::{DynamicImage, GrayImage, ImageFormat, RgbImage};

fn png(image: DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).expect("memory is all it takes");
    bytes.into_inner()
}

/// Five triangles of four materials: one with a texture of 3x2 colours, one of 2x5 grays and one whose file is that of the
/// first, and one without; one triangle of the first has no coordinates. Vertices have colours.
///
/// # Panics
/// Where it does not import.
#[must_use]
pub fn model() -> Model {
    const OBJ: &[u8] =
        b"mtllib s.mtl\nv 0 0 0 1 1 1\nv 4 0 0 1 0.5 0.25\nv 4 0 4 0 1 0\nv 0 0 4 1 1 1\nv 1 1 1 0 0 1\n\
        v 3 1 2 1 0.75 0\nv 2 3 2 0 0 0\nv 2 1 3 1 1 1\nvt 0 0\nvt 2.5 0\nvt 2.5 -3.25\nvt 0 1\n\
        usemtl tiles\nf 1/1 4/4 3/3\nf 1 3 2\nusemtl gray\nf 5/1 7/2 6/3\nusemtl same\nf 6/4 7/1 8/2\n\
        usemtl plain\nf 8/1 7/2 5/3\n";
    let colours = RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8 * 100, y as u8 * 200, 128]));
    let grays = GrayImage::from_fn(2, 5, |x, y| image::Luma([(x * 90 + y * 30) as u8]));
    let (colours, grays) = (png(colours.into()), png(grays.into()));
    let files: [(&str, &[u8]); 5] = [
        ("s.obj", OBJ),
        ("s.mtl", b"newmtl tiles\nmap_Kd a.png\nnewmtl gray\nmap_Kd b.png\nnewmtl same\nmap_Kd a.png\nKd 0.5 0.5 0.5\nnewmtl plain\nKd 0.9 0.2 0.1\n"),
        ("a.png", &colours),
        ("b.png", &grays),
        (
            "s.toml",
            b"model = 's.obj'\n[camera]\nposition = [1, 3, 8]\nlook_at = [2, 1, 2]\n[[light]]\nposition = [3, 5, 3]\n\
              [render]\nsize = [12, 9]\nambient = [0.1, 0.1, 0.1]\n",
        ),
    ];
    load_from(&Embedded(&files), "s.toml").expect("a good scene").model
}

/// [`model`] as a blob, a leaf for each triangle.
///
/// # Panics
/// Where it cannot be prepared.
#[must_use]
pub fn sample<K: Kernel>() -> Blob {
    let tree = TreeOptions { leaf_max: 1, leaf_always: true, ..TreeOptions::default() };
    prepare::<K>(&model(), &Options { tree, ..Options::default() }).expect("it fits every kernel").blob
}
