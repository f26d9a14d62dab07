//! Bispectral matrices: read as arrays, separated into their elastic and luminescent part, factorised, estimated from
//! broadband spectra, and applied to lights.
//!
//! *May use:* `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* negative noise stays until a step that says so; what a matrix cannot tell is NaN or named, never filled in
//! silence; a light is never cut where the matrix is excited.

mod apply;
mod balance;
mod colour;
mod complete;
mod consistency;
mod daylight;
pub mod estimate;
mod factors;
mod illuminant;
mod light;
mod matrix;
mod nonnegative;
mod operator;
mod overlap;
pub(crate) mod piecewise;
mod predict;
mod reradiation;
mod restore;
mod separate;
mod store;
mod stored_light;
mod unlit;

pub use balance::{Balance, Share};
pub use colour::{Colour, Difference, Observer, Whiteness};
pub use complete::{
    Bispectral, Complete, CompleteTable, Incident, Lit, NoComplete, NotAttached, OutsideExcitation, Radiated,
    Reflected, Values, attach,
};
pub use consistency::{Consistency, Deviation, Level, ScanOf, Shape};
pub use factors::Factors;
pub use light::{Extend, Light, NoLight};
pub use matrix::{Matrix, NoMatrix, steps};
pub use operator::{By, Operator, STEPS_NM, Samples, Way};
pub use overlap::{Floor, Overlap};
pub use predict::{Prediction, Visible};
pub use reradiation::{Luminescence, NotAligned, Reradiation};
pub use restore::restored;
pub use separate::{NotSeparated, Separate, Separated, separate};
pub use store::{IdTaken, Parts, parts};
pub use unlit::Unlit;
