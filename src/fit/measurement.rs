//! From a measurement of a document to a fitted model.

use super::effort::Effort;
use super::fits::Fits;
use super::geometry_set::GeometrySet;
use super::identifiability::findings;
use super::options::{Choice, FitError, FitOptions};
use super::separability::{NotSeparable, separability};
use super::solve::{Fitter, Terms};
use crate::dataset::{Document, Id, Measurement, Model, Reduced, Residuals, reduce, residuals};
use crate::quantity::{QuantityKind, Reference};
use crate::terms::TermKind;

/// Fits the terms to a measurement of a document, without a starting point.
///
/// # Errors
/// [`FitError`] when the measurement cannot be reduced, its reference is unstated, or too few values are usable. That
/// the data cannot tell a parameter is not an error but a finding of the model.
pub fn fit_measurement(
    document: &Document,
    measurement: &Measurement,
    options: &FitOptions,
) -> Result<Model, FitError> {
    let name = || measurement.id.to_string();
    let Prepared { choice, mut data, reference, assumed } = prepared(document, measurement, options)?;
    let (set, fits, undone) = fit_reduced(&name(), &data, &reference, choice.terms(), options)?;
    // A geometry that took no part has no residual either, even where the sum of terms happens to have a value.
    set.undefined().iter().for_each(|&row| data.values.column_mut(row).fill(f64::NAN));
    let mut identifiability = data.notes.clone();
    if assumed {
        identifiability
            .push(format!("the measurement does not state its reference; `{reference}` was assumed on request"));
    }
    identifiability.extend(not_a_ratio(&data, choice));
    identifiability.extend(undone);
    identifiability.extend(findings(&fits, &set, choice.terms(), &data, options.wavelength_shift_nm));
    let separability = match separability(&data, &reference) {
        Ok(separability) => Some(separability),
        Err(NotSeparable::NoTable) => None,
        Err(reason @ NotSeparable::Undefined(_)) => {
            identifiability.push(reason.to_string());
            None
        }
    };
    let (covariance_parameters, covariance) = fits.stored_covariance(choice);
    let mut model = Model {
        id: Id::from_title(&format!("{}-{}", measurement.id, what_was_fitted(&data))),
        title: None,
        measurement: measurement.id.clone(),
        data_digest: options.data_digest.clone(),
        reduction: data.reduction.clone(),
        mask: (!options.mask.is_empty()).then(|| options.mask.to_string()),
        reference,
        unit: data.kind.unit().to_owned(),
        emission: data.emission.clone(),
        terms: fits.terms(&data, choice, options),
        nuisances: fits.nuisances(),
        covariance_parameters,
        covariance: covariance.into_shared(),
        residuals: Residuals { rms: f64::NAN, reduced_chi_square: f64::NAN, count: 0, left_out: 0 },
        converged: fits.converged(),
        method: fits.method(options),
        identifiability,
        separability,
        donaldson: None,
    };
    model.residuals = residuals(&model, &data, model.fitted_parameters())?.1;
    Ok(model)
}

/// What is fitted: the terms, the numbers, and the reference that they are relative to.
pub(super) struct Prepared {
    pub(super) choice: Choice,
    pub(super) data: Reduced,
    pub(super) reference: Reference,
    /// True where the reference was assumed on request.
    pub(super) assumed: bool,
}

/// Reduces a measurement for a fit.
pub(super) fn prepared(
    document: &Document,
    measurement: &Measurement,
    options: &FitOptions,
) -> Result<Prepared, FitError> {
    let name = || measurement.id.to_string();
    let kind = measurement.quantity.kind;
    if matches!(kind, QuantityKind::Brdf | QuantityKind::Brrdf) {
        return Err(FitError::NoFactor { measurement: name(), kind });
    }
    let choice = Choice::new(&options.terms, measurement.quantity.part)?;
    let mut data = reduce(document, measurement, options.reduction)?;
    let hidden = data.apply(&options.mask);
    if hidden > 0 {
        data.notes.push(format!("{hidden} rows are masked out on request ({})", options.mask));
    }
    let (reference, assumed) = match (data.reference, options.assume_reference) {
        (Reference::Unstated, Some(assumed)) => (assumed, true),
        (stated, Some(asked)) if asked != stated => {
            return Err(FitError::ReferenceStated { measurement: name(), stated, asked });
        }
        (stated, _) => (stated, false),
    };
    Ok(Prepared { choice, data, reference, assumed })
}

/// How the numbers were formed, for the model's id: a reduction to `none` keeps every wavelength.
fn what_was_fitted(data: &Reduced) -> &str {
    match data.emission.wavelengths() {
        Some(_) if data.reduction == "none" => "every-wavelength",
        None if data.reduction == "none" => "band",
        _ => &data.reduction,
    }
}

/// Amplitudes of a radiance carry its unit: the names of the parameters do not say so.
fn not_a_ratio(data: &Reduced, choice: Choice) -> Option<String> {
    let amplitude = |kind: TermKind| format!("`{}`", kind.parameters()[0].name);
    let specular = choice.specular.then_some(TermKind::TorranceSparrow);
    let names: Vec<String> = choice.diffuse.into_iter().chain(specular).map(amplitude).collect();
    let (kind, unit) = (data.kind, data.kind.unit());
    (!kind.is_factor()).then(|| {
        format!(
            "the fitted numbers are {kind} (unit {unit}) and no factor: {} are amplitudes in that unit, no albedo and no \
             share of the incident light; only the fit of a factor gives those",
            names.join(" and ")
        )
    })
}

/// Fits the terms; where no specular one is seen, the diffuse one alone over every geometry at which it has a value.
pub(super) fn fit_reduced(
    name: &str,
    data: &Reduced,
    reference: &Reference,
    terms: Terms,
    options: &FitOptions,
) -> Result<(GeometrySet, Fits, Option<String>), FitError> {
    let geometry_error = |source| FitError::Geometry { measurement: name.to_owned(), source };
    let data_error = |source| FitError::Data { measurement: name.to_owned(), source };
    let fitted = |set: &GeometrySet, terms: Terms| -> Result<(Fits, Option<String>), FitError> {
        let mut fitter = Fitter::new(set, terms).sharing(options.share.unwrap_or_default());
        let index = options.index_box.map(|(low, high)| (low - 1.0, high - 1.0));
        if options.roughness_box.is_some() || index.is_some() {
            let all = (f64::MIN_POSITIVE, f64::MAX);
            fitter = fitter.within(options.roughness_box.unwrap_or(all), index.unwrap_or(all));
        }
        let mut fits = Fits::of(&fitter, data, options).map_err(data_error)?;
        let undone = fits.refine(&fitter, data, reference, options);
        Ok((fits, undone))
    };
    let diffuse = || GeometrySet::diffuse(&data.geometry, reference).map_err(geometry_error);
    if !terms.specular {
        let set = diffuse()?;
        let (fits, undone) = fitted(&set, terms)?;
        return Ok((set, fits, undone));
    }
    let set = GeometrySet::new(&data.geometry, reference, options.distribution, options.denominator)
        .map_err(geometry_error)?;
    // Its tables are built already, of the usual effort.
    let set = if options.effort == Effort::default() { set } else { set.with_effort(options.effort) };
    let (fits, undone) = fitted(&set, terms)?;
    if fits.has_specular() || set.undefined().is_empty() || !terms.diffuse {
        return Ok((set, fits, undone));
    }
    let set = diffuse()?;
    let (alone, undone) = fitted(&set, Terms { diffuse: true, specular: false })?;
    Ok((set, alone.after(&fits), undone))
}
