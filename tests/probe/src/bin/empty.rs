//! Nothing but what every program here has; what another one has more is its own.
#![cfg_attr(target_os = "none", no_std, no_main)]

fn nothing() {}

probe::program!(nothing);
