//! Fuzzes [`tests::fuzz::blob`].

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| tests::fuzz::blob(data));
