//! The one definition of a model's prediction and of predicted minus measured.

use ndarray::Array2;

use super::{Effect, Effects, FittedTerm, Model, Reduced, Residuals};
use crate::quantity::{Geometry, Reference};
use crate::terms::{Denominator, Distribution, Term, TermKind, TorranceSparrow, Undefined};

/// Why a stored term is not one of the standard's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TermsError {
    /// A parameter is not there, or not for this emission value.
    #[error("term `{term}`: no `{parameter}` for emission index {emission}")]
    MissingParameter {
        /// Which term.
        term: TermKind,
        /// Which parameter.
        parameter: &'static str,
        /// Which emission value.
        emission: usize,
    },
}

impl FittedTerm {
    /// A parameter's value at an emission index: one number serves all.
    #[must_use]
    pub fn parameter_at(&self, name: &str, emission: usize) -> Option<f64> {
        let parameter = self.parameters.iter().find(|parameter| parameter.name == name)?;
        if parameter.value.len() == 1 { parameter.value.first() } else { parameter.value.get(emission) }.copied()
    }

    /// False for a specular term that was not seen at an emission value: its intensity is 0 and its shape undefined, and it
    /// adds nothing.
    #[must_use]
    pub fn is_seen_at(&self, emission: usize) -> bool {
        let names = self.kind.parameters();
        self.kind != TermKind::TorranceSparrow
            || self.parameter_at(names[0].name, emission) != Some(0.0)
            || self.parameter_at(names[1].name, emission).is_none_or(|roughness| !roughness.is_nan())
    }

    /// The term at one emission value.
    ///
    /// # Errors
    /// [`TermsError`] when a parameter is missing.
    pub fn term_at(&self, emission: usize) -> Result<Term, TermsError> {
        let value = |parameter: &'static str| {
            self.parameter_at(parameter, emission).ok_or(TermsError::MissingParameter {
                term: self.kind,
                parameter,
                emission,
            })
        };
        let names = self.kind.parameters();
        Ok(match self.kind {
            TermKind::Lambertian => Term::Lambertian { albedo: value(names[0].name)? },
            TermKind::Luminescent => Term::Luminescent { factor: value(names[0].name)? },
            TermKind::TorranceSparrow => Term::TorranceSparrow(TorranceSparrow {
                intensity: value(names[0].name)?,
                roughness: value(names[1].name)?,
                refractive_index: value(names[2].name)?,
                distribution: self.distribution.unwrap_or(Distribution::GaussianHalfHeight),
                denominator: self.denominator.unwrap_or(Denominator::CosThetaI),
            }),
        })
    }
}

impl Model {
    /// What the instrument did to the geometries of the data.
    #[must_use]
    pub fn effects(&self) -> Effects {
        let known = self.nuisances.iter().filter_map(|fitted| {
            let effect = fitted.name.parse::<Effect>().ok()?;
            fitted.value.first().map(|value| (effect, *value))
        });
        known.fold(Effects::default(), |effects, (effect, value)| effects.with(effect, value))
    }

    /// The terms that were seen at one emission value of the fitted numbers.
    ///
    /// # Errors
    /// [`TermsError`] when a parameter is missing.
    pub fn terms_at(&self, emission: usize) -> Result<Vec<Term>, TermsError> {
        self.terms.iter().filter(|term| term.is_seen_at(emission)).map(|term| term.term_at(emission)).collect()
    }
}

/// The sum of terms at one geometry, with the elastic and the luminescent part apart.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prediction {
    /// Reflected part, in the unit of the reference convention (Y/E without a reference).
    pub elastic: f64,
    /// Luminescent part.
    pub luminescent: f64,
}

impl Prediction {
    /// Both parts: what a broadband instrument measures.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.elastic + self.luminescent
    }
}

/// Predicts the sum of terms under a reference convention.
///
/// # Errors
/// [`Undefined`] where a term, or the sum, has no value at the geometry.
pub fn predict(terms: &[Term], geometry: &Geometry, reference: &Reference) -> Result<Prediction, Undefined> {
    let mut sum = Prediction::default();
    for term in terms {
        let value = term.evaluate(geometry, reference)?.value;
        match term.kind() {
            TermKind::Luminescent => sum.luminescent += value,
            TermKind::Lambertian | TermKind::TorranceSparrow => sum.elastic += value,
        }
    }
    if sum.total().is_finite() { Ok(sum) } else { Err(Undefined::NotFinite) }
}

/// Predictions \[emission, N\] for reduced data; NaN where a term is undefined.
fn predictions(model: &Model, data: &Reduced) -> Result<Array2<f64>, TermsError> {
    let terms: Vec<Vec<Term>> =
        (0..data.values.nrows()).map(|emission| model.terms_at(emission)).collect::<Result<_, _>>()?;
    let effects = model.effects();
    let seen: Vec<Vec<(Geometry, f64)>> = data.geometry.iter().map(|geometry| effects.seen(geometry)).collect();
    Ok(Array2::from_shape_fn(data.values.dim(), |(emission, row)| {
        let part = |(geometry, share): &(Geometry, f64)| {
            predict(&terms[emission], geometry, &model.reference).map_or(f64::NAN, |p| share * p.total())
        };
        seen[row].iter().map(part).sum()
    }))
}

/// Measured minus predicted \[emission, N\], NaN where there is no measured or no predicted value, with their summary.
/// `parameters` is how many were fitted.
///
/// # Errors
/// [`TermsError`] when a parameter of the model is missing.
pub fn residuals(model: &Model, data: &Reduced, parameters: usize) -> Result<(Array2<f64>, Residuals), TermsError> {
    let residual = &data.values - &predictions(model, data)?;
    let weight_known =
        |index: (usize, usize)| data.sigma.as_ref().is_none_or(|sigma| sigma[index] > 0.0 && sigma[index].is_finite());
    let used: Vec<((usize, usize), f64)> = residual
        .indexed_iter()
        .filter(|(index, value)| value.is_finite() && weight_known(*index))
        .map(|(index, value)| (index, *value))
        .collect();
    let count = used.len();
    let (columns, rows) = data.values.dim();
    let all = (columns + data.left_out_emission) * (rows + data.left_out);
    let sum: f64 = used.iter().map(|(_, value)| value * value).sum();
    let freedom = count.saturating_sub(parameters) as f64;
    let chi_square: f64 = data
        .sigma
        .as_ref()
        .map_or(f64::NAN, |sigma| used.iter().map(|(index, value)| (value / sigma[*index]).powi(2)).sum::<f64>());
    let summary = Residuals {
        rms: (sum / count as f64).sqrt(),
        reduced_chi_square: chi_square / freedom,
        count: count as u64,
        left_out: (all - count) as u64,
    };
    Ok((residual, summary))
}
