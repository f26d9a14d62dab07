//! What each geometry tells: the derivatives of its value over its standard deviation.

use super::guess::{Guess, Noise};
use crate::quantity::Geometry;

/// One row per geometry: derivatives in every parameter, times the parameter's scale, over sigma.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    count: usize,
    rows: Vec<f64>,
    values: Vec<f64>,
    without: Vec<usize>,
}

impl Sensitivities {
    /// The sensitivities of geometries under a guess and a noise.
    ///
    /// A geometry where a term has no value, or whose value is 0 without a floor (nothing is known of its noise), tells
    /// nothing: its row is 0, and [`Sensitivities::without_value`] lists it.
    #[must_use]
    pub fn new(guess: &Guess, noise: &Noise, geometry: &[Geometry]) -> Self {
        let count = guess.parameters().len();
        let mut all =
            Self { count, rows: Vec::with_capacity(count * geometry.len()), values: Vec::new(), without: Vec::new() };
        let mut by = Vec::with_capacity(count);
        for (index, geometry) in geometry.iter().enumerate() {
            let value = guess.evaluate(geometry, &mut by).unwrap_or(f64::NAN);
            let sigma = noise.sigma(value);
            all.values.push(value);
            if sigma > 0.0 && sigma.is_finite() {
                all.rows.extend(by.iter().zip(guess.parameters()).map(|(by, one)| by * one.scale / sigma));
            } else {
                all.without.push(index);
                all.rows.extend(std::iter::repeat_n(0.0, count));
            }
        }
        all
    }

    /// The same with the rows of further geometries behind.
    #[must_use]
    pub fn with(&self, other: &Self, chosen: &[usize]) -> Self {
        let mut all = self.clone();
        for &index in chosen {
            all.rows.extend(other.row(index));
            all.values.push(other.values[index]);
        }
        all
    }

    /// How many geometries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// True without geometries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The values predicted; NaN where there is none.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Indices of the geometries that tell nothing.
    #[must_use]
    pub fn without_value(&self) -> &[usize] {
        &self.without
    }

    /// How many parameters.
    pub(super) fn parameters(&self) -> usize {
        self.count
    }

    pub(super) fn row(&self, index: usize) -> &[f64] {
        &self.rows[index * self.count..(index + 1) * self.count]
    }

    pub(super) fn rows(&self) -> &[f64] {
        &self.rows
    }
}
