//! Bispectral matrices: read as arrays, separated into their elastic and luminescent part, factorised, estimated from
//! broadband spectra, and applied to lights.
//!
//! *May use:* `dataset`, `quantity`.
//!
//! *Invariant:* negative noise stays until a step that says so; what a matrix cannot tell is NaN or named, never filled in
//! silence; a light is never cut where the matrix is excited.

mod balance;
mod factors;
mod matrix;
mod nonnegative;
mod overlap;
mod separate;

pub use balance::{Balance, Share};
pub use factors::Factors;
pub use matrix::{Matrix, NoMatrix, steps};
pub use overlap::{Floor, Overlap};
pub use separate::{NotSeparated, Separate, Separated, separate};
