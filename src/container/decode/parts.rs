//! Samples, instruments, lights, white references, provenance; the emission axis and the quantity.

use super::super::error::ReadError;
use super::super::layout::name;
use super::{At, attribute_number, dataset_text, member, parsed};
use crate::dataset::{Id, Instrument, Light, LightSpectrum, Provenance, Sample, WhiteReference};
use crate::quantity::{Band, Bandpass, EmissionAxis, Quantity, WavelengthAxis};

pub(super) fn sample(id: Id, at: &At<'_>) -> Result<Sample, ReadError> {
    Ok(Sample {
        id,
        title: at.optional_text(name::TITLE)?,
        material: at.optional_text(name::MATERIAL)?,
        mark: at.optional_text(name::MARK)?,
        simulated: at.truth(name::SIMULATED)?,
    })
}

pub(super) fn instrument(id: Id, at: &At<'_>) -> Result<Instrument, ReadError> {
    Ok(Instrument {
        id,
        model: at.optional_text(name::MODEL_NAME)?,
        serial: at.optional_text(name::SERIAL)?,
        aperture: at.optional_text(name::APERTURE)?,
        accessories: at.optional_text(name::ACCESSORIES)?,
        distance_mm: at.optional_number(name::DISTANCE_MM)?,
    })
}

pub(super) fn light(id: Id, at: &At<'_>) -> Result<Light, ReadError> {
    let spectrum = at.group.dataset(name::VALUE).map(|_| light_spectrum(at)).transpose()?;
    Ok(Light { id, title: at.optional_text(name::TITLE)?, spectrum })
}

fn light_spectrum(at: &At<'_>) -> Result<LightSpectrum, ReadError> {
    Ok(LightSpectrum {
        quantity: quantity(at)?,
        axis: wavelength_axis(at)?,
        values: at.numbers(name::VALUE)?,
        flags: at.integers(name::VALUE_FLAG)?,
    })
}

pub(super) fn white_reference(id: Id, at: &At<'_>) -> Result<WhiteReference, ReadError> {
    Ok(WhiteReference {
        id,
        title: at.optional_text(name::TITLE)?,
        certificate: at.optional_text(name::CERTIFICATE)?,
        certified_nm: at.numbers_or_none(name::CERTIFIED_WAVELENGTH)?,
        certified_factor: at.numbers_or_none(name::CERTIFIED_FACTOR)?,
        certified_relative_uncertainty: at.optional_number(name::CERTIFIED_RELATIVE_U)?,
    })
}

pub(super) fn provenance(at: &At<'_>) -> Result<Provenance, ReadError> {
    Ok(Provenance {
        receipts: at.json(name::RECEIPTS)?.unwrap_or_default(),
        steps: at.json(name::STEPS)?.unwrap_or_default(),
    })
}

pub(super) fn emission_axis(at: &At<'_>) -> Result<EmissionAxis, ReadError> {
    let Some(band) = at.group.dataset(name::BAND) else { return wavelength_axis(at).map(EmissionAxis::Wavelengths) };
    let end = |name: &str| {
        let path = format!("{}@{name}", at.member_path(name::BAND));
        band.attributes.get(name).map(|array| attribute_number(array, &path)).transpose()
    };
    let band = match (end(name::FROM_NM)?, end(name::TO_NM)?) {
        (Some(from_nm), Some(to_nm)) => Some(Band { from_nm, to_nm }),
        (None, None) => None,
        _ => {
            let path = at.member_path(name::BAND);
            return Err(ReadError::unexpected(&path, "one end of the band", "both ends or none"));
        }
    };
    Ok(EmissionAxis::Band { band })
}

fn wavelength_axis(at: &At<'_>) -> Result<WavelengthAxis, ReadError> {
    let bandpass = match at.group.dataset(name::FWHM) {
        None => Bandpass::Unstated,
        Some(dataset) => {
            let path = at.member_path(name::FWHM);
            let shape = dataset_text(dataset, name::SHAPE, &path)?;
            Bandpass::Stated { fwhm_nm: at.numbers(name::FWHM)?, shape: member(&shape, &path)? }
        }
    };
    Ok(WavelengthAxis { nm: at.numbers(name::WAVELENGTH)?, bandpass })
}

/// The quantity of the values of a group.
pub(super) fn quantity(at: &At<'_>) -> Result<Quantity, ReadError> {
    let dataset = at.dataset(name::VALUE)?;
    let path = at.member_path(name::VALUE);
    let text = |name: &str| dataset_text(dataset, name, &path);
    let place = |name: &str| format!("{path}@{name}");
    Ok(Quantity {
        kind: parsed(&text(name::QUANTITY)?, &place(name::QUANTITY))?,
        part: parsed(&text(name::PART)?, &place(name::PART))?,
        normalised_at: parsed(&text(name::NORMALISED_AT)?, &place(name::NORMALISED_AT))?,
        basis: parsed(&text(name::BASIS)?, &place(name::BASIS))?,
        reference: parsed(&text(name::REFERENCE)?, &place(name::REFERENCE))?,
        reference_light: parsed(&text(name::REFERENCE_LIGHT)?, &place(name::REFERENCE_LIGHT))?,
        certified_factor: at.numbers_or_none(name::CERTIFIED_FACTOR)?,
    })
}
