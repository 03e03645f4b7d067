#![no_main]

use finwright::drawing::read_pdf;
use fuzz_drawings::{fuzz, sort};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    fuzz(bytes, read_pdf).into_iter().flatten().for_each(sort);
});
