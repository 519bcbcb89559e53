#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| rasterbook_fuzz::polygon(data));
