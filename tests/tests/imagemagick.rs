//! The difference picture and its counts against ImageMagick, run as in the 2009 report.

use host_tools::compare::{compare, difference};
use host_tools::picture::Picture;
use std::path::Path;
use std::process::Command;

/// The name under which ImageMagick is installed: `magick` since version 7, `convert` before.
fn imagemagick() -> Option<&'static str> {
    ["magick", "convert"].into_iter().find(|name| {
        // Other programs bear these names too, so it must say what it is.
        let version = Command::new(name).arg("-version").output();
        version.is_ok_and(|said| said.status.success() && said.stdout.starts_with(b"Version: ImageMagick"))
    })
}

/// The report's command, word for word.
fn reported_difference(program: &str, a: &Picture, b: &Picture, folder: &Path) -> Picture {
    let [a_png, b_png, diff_png] = ["a.png", "b.png", "diff.png"].map(|name| folder.join(name));
    a.write_png(&a_png).unwrap();
    b.write_png(&b_png).unwrap();
    let status = Command::new(program)
        .args([&a_png, &b_png])
        .args(["-compose", "difference", "-composite", "-separate", "-background", "black", "-compose", "plus"])
        .arg("-flatten")
        .arg(&diff_png)
        .status()
        .unwrap();
    assert!(status.success());
    Picture::read_png(&diff_png).unwrap()
}

fn noise(seed: u32) -> Picture {
    let mut state = seed;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    Picture::from_fn(61, 47, |_, _| [byte(), byte(), byte()])
}

fn changed(picture: &Picture, change: impl Fn(usize, u8) -> u8) -> Picture {
    let mut changed = picture.clone();
    let bytes = changed.pixels_mut().as_flattened_mut();
    bytes.iter_mut().enumerate().for_each(|(i, byte)| *byte = change(i, *byte));
    changed
}

#[test]
fn difference_and_counts_are_imagemagicks() {
    let Some(program) = imagemagick() else {
        println!("skipped: ImageMagick is not installed (apt-get install imagemagick)");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let base = noise(1);
    let gray = Picture::from_fn(61, 47, |x, y| [(x * y % 256) as u8; 3]);
    let cases = [
        ("noise", base.clone(), noise(2)),
        ("off by one here and there", base.clone(), changed(&base, |i, byte| byte ^ u8::from(i % 5 == 0))),
        (
            "one channel, every value",
            base.clone(),
            changed(&base, |i, byte| if i % 3 == 1 { 255 - byte } else { byte }),
        ),
        ("around the thresholds", gray.clone(), changed(&gray, |i, byte| byte.wrapping_add((i % 23) as u8))),
        ("saturating", Picture::new(61, 47), changed(&base, |i, byte| byte | if i % 2 == 0 { 0xf0 } else { 0 })),
        ("black and white", Picture::new(61, 47), Picture::from_fn(61, 47, |_, _| [255; 3])),
        ("equal", base.clone(), base.clone()),
        ("gray noise", gray.clone(), changed(&gray, |i, byte| byte ^ (i as u8 / 3 % 7))),
    ];
    for (name, a, b) in &cases {
        let theirs = reported_difference(program, a, b, folder.path());
        assert!(theirs == difference(a, b).unwrap(), "{name}: the difference pictures differ");
        let over = |threshold| theirs.pixels().iter().filter(|pixel| pixel[0] > threshold).count() as u64;
        let ours = compare(a, b).unwrap();
        assert_eq!([ours.over_1, ours.over_4, ours.over_64], [over(1), over(4), over(64)], "{name}");
    }

    // The check itself: one unit in one channel of one pixel must show.
    let (_, a, b) = &cases[1];
    let nearly = changed(b, |i, byte| byte ^ u8::from(i == 1));
    assert!(reported_difference(program, a, &nearly, folder.path()) != difference(a, b).unwrap());
}
