//! The profile of the blob, as firmware has it.

use std::path::PathBuf;
use std::{env, fs, io};

use firmware_rt::build::{BLOB_VARIABLE, DEFAULT_BLOB, Traits};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-env-changed={BLOB_VARIABLE}");
    let path = env::var_os(BLOB_VARIABLE).map_or_else(|| DEFAULT_BLOB.into(), PathBuf::from);
    println!("cargo::rerun-if-changed={}", path.display());
    let wrong = |what: &str| io::Error::other(format!("{}: {what}", path.display()));
    let mut traits = Traits::of(&fs::read(&path)?).ok_or_else(|| wrong("not a blob"))?;
    println!("cargo::rerun-if-env-changed=PROBE_NEEDS");
    if let Ok(needs) = env::var("PROBE_NEEDS") {
        traits.needs = u32::from_str_radix(&needs, 16).unwrap();
        traits.depth = 16;
        traits.branches = if traits.needs & (3 << 12) != 0 { 4 } else { 0 };
    }
    let kernel = traits.kernel_path().ok_or_else(|| wrong("no firmware has this blob's kernel"))?;
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or_else(|| wrong("no OUT_DIR"))?);
    fs::write(out.join("profile.rs"), profile(kernel, &traits))
}

/// The Rust of a profile: its kernel, its needs, the levels of its trees, and the rays that may wait.
fn profile(kernel: &str, Traits { needs, depth, branches, .. }: &Traits) -> String {
    let prefer = if env::var("OPT_LEVEL").is_ok_and(|level| level == "s" || level == "z") { "Size" } else { "Speed" };
    format!(
        "type Kernel = {kernel};\n\
         const DEPTH: usize = {depth};\n\
         const BRANCHES: usize = {branches};\n\
         \n\
         #[derive(Clone, Copy, Debug, Default)]\n\
         struct This;\n\
         \n\
         impl core_rt::profile::Profile for This {{\n    \
         type Kernel = Kernel;\n    \
         const NEEDS: core_rt::profile::Needs = core_rt::profile::Needs::from_bits({needs:#x});\n    \
         const PREFER: core_rt::profile::Prefer = core_rt::profile::Prefer::{prefer};\n}}\n"
    )
}
