//! How uncertain a model's prediction is, from the covariance of its parameters: sqrt(g' C g) with the exact gradient g
//! (GUM, JCGM 100:2008, 5.2.2).

use ndarray::Array2;

use super::{Model, TermsError};
use crate::quantity::{Geometry, Reference};
use crate::terms::{Term, TermKind, Undefined};

/// Parameters that a term has at most.
const MOST: usize = 3;

/// Covariance of the parameters of a sum of terms at one emission value.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterCovariance {
    /// Names of the parameters, term by term.
    names: Vec<String>,
    /// Row of each parameter of each term.
    place: Vec<[usize; MOST]>,
    /// NaN where it is not known.
    covariance: Array2<f64>,
    /// Relative standard uncertainty that the amplitude of each term shares with all values; `None` where none is stored.
    shared_relative: Option<Vec<f64>>,
}

/// One of the predictions in a weighted sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// How often it counts.
    pub weight: f64,
    /// Where from and where to.
    pub geometry: Geometry,
    /// Relative to what.
    pub reference: Reference,
}

/// The uncertainty of a prediction.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictionUncertainty {
    /// Standard uncertainty (k = 1) from the independent errors of the data, in the unit of the prediction; `None` where
    /// the covariance has no number for what the prediction depends on.
    pub standard: Option<f64>,
    /// Relative standard uncertainty that the prediction shares with all others of the model; `None` where none is stored.
    pub shared_relative: Option<f64>,
    /// Parameters, or pairs of them, whose covariance the prediction needs and the model does not have.
    pub unknown: Vec<String>,
}

impl ParameterCovariance {
    /// A covariance of these terms of which nothing is known. Names are `TERM.PARAMETER`, `TERM:POSITION.PARAMETER` where
    /// several terms are of one kind.
    #[must_use]
    pub fn unknown(terms: &[TermKind]) -> Self {
        let (mut names, mut place) = (Vec::new(), Vec::with_capacity(terms.len()));
        for (position, kind) in terms.iter().enumerate() {
            let mut rows = [0; MOST];
            for (parameter, row) in kind.parameters().iter().zip(&mut rows) {
                *row = names.len();
                names.push(Model::name_in_covariance(terms, position, parameter.name));
            }
            place.push(rows);
        }
        let covariance = Array2::from_elem((names.len(), names.len()), f64::NAN);
        Self { names, place, covariance, shared_relative: None }
    }

    /// The names of the parameters, in order.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Enters a covariance of named parameters; the first name that is none of this model is an error.
    ///
    /// # Errors
    /// The name.
    pub fn enter(&mut self, names: &[String], covariance: impl Fn(usize, usize) -> f64) -> Result<(), String> {
        let row = |name: &String| self.names.iter().position(|own| own == name).ok_or_else(|| name.clone());
        let rows: Vec<usize> = names.iter().map(row).collect::<Result<_, _>>()?;
        for (i, row) in rows.iter().enumerate() {
            for (j, column) in rows.iter().enumerate() {
                self.covariance[(*row, *column)] = covariance(i, j);
            }
        }
        Ok(())
    }

    /// The uncertainty of the sum of those terms that `counts` picks, at a geometry.
    ///
    /// # Errors
    /// [`Undefined`] where a term has no value.
    pub fn of_prediction(
        &self,
        terms: &[Term],
        geometry: &Geometry,
        reference: &Reference,
        counts: impl Fn(TermKind) -> bool,
    ) -> Result<PredictionUncertainty, Undefined> {
        self.of_sum(terms, &[Look { weight: 1.0, geometry: *geometry, reference: *reference }], counts)
    }

    /// The uncertainty of a weighted sum of predictions of the same terms.
    ///
    /// # Errors
    /// [`Undefined`] where a term has no value.
    pub fn of_sum(
        &self,
        terms: &[Term],
        looks: &[Look],
        counts: impl Fn(TermKind) -> bool,
    ) -> Result<PredictionUncertainty, Undefined> {
        let mut gradient = vec![0.0; self.names.len()];
        let (mut sum, mut shared) = (0.0, 0.0);
        for (position, term) in terms.iter().enumerate().filter(|(_, term)| counts(term.kind())) {
            for look in looks {
                let evaluation = term.evaluate(&look.geometry, &look.reference)?;
                let value = look.weight * evaluation.value;
                sum += value;
                shared += value * self.shared_relative.as_ref().map_or(0.0, |shared| shared[position]);
                for (row, by) in self.place[position].iter().zip(evaluation.by).take(term.kind().parameters().len()) {
                    gradient[*row] += look.weight * by;
                }
            }
        }
        let needed: Vec<usize> = (0..gradient.len()).filter(|row| gradient[*row] != 0.0).collect();
        let (mut variance, mut unknown) = (0.0, Vec::new());
        for &i in &needed {
            for &j in &needed {
                variance += gradient[i] * self.covariance[(i, j)] * gradient[j];
            }
            if self.covariance[(i, i)].is_nan() {
                unknown.push(format!("`{}`", self.names[i]));
            }
        }
        if unknown.is_empty() {
            for (&i, &j) in needed.iter().flat_map(|i| needed.iter().map(move |j| (i, j))) {
                if i < j && self.covariance[(i, j)].is_nan() {
                    unknown.push(format!("`{}` with `{}`", self.names[i], self.names[j]));
                }
            }
        }
        // A variance that cancels to nothing may round to a little below it.
        let standard = variance.is_finite().then(|| variance.max(0.0).sqrt());
        let shared_relative = self.shared_relative.as_ref().map(|all| match &all[..] {
            // What all share alike is that, without a rounding.
            [first, rest @ ..] if rest.iter().all(|other| other == first) => *first,
            _ if sum == 0.0 => 0.0,
            _ => shared / sum,
        });
        Ok(PredictionUncertainty { standard, shared_relative, unknown })
    }
}

impl Model {
    /// The covariance of the parameters at one emission value, as far as the model holds it: what is stored, and on the
    /// diagonal the standard uncertainties of parameters that it does not name.
    #[must_use]
    pub fn parameter_covariance(&self, emission: usize) -> ParameterCovariance {
        let kinds: Vec<TermKind> = self.terms.iter().map(|term| term.kind).collect();
        let mut all = ParameterCovariance::unknown(&kinds);
        let at = |list: &[f64]| if list.len() == 1 { list.first() } else { list.get(emission) }.copied();
        let mut shared_relative = Vec::with_capacity(self.terms.len());
        let mut has_shared = false;
        for (term, rows) in self.terms.iter().zip(&all.place) {
            let names = term.kind.parameters();
            for (parameter, row) in names.iter().zip(rows) {
                let fitted = term.parameters.iter().find(|fitted| fitted.name == parameter.name);
                let sigma = fitted.and_then(|fitted| at(&fitted.standard_uncertainty)).unwrap_or(f64::NAN);
                all.covariance[(*row, *row)] = sigma * sigma;
            }
            let amplitude =
                term.parameters.iter().find(|fitted| Some(fitted.name.as_str()) == names.first().map(|p| p.name));
            let shared = amplitude.and_then(|amplitude| at(&amplitude.shared_relative_uncertainty));
            has_shared |= shared.is_some();
            shared_relative.push(shared.unwrap_or(0.0));
        }
        let covariance = self.covariance_at(emission);
        let stored = |i: usize, j: usize| covariance.and_then(|all| all.get((i, j)).copied()).unwrap_or(f64::NAN);
        // The terms of a prediction are those that were seen, and stand in the order of these.
        let seen = |position: &usize| self.terms[*position].is_seen_at(emission);
        let positions: Vec<usize> = (0..self.terms.len()).filter(seen).collect();
        all.place = positions.iter().map(|position| all.place[*position]).collect();
        let shared_relative = positions.iter().map(|position| shared_relative[*position]).collect();
        // A name that is none of the terms' is a finding of the validator; here it enters nothing.
        let _ = all.enter(&self.covariance_parameters, stored);
        all.shared_relative = has_shared.then_some(shared_relative);
        all
    }

    /// The uncertainty of what the model predicts at a geometry and emission index, all terms together.
    ///
    /// # Errors
    /// [`PredictionError`] when the model lacks a parameter, or a term has no value there.
    pub fn prediction_uncertainty(
        &self,
        emission: usize,
        geometry: &Geometry,
        reference: &Reference,
    ) -> Result<PredictionUncertainty, PredictionError> {
        let terms = self.terms_at(emission)?;
        Ok(self.parameter_covariance(emission).of_prediction(&terms, geometry, reference, |_| true)?)
    }
}

/// Why a model predicts nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PredictionError {
    /// A parameter is missing.
    #[error(transparent)]
    Terms(#[from] TermsError),
    /// A term has no value at the geometry.
    #[error(transparent)]
    Undefined(#[from] Undefined),
}
