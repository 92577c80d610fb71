//! Fuzzes [`tests::fuzz::scene_toml`].

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| tests::fuzz::scene_toml(data));
