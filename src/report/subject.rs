//! What a figure is of: the name in its title, which says once where the sample is simulated.

use crate::dataset::{Document, Measurement, Sample};

/// The sample's title, else the measurement's, else its id: for figures of a surface.
pub(super) fn of_sample(document: &Document, measurement: &Measurement) -> String {
    let sample = sample_of(document, measurement);
    let title = sample.and_then(|sample| sample.title.clone()).or_else(|| measurement.title.clone());
    with_origin(title.unwrap_or_else(|| measurement.id.to_string()), sample)
}

/// The measurement's title, else the sample's, else its id: for figures that tell measurements of one sample apart.
pub(super) fn of_measurement(document: &Document, measurement: &Measurement) -> String {
    let sample = sample_of(document, measurement);
    let title = measurement.title.clone().or_else(|| sample.and_then(|sample| sample.title.clone()));
    with_origin(title.unwrap_or_else(|| measurement.id.to_string()), sample)
}

/// A measurement among the others of its document, by role, id and quantity.
pub(super) fn which(measurement: &Measurement, quantity: &str) -> String {
    format!("{} `{}`, {quantity}", measurement.role, measurement.id)
}

fn sample_of<'a>(document: &'a Document, measurement: &Measurement) -> Option<&'a Sample> {
    measurement.sample.as_ref().and_then(|id| document.samples.iter().find(|sample| sample.id == *id))
}

fn with_origin(title: String, sample: Option<&Sample>) -> String {
    let is_said = title.to_lowercase().contains("simulated");
    if sample.is_some_and(|sample| sample.simulated) && !is_said { format!("{title} (simulated)") } else { title }
}
