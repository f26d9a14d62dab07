//! Wavelengths whose usable values are a truncated sample: what lies on the floor is missing from it.
//!
//! Values on the floor are upper bounds. Where each has a number and an uncertainty they are fitted as bounds, and nothing
//! is lost. Otherwise they are left out, and what is left has lost its lower noise, so that a fit of it is biased upwards. Left out of the sums are residuals that are about as large as the bounds themselves: for signals
//! spread over the noise about the floor, the sum over what is missing of signal times missing residual is the sum of
//! the squared bounds (the integral of m phi(1 - m) over m is that of Phi(1 - m), m the signal and 1 the floor in units
//! of the noise). A diffuse amplitude over n rows is then biased by about
//!
//! sum over the floor of (bound / sigma)^2 / (sqrt(n) median(value / sigma))
//!
//! of its own standard uncertainty. The median and not the root mean square: a highlight is in few rows, outshines all
//! others and tells a diffuse term next to nothing. The highlight itself lies high above the floor and is biased less.

use super::{independent_sigma, usable};
use crate::dataset::Measurement;
use crate::dataset::bound::bound_at;
use crate::quantity::Flag;

/// A bias of this part of the stated standard uncertainty is hidden by it: it lengthens the error by 3 %.
const TOLERATED_BIAS: f64 = 0.25;

/// Which of a measurement's emission values may be fitted one by one.
pub(super) struct Truncation {
    /// Indices of the emission values whose usable values are a fair sample.
    pub(super) fair: Vec<usize>,
    /// Indices of those that the floor truncates, with the number of rows below detection.
    pub(super) truncated: Vec<(usize, usize)>,
    /// Indices of those without a usable value, for other reasons.
    pub(super) empty: Vec<usize>,
}

impl Truncation {
    /// Looks at each emission value over the rows that have a geometry.
    pub(super) fn of(measurement: &Measurement, rows: &[usize]) -> Self {
        let mut found = Self { fair: Vec::new(), truncated: Vec::new(), empty: Vec::new() };
        for column in 0..measurement.emission.len() {
            let (count, bias) = floor_bias(measurement, rows, column);
            if bias > TOLERATED_BIAS && !is_censored(measurement, rows, column) {
                found.truncated.push((column, count));
            } else if rows.iter().any(|row| usable(measurement, *row, column).is_finite()) {
                found.fair.push(column);
            } else {
                found.empty.push(column);
            }
        }
        found
    }

    /// How many emission values are left out.
    pub(super) fn left_out(&self) -> usize {
        self.truncated.len() + self.empty.len()
    }

    /// What is left out and why, one sentence each.
    pub(super) fn notes(&self, measurement: &Measurement, rows: usize) -> Vec<String> {
        let nm = measurement.emission.wavelengths().unwrap_or(&[]);
        let name = |column: &usize| nm.get(*column).map_or_else(|| "the band".to_owned(), |nm| format!("{nm} nm"));
        let (count, of) = (self.truncated.len(), measurement.emission.len());
        let mut notes = Vec::new();
        if count > 0 {
            let list: Vec<String> =
                self.truncated.iter().map(|(column, below)| format!("{} ({below})", name(column))).collect();
            notes.push(format!(
                "{count} of {of} emission values get no model (in brackets: how many of {rows} rows are below detection): \
                 {}; the values that are left are those whose noise went up, and would bias an amplitude by more than \
                 {TOLERATED_BIAS} of its standard uncertainty",
                list.join(", ")
            ));
        }
        if !self.empty.is_empty() {
            let list: Vec<String> = self.empty.iter().map(name).collect();
            let count = self.empty.len();
            notes.push(format!(
                "{count} of {of} emission values get no model, no row has a usable value there: {}",
                list.join(", ")
            ));
        }
        notes
    }
}

/// True where every row below detection has a bound and an uncertainty: then the bounds are fitted as such, and nothing is
/// truncated.
fn is_censored(measurement: &Measurement, rows: &[usize], column: usize) -> bool {
    let below = |row: &&usize| measurement.flags_at(**row, column).contains(Flag::BelowDetection);
    rows.iter().filter(below).all(|row| bound_at(measurement, *row, column).is_some())
}

/// The rows below detection at an emission value, and the bias that leaving them out gives an amplitude, in its standard
/// uncertainties. Without stated uncertainties the floor itself is the noise.
fn floor_bias(measurement: &Measurement, rows: &[usize], column: usize) -> (usize, f64) {
    let below = |row: &&usize| measurement.flags_at(**row, column).contains(Flag::BelowDetection);
    let bounds: Vec<(usize, f64)> =
        rows.iter().filter(below).map(|row| (*row, measurement.values[(*row, column)])).collect();
    let known = || bounds.iter().map(|(_, bound)| *bound).filter(|bound| bound.is_finite());
    let floor = (known().map(|bound| bound * bound).sum::<f64>() / known().count() as f64).sqrt();
    let sigma = |row: usize| independent_sigma(measurement, row, column).filter(|sigma| *sigma > 0.0).unwrap_or(floor);
    // A row that is below detection without a value has a bound all the same: one of the size of the noise.
    let in_sigmas = |(row, bound): &(usize, f64)| if bound.is_finite() { bound / sigma(*row) } else { 1.0 };
    let missing: f64 = bounds.iter().map(|bound| in_sigmas(bound).powi(2)).sum();
    let used = rows.iter().map(|row| (*row, usable(measurement, *row, column))).filter(|(_, value)| value.is_finite());
    let mut signals: Vec<f64> = used.map(|(row, value)| (value / sigma(row)).abs()).collect();
    if signals.is_empty() {
        return (bounds.len(), if bounds.is_empty() { 0.0 } else { f64::INFINITY });
    }
    signals.extend(bounds.iter().map(in_sigmas));
    signals.sort_by(f64::total_cmp);
    let median = signals[signals.len() / 2];
    (bounds.len(), missing / ((signals.len() as f64).sqrt() * median))
}
