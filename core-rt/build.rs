//! Says `prefer_size` where the compiler is told to prefer size: what is then out of line and there once is inlined, or
//! looked up, otherwise. The results are the same.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(prefer_size)");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level == "s" || level == "z") {
        println!("cargo::rustc-cfg=prefer_size");
    }
}
