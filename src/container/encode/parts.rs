//! Samples, instruments, lights, white references, provenance; and what several parts share: the emission axis and the
//! quantity.

use super::super::error::EncodeError;
use super::super::fields::{Description, encode_fields};
use super::super::layout::name;
use super::super::tree::{Array, Data, Dataset, Group};
use super::{faithful, without_nul};
use crate::dataset::{Light, LightSpectrum, Provenance, WhiteReference};
use crate::quantity::{Bandpass, EmissionAxis, Flag, Quantity, QuantityKind, WavelengthAxis};

pub(super) fn described(part: &impl Description) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    encode_fields(&mut group, part)?;
    Ok(group)
}

pub(super) fn light(light: &Light) -> Result<Group, EncodeError> {
    // The spectrum has attributes of the same names; it is an array and not a description.
    let mut group = described(&Light { spectrum: None, ..light.clone() })?;
    if let Some(spectrum) = &light.spectrum {
        light_spectrum(&mut group, spectrum)?;
    }
    Ok(group)
}

fn light_spectrum(group: &mut Group, spectrum: &LightSpectrum) -> Result<(), EncodeError> {
    wavelength_axis(group, &spectrum.axis)?;
    certified_factor(group, &spectrum.quantity, name::WAVELENGTH);
    group.vector(name::VALUE_FLAG, Data::U16(spectrum.flags.clone().into()), name::WAVELENGTH);
    let value = group.vector(name::VALUE, Data::F64(spectrum.values.clone().into()), name::WAVELENGTH);
    quantity(value, &spectrum.quantity)?;
    value.checked_text(name::ANCILLARY, name::VALUE_FLAG)?;
    value_flags(group);
    Ok(())
}

pub(super) fn white_reference(reference: &WhiteReference) -> Result<Group, EncodeError> {
    let mut group = described(reference)?;
    if !reference.certified_nm.is_empty() {
        group.scale(name::CERTIFIED_WAVELENGTH, &reference.certified_nm, "nm", "wavelength in air");
    }
    if !reference.certified_factor.is_empty() {
        let factor = Data::F64(reference.certified_factor.clone().into());
        group
            .vector(name::CERTIFIED_FACTOR, factor, name::CERTIFIED_WAVELENGTH)
            .unit("1")
            .long_name("certified radiance factor");
    }
    Ok(group)
}

pub(super) fn provenance(provenance: &Provenance) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.json(name::RECEIPTS, &provenance.receipts)?;
    group.json(name::STEPS, &provenance.steps)?;
    Ok(group)
}

/// The emission axis as a dimension scale; returns its name.
pub(super) fn emission_axis(group: &mut Group, axis: &EmissionAxis) -> Result<&'static str, EncodeError> {
    match axis {
        EmissionAxis::Wavelengths(axis) => {
            wavelength_axis(group, axis)?;
            Ok(name::WAVELENGTH)
        }
        EmissionAxis::Band { band } => {
            group.index_scale(name::BAND, 1);
            if let (Some(band), Some(scale)) = (band, group.dataset_mut(name::BAND)) {
                for (name, end) in [(name::FROM_NM, band.from_nm), (name::TO_NM, band.to_nm)] {
                    let end = Array::scalar(Data::F64(vec![end].into()));
                    scale.attributes.insert(name.to_owned(), end);
                }
            }
            Ok(name::BAND)
        }
    }
}

pub(super) fn wavelength_axis(group: &mut Group, axis: &WavelengthAxis) -> Result<(), EncodeError> {
    group.scale(name::WAVELENGTH, &axis.nm, "nm", "nominal emission wavelength in air");
    if !axis.actual_nm.is_empty() {
        group
            .vector(name::WAVELENGTH_ACTUAL, Data::F64(axis.actual_nm.clone().into()), name::WAVELENGTH)
            .unit("nm")
            .long_name("centre of the bandpass as calibrated");
    }
    if let Bandpass::Stated { fwhm_nm, shape, correction } = &axis.bandpass {
        let fwhm = group.vector(name::FWHM, Data::F64(fwhm_nm.clone().into()), name::WAVELENGTH);
        fwhm.unit("nm").long_name("full width at half maximum of the instrument");
        fwhm.checked_text(name::SHAPE, shape.name())?.checked_text(name::CORRECTION, correction.name())?;
    }
    Ok(())
}

/// What the values of a dataset mean, as its attributes.
pub(super) fn quantity(dataset: &mut Dataset, quantity: &Quantity) -> Result<(), EncodeError> {
    dataset.unit(quantity.kind.unit()).long_name(quantity.kind.name());
    si_unit(dataset, quantity.kind);
    dataset.checked_text(name::QUANTITY, quantity.kind.name())?;
    dataset.checked_text(name::PART, quantity.part.name())?;
    dataset.checked_text(name::NORMALISED_AT, quantity.normalised_at.name())?;
    dataset.checked_text(name::BASIS, quantity.basis.name())?;
    dataset.checked_text(name::REFERENCE, &faithful(name::REFERENCE, &quantity.reference)?)?;
    let light = faithful(name::REFERENCE_LIGHT, &quantity.reference_light)?;
    dataset.checked_text(name::REFERENCE_LIGHT, &without_nul(&light)?)?;
    Ok(())
}

/// The unit once more as a factor and exponents, so that no program has to parse a text.
pub(super) fn si_unit(dataset: &mut Dataset, kind: QuantityKind) {
    if let Some(unit) = kind.si_unit() {
        let mut put = |name: &str, array| dataset.attributes.insert(name.to_owned(), array);
        put(name::SI_FACTOR, Array::scalar(Data::F64(vec![unit.factor].into())));
        put(name::SI_EXPONENTS, Array::vector(Data::I8(unit.exponents.to_vec().into())));
    }
}

pub(super) fn certified_factor(group: &mut Group, quantity: &Quantity, axis: &str) {
    if !quantity.certified_factor.is_empty() {
        group
            .vector(name::CERTIFIED_FACTOR, Data::F64(quantity.certified_factor.clone().into()), axis)
            .unit("1")
            .long_name("certified radiance factor of the reference, contained in the values");
    }
}

/// Describes `value_flag` in the words of CF.
pub(super) fn value_flags(group: &mut Group) {
    let masks = Data::U16(Flag::ALL.iter().map(|flag| flag.bit()).collect());
    let meanings = Flag::ALL.map(Flag::name);
    if let Some(flags) = group.dataset_mut(name::VALUE_FLAG) {
        flags.flags(masks, &meanings).long_name("why a value is missing or may not be used");
    }
}
