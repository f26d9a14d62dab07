//! Are the wavelength axes axes?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::Place;
use crate::quantity::{Bandpass, EmissionAxis, WavelengthAxis};

/// Every emission axis with the path of its group.
fn axes<'a>(context: &Context<'a>) -> Vec<(String, &'a WavelengthAxis)> {
    let Some(document) = context.document() else { return Vec::new() };
    let measured = document.measurements.iter().map(|m| (format!("/{}/{}", name::MEASUREMENT, m.id), &m.emission));
    let fitted = document.models.iter().map(|m| (format!("/{}/{}", name::MODEL, m.id), &m.emission));
    let mut axes: Vec<_> = measured
        .chain(fitted)
        .filter_map(|(path, emission)| match emission {
            EmissionAxis::Wavelengths(axis) => Some((path, axis)),
            EmissionAxis::Band { .. } => None,
        })
        .collect();
    for light in &document.lights {
        if let Some(spectrum) = &light.spectrum {
            axes.push((format!("/{}/{}", name::LIGHT, light.id), &spectrum.axis));
        }
    }
    axes
}

pub(in super::super) fn positive(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        if let Some(index) = axis.nm.iter().position(|nm| !(nm.is_finite() && *nm > 0.0)) {
            let place = Place::path(format!("{path}/{}", name::WAVELENGTH)).at_index([index]);
            found.add(place, format!("{} nm", axis.nm[index]), "a positive finite wavelength");
        }
    }
}

pub(in super::super) fn ascending(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        if let Some(index) = axis.nm.windows(2).position(|pair| pair[1] <= pair[0]) {
            let place = Place::path(format!("{path}/{}", name::WAVELENGTH)).at_index([index + 1]);
            found.add(place, format!("{} nm", axis.nm[index + 1]), format!("more than {} nm", axis.nm[index]));
        }
    }
}

pub(in super::super) fn bandpass_length(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        if let Bandpass::Stated { fwhm_nm, .. } = &axis.bandpass
            && fwhm_nm.len() != 1
            && fwhm_nm.len() != axis.nm.len()
        {
            let place = Place::path(format!("{path}/{}", name::FWHM));
            found.add(place, format!("{} widths", fwhm_nm.len()), format!("one, or {}", axis.nm.len()));
        }
    }
}

pub(in super::super) fn bandpass_unstated(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        if axis.bandpass == Bandpass::Unstated {
            found.add(Place::path(format!("{path}/{}", name::FWHM)), "nothing", "the bandpass of the instrument");
        }
    }
}
