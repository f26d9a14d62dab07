//! What the file cannot hold, and what the schema of the format objects to, in words.

use super::convert::Conversion;
use super::metadata::{has_calibration, one_bandpass};
use super::points::{Points, polarisation};
use crate::dataset::{Document, Measurement, Role};
use crate::quantity::{Bandpass, BandpassShape, EmissionAxis, Part, Reference};

/// One line each.
pub(super) fn lost(
    document: &Document,
    measurement: &Measurement,
    conversion: &Conversion,
    points: &Points,
    missing: &[&str],
) -> Vec<String> {
    let mut lost = Vec::new();
    let mut note = |is_lost: bool, what: String| lost.extend(is_lost.then_some(what));
    let from_factor = matches!(conversion, Conversion::Factor(_));
    note(from_factor, "the radiance factor itself: the file holds the BRDF made of it".to_owned());
    let part = measurement.quantity.part;
    note(
        matches!(part, Part::Total | Part::Luminescent),
        format!("that the values hold fluorescence (`{part}`) under one light: a BRDF is of reflected light"),
    );
    note(
        points.left_out > 0,
        format!(
            "{} values that are missing, in no known geometry or at grazing incidence, with their reasons",
            points.left_out
        ),
    );
    note(points.sigma_left_out, "the uncertainties: some are unknown, and `uBRDF` has no way to say so".to_owned());
    note(points.excitation_left_out, "the wavelengths of excitation: some rows have none".to_owned());
    note(points.polarisation_left_out, "the polarisation of the excitation: not s, p, u or a Stokes vector".to_owned());
    rows(measurement, &mut note);
    parts(document, measurement, &mut note);
    let negative = points.value.iter().filter(|value| **value < 0.0).count();
    note(negative > 0, format!("nothing of {negative} values below 0, but the schema of the format refuses them"));
    let grazing = points.grazing();
    note(grazing > 0, format!("nothing of {grazing} points at 90 degrees, but the schema of the format refuses them"));
    note(
        !missing.is_empty(),
        format!("what the schema of the format requires and the document does not say: {}", missing.join(", ")),
    );
    lost
}

fn rows(measurement: &Measurement, note: &mut impl FnMut(bool, String)) {
    let rows = &measurement.acquisitions;
    note(measurement.role != Role::Sample, format!("the role `{}`: a BRDF is of a sample", measurement.role));
    let in_order = (0_u32..).zip(rows).all(|(position, row)| row.order == position);
    note(!in_order, "the order of acquisition".to_owned());
    note(rows.iter().any(|row| row.time.is_some()), "times of acquisition but the first".to_owned());
    note(rows.iter().any(|row| row.exposure_ms.is_some()), "exposure times".to_owned());
    note(rows.iter().any(|row| row.repeats != 1), "how many readings a row is the mean of".to_owned());
    note(rows.iter().any(|row| row.quality_code.is_some()), "quality codes of the instrument".to_owned());
    let mut states = measurement.excitations.iter();
    let filter = states.clone().any(|state| state.filter.is_some());
    note(filter, "filters of the excitation".to_owned());
    let first = states.next();
    let differ =
        states.any(|other| first.is_some_and(|first| first.light != other.light || first.fwhm_nm != other.fwhm_nm));
    note(differ, "lights and bandwidths of the excitation: rows have different ones".to_owned());
    if let EmissionAxis::Wavelengths(axis) = &measurement.emission {
        note(!axis.actual_nm.is_empty(), "the calibrated wavelengths beside the nominal ones".to_owned());
        if let Bandpass::Stated { shape, .. } = &axis.bandpass {
            let one = one_bandpass(measurement).is_some();
            note(!one, "the bandpass: wavelengths have different ones".to_owned());
            note(one && *shape != BandpassShape::Unstated, "shape and correction of the bandpass".to_owned());
        }
    }
}

fn parts(document: &Document, measurement: &Measurement, note: &mut impl FnMut(bool, String)) {
    if let Some(derivation) = &measurement.derivation {
        note(true, format!("the derivation from `{}` and `{}`", derivation.numerator, derivation.reference));
    }
    let reference = measurement.quantity.reference;
    note(matches!(reference, Reference::FixedGeometry { .. }), format!("the geometry of the reference, `{reference}`"));
    note(has_calibration(document, measurement), "the chains of calibrations".to_owned());
    let named = |id| measurement.excitations.iter().any(|state| state.light.as_ref() == Some(id));
    for light in document.lights.iter().filter(|light| named(&light.id) && light.spectrum.is_some()) {
        note(true, format!("the spectrum of the light `{}`", light.id));
    }
    let viewing = measurement.conditions.viewing_polarisation.as_deref();
    note(
        viewing.is_some_and(|text| polarisation(text).is_none()),
        "the polarisation of the detection, in words".to_owned(),
    );
    let drift = measurement.conditions.relative_drift.is_some() || measurement.conditions.drift_handling.is_some();
    note(drift, "what is known of drift".to_owned());
    let others = document.measurements.len().saturating_sub(1);
    note(others > 0, format!("the other measurements of the document ({others})"));
    note(!document.models.is_empty(), format!("the fitted models ({})", document.models.len()));
    note(!document.provenance.receipts.is_empty(), "the receipts of imports".to_owned());
    note(!document.provenance.steps.is_empty(), "the steps since".to_owned());
    for extension in document.extensions.iter().filter(|extension| extension.domain.as_str() != super::DOMAIN) {
        note(true, format!("the extension `{}`", extension.domain));
    }
}
