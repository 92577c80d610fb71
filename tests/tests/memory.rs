//! What `intray prep` takes of memory: under 200 bytes a triangle at the peak, from the text of an OBJ to the blob.
//!
//! Counted are bytes that the program has asked for and not given back, above those before: no time, no pages, no machine. All is
//! one test, since whatever else ran beside it would be counted with it.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write as _;
use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Parser;
use host_tools::cli::SceneArguments;

/// The system's allocator, counted.
struct Counted;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn taken(bytes: usize) {
    let live = LIVE.fetch_add(bytes, Ordering::Relaxed) + bytes;
    PEAK.fetch_max(live, Ordering::Relaxed);
}

// SAFETY: all of it is the system's.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        taken(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        taken(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        taken(size);
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(place, layout, size) }
    }
}

#[global_allocator]
static COUNTED: Counted = Counted;

/// Bytes at the peak of some work, above those before.
fn peak(work: impl FnOnce()) -> usize {
    let before = LIVE.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    work();
    PEAK.load(Ordering::Relaxed) - before
}

#[derive(Debug, Parser)]
struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
}

/// A square of hills of `2 n^2` smooth triangles.
fn hills(n: usize) -> String {
    let (mut text, side) = (String::new(), n + 1);
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let height = (x * x * 3 + y * y * 5 + x * y) % 97;
        writeln!(text, "v {x} {y} 0.{height:02}\nvn 0.{height:02} -0.1 1").expect("a string");
    }
    for (x, y) in (0..n).flat_map(|y| (0..n).map(move |x| (x, y))) {
        let [a, b, c, d] = [0, 1, side, side + 1].map(|corner| y * side + x + corner + 1);
        writeln!(text, "f {a}//{a} {b}//{b} {d}//{d} {c}//{c}").expect("a string");
    }
    text
}

#[test]
fn preparing_takes_under_200_bytes_a_triangle() {
    let megabyte = peak(|| drop(black_box(vec![0u8; 1 << 20])));
    assert!((1 << 20..2 << 20).contains(&megabyte), "a megabyte is counted as {megabyte} bytes");

    let n = 224;
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hills.obj");
    std::fs::write(&file, hills(n)).expect("a file");
    let name = file.to_str().expect("UTF-8");
    // Parts of a tree that threads build are joined in the end: by two threads always.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
    for kernel in ["exact14", "exact29", "auto"] {
        for prefer in ["speed", "size"] {
            let arguments = ["prep", name, "--kernel", kernel, "--prefer", prefer];
            let scene = Arguments::parse_from(arguments).scene;
            let mut bytes = 0;
            let peak = peak(|| bytes = pool.install(|| scene.load_for_chip()).expect("hills").blob.bytes().len());
            let each = |bytes: usize| bytes as f64 / (2 * n * n) as f64;
            println!("{kernel}, {prefer}: {:.1} bytes a triangle, {:.1} of them the blob's", each(peak), each(bytes));
            assert!(peak > bytes && each(peak) < 200.0, "{kernel}, {prefer}: {} bytes a triangle", each(peak));
        }
    }
}
