//! Readings of which one side is known.

use super::Measurement;
use super::reduce::independent_sigma;
use crate::quantity::Flag;

/// The side of a bound on which the true reading lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// On or below it: a value on the instrument's floor.
    AtMost,
    /// On or above it: a detector that was overloaded.
    AtLeast,
}

/// A reading of which one side is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Index of the emission value.
    pub emission: usize,
    /// Index of the geometry.
    pub geometry: usize,
    /// On which side of the bound it lies.
    pub side: Side,
    /// The bound, in the unit of the values.
    pub bound: f64,
    /// Standard uncertainty of a reading there; the same unit.
    pub sigma: f64,
}

/// The bound that a value of a measurement is; `None` where its flags say that it is none, or where it lacks a number or an
/// uncertainty.
pub(super) fn bound_at(measurement: &Measurement, row: usize, column: usize) -> Option<Bound> {
    let flags = measurement.flags_at(row, column);
    let others = |flag: Flag| flag.excludes_from_fit() && !matches!(flag, Flag::BelowDetection | Flag::Saturated);
    if flags.iter().any(others) {
        return None;
    }
    let side = match (flags.contains(Flag::BelowDetection), flags.contains(Flag::Saturated)) {
        (true, false) => Side::AtMost,
        (false, true) => Side::AtLeast,
        _ => return None,
    };
    let bound = measurement.values[(row, column)];
    let sigma = independent_sigma(measurement, row, column)?;
    let usable = bound.is_finite() && sigma > 0.0 && sigma.is_finite();
    usable.then_some(Bound { emission: column, geometry: row, side, bound, sigma })
}
