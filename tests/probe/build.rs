//! The profile of the blob, as firmware has it, or one of other needs.

use std::path::PathBuf;
use std::{env, fs, io};

use firmware_rt::build::{BLOB_VARIABLE, DEFAULT_BLOB, NEEDS_VARIABLE, Traits, prefer};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-env-changed={BLOB_VARIABLE}");
    println!("cargo::rerun-if-env-changed={NEEDS_VARIABLE}");
    let asked = env::var_os(BLOB_VARIABLE).filter(|path| !path.is_empty());
    let path = asked.map_or_else(|| DEFAULT_BLOB.into(), PathBuf::from);
    println!("cargo::rerun-if-changed={}", path.display());
    let wrong = |what: &str| io::Error::other(format!("{}: {what}", path.display()));
    let mut traits = Traits::of(&fs::read(&path)?).ok_or_else(|| wrong("not a blob"))?;
    if let Some(needs) = env::var(NEEDS_VARIABLE).ok().filter(|needs| !needs.is_empty()) {
        traits.needs = u64::from_str_radix(&needs, 16).map_err(io::Error::other)?;
    }
    let kernel = traits.kernel_path().ok_or_else(|| wrong("no firmware has this blob's kernel"))?;
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or_else(|| wrong("no OUT_DIR"))?);
    fs::write(out.join("profile.rs"), profile(kernel, &traits))
}

/// The Rust of a profile: its kernel, its needs, the levels of its trees, and the rays that may wait.
fn profile(kernel: &str, Traits { needs, depth, branches, .. }: &Traits) -> String {
    let prefer = prefer();
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
         type Walk<'a> = core_rt::bvh::InPlace;\n    \
         const NEEDS: core_rt::profile::Needs = core_rt::profile::Needs::from_bits({needs:#x});\n    \
         const PREFER: core_rt::profile::Prefer = core_rt::profile::Prefer::{prefer:?};\n}}\n"
    )
}
