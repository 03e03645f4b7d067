#![no_main]

use finwright::drawing::read_dxf;
use fuzz_drawings::{fuzz, sort};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Some(drawing) = fuzz(bytes, read_dxf) {
        sort(drawing);
    }
});
