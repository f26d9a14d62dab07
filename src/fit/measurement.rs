//! From a measurement of a document to a fitted model.

use ndarray::Array2;

use super::geometry_set::{GeometrySet, SetError};
use super::identifiability::findings;
use super::left_out::LeftOut;
use super::outcome::Fit;
use super::separability::{NotSeparable, separability};
use super::solve::{DataError, Fitter, Terms};
use crate::dataset::{
    Document, FittedParameter, FittedTerm, Id, Measurement, Model, ReduceError, Reduced, Reduction, Residuals,
    TermsError, reduce, residuals,
};
use crate::quantity::{Part, QuantityKind, Reference};
use crate::terms::{Denominator, Distribution, Parameter, TermKind};

/// What to fit and how.
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// The terms; empty for what the measurement's part calls for: `luminescent` for a luminescent factor,
    /// `lambertian` and `torrance-sparrow` for all else.
    pub terms: Vec<TermKind>,
    /// Form of D.
    pub distribution: Distribution,
    /// Denominator of the specular term.
    pub denominator: Denominator,
    /// How a spectrum becomes the fitted number.
    pub reduction: Reduction,
    /// A reference convention to use where the measurement does not state one; recorded as an assumption.
    pub assume_reference: Option<Reference>,
    /// Digest of the measurement, stored with the model.
    pub data_digest: String,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            terms: Vec::new(),
            distribution: Distribution::GaussianHalfHeight,
            denominator: Denominator::CosThetaI,
            reduction: Reduction::Auto,
            assume_reference: None,
            data_digest: String::new(),
        }
    }
}

/// Why a measurement cannot be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The measurement cannot be reduced to numbers.
    #[error(transparent)]
    Reduce(#[from] ReduceError),
    /// The geometries cannot be fitted over.
    #[error("measurement `{measurement}`: {source}")]
    Geometry {
        /// Which measurement.
        measurement: String,
        /// Why.
        source: SetError,
    },
    /// The numbers cannot be fitted.
    #[error("measurement `{measurement}`: {source}")]
    Data {
        /// Which measurement.
        measurement: String,
        /// Why.
        source: DataError,
    },
    /// Two diffuse terms at once.
    #[error(
        "`lambertian` and `luminescent` have one angular form under one light and cannot be told apart by a scan; fit one"
    )]
    TwoDiffuseTerms,
    /// One term asked for twice.
    #[error("the term `{0}` is asked for twice; a sum of two of one form has no parameters of its own: name it once")]
    SameTermTwice(TermKind),
    /// The reference asked for is not the one that the measurement states.
    #[error(
        "measurement `{measurement}` states its reference as `{stated}`; `{asked}` was asked for, and a reference can be \
         assumed only where none is stated: leave `--reference` out, or correct the file"
    )]
    ReferenceStated {
        /// Which measurement.
        measurement: String,
        /// What it states.
        stated: Reference,
        /// What was asked for.
        asked: Reference,
    },
    /// A ratio to the irradiance of the surface, where the terms are of radiance over that of the beam.
    #[error(
        "measurement `{measurement}` is a `{kind}`; expected a factor or a radiance: pi and cos(theta_i) are between the \
         two, so convert it to a radiance factor first (times pi, with the reference `same-geometry`)"
    )]
    NoFactor {
        /// Which measurement.
        measurement: String,
        /// What it is.
        kind: QuantityKind,
    },
    /// The same term twice, or a term of the result without a parameter.
    #[error(transparent)]
    Terms(#[from] TermsError),
}

/// The terms of a fit: at most one diffuse, at most one specular.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    pub(super) diffuse: Option<TermKind>,
    pub(super) specular: bool,
}

impl Choice {
    fn new(terms: &[TermKind], part: Part) -> Result<Self, FitError> {
        let default: &[TermKind] = match part {
            Part::Luminescent => &[TermKind::Luminescent],
            _ => &[TermKind::Lambertian, TermKind::TorranceSparrow],
        };
        let terms = if terms.is_empty() { default } else { terms };
        if let Some(twice) = terms.iter().enumerate().find(|(k, kind)| terms[..*k].contains(kind)) {
            return Err(FitError::SameTermTwice(*twice.1));
        }
        let has = |kind| terms.contains(&kind);
        let diffuse = match (has(TermKind::Lambertian), has(TermKind::Luminescent)) {
            (true, true) => return Err(FitError::TwoDiffuseTerms),
            (true, false) => Some(TermKind::Lambertian),
            (false, true) => Some(TermKind::Luminescent),
            (false, false) => None,
        };
        Ok(Self { diffuse, specular: has(TermKind::TorranceSparrow) })
    }

    pub(super) fn terms(self) -> Terms {
        Terms { diffuse: self.diffuse.is_some(), specular: self.specular }
    }
}

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
    let geometry_error = |source| FitError::Geometry { measurement: name(), source };
    let data_error = |source| FitError::Data { measurement: name(), source };
    let (set, fit) = fit_reduced(&data, &reference, choice.terms(), options, geometry_error, data_error)?;
    // A geometry that took no part has no residual either, even where the sum of terms happens to have a value.
    set.undefined().iter().for_each(|&row| data.values.column_mut(row).fill(f64::NAN));
    let left_out = LeftOut { no_value: fit.left_out.no_value + data.left_out * data.values.nrows(), ..fit.left_out };
    let mut identifiability = data.notes.clone();
    if assumed {
        identifiability
            .push(format!("the measurement does not state its reference; `{reference}` was assumed on request"));
    }
    identifiability.extend(not_a_ratio(&data, choice));
    identifiability.extend(findings(&fit, &set, choice.terms(), data.sigma.is_some(), &left_out));
    let separability = match separability(&data, &reference) {
        Ok(separability) => Some(separability),
        Err(NotSeparable::NoTable) => None,
        Err(reason @ NotSeparable::Undefined(_)) => {
            identifiability.push(reason.to_string());
            None
        }
    };
    let (covariance_parameters, covariance) = stored_covariance(&fit, choice);
    let mut model = Model {
        id: Id::from_title(&format!("{}-{}", measurement.id, what_was_fitted(&data))),
        title: None,
        measurement: measurement.id.clone(),
        data_digest: options.data_digest.clone(),
        reduction: data.reduction.clone(),
        reference,
        unit: data.kind.unit().to_owned(),
        emission: data.emission.clone(),
        terms: fitted_terms(&fit, &data, choice, options),
        covariance_parameters,
        covariance: covariance.into_shared(),
        residuals: Residuals { rms: f64::NAN, reduced_chi_square: f64::NAN, count: 0, left_out: 0 },
        converged: fit.stop.is_converged(),
        method: method(&fit),
        identifiability,
        separability,
    };
    let parameters = data.values.len() - fit.left_out.total() - fit.degrees_of_freedom as usize;
    model.residuals = residuals(&model, &data, parameters)?.1;
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
    let data = reduce(document, measurement, options.reduction)?;
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
    data: &Reduced,
    reference: &Reference,
    terms: Terms,
    options: &FitOptions,
    geometry_error: impl Fn(SetError) -> FitError,
    data_error: impl Fn(DataError) -> FitError,
) -> Result<(GeometrySet, Fit), FitError> {
    let sigma = || data.sigma.as_ref().map(|sigma| sigma.view());
    let fitted = |set: GeometrySet, terms: Terms| match Fitter::new(&set, terms).fit_bands(data.values.view(), sigma())
    {
        Ok(fit) => Ok((set, fit)),
        Err(source) => Err(data_error(source)),
    };
    let diffuse = || GeometrySet::diffuse(&data.geometry, reference).map_err(&geometry_error);
    if !terms.specular {
        return fitted(diffuse()?, terms);
    }
    let set = GeometrySet::new(&data.geometry, reference, options.distribution, options.denominator)
        .map_err(&geometry_error)?;
    let (set, fit) = fitted(set, terms)?;
    if fit.has_specular() || set.undefined().is_empty() || !terms.diffuse {
        return Ok((set, fit));
    }
    let (set, alone) = fitted(diffuse()?, Terms { diffuse: true, specular: false })?;
    Ok((set, Fit { specular_gain: fit.specular_gain, evaluations: fit.evaluations, ..alone }))
}

fn method(fit: &Fit) -> String {
    format!(
        "least squares, weighted with 1/sigma^2 where sigma is known; amplitudes non-negative by variable projection; \
         roughness and index from a 12 x 3 grid, two starts polished by Levenberg-Marquardt; {} after {} evaluations",
        fit.stop.text(),
        fit.evaluations
    )
}

fn fitted_terms(fit: &Fit, data: &Reduced, choice: Choice, options: &FitOptions) -> Vec<FittedTerm> {
    let unit = data.kind.unit();
    let sigma = |k: usize| (0..fit.bands.len()).map(|band| fit.standard_uncertainty(band)[k]).collect::<Vec<f64>>();
    let amplitude = |parameter: &Parameter, k: usize| FittedParameter {
        name: parameter.name.to_owned(),
        unit: unit.to_owned(),
        value: fit.bands.iter().map(|band| if k == 0 { band.diffuse } else { band.intensity }).collect(),
        standard_uncertainty: sigma(k),
        shared_relative_uncertainty: shared(data),
    };
    let common = |parameter: &Parameter, value: f64, k: usize| FittedParameter {
        name: parameter.name.to_owned(),
        unit: parameter.unit(Some(options.distribution)).to_owned(),
        value: vec![value],
        standard_uncertainty: vec![fit.standard_uncertainty(0)[k]],
        shared_relative_uncertainty: Vec::new(),
    };
    let mut terms = Vec::new();
    if let Some(kind) = choice.diffuse {
        let parameters = vec![amplitude(&kind.parameters()[0], 0)];
        terms.push(FittedTerm { kind, distribution: None, denominator: None, parameters });
    }
    if fit.has_specular() {
        let names = TermKind::TorranceSparrow.parameters();
        terms.push(FittedTerm {
            kind: TermKind::TorranceSparrow,
            distribution: Some(options.distribution),
            denominator: Some(options.denominator),
            parameters: vec![
                amplitude(&names[0], 1),
                common(&names[1], fit.roughness, 2),
                common(&names[2], fit.refractive_index(), 3),
            ],
        });
    }
    terms
}

/// What all rows share scales every amplitude alike; nothing is stored where there is none.
fn shared(data: &Reduced) -> Vec<f64> {
    if data.shared_relative.iter().all(|relative| *relative == 0.0) { Vec::new() } else { data.shared_relative.clone() }
}

/// The covariance that is stored: of all parameters where there is one emission value, of the common ones otherwise.
fn stored_covariance(fit: &Fit, choice: Choice) -> (Vec<String>, Array2<f64>) {
    let name = |kind: TermKind, k: usize| format!("{}.{}", kind.name(), kind.parameters()[k].name);
    let mut entries: Vec<(String, usize)> = Vec::new();
    let single = fit.bands.len() == 1;
    if let (Some(kind), true) = (choice.diffuse, single) {
        entries.push((name(kind, 0), 0));
    }
    if fit.has_specular() {
        if single {
            entries.push((name(TermKind::TorranceSparrow, 0), 1));
        }
        entries.extend([1, 2].map(|k| (name(TermKind::TorranceSparrow, k), k + 1)));
    }
    let covariance = Array2::from_shape_fn((entries.len(), entries.len()), |(i, j)| {
        fit.bands[0].covariance[entries[i].1][entries[j].1]
    });
    (entries.into_iter().map(|entry| entry.0).collect(), covariance)
}
