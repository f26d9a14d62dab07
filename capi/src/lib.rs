//! The validator for C: see `include/bbrf.h`.

#[allow(unsafe_code, reason = "pointers from C; nothing else in this package may touch one")]
mod ffi;
mod report;
