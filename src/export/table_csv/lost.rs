//! What a table cannot hold, in words.

use super::head::{common_state, one_bandpass};
use crate::dataset::{Document, Id, Measurement, Role};
use crate::quantity::{Bandpass, BandpassShape, EmissionAxis, Flags};

/// One line for each thing of a measurement that reading its table does not bring back.
pub(super) fn lost(document: &Document, measurement: &Measurement) -> Vec<String> {
    let mut lost = Vec::new();
    let mut note = |is_lost: bool, what: String| lost.extend(is_lost.then_some(what));
    note(measurement.role != Role::Sample, format!("the role `{}`: a table is of a sample", measurement.role));
    for component in &measurement.uncertainty.components {
        note(true, format!("the shared uncertainty component `{}`", component.name));
    }
    if let Some(derivation) = &measurement.derivation {
        note(true, format!("the derivation from `{}` and `{}`", derivation.numerator, derivation.reference));
    }
    if let Some(white) = &measurement.white_reference {
        note(true, format!("the white reference `{white}` with its certificate"));
    }
    let factors = measurement.quantity.certified_factor.len();
    note(factors > 1, format!("the certified factor of {factors} wavelengths"));
    note(
        Id::from_title(measurement.id.as_str()) != measurement.id,
        format!("the spelling of the id `{}`", measurement.id),
    );
    let two_titles = measurement.title.is_some() && document.title.is_some() && measurement.title != document.title;
    note(two_titles, "the title of the document: the measurement has its own".to_owned());
    emission(measurement, &mut note);
    rows(measurement, &mut note);
    excitation(document, measurement, &mut note);
    parts(document, measurement, &mut note);
    lost
}

fn emission(measurement: &Measurement, note: &mut impl FnMut(bool, String)) {
    if let EmissionAxis::Wavelengths(axis) = &measurement.emission
        && let Bandpass::Stated { fwhm_nm, shape, .. } = &axis.bandpass
    {
        let several = one_bandpass(&axis.bandpass).is_none();
        note(several, format!("the bandpass of {} wavelengths", fwhm_nm.len()));
        note(!several && *shape != BandpassShape::Unstated, "the shape of the bandpass".to_owned());
    }
}

fn rows(measurement: &Measurement, note: &mut impl FnMut(bool, String)) {
    let rows = &measurement.acquisitions;
    note(rows.is_empty() || measurement.emission.is_empty(), "the measurement itself: it has no values".to_owned());
    note(rows.iter().any(|row| row.repeats != 1), "how many readings a row is the mean of".to_owned());
    note(rows.iter().any(|row| row.quality_code.is_some()), "quality codes of the instrument".to_owned());
    let ascending = rows.windows(2).all(|pair| pair[0].order <= pair[1].order);
    note(!ascending, "the order of the rows in the file: reading sorts them by `order`".to_owned());
    let unflagged = |(at, value): ((usize, usize), &f64)| {
        value.is_infinite() || value.is_nan() && !measurement.flags_at(at.0, at.1).explains_absence()
    };
    let refused = measurement.values.indexed_iter().filter(|(at, value)| unflagged((*at, *value))).count();
    note(refused > 0, format!("{refused} values that are not finite and have no flag that says why"));
    let unknown = measurement.flags.iter().filter(|bits| Flags(**bits).unknown_bits() != 0).count();
    note(unknown > 0, format!("flags of {unknown} values that the standard does not know"));
}

fn excitation(document: &Document, measurement: &Measurement, note: &mut impl FnMut(bool, String)) {
    let states = &measurement.excitations;
    let more = states.iter().any(|state| state.light.is_some() || state.fwhm_nm.is_some() || state.filter.is_some());
    let several = more && common_state(measurement).is_none();
    note(several, "lights, bandwidths and filters of the excitation: rows have different ones".to_owned());
    note(states.iter().any(|state| state.polarisation.is_some()), "the polarisation of the excitation".to_owned());
    let named = |id: &Id| states.iter().any(|state| state.light.as_ref() == Some(id));
    for light in document.lights.iter().filter(|light| named(&light.id) && light.spectrum.is_some()) {
        note(true, format!("the spectrum of the light `{}`", light.id));
    }
}

fn parts(document: &Document, measurement: &Measurement, note: &mut impl FnMut(bool, String)) {
    let found = document.instruments.iter().find(|part| Some(&part.id) == measurement.instrument.as_ref());
    if let Some(part) = found {
        let more = part.aperture.is_some() || part.accessories.is_some() || part.distance_mm.is_some();
        note(more, format!("aperture, accessories and distance of the instrument `{}`", part.id));
    }
    for extension in &document.extensions {
        note(true, format!("the extension `{}`", extension.domain));
    }
}
