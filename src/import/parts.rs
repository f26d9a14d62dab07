//! The parts of a document around its measurements: sample, instrument, lights, excitation states; and what of them
//! stays empty.

use super::keys::Settings;
use super::receipt::Notes;
use super::record::Details;
use crate::dataset::{Document, Excitation, Id, Instrument, Light, Measurement, Sample};
use crate::quantity::{Bandpass, BandpassCorrection, BandpassShape, EmissionAxis};

/// A document with its title, licence and citation.
pub(super) fn document(settings: &Settings) -> Document {
    Document {
        title: settings.title.clone(),
        license: settings.license.clone(),
        citation: settings.citation.clone(),
        ..Document::default()
    }
}

/// The bandpass that the caller states, else the one that the source reports.
pub(super) fn bandpass(settings: &Settings, reported: Option<&Details>) -> Bandpass {
    let of_source = reported.and_then(|details| {
        Some((details.bandpass_nm?, details.bandpass_correction.unwrap_or(BandpassCorrection::Unstated)))
    });
    let stated = settings.bandpass_nm.map(|fwhm| (fwhm, BandpassCorrection::Unstated));
    stated.or(of_source).map_or(Bandpass::Unstated, |(fwhm, correction)| Bandpass::Stated {
        fwhm_nm: vec![fwhm],
        shape: BandpassShape::Unstated,
        correction,
    })
}

/// The excitation states of a measurement, each once.
#[derive(Debug)]
pub(super) struct Excitations {
    /// The states in the order of their first row.
    pub(super) list: Vec<Excitation>,
    settings: Excitation,
}

impl Excitations {
    /// No state yet; what the settings state holds for every row that does not say otherwise.
    pub(super) fn new(settings: &Settings) -> Self {
        let settings = Excitation {
            light: settings.light.as_deref().map(Id::from_title),
            wavelength_nm: settings.excitation_nm,
            fwhm_nm: settings.excitation_fwhm_nm,
            filter: settings.filter.clone(),
            ..Excitation::default()
        };
        Self { list: Vec::new(), settings }
    }

    /// The index of a state; `None` where nothing is known of it.
    pub(super) fn find(&mut self, wavelength_nm: Option<f64>, light: Option<&str>) -> Option<u32> {
        let mut state = self.settings.clone();
        state.wavelength_nm = wavelength_nm.or(state.wavelength_nm);
        state.light = light.map(Id::from_title).or(state.light);
        if state.light.is_none() && state.wavelength_nm.is_none() && state.filter.is_none() {
            return None;
        }
        let known = self.list.iter().position(|other| *other == state);
        let index = known.unwrap_or_else(|| {
            self.list.push(state);
            self.list.len() - 1
        });
        u32::try_from(index).ok()
    }
}

/// Adds the sample to the document and its id to the measurement. Without a name or a particular there is none.
pub(super) fn attach_sample(
    document: &mut Document,
    measurement: &mut Measurement,
    settings: &Settings,
    notes: &mut Notes,
) {
    let simulated = settings.simulated.unwrap_or(false);
    if settings.sample.is_none() && settings.material.is_none() && settings.mark.is_none() && !simulated {
        notes.unfilled("samples");
        return;
    }
    let id = Id::from_title(settings.sample.as_deref().unwrap_or("sample"));
    if settings.mark.is_none() {
        notes.unfilled(format!("samples/{id}/mark"));
    }
    measurement.sample = Some(id.clone());
    if !document.samples.iter().any(|sample| sample.id == id) {
        document.samples.push(Sample {
            id,
            title: settings.sample.clone(),
            material: settings.material.clone(),
            mark: settings.mark.clone(),
            simulated,
            ..Sample::default()
        });
    }
}

/// Adds the instrument to the document and its id to the measurement; what the caller states goes before what the
/// records say.
pub(super) fn attach_instrument(
    document: &mut Document,
    measurement: &mut Measurement,
    details: Option<&Details>,
    settings: &Settings,
    notes: &mut Notes,
) {
    let said = |field: fn(&Details) -> &Option<String>| details.and_then(|details| field(details).clone());
    let model = settings.instrument.clone().or_else(|| said(|details| &details.model));
    let serial = settings.serial.clone().or_else(|| said(|details| &details.serial));
    if model.is_none() && serial.is_none() {
        notes.unfilled("instruments");
        return;
    }
    let id = Id::from_title(model.as_deref().unwrap_or("instrument"));
    if serial.is_none() {
        notes.unfilled(format!("instruments/{id}/serial"));
    }
    measurement.instrument = Some(id.clone());
    if !document.instruments.iter().any(|instrument| instrument.id == id) {
        let aperture = said(|details| &details.aperture);
        let accessories = said(|details| &details.accessories);
        document.instruments.push(Instrument { id, model, serial, aperture, accessories, ..Instrument::default() });
    }
}

/// Adds a light without a spectrum for every one that the measurement names and the document lacks.
pub(super) fn attach_lights(document: &mut Document, measurement: &Measurement, settings: &Settings) {
    for id in measurement.excitations.iter().filter_map(|excitation| excitation.light.as_ref()) {
        if !document.lights.iter().any(|light| light.id == *id) {
            let title = settings.light.clone().filter(|name| Id::from_title(name) == *id);
            document.lights.push(Light { id: id.clone(), title, ..Light::default() });
        }
    }
}

/// Lists what the source did not say about a measurement.
pub(super) fn list_unfilled(measurement: &Measurement, notes: &mut Notes) {
    let id = &measurement.id;
    for field in measurement.quantity.unstated_fields() {
        notes.unfilled(format!("measurements/{id}/quantity/{field}"));
    }
    match &measurement.emission {
        EmissionAxis::Wavelengths(axis) if axis.bandpass == Bandpass::Unstated => {
            notes.unfilled(format!("measurements/{id}/emission/bandpass"));
        }
        EmissionAxis::Band { band: None } => notes.unfilled(format!("measurements/{id}/emission/band")),
        _ => {}
    }
    let rows = &measurement.acquisitions;
    let lacks = [
        ("geometry", rows.iter().any(|row| row.geometry.is_none())),
        ("excitation", rows.iter().any(|row| row.excitation.is_none())),
        ("time", rows.iter().any(|row| row.time.is_none())),
        ("exposure_ms", rows.iter().any(|row| row.exposure_ms.is_none())),
    ];
    for (field, _) in lacks.iter().filter(|(_, lacking)| *lacking) {
        notes.unfilled(format!("measurements/{id}/acquisitions/{field}"));
    }
    if measurement.uncertainty.standard.is_none() {
        notes.unfilled(format!("measurements/{id}/uncertainty"));
    }
}
