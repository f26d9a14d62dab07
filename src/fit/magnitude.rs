//! Numbers whose squares leave the range of double precision cannot be fitted: they would give NaN for a result.

use ndarray::ArrayView2;

use super::left_out::reason;
use super::solve::DataError;

/// Values and uncertainties may have magnitudes from 1 over this to this, and a value may be so many uncertainties large:
/// then every sum of squares of a million values is finite, with room for the angular factors.
const LARGEST: f64 = 1e60;

/// Checks the values that take part.
pub(super) fn check(values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> Result<(), DataError> {
    for (index, &value) in values.indexed_iter() {
        let sigma = sigma.map(|sigma| sigma[index]);
        if reason(value, sigma).is_some() {
            continue;
        }
        let is_ordinary = |number: f64| (LARGEST.recip()..=LARGEST).contains(&number.abs());
        let numbers = [("value", value), ("standard uncertainty", sigma.unwrap_or(1.0))];
        if let Some((what, found)) = numbers.into_iter().find(|(_, number)| *number != 0.0 && !is_ordinary(*number)) {
            return Err(DataError::OutOfRange { what, found });
        }
        if let Some(found) = sigma.map(|sigma| value / sigma).filter(|ratio| ratio.abs() > LARGEST) {
            return Err(DataError::OutOfRange { what: "value over its standard uncertainty", found });
        }
    }
    Ok(())
}
