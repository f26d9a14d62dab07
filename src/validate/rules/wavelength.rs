//! Are the wavelength axes axes?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Excitation, Place};
use crate::quantity::{Bandpass, BandpassCorrection, BandpassShape, EmissionAxis, WavelengthAxis};

/// Every emission axis with the path of its group.
fn axes<'a>(context: &Context<'a>) -> Vec<(String, &'a WavelengthAxis)> {
    let Some(document) = context.document() else { return Vec::new() };
    let measured = document.measurements.iter().map(|m| (format!("/{}/{}", name::MEASUREMENT, m.id), &m.emission));
    let fitted = document.models.iter().map(|m| (format!("/{}/{}", name::MODEL, m.id), &m.emission));
    let factorised =
        document.factorisations.iter().map(|f| (format!("/{}/{}", name::FACTORISATION, f.id), &f.emission));
    let mut axes: Vec<_> = measured
        .chain(fitted)
        .filter_map(|(path, emission)| match emission {
            EmissionAxis::Wavelengths(axis) => Some((path, axis)),
            EmissionAxis::Band { .. } => None,
        })
        .chain(factorised)
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

pub(in super::super) fn bandpass_positive(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        let Bandpass::Stated { fwhm_nm, .. } = &axis.bandpass else { continue };
        if let Some(index) = fwhm_nm.iter().position(|width| !(width.is_finite() && *width > 0.0)) {
            let place = Place::path(format!("{path}/{}", name::FWHM)).at_index([index]);
            found.add(place, format!("{} nm", fwhm_nm[index]), "a positive finite width");
        }
    }
}

pub(in super::super) fn bandpass_particulars(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        let Bandpass::Stated { shape, correction, .. } = &axis.bandpass else { continue };
        let place = |attribute: &str| Place::path(format!("{path}/{}@{attribute}", name::FWHM));
        if *shape == BandpassShape::Unstated {
            found.add(place(name::SHAPE), "`unstated`", "the shape of the slit function");
        }
        if *correction == BandpassCorrection::Unstated {
            found.add(place(name::CORRECTION), "`unstated`", "`corrected` or `uncorrected`");
        }
    }
}

pub(in super::super) fn actual_length(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        let (actual, nominal) = (axis.actual_nm.len(), axis.nm.len());
        if actual != 0 && actual != nominal {
            let place = Place::path(format!("{path}/{}", name::WAVELENGTH_ACTUAL));
            found.add(place, format!("{actual} wavelengths"), format!("none, or {nominal}"));
        }
    }
}

pub(in super::super) fn actual_near(context: &Context<'_>, found: &mut Finder) {
    for (path, axis) in axes(context) {
        let step = axis.nm.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let near = |(nominal, actual): (&f64, &f64)| (nominal - actual).abs() < step;
        if let Some(index) = axis.nm.iter().zip(&axis.actual_nm).position(|pair| !near(pair)) {
            let place = Place::path(format!("{path}/{}", name::WAVELENGTH_ACTUAL)).at_index([index]);
            let expected = format!("within a step ({step} nm) of the nominal {} nm", axis.nm[index]);
            found.add(place, format!("{} nm", axis.actual_nm[index]), expected);
        }
    }
}

pub(in super::super) fn range(context: &Context<'_>, found: &mut Finder) {
    // Below lies nothing that fluoresces from a surface; above, nothing that a lamp excites.
    const FROM: f64 = 100.0;
    const TO: f64 = 20_000.0;
    for (path, axis) in axes(context) {
        if let Some(index) = axis.nm.iter().position(|nm| nm.is_finite() && *nm > 0.0 && !(FROM..=TO).contains(nm)) {
            let place = Place::path(format!("{path}/{}", name::WAVELENGTH)).at_index([index]);
            found.add(place, format!("{} nm", axis.nm[index]), format!("{FROM} to {TO} nm; is it another unit?"));
        }
    }
}

pub(in super::super) fn band_order(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    let measured = document.measurements.iter().map(|m| (format!("/{}/{}", name::MEASUREMENT, m.id), &m.emission));
    let fitted = document.models.iter().map(|m| (format!("/{}/{}", name::MODEL, m.id), &m.emission));
    for (path, emission) in measured.chain(fitted) {
        if let EmissionAxis::Band { band: Some(band) } = emission
            && !(band.from_nm > 0.0 && band.from_nm < band.to_nm && band.to_nm.is_finite())
        {
            let place = Place::path(format!("{path}/{}", name::BAND));
            found.add(place, format!("{} to {} nm", band.from_nm, band.to_nm), "a positive lower end below the upper");
        }
    }
}

pub(in super::super) fn excitation(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        for (index, state) in measurement.excitations.iter().enumerate() {
            let fields = [
                (name::EXCITATION_WAVELENGTH, state.wavelength_nm),
                (name::EXCITATION_FWHM, state.fwhm_nm),
                (name::EXCITATION_ACTUAL, state.actual_nm),
            ];
            for (dataset, nm) in fields.into_iter().filter_map(|(dataset, nm)| Some((dataset, nm?))) {
                if !(nm.is_finite() && nm > 0.0) {
                    let place = Place::path(format!("{path}/{dataset}")).at_index([index]);
                    found.add(place, format!("{nm} nm"), "a positive finite number");
                }
            }
        }
    }
}

pub(in super::super) fn excitation_bandpass(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let open = |state: &Excitation| state.wavelength_nm.is_some() && state.fwhm_nm.is_none();
        if let Some(index) = measurement.excitations.iter().position(open) {
            let place = Place::path(format!("{path}/{}", name::EXCITATION_FWHM)).at_index([index]);
            found.add(place, "nothing", "the full width at half maximum of the excitation");
        }
    }
}
