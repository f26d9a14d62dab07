//! The figures of a measurement: its mean spectrum.

use super::curve::{CurveText, Points, line_in_band};
use super::fitted::{Drawn, quantity_words};
use super::frame::with_unit;
use super::subject;
use crate::dataset::{Document, Measurement};

/// The mean spectrum of a measurement that has wavelengths, in a band of its uncertainty.
#[must_use]
pub fn measurement_figures(document: &Document, measurement: &Measurement) -> Drawn {
    let mut drawn = Drawn::default();
    let Some(nm) = measurement.emission.wavelengths().filter(|nm| nm.len() > 1) else { return drawn };
    let spectrum = mean_spectrum(measurement, nm);
    let subject = subject::of_measurement(document, measurement);
    let quantity = quantity_words(measurement.quantity.kind);
    let rows = measurement.acquisitions.len();
    let text = CurveText {
        name: "spectrum".to_owned(),
        title: format!("{subject}: mean spectrum"),
        subtitle: format!("mean of {rows} acquisitions; values that may not be fitted are left out"),
        x: "emission wavelength (nm)".to_owned(),
        y: with_unit(&format!("mean {quantity}"), measurement.quantity.kind.unit()),
        caption: format!(
            "The {quantity} at each emission wavelength, averaged over the {rows} acquisitions. The band is the standard \
             uncertainty of a single value (root mean square over the acquisitions, with the components that they \
             share), not the spread between geometries."
        ),
    };
    drawn.take(line_in_band(&spectrum, None, &text).map(|figure| figure.prefixed(measurement.id.as_str())));
    drawn
}

fn mean_spectrum(measurement: &Measurement, nm: &[f64]) -> Points {
    let columns = nm.len().min(measurement.values.ncols());
    let (y, error) = (0..columns).map(|column| mean_at(measurement, column)).unzip();
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
