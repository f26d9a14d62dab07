//! The spectrum of a scan, whatever its geometries: the amplitude of what follows the cosine of the incidence, wavelength by
//! wavelength.

use super::comparison::Spectrum;
use crate::dataset::{Document, Mask, Measurement, Model, Reduced, Reduction, reduce};
use crate::quantity::{Bandpass, CorrelatedOver, EmissionAxis, Geometry, Reference};
use crate::terms::{Term, TermKind, diffuse_factor};

/// A row in which the specular term is more than this share of what the model predicts says little of the diffuse spectrum.
const SPECULAR: f64 = 0.05;

/// What falls on a group of rows, as the index of its excitation state, and the spectrum of those rows.
pub(super) type OfState = (Option<u32>, Spectrum);

/// The spectrum of each excitation state.
///
/// # Errors
/// A sentence where the scan has no spectrum.
pub(super) fn spectra(document: &Document, scan: &Measurement, model: &Model) -> Result<Vec<OfState>, String> {
    let EmissionAxis::Wavelengths(axis) = &scan.emission else {
        return Err("the scan is in one band only: the shape of its spectrum cannot be checked".to_owned());
    };
    if axis.nm.len() < 3 {
        return Err(format!(
            "the scan has {} wavelengths: the shape of its spectrum cannot be checked with fewer than 3",
            axis.nm.len()
        ));
    }
    let fwhm_nm = match &axis.bandpass {
        Bandpass::Stated { fwhm_nm, .. } => fwhm_nm.get(fwhm_nm.len() / 2).copied(),
        Bandpass::Unstated => None,
    };
    if model.has_spectral_albedo(scan) {
        return Ok(vec![(None, albedo(model, scan, fwhm_nm))]);
    }
    let mut data = reduce(document, scan, Reduction::None)
        .map_err(|error| format!("the shape of the scan's spectrum cannot be checked: {error}"))?;
    if let Ok(mask) = model.mask.as_deref().unwrap_or_default().parse::<Mask>() {
        data.apply(&mask);
    }
    let state = |row: usize| scan.acquisitions.get(data.rows[row]).and_then(|row| row.excitation);
    let mut states: Vec<Option<u32>> = (0..data.rows.len()).map(state).collect();
    states.sort_unstable();
    states.dedup();
    let diffuse: Vec<Option<f64>> =
        data.geometry.iter().map(|geometry| clear_of_the_interface(model, geometry)).collect();
    let all = states.into_iter().map(|one| {
        let rows: Vec<(usize, f64)> = diffuse
            .iter()
            .enumerate()
            .filter(|(row, _)| state(*row) == one)
            .filter_map(|(row, factor)| Some((row, (*factor)?)))
            .collect();
        (one, Spectrum { fwhm_nm, ..spectrum(scan, &data, model, &rows) })
    });
    Ok(all.collect())
}

/// The albedo that was fitted at every wavelength, with what its errors do not share.
fn albedo(model: &Model, scan: &Measurement, fwhm_nm: Option<f64>) -> Spectrum {
    let term = model.terms.iter().find(|term| term.kind == TermKind::Lambertian);
    let Some((fitted, nm)) = term.and_then(|term| term.parameters.first()).zip(model.emission.wavelengths()) else {
        return Spectrum::default();
    };
    let sigma = |(k, value): (usize, &f64)| {
        let own = fitted.standard_uncertainty.get(k).copied().unwrap_or(f64::NAN);
        own.hypot(by_wavelength(scan, nm[k]) * value)
    };
    let sigma = fitted.value.iter().enumerate().map(sigma).collect();
    Spectrum { nm: nm.to_vec(), values: fitted.value.clone(), sigma, fwhm_nm }
}

/// The relative standard uncertainty that all rows share at one wavelength, and wavelengths do not.
fn by_wavelength(scan: &Measurement, nm: f64) -> f64 {
    let column = scan.emission.wavelengths().and_then(|axis| axis.iter().position(|one| *one == nm)).unwrap_or(0);
    let components = scan.uncertainty.components.iter();
    let own = components.filter(|component| component.correlated_over == CorrelatedOver::Acquisitions);
    own.map(|component| component.relative_at(column).powi(2)).sum::<f64>().sqrt()
}

/// The angular factor of the diffuse part at a geometry; `None` where there is none, or the interface shows.
fn clear_of_the_interface(model: &Model, geometry: &Geometry) -> Option<f64> {
    let factor = diffuse_factor(geometry, &model.reference).ok().filter(|factor| *factor > 0.0)?;
    let is_clear = (0..model.emission.len()).all(|emission| {
        let Ok(terms) = model.terms_at(emission) else { return true };
        let Some(specular) = specular(&terms, geometry, &model.reference) else { return false };
        let diffuse: f64 = terms
            .iter()
            .filter(|term| term.kind() != TermKind::TorranceSparrow)
            .map(|term| term.values()[0] * factor)
            .sum();
        specular == 0.0 || specular <= SPECULAR * (specular + diffuse)
    });
    is_clear.then_some(factor)
}

fn specular(terms: &[Term], geometry: &Geometry, reference: &Reference) -> Option<f64> {
    let lit = terms.iter().filter(|term| term.kind() == TermKind::TorranceSparrow);
    lit.map(|term| term.evaluate(geometry, reference).map(|one| one.value)).sum::<Result<f64, _>>().ok()
}

/// The amplitude of the angular factor at each wavelength, by least squares, less the specular term.
fn spectrum(scan: &Measurement, data: &Reduced, model: &Model, rows: &[(usize, f64)]) -> Spectrum {
    let mut found = Spectrum::default();
    let Some(nm) = data.emission.wavelengths() else { return found };
    let fitted = model.emission.wavelengths();
    for (column, nm) in nm.iter().enumerate() {
        let nearest = |fitted: &[f64]| {
            (0..fitted.len()).min_by(|a, b| (fitted[*a] - nm).abs().total_cmp(&(fitted[*b] - nm).abs()))
        };
        let terms = model.terms_at(fitted.and_then(nearest).unwrap_or(0)).unwrap_or_default();
        let looks: Vec<[f64; 3]> = rows
            .iter()
            .filter_map(|(row, factor)| {
                let value = data.values[(column, *row)];
                let less = specular(&terms, &data.geometry[*row], &model.reference)?;
                // The scale error of a record moves its whole spectrum: it is no error of the shape.
                let sigma = data.sigma.as_ref().map_or(f64::NAN, |sigma| {
                    let record = data.record_relative[column] * value;
                    (sigma[(column, *row)].powi(2) - record * record).max(0.0).sqrt()
                });
                value.is_finite().then_some([value - less, sigma, *factor])
            })
            .collect();
        if let Some((value, sigma)) = amplitude(&looks) {
            found.nm.push(*nm);
            found.values.push(value);
            found.sigma.push(sigma.hypot(by_wavelength(scan, *nm) * value));
        }
    }
    found
}

/// The best amplitude of (value, sigma, factor), with its standard uncertainty: from the stated ones, and from the scatter where that
/// is more or nothing is stated.
fn amplitude(looks: &[[f64; 3]]) -> Option<(f64, f64)> {
    let stated = looks.iter().all(|[_, sigma, _]| *sigma > 0.0 && sigma.is_finite());
    let weight = |sigma: f64| if stated { sigma.powi(-2) } else { 1.0 };
    let information: f64 = looks.iter().map(|[_, sigma, factor]| weight(*sigma) * factor * factor).sum();
    if information.is_nan() || information <= 0.0 {
        return None;
    }
    let value = looks.iter().map(|[value, sigma, factor]| weight(*sigma) * factor * value).sum::<f64>() / information;
    let square: f64 = looks.iter().map(|[y, sigma, factor]| weight(*sigma) * (y - value * factor).powi(2)).sum();
    let scatter = match looks.len() {
        0 | 1 => f64::NAN,
        count => square / (count - 1) as f64,
    };
    // max() passes over what is not known.
    let unit = if stated { scatter.max(1.0) } else { scatter };
    Some((value, (unit / information).sqrt()))
}
