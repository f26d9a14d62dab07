//! The factors of a Donaldson matrix.

use super::super::error::EncodeError;
use super::super::layout::name;
use super::super::tree::{Array, Data, Dataset, Group};
use super::parts::wavelength_axis;
use crate::dataset::Factorisation;

pub(super) fn factorisation(part: &Factorisation) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.optional_text(name::TITLE, part.title.as_ref())?;
    group.text(name::MEASUREMENT, part.measurement.as_str())?;
    group.text(name::DATA_DIGEST, &part.data_digest)?;
    group.text(name::METHOD, &part.method)?;
    for (name, number) in
        [(name::REACH, part.reach_nm), (name::FLOOR, part.floor), (name::RESIDUAL_RMS, part.residual_rms)]
    {
        group.attribute(name, Data::F64(vec![number].into()));
    }
    group.attribute(name::RESIDUAL_COUNT, Data::U64(vec![part.residual_count].into()));
    group.index_scale(name::FACTOR, part.rank());
    group.scale(name::WAVELENGTH_EXCITATION, &part.excitation_nm, "nm", "centre of the excitation");
    wavelength_axis(&mut group, &part.emission)?;
    for (name, scale, values, u) in [
        (name::EXCITATION_FACTOR, name::WAVELENGTH_EXCITATION, &part.excitation, &part.excitation_u),
        (name::EMISSION_FACTOR, name::WAVELENGTH, &part.emission_factor, &part.emission_factor_u),
    ] {
        for (name, values) in [(name.to_owned(), values), (format!("{name}{}", name::SUFFIX_U), u)] {
            let array = Array { shape: values.shape().to_vec(), data: Data::F64(values.iter().copied().collect()) };
            let axes = vec![name::FACTOR.to_owned(), scale.to_owned()];
            let long_name =
                if name.ends_with(name::SUFFIX_U) { "standard uncertainty (k = 1)" } else { "spectra of the factors" };
            group.put(&name, Dataset { axes, ..Dataset::new(array) }).unit("1").long_name(long_name);
        }
    }
    group
        .vector(name::ELASTIC, Data::F64(part.elastic.clone().into()), name::WAVELENGTH)
        .unit("1")
        .long_name("elastic radiance factor");
    group
        .vector(
            &format!("{}{}", name::ELASTIC, name::SUFFIX_U),
            Data::F64(part.elastic_u.clone().into()),
            name::WAVELENGTH,
        )
        .unit("1")
        .long_name("standard uncertainty (k = 1)");
    if !part.findings.is_empty() {
        group.texts(name::IDENTIFIABILITY, part.findings.iter().map(String::as_str), "")?;
    }
    Ok(group)
}
