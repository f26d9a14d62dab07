//! The functions of `include/bbrf.h`. Every unsafe line of the package is here, and each rests on what the header asks of
//! the caller: texts end in NUL, pointers point to what the names say, a report is freed once and by `bbrf_free`.
//! A panic does not cross into C: it ends as status 2 without a report.

use std::ffi::{CStr, CString, c_char, c_int};
use std::panic::catch_unwind;
use std::path::PathBuf;

use crate::report::{of_bytes, of_file};

/// Status of what could not be read, and of a defect.
const UNREADABLE: c_int = 2;

/// Validates the file of that name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bbrf_validate(path: *const c_char, json_report: *mut *mut c_char) -> c_int {
    // SAFETY: the caller gives NULL or a text that ends in NUL.
    let path = if path.is_null() { PathBuf::new() } else { path_of(unsafe { CStr::from_ptr(path) }) };
    // SAFETY: the caller gives NULL or a place for a pointer.
    unsafe { hand_over(catch_unwind(|| of_file(&path)).ok(), json_report) }
}

/// Validates bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bbrf_validate_bytes(bytes: *const u8, length: usize, json_report: *mut *mut c_char) -> c_int {
    let fits = isize::try_from(length).is_ok();
    let bytes = if bytes.is_null() || !fits {
        &[]
    } else {
        // SAFETY: the caller gives `length` readable bytes, which do not change meanwhile.
        unsafe { std::slice::from_raw_parts(bytes, length) }
    };
    // SAFETY: the caller gives NULL or a place for a pointer.
    unsafe { hand_over(catch_unwind(|| of_bytes(bytes)).ok(), json_report) }
}

/// Frees a report.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bbrf_free(json_report: *mut c_char) {
    if !json_report.is_null() {
        // SAFETY: it came from `CString::into_raw` below, and the caller frees it once.
        drop(unsafe { CString::from_raw(json_report) });
    }
}

/// The version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn bbrf_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// # Safety
/// `target` is NULL or points to a place for a pointer.
unsafe fn hand_over(answer: Option<(c_int, Option<CString>)>, target: *mut *mut c_char) -> c_int {
    let (status, report) = answer.unwrap_or((UNREADABLE, None));
    if !target.is_null() {
        let report = report.map_or(std::ptr::null_mut(), CString::into_raw);
        // SAFETY: as this function asks.
        unsafe { target.write(report) };
    }
    status
}

#[cfg(unix)]
fn path_of(text: &CStr) -> PathBuf {
    use std::os::unix::ffi::OsStrExt;
    PathBuf::from(std::ffi::OsStr::from_bytes(text.to_bytes()))
}

/// Elsewhere names are UTF-8.
#[cfg(not(unix))]
fn path_of(text: &CStr) -> PathBuf {
    PathBuf::from(text.to_string_lossy().into_owned())
}
