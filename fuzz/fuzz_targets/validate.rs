//! Whatever the bytes: a report. And what the reader gives out, the validator has read the same.
#![no_main]

use bbrf::container::{Limits, read_bytes};
use bbrf::validate::validate_bytes;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let report = validate_bytes(bytes);
    if let Ok(opened) = read_bytes(bytes, &Limits::default()) {
        assert_eq!(report.digest.as_deref(), Some(opened.computed_digest.as_str()));
        assert!(opened.mismatched.is_empty() || !report.findings.is_empty(), "{:?}", opened.mismatched);
    }
});
