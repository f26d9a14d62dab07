//! What C gets: a status and the report as `bbrf validate --json` prints it.

use std::ffi::CString;
use std::path::Path;

use bbrf_core::validate::{Checked, Grading, PROFILES, Status, form, validate_bytes, validate_file};

/// How the bytes of a caller are called in a report.
const BYTES: &str = "(bytes)";

fn grading() -> Grading {
    PROFILES.first().map_or_else(Grading::default, Grading::of)
}

pub(crate) fn of_file(path: &Path) -> (i32, Option<CString>) {
    answer(&validate_file(path, &grading()))
}

pub(crate) fn of_bytes(bytes: &[u8]) -> (i32, Option<CString>) {
    answer(&Checked::new(BYTES.to_owned(), validate_bytes(bytes), &grading()))
}

fn answer(checked: &Checked) -> (i32, Option<CString>) {
    let status = match checked.status {
        Status::Valid => 0,
        Status::Invalid => 1,
        Status::Unreadable => 2,
    };
    let json = form::json(std::slice::from_ref(checked)).ok().and_then(|json| CString::new(json).ok());
    (status, json)
}
