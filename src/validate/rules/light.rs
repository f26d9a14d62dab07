//! Can the spectra of the lights be spectra of lights, and do they reach as far as they are used? Their axes are judged
//! with all others, by the rules of wavelengths.

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Excitation, Light, LightSpectrum, Measurement, Place, Role};
use crate::quantity::{EmissionAxis, Flags, Part};

fn spectra<'a>(context: &Context<'a>) -> impl Iterator<Item = (String, &'a Light, &'a LightSpectrum)> {
    let lights = context.document().map_or(&[][..], |document| &document.lights);
    lights.iter().filter_map(|light| {
        Some((format!("/{}/{}/{}", name::LIGHT, light.id, name::VALUE), light, light.spectrum.as_ref()?))
    })
}

/// Values with their flags, and their index.
fn values(spectrum: &LightSpectrum) -> impl Iterator<Item = (usize, f64, Flags)> {
    let flags = spectrum.flags.iter().copied().chain(std::iter::repeat(0));
    spectrum.values.iter().zip(flags).enumerate().map(|(index, (value, flags))| (index, *value, Flags(flags)))
}

/// Values that may be taken for the light.
fn usable(spectrum: &LightSpectrum) -> Vec<(usize, f64)> {
    let known = |(index, value, flags): (usize, f64, Flags)| {
        (value.is_finite() && !flags.explains_absence()).then_some((index, value))
    };
    values(spectrum).filter_map(known).collect()
}

pub(in super::super) fn shape(context: &Context<'_>, found: &mut Finder) {
    for (path, _, spectrum) in spectra(context) {
        let lengths = [spectrum.axis.nm.len(), spectrum.values.len(), spectrum.flags.len()];
        if lengths.iter().any(|length| *length != lengths[0]) {
            let [wavelengths, values, flags] = lengths;
            let what = format!("{values} values and {flags} flag masks");
            found.add(Place::path(path), what, format!("{wavelengths} of both, one for each wavelength"));
        }
    }
}

/// Reports the first value of each spectrum that the rule objects to.
fn each(context: &Context<'_>, found: &mut Finder, expected: &str, objects: impl Fn(f64, Flags) -> bool) {
    for (path, _, spectrum) in spectra(context) {
        if let Some((index, value, _)) = values(spectrum).find(|(_, value, flags)| objects(*value, *flags)) {
            found.add(Place::path(path).at_index([index]), value.to_string(), expected);
        }
    }
}

pub(in super::super) fn nan_without_reason(context: &Context<'_>, found: &mut Finder) {
    let expected = "a flag that says why there is no value";
    each(context, found, expected, |value, flags| value.is_nan() && !flags.explains_absence());
}

pub(in super::super) fn infinite(context: &Context<'_>, found: &mut Finder) {
    each(context, found, "a finite number, or NaN with a reason", |value, _| value.is_infinite());
}

/// Noise of neighbouring values, from how each departs from the line between its neighbours: the median of the
/// magnitudes, which lines of a lamp do not move, as the standard deviation of a normal distribution.
fn noise(values: &[(usize, f64)]) -> f64 {
    let mut bends: Vec<f64> =
        values.windows(3).map(|three| (three[1].1 - (three[0].1 + three[2].1) / 2.0).abs()).collect();
    bends.sort_by(f64::total_cmp);
    let median = bends.get(bends.len() / 2).copied().unwrap_or(0.0);
    median / 0.674_489_750_196_081_7 / 1.5_f64.sqrt()
}

pub(in super::super) fn negative(context: &Context<'_>, found: &mut Finder) {
    // A spectrum of a light has no uncertainty: what it scatters by is its noise, and a thousandth of the peak is none.
    const SIGMAS: f64 = 6.0;
    const OF_PEAK: f64 = 1e-3;
    for (path, _, spectrum) in spectra(context) {
        let known = usable(spectrum);
        let peak = known.iter().map(|(_, value)| *value).fold(0.0, f64::max);
        let allowed = (SIGMAS * noise(&known)).min(peak).max(OF_PEAK * peak);
        let lowest = known.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, value)) = lowest.filter(|(_, value)| *value < -allowed) {
            let expected = format!("no less than {:.3e}: what its neighbours scatter by", -allowed);
            found.add(Place::path(path).at_index([*index]), value.to_string(), expected);
        }
    }
}

pub(in super::super) fn no_value(context: &Context<'_>, found: &mut Finder) {
    for (path, _, spectrum) in spectra(context) {
        if !usable(spectrum).iter().any(|(_, value)| *value > 0.0) {
            found.add(Place::path(path), "no value above 0", "a spectrum with light in it");
        }
    }
}

/// True where rows are lit by that light as it is, without a monochromator.
fn is_lit_by(measurement: &Measurement, light: &Light) -> bool {
    let broad = |state: &Excitation| state.wavelength_nm.is_none() && state.light.as_ref() == Some(&light.id);
    measurement.excitations.iter().any(broad)
}

pub(in super::super) fn covers_emission(context: &Context<'_>, found: &mut Finder) {
    for (path, light, spectrum) in spectra(context) {
        let used = context.measurements().filter(|(_, measurement)| {
            measurement.role == Role::Sample
                && measurement.quantity.part != Part::Luminescent
                && is_lit_by(measurement, light)
        });
        for (measured, measurement) in used {
            let EmissionAxis::Wavelengths(axis) = &measurement.emission else { continue };
            let ends = |nm: &[f64]| Some((*nm.first()?, *nm.last()?));
            let Some(((first, last), (from, to))) = ends(&axis.nm).zip(ends(&spectrum.axis.nm)) else { continue };
            if first < from || last > to {
                let place = Place::path(path.replace(name::VALUE, name::WAVELENGTH));
                let expected = format!("{first} to {last} nm, the emission axis of {measured}");
                found.add(place, format!("{from} to {to} nm"), expected);
            }
        }
    }
}
