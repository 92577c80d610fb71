//! The RP2040's second boot stage and its clocks. Built and checked, and not yet run on hardware.

use rp_pac::clocks::vals::{ClkRefCtrlSrc, ClkSysCtrlAuxsrc, ClkSysCtrlSrc};
use rp_pac::xosc::vals::{CtrlFreqRange, Enable};
use rp_pac::{CLOCKS, PLL_SYS, RESETS, XOSC};

/// What the boot ROM copies from the first 256 bytes of the flash, checks by their CRC-32 and runs: it sets the Pico's flash
/// (a W25Q16JV, which takes the commands of a W25Q080) up to be read as memory, and goes on to what lies behind it.
#[used]
#[unsafe(link_section = ".boot")]
static BOOT: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

/// The crystal's start-up delay, about 1 ms in steps of 256 periods at 12 MHz (data sheet, 2.16).
const CRYSTAL_DELAY: u16 = 47;

/// The phase-locked loop: 12 MHz times 125 is 1500 MHz, and that by 6 and by 2 is 125 MHz (data sheet, 2.18).
const FEEDBACK: u16 = 125;
const DIVIDERS: [u8; 2] = [6, 2];

/// The core's clock from the crystal at 125 MHz, instead of from the ring oscillator at about 6 MHz; the order of steps is
/// that of the RP2040's data sheet, 2.15, 2.16 and 2.18. A debugger resets the core and not the clocks, so that they may run
/// already.
pub(super) fn start_clocks() {
    XOSC.ctrl().write(|ctrl| ctrl.set_freq_range(CtrlFreqRange::_1_15MHZ));
    XOSC.startup().write(|startup| startup.set_delay(CRYSTAL_DELAY));
    XOSC.ctrl().modify(|ctrl| ctrl.set_enable(Enable::ENABLE));
    while !XOSC.status().read().stable() {}

    // Away from the loop before it is touched: the core by the reference, and the reference by the crystal. What is
    // selected is told one-hot.
    CLOCKS.clk_sys_ctrl().modify(|ctrl| ctrl.set_src(ClkSysCtrlSrc::CLK_REF));
    while CLOCKS.clk_sys_selected().read() != 1 << ClkSysCtrlSrc::CLK_REF.to_bits() {}
    CLOCKS.clk_ref_ctrl().modify(|ctrl| ctrl.set_src(ClkRefCtrlSrc::XOSC_CLKSRC));
    while CLOCKS.clk_ref_selected().read() != 1 << ClkRefCtrlSrc::XOSC_CLKSRC.to_bits() {}

    RESETS.reset().modify(|reset| reset.set_pll_sys(true));
    RESETS.reset().modify(|reset| reset.set_pll_sys(false));
    while !RESETS.reset_done().read().pll_sys() {}
    PLL_SYS.cs().modify(|cs| cs.set_refdiv(1));
    PLL_SYS.fbdiv_int().write(|fbdiv| fbdiv.set_fbdiv_int(FEEDBACK));
    PLL_SYS.pwr().modify(|power| {
        power.set_pd(false);
        power.set_vcopd(false);
    });
    while !PLL_SYS.cs().read().lock() {}
    PLL_SYS.prim().write(|dividers| {
        dividers.set_postdiv1(DIVIDERS[0]);
        dividers.set_postdiv2(DIVIDERS[1]);
    });
    PLL_SYS.pwr().modify(|power| power.set_postdivpd(false));

    CLOCKS.clk_sys_ctrl().modify(|ctrl| ctrl.set_auxsrc(ClkSysCtrlAuxsrc::CLKSRC_PLL_SYS));
    CLOCKS.clk_sys_ctrl().modify(|ctrl| ctrl.set_src(ClkSysCtrlSrc::CLKSRC_CLK_SYS_AUX));
    while CLOCKS.clk_sys_selected().read() != 1 << ClkSysCtrlSrc::CLKSRC_CLK_SYS_AUX.to_bits() {}
}
