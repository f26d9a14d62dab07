//! Documents in other people's formats, one file each.
//!
//! *May use:* `dataset`, `quantity`. Writers take `impl Write`; whoever calls creates the file.
//!
//! *Invariant:* numbers are written so that reading gives the same bits.

pub mod bfc;
mod grid;
pub mod json;
pub mod matrix;
pub mod table_csv;
pub mod universal_brdf;
