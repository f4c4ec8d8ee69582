#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| bidir_fuzz::serialized(data));
