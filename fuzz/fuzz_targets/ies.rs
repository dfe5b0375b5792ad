#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| trove_fuzz::run_once("ies", data));
