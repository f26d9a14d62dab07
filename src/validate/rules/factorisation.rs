//! Do the factors of a matrix hold together with it?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::container::measurement_digest;
use crate::dataset::{Factorisation, Place};

fn parts<'a>(context: &Context<'a>) -> impl Iterator<Item = (String, &'a Factorisation)> {
    let parts = context.document().map_or(&[][..], |document| &document.factorisations);
    parts.iter().map(|part| (format!("/{}/{}", name::FACTORISATION, part.id), part))
}

pub(in super::super) fn shape(context: &Context<'_>, found: &mut Finder) {
    for (path, part) in parts(context) {
        if let Some((array, shape, expected)) = part.misfit() {
            found.add(
                Place::path(format!("{path}/{array}")),
                format!("shape {shape:?}"),
                format!("shape {expected:?}"),
            );
        }
    }
}

pub(in super::super) fn axis(context: &Context<'_>, found: &mut Finder) {
    for (path, part) in parts(context) {
        let nm = &part.excitation_nm;
        let is_wrong = |k: &usize| !(nm[*k].is_finite() && nm[*k] > 0.0 && (*k == 0 || nm[*k] > nm[*k - 1]));
        if let Some(k) = (0..nm.len()).find(is_wrong) {
            let place = Place::path(format!("{path}/{}", name::WAVELENGTH_EXCITATION)).at_index([k]);
            found.add(place, format!("{} nm", nm[k]), "positive wavelengths, each above the one before");
        }
    }
}

pub(in super::super) fn negative(context: &Context<'_>, found: &mut Finder) {
    for (path, part) in parts(context) {
        for (array, values) in [
            (name::EXCITATION_FACTOR.to_owned(), &part.excitation),
            (name::EMISSION_FACTOR.to_owned(), &part.emission_factor),
            (format!("{}{}", name::EXCITATION_FACTOR, name::SUFFIX_U), &part.excitation_u),
            (format!("{}{}", name::EMISSION_FACTOR, name::SUFFIX_U), &part.emission_factor_u),
        ] {
            if let Some(((row, column), value)) = values.indexed_iter().find(|(_, value)| **value < 0.0) {
                let place = Place::path(format!("{path}/{array}")).at_index([row, column]);
                found.add(place, value.to_string(), "0 or more");
            }
        }
    }
}

pub(in super::super) fn data_changed(context: &Context<'_>, found: &mut Finder) {
    for (path, part) in parts(context) {
        let measurement = context.document().and_then(|document| document.measurement(part.measurement.as_str()));
        let Some(now) = measurement.and_then(|measurement| measurement_digest(measurement).ok()) else { continue };
        if now != part.data_digest {
            found.add(Place::path(format!("{path}@{}", name::DATA_DIGEST)), now, part.data_digest.as_str());
        }
    }
}
