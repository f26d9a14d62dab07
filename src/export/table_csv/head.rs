//! The `# key: value` lines: what holds for all rows, in the keys that the importer of tables takes.

use crate::dataset::{Document, Excitation, Id, Measurement};
use crate::quantity::{Bandpass, EmissionAxis};

/// The keys with their values, in the order of the file.
pub(in crate::export) fn keys(document: &Document, measurement: &Measurement) -> Vec<(&'static str, String)> {
    let mut keys = vec![("id", measurement.id.to_string())];
    let mut add = |name, value: Option<String>| keys.extend(value.map(|value| (name, one_line(&value))));
    add("title", measurement.title.clone().or_else(|| document.title.clone()));
    add("license", document.license.clone());
    add("citation", document.citation.clone());
    quantity(measurement, &mut add);
    parts(document, measurement, &mut add);
    match &measurement.emission {
        EmissionAxis::Band { band } => add("band-nm", band.map(|band| band.to_string())),
        EmissionAxis::Wavelengths(axis) => add("bandpass-nm", one_bandpass(&axis.bandpass).map(|nm| nm.to_string())),
    }
    add("coverage-factor", measurement.uncertainty.standard.as_ref().map(|_| "1".to_owned()));
    keys.retain(|(_, value)| !value.is_empty());
    keys
}

fn quantity(measurement: &Measurement, add: &mut impl FnMut(&'static str, Option<String>)) {
    let quantity = &measurement.quantity;
    add("quantity", Some(quantity.kind.name().to_owned()));
    add("part", Some(quantity.part.name().to_owned()));
    add("normalised-at", Some(quantity.normalised_at.name().to_owned()));
    add("basis", Some(quantity.basis.name().to_owned()));
    add("reference", Some(quantity.reference.to_string()));
    add("reference-light", Some(quantity.reference_light.to_string()));
    let factor = Some(&quantity.certified_factor).filter(|factor| factor.len() == 1);
    add("certified-factor", factor.and_then(|factor| factor.first()).map(f64::to_string));
}

fn parts(document: &Document, measurement: &Measurement, add: &mut impl FnMut(&'static str, Option<String>)) {
    let sample = measurement.sample.as_ref().and_then(|id| document.samples.iter().find(|part| part.id == *id));
    if let Some(sample) = sample {
        add("sample", Some(named(&sample.id, sample.title.as_deref())));
        add("material", sample.material.clone());
        add("mark", sample.mark.clone());
        add("simulated", sample.simulated.then(|| "true".to_owned()));
    }
    let instrument =
        measurement.instrument.as_ref().and_then(|id| document.instruments.iter().find(|part| part.id == *id));
    if let Some(instrument) = instrument {
        add("instrument", Some(named(&instrument.id, instrument.model.as_deref())));
        add("serial", instrument.serial.clone());
    }
    if let Some(state) = common_state(measurement) {
        let light = state.light.as_ref();
        let title =
            light.and_then(|id| document.lights.iter().find(|part| part.id == *id)).and_then(|l| l.title.as_deref());
        add("light", light.map(|id| named(id, title)));
        add("excitation-fwhm-nm", state.fwhm_nm.map(|nm| nm.to_string()));
        add("filter", state.filter.clone());
    }
}

/// The name of a part from which the importer makes the same id: its title where that does, else the id.
fn named(id: &Id, title: Option<&str>) -> String {
    let title = title.map(one_line).filter(|title| Id::from_title(title) == *id);
    title.unwrap_or_else(|| id.to_string())
}

/// The excitation of all rows, where they differ in the wavelength at most, which has a column.
pub(in crate::export) fn common_state(measurement: &Measurement) -> Option<&Excitation> {
    let mut states = measurement.acquisitions.iter().map(|row| measurement.excitation_of(row));
    let first = states.next()??;
    let same = |other: &Excitation| {
        other.light == first.light && other.fwhm_nm == first.fwhm_nm && other.filter == first.filter
    };
    states.all(|other| other.is_some_and(same)).then_some(first)
}

/// The bandpass, where it is one number.
pub(super) fn one_bandpass(bandpass: &Bandpass) -> Option<f64> {
    match bandpass {
        Bandpass::Stated { fwhm_nm, .. } if fwhm_nm.len() == 1 => fwhm_nm.first().copied(),
        _ => None,
    }
}

/// A key's value ends with its line.
fn one_line(text: &str) -> String {
    text.replace(['\r', '\n'], " ").trim().to_owned()
}
