//! What a scene takes is what it takes on every board of an instruction set, so that one board can stand for all chips of it.

use std::time::Duration;

use chip_fit::core::Isa;
use chip_fit::need::measure;
use firmware_rt::board::{MICROBIT, ROOMY};
use host_tools::builtin;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::firmware::Wanted;
use host_tools::emulate::machine::Machine;
use host_tools::emulate::{self, Run};
use host_tools::engine;
use host_tools::import::{Embedded, load_from};
use host_tools::prepare::Options;

const LIMIT: Duration = Duration::from_secs(600);

#[test]
fn more_memory_changes_neither_the_picture_nor_its_instructions() {
    if let Err(error) = emulate::check(&MICROBIT) {
        println!("skipped: {error}");
        return;
    }
    let mut model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    model.render.size = [48, 36];
    let engine = engine::by_name("exact14").unwrap();
    let prepared = engine.prepare(&model, &Options::default()).unwrap();
    let blob = prepared.blob.bytes();
    let counter = Counter::provide(&Machine::of(&MICROBIT).unwrap()).unwrap();
    let [small, roomy] = [&MICROBIT, &ROOMY].map(|board| {
        let elf = Wanted { board, blob, hits: None, count: false }.provide().unwrap();
        let run = Run { board, elf: &elf, blob: Some(blob), counter: Some(&counter), limit: LIMIT };
        let outcome = run.perform(&mut Vec::new()).unwrap();
        let counts = outcome.counts.unwrap();
        (outcome.picture.crc32(), counts.instructions, counts.cycles, outcome.report.stack_bytes, elf.text_bytes)
    });
    assert_eq!((small.0, small.1, &small.2), (roomy.0, roomy.1, &roomy.2));
    // Around the drawing the compiler pushes a pair of registers more or less, as constants are other ones.
    assert!(small.3.abs_diff(roomy.3) <= 16, "{} and {}", small.3, roomy.3);
    let picture = engine.render(blob, [16, 16], &|_| ()).unwrap().picture;
    assert_eq!(small.0, picture.crc32(), "the host's");

    // And that is what is measured.
    let need = measure(Isa::Thumbv6m, blob, engine.id(), LIMIT, &mut Vec::new()).unwrap().need;
    assert_eq!((need.instructions, need.cycles), (Some(small.1), small.2));
    assert_eq!((need.stack_bytes, need.text_bytes), (small.3.into(), small.4));
    assert_eq!((need.scene_bytes, need.board), (blob.len() as u64, "microbit"));
}
