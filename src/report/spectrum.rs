//! The figures of a measurement: its mean spectrum.

use super::curve::{CurveText, Points, line_in_band};
use super::fitted::{Drawn, quantity_words};
use super::frame::with_unit;
use super::{ReportError, subject};
use crate::dataset::{Document, Measurement};
use crate::quantity::Flag;

/// The most acquisitions without a usable value, as a share, at a wavelength whose mean is drawn. Mostly it is the low ones
/// that are missing, so that the mean of the rest is too high.
const MOST_MISSING: f64 = 0.02;

/// The mean spectrum of a measurement that has wavelengths, in a band of its uncertainty; a gap where some acquisitions
/// have no usable value.
#[must_use]
pub fn measurement_figures(document: &Document, measurement: &Measurement) -> Drawn {
    let mut drawn = Drawn::default();
    let Some(nm) = measurement.emission.wavelengths().filter(|nm| nm.len() > 1) else { return drawn };
    let spectrum = mean_spectrum(measurement, nm);
    let left_out = spectrum.y.iter().filter(|y| !y.is_finite()).count();
    if left_out == spectrum.y.len() {
        let (measurement, rows) = (measurement.id.to_string(), measurement.acquisitions.len());
        drawn.not_drawn.push(ReportError::NoWholeWavelength { measurement, rows }.to_string());
        return drawn;
    }
    let subject = subject::of_measurement(document, measurement);
    let quantity = quantity_words(measurement.quantity.kind);
    let rows = measurement.acquisitions.len();
    let text = CurveText {
        name: "spectrum".to_owned(),
        title: format!("{subject}: {}", subject::which(measurement, &format!("mean {quantity}"))),
        subtitle: format!("mean of {rows} acquisitions; {}", gaps(left_out, spectrum.y.len())),
        x: "emission wavelength (nm)".to_owned(),
        y: with_unit(&format!("mean {quantity}"), measurement.quantity.kind.unit()),
        caption: format!(
            "The {quantity} at each emission wavelength, averaged over the {rows} acquisitions. The band is the standard \
             uncertainty of a single value (root mean square over the acquisitions, with the components that they \
             share), not the spread between geometries. {}",
            why(left_out, spectrum.y.len())
        ),
    };
    drawn.take(line_in_band(&spectrum, None, &text).map(|figure| figure.prefixed(measurement.id.as_str())));
    drawn
}

/// How many wavelengths are gaps, short.
fn gaps(left_out: usize, of: usize) -> String {
    match left_out {
        0 => format!("all {of} wavelengths"),
        _ => format!("gaps: {left_out} of {of} wavelengths where values are missing or below detection"),
    }
}

/// The same as a sentence, with the reason.
fn why(left_out: usize, of: usize) -> String {
    match left_out {
        0 => format!("All {of} wavelengths are shown."),
        _ => format!(
            "{left_out} of {of} wavelengths are left out: more than {:.0} % of the acquisitions have no usable value there \
             (missing, below detection), and the mean of the rest would be too high.",
            100.0 * MOST_MISSING
        ),
    }
}

fn mean_spectrum(measurement: &Measurement, nm: &[f64]) -> Points {
    let columns = nm.len().min(measurement.values.ncols());
    let is_usable = |row: usize, column: usize| {
        measurement.values[(row, column)].is_finite() && measurement.flags_at(row, column).may_be_fitted()
    };
    let is_below = |row: usize, column: usize| measurement.flags_at(row, column).contains(Flag::BelowDetection);
    // A row that was not measured at all takes no part in the scan; one below detection throughout does.
    let takes_part = |row: &usize| (0..columns).any(|column| is_usable(*row, column) || is_below(*row, column));
    let used: Vec<usize> = (0..measurement.values.nrows()).filter(takes_part).collect();
    let is_whole = |column: usize| {
        let missing = used.iter().filter(|row| !is_usable(**row, column)).count();
        missing as f64 <= MOST_MISSING * used.len() as f64
    };
    let mean = |column| if is_whole(column) { mean_at(measurement, column) } else { (f64::NAN, f64::NAN) };
    let (y, error) = (0..columns).map(mean).unzip();
    Points {
        x: nm[..columns].to_vec(),
        y,
        error,
        name: "mean".to_owned(),
        error_name: "± standard uncertainty of one value".to_owned(),
    }
}

/// Mean of the usable values at one wavelength, and the root mean square of their standard uncertainties.
fn mean_at(measurement: &Measurement, column: usize) -> (f64, f64) {
    let (mut count, mut sum, mut variance) = (0.0, 0.0, 0.0);
    for (row, &value) in measurement.values.column(column).iter().enumerate() {
        if value.is_finite() && measurement.flags_at(row, column).may_be_fitted() {
            count += 1.0;
            sum += value;
            variance += variance_at(measurement, row, column, value);
        }
    }
    (sum / count, (variance / count).sqrt())
}

fn variance_at(measurement: &Measurement, row: usize, column: usize, value: f64) -> f64 {
    let uncertainty = &measurement.uncertainty;
    let own = uncertainty.standard.as_ref().and_then(|standard| standard.get((row, column))).copied();
    let shared = uncertainty.components.iter().map(|component| (component.relative_at(column) * value).powi(2));
    own.filter(|own| own.is_finite()).unwrap_or(0.0).powi(2) + shared.sum::<f64>()
}
