//! What a fit of the simulated scan must find.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::instrument::{NOISE, SCALE};
use super::objects::Object;
use super::optics::{Spectra, WAVELENGTHS, WHITE_FACTOR, wavelength_nm};

/// Bands for which the truth is summed, nm, both ends included.
const BANDS: [(f64, f64); 5] = [(400.0, 700.0), (460.0, 680.0), (480.0, 680.0), (500.0, 620.0), (500.0, 700.0)];

/// Irradiance below which there is no light, W m-2 nm-1.
const DARK: f64 = 1.0e-9;

/// The parameters and the spectra behind the scan. Factors are over the perfect diffuser at theta_i = 0, so a
/// Lambertian factor against the white plate in its fixed geometry is `albedo` times cos(theta_i).
pub(crate) fn truth(object: &Object, spectra: &Spectra) -> Value {
    let albedo: Vec<f64> = (0..WAVELENGTHS).map(|i| albedo(spectra, i..i + 1)).collect();
    let luminescent: Vec<f64> =
        (0..WAVELENGTHS).map(|i| ratio(spectra.luminescent[i], spectra.irradiance[i])).collect();
    let radiance: Vec<f64> = spectra.luminescent.iter().map(|exitance| exitance / PI).collect();
    json!({
        "simulated": true,
        "object": object.name,
        "title": object.title,
        "torrance-sparrow": {
            "intensity": object.intensity,
            "roughness": object.roughness,
            "refractive_index": object.refractive_index,
            "distribution": "gaussian-half-height",
            "denominator": "cos-theta-i",
        },
        "reference": "fixed-geometry(0,45)",
        "certified_factor": WHITE_FACTOR,
        "noise": { "relative_per_value": NOISE, "relative_per_record": SCALE },
        "bands": BANDS.iter().map(|band| band_truth(spectra, *band)).collect::<Vec<_>>(),
        "emission_nm": (0..WAVELENGTHS).map(wavelength_nm).collect::<Vec<_>>(),
        "irradiance": rounded(&spectra.irradiance),
        "albedo": rounded(&albedo),
        "luminescent_part_of_albedo": rounded(&luminescent),
        "luminescent_radiance_at_normal_incidence": rounded(&radiance),
    })
}

/// Reflected and luminescent light over what falls in, as a ratio of sums.
fn albedo(spectra: &Spectra, range: std::ops::Range<usize>) -> f64 {
    let sum = |values: &[f64]| values[range.clone()].iter().sum::<f64>();
    ratio(sum(&spectra.diffuse) + sum(&spectra.luminescent), sum(&spectra.irradiance))
}

/// A quotient over irradiance; not a number, and `null` in the file, where no light falls in.
fn ratio(exitance: f64, irradiance: f64) -> f64 {
    if irradiance > DARK { exitance / irradiance } else { f64::NAN }
}

fn band_truth(spectra: &Spectra, (from, to): (f64, f64)) -> Value {
    let index = |nm: f64| ((nm - 380.0) / 4.0) as usize;
    let range = index(from)..index(to) + 1;
    json!({ "from_nm": from, "to_nm": to, "albedo": round(albedo(spectra, range)) })
}

/// Six digits: what the platform's `exp` leaves in the last one must not change the file.
fn round(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(f64::NAN)
}

fn rounded(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| round(*value)).collect()
}
