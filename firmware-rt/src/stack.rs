//! How deep the stack was: painted before, looked at after.

use crate::board::Region;

/// Unlikely as a value, and odd, so no address of an object.
const PAINT: u32 = 0x5afe_c0d5;

/// What the painter itself may use below its caller, bytes.
const OWN: usize = 128;

/// Paints what is free of the stack.
///
/// # Safety
/// `stack` is the RAM that the running stack has, and nothing else lies there.
#[inline(never)]
pub unsafe fn paint(stack: Region) {
    let here = 0u32;
    let end = (&raw const here).addr() - OWN;
    for address in (stack.start as usize..end).step_by(4) {
        // SAFETY: below this frame by more than it needs, and in the stack's memory, so that nothing lies there.
        unsafe { core::ptr::without_provenance_mut::<u32>(address).write_volatile(PAINT) };
    }
}

/// The deepest that the stack was since it was painted, bytes.
///
/// # Safety
/// `stack` is the RAM that the running stack has.
#[inline(never)]
pub unsafe fn deepest(stack: Region) -> u32 {
    let words = stack.start..stack.end();
    // SAFETY: an aligned word of RAM, and any bits are a u32.
    let is_painted =
        |&address: &u32| unsafe { core::ptr::without_provenance::<u32>(address as usize).read_volatile() == PAINT };
    words.end - words.clone().step_by(4).find(|address| !is_painted(address)).unwrap_or(words.end)
}
