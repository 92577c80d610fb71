//! What no firmware should do, on purpose: the host must hear of it, and the run must end.

use core_rt::exact::Exact14;
use core_rt::kernel::Kernel;

use crate::board::Board;
use crate::end::end;
use crate::status::Status;
use crate::transport::Link;

/// Does what the first word in the blob's place, that of the default blob's kernel, asks for.
pub fn misbehave(board: &Board) -> ! {
    let _link = Link::start();
    // SAFETY: an aligned word of flash, which is there whether or not anything was put into it.
    let asked = unsafe { core::ptr::without_provenance::<u32>(board.blob(Exact14::ID).start as usize).read_volatile() };
    defmt::info!("misbehaving: {=u32}", asked);
    match asked {
        1 => overflow(1),
        2 => loop {
            core::hint::spin_loop();
        },
        3 => panic!(),
        // SAFETY: none; nothing is mapped there, which is what it is for.
        4 => unsafe { core::ptr::without_provenance_mut::<u32>(0xe000_0000_usize - 4).write_volatile(0) },
        _ => {}
    }
    end(Status::Done, || ())
}

/// Uses stack until there is none left.
#[inline(never)]
#[expect(unconditional_recursion, reason = "it is what it is for")]
fn overflow(depth: u32) {
    let frame = core::hint::black_box([depth; 16]);
    overflow(frame[0] + 1);
    core::hint::black_box(frame);
}
