//! Samples, instruments, lights, white references, provenance; the emission axis and the quantity.

use super::super::error::ReadError;
use super::super::fields::{Description, decode_fields};
use super::super::layout::{is_outside_digest, name};
use super::super::tree::{Array, Attributes, Dataset, Group};
use super::{At, attribute_number, dataset_text, parsed};
use crate::dataset::{Extension, Id, Light, LightSpectrum, Provenance, WhiteReference};
use crate::quantity::{Band, Bandpass, BandpassCorrection, EmissionAxis, Quantity, WavelengthAxis};

pub(super) fn described<T: Description>(id: Id, at: &At<'_>) -> Result<T, ReadError> {
    decode_fields(at.group, &at.path, Some(id.as_str()))
}

pub(super) fn light(id: Id, at: &At<'_>) -> Result<Light, ReadError> {
    let spectrum = at.group.dataset(name::VALUE).map(|_| light_spectrum(at)).transpose()?;
    Ok(Light { spectrum, ..described(id, at)? })
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
        certified_nm: at.numbers_or_none(name::CERTIFIED_WAVELENGTH)?,
        certified_factor: at.numbers_or_none(name::CERTIFIED_FACTOR)?,
        ..described(id, at)?
    })
}

pub(super) fn extensions(at: &At<'_>) -> Result<Vec<Extension>, ReadError> {
    at.members(|domain, at| Ok(Extension { domain, content: without_foreign(at.group) }))
}

/// Without what other programs add when they copy a file.
fn without_foreign(group: &Group) -> Group {
    let own = |attributes: &Attributes| {
        attributes
            .iter()
            .filter(|(name, _)| !is_outside_digest(name))
            .map(|(name, array)| (name.clone(), array.clone()))
            .collect()
    };
    let content = group.datasets.iter().filter(|(_, dataset)| !is_netcdf_dimension(dataset));
    let datasets = content.map(|(name, dataset)| {
        (name.clone(), Dataset { attributes: own(&dataset.attributes), ..Dataset::new(dataset.array.clone()) })
    });
    Group {
        attributes: own(&group.attributes),
        datasets: datasets.collect(),
        groups: group.groups.iter().map(|(name, group)| (name.clone(), without_foreign(group))).collect(),
    }
}

/// A dimension that netCDF made up for an axis without a scale.
fn is_netcdf_dimension(dataset: &Dataset) -> bool {
    let name = dataset.attributes.get("NAME").and_then(Array::as_text);
    name.is_some_and(|name| name.starts_with("This is a netCDF dimension but not a netCDF variable"))
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

pub(super) fn wavelength_axis(at: &At<'_>) -> Result<WavelengthAxis, ReadError> {
    let bandpass = match at.group.dataset(name::FWHM) {
        None => Bandpass::Unstated,
        Some(dataset) => {
            let path = at.member_path(name::FWHM);
            let shape = dataset_text(dataset, name::SHAPE, &path)?;
            Bandpass::Stated {
                fwhm_nm: at.numbers(name::FWHM)?,
                shape: parsed(&shape, &format!("{path}@{}", name::SHAPE))?,
                correction: match dataset.attributes.get(name::CORRECTION) {
                    None => BandpassCorrection::Unstated,
                    Some(_) => parsed(
                        &dataset_text(dataset, name::CORRECTION, &path)?,
                        &format!("{path}@{}", name::CORRECTION),
                    )?,
                },
            }
        }
    };
    Ok(WavelengthAxis {
        nm: at.numbers(name::WAVELENGTH)?,
        bandpass,
        actual_nm: at.numbers_or_none(name::WAVELENGTH_ACTUAL)?,
    })
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
