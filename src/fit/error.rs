//! Why data cannot be fitted.

use super::left_out::LeftOut;

/// Data that cannot be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DataError {
    /// Arrays of another length than the geometries.
    #[error("{found} values for {expected} geometries")]
    Length {
        /// Length found.
        found: usize,
        /// Number of geometries.
        expected: usize,
    },
    /// Uncertainties of another number of emission values.
    #[error("uncertainties of {found} emission values for {expected}")]
    Rows {
        /// Number found.
        found: usize,
        /// Number of emission values.
        expected: usize,
    },
    /// A bound that cannot be used.
    #[error("the bound of emission value {emission} at geometry {geometry} (both from 0): {problem}")]
    Bound {
        /// Index of the emission value.
        emission: usize,
        /// Index of the geometry.
        geometry: usize,
        /// Why.
        problem: &'static str,
    },
    /// Fewer usable values than parameters.
    #[error("{usable} usable values for {parameters} parameters ({left_out}); a fit needs more values than parameters")]
    TooFew {
        /// Values that are finite, have a positive uncertainty, and a geometry where every term is defined.
        usable: usize,
        /// Number of parameters.
        parameters: usize,
        /// The others, by reason.
        left_out: LeftOut,
    },
    /// A number whose square is none.
    #[error(
        "a {what} of {found:e}: its square is beyond the range of numbers; expected magnitudes from 1e-60 to 1e60 (or 0): \
         state the values in another unit"
    )]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// The number.
        found: f64,
    },
    /// No term to fit.
    #[error("no term to fit")]
    NoTerm,
}
