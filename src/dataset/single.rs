//! Values in single precision: half the bytes, seven digits.

use super::{Document, Id};

/// A number that single precision does not reach.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "measurement `{measurement}`, row {row}, emission {column}: found {found:e}; expected 0 or a size between 1.2e-38 and 3.4e38, \
     which single precision can hold: leave the values in double precision"
)]
pub struct NotSingle {
    /// Which measurement.
    pub measurement: Id,
    /// Row, from 0.
    pub row: usize,
    /// Emission value, from 0.
    pub column: usize,
    /// The number.
    pub found: f64,
}

impl Document {
    /// Rounds the values of all measurements, and their standard uncertainties, to the nearest number of single precision: each
    /// changes by at most 6e-8 of itself. What refers to a measurement by its digest is left as it is.
    ///
    /// # Errors
    /// [`NotSingle`]; the document is then as it was.
    pub fn round_to_single(&mut self) -> Result<(), NotSingle> {
        let mut rounded = Vec::with_capacity(self.measurements.len());
        for measurement in &self.measurements {
            let of = |array: &ndarray::ArcArray2<f64>| {
                let is_wrong = |value: f64| value.is_finite() && value != 0.0 && !(value as f32).is_normal();
                match array.indexed_iter().find(|(_, value)| is_wrong(**value)) {
                    None => Ok(array.mapv(|value| f64::from(value as f32)).into_shared()),
                    Some(((row, column), found)) => {
                        Err(NotSingle { measurement: measurement.id.clone(), row, column, found: *found })
                    }
                }
            };
            rounded.push((of(&measurement.values)?, measurement.uncertainty.standard.as_ref().map(of).transpose()?));
        }
        for (measurement, (values, sigma)) in self.measurements.iter_mut().zip(rounded) {
            measurement.values = values;
            measurement.uncertainty.standard = sigma;
        }
        Ok(())
    }
}
