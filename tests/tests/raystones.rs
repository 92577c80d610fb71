//! The raystones scene on chips: what a pixel takes, beside what other tracers of the same scene publish. The README has the
//! table; `INTRAY_BLESS=1` renews it.
//!
//! It is skipped, with a line that says so, where chips cannot be emulated, or where the compiler is another than the one that
//! the README names: instructions are the compiler's.

use core_rt::exact::{Exact14, Exact29};
use core_rt::kernel::Kernel;
use firmware_rt::board::MICROBIT;
use host_tools::compare::compare;
use host_tools::engine;
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use tests::boards::counted;
use tests::chips::{Job, scene};
use tests::documents::{README, check_part, compiler, document, generated, is_blessing};

/// The size that everyone renders.
const SIZE: [u32; 2] = [40, 20];

/// Instructions a pixel that `exact14` may take on a Cortex-M0 and elsewhere, and the least PSNR.
const MOST: [u64; 2] = [4000, 2500];
const LEAST_DB: f64 = 36.0;

/// The model of cycles of the micro:bit's core.
const CORE: &str = "cortex-m0";

#[test]
fn the_readme_shows_what_raystones_takes() {
    let boards: Vec<_> = counted().collect();
    let is_other = !generated(&document(README), "raystones").expect("the README has the marks").contains(&compiler());
    if boards.len() < 2 || (is_other && !is_blessing()) {
        println!("skipped the figures of raystones: they are those of another compiler, or of chips that are not here");
        return;
    }
    let model = scene("raystones", SIZE);
    let truth = Reference::new(&model).picture(&|_| {});
    let pixels = SIZE.map(u64::from).iter().product::<u64>();
    let mut table = format!(
        "40x20 pixels, firmware by {}.\n\n| kernel | board | instructions a pixel | cycles a pixel | raystones | PSNR, dB |\n\
         | --- | --- | --- | --- | --- | --- |\n",
        compiler()
    );
    for kernel in [Exact14::NAME, Exact29::NAME, "f32"] {
        let engine = engine::by_name(kernel).expect("a kernel of this name");
        let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
        let picture = engine.render(blob.bytes(), [16, 16], &|_| {}).expect("a blob just made").picture;
        let psnr = compare(&picture, &truth).expect("one size").psnr.unwrap_or(f64::INFINITY);
        for (board, counter) in &boards {
            let counts = Job::new(board, &model, kernel, None).counts(counter);
            // Where the model knows no cycles, an instruction is one.
            let (cycles, how) = match counts.cycles.get(CORE) {
                Some(&cycles) if *board == &MICROBIT => (cycles, CORE),
                _ => (counts.instructions, "one an instruction"),
            };
            let a_pixel = |count: u64| count.div_ceil(pixels);
            table += &format!(
                "| `{kernel}` | {} | {} | {} ({how}) | {:.0} | {psnr:.1} |\n",
                board.name,
                a_pixel(counts.instructions),
                a_pixel(cycles),
                1e6 * pixels as f64 / cycles as f64,
            );
            if kernel == Exact14::NAME {
                let most = MOST[usize::from(*board != &MICROBIT)];
                assert!(
                    a_pixel(counts.instructions) <= most,
                    "{}: {} a pixel",
                    board.name,
                    a_pixel(counts.instructions)
                );
                assert!(psnr >= LEAST_DB, "{psnr} dB");
            }
        }
    }
    check_part(README, "raystones", &table, |a, b| a == b);
}
