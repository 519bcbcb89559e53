#![no_main]

// A decoder that panics is an error, and no finding.
libfuzzer_sys::fuzz_target!(
    init: rasterbook::files::silence_decoders(),
    |data: &[u8]| rasterbook_fuzz::model(data)
);
