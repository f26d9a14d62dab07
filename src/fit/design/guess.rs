//! The material that is guessed, and the noise that is expected.

use crate::dataset::predict;
use crate::quantity::{Geometry, Reference};
use crate::terms::{InvalidParameter, REFRACTIVE_INDEX, Term};

/// A material guessed.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    terms: Vec<Term>,
    reference: Reference,
    parameters: Vec<GuessedParameter>,
}

/// A parameter of the guess.
#[derive(Debug, Clone, PartialEq)]
pub struct GuessedParameter {
    /// `TERM.PARAMETER`, or `TERM:POSITION.PARAMETER` where several terms are of one kind, as in a stored covariance.
    pub name: String,
    /// The parameter's own name.
    pub parameter: &'static str,
    /// Unit, `1` for none.
    pub unit: &'static str,
    /// Value guessed.
    pub value: f64,
    /// What a relative uncertainty is relative to: the value, of an index n - 1, and 1 where that is 0.
    pub scale: f64,
}

/// A guess that predicts nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GuessError {
    /// No term.
    #[error("the guessed model has no term")]
    NoTerm,
    /// A parameter that the standard does not allow.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
    /// The noise is nothing or no number.
    #[error(
        "a noise of {relative} (relative) and {floor} (absolute); expected numbers of at least 0, one of them above 0"
    )]
    Noise {
        /// Relative standard deviation.
        relative: f64,
        /// Absolute standard deviation.
        floor: f64,
    },
}

impl Guess {
    /// A guess of terms, measured against a reference.
    ///
    /// # Errors
    /// [`GuessError`] without terms, and for a parameter out of range.
    pub fn new(terms: Vec<Term>, reference: Reference) -> Result<Self, GuessError> {
        if terms.is_empty() {
            return Err(GuessError::NoTerm);
        }
        terms.iter().try_for_each(Term::check)?;
        let parameters = parameters(&terms);
        Ok(Self { terms, reference, parameters })
    }

    /// The terms.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The reference that values are relative to.
    #[must_use]
    pub fn reference(&self) -> Reference {
        self.reference
    }

    /// Every parameter, term by term.
    #[must_use]
    pub fn parameters(&self) -> &[GuessedParameter] {
        &self.parameters
    }

    /// The value at a geometry and the derivatives in every parameter; `None` where a term has none.
    pub(super) fn evaluate(&self, geometry: &Geometry, by: &mut Vec<f64>) -> Option<f64> {
        by.clear();
        for term in &self.terms {
            let at = term.evaluate(geometry, &self.reference).ok()?;
            by.extend(&at.by[..term.kind().parameters().len()]);
        }
        predict(&self.terms, geometry, &self.reference).ok().map(|prediction| prediction.total())
    }
}

fn parameters(terms: &[Term]) -> Vec<GuessedParameter> {
    let several = |term: &Term| terms.iter().filter(|other| other.kind() == term.kind()).count() > 1;
    let mut list = Vec::new();
    for (position, term) in terms.iter().enumerate() {
        let kind = term.kind();
        let distribution = match term {
            Term::TorranceSparrow(term) => Some(term.distribution),
            _ => None,
        };
        for (parameter, value) in kind.parameters().iter().zip(term.values()) {
            let place = if several(term) { format!(":{position}") } else { String::new() };
            let distance = if parameter.name == REFRACTIVE_INDEX.name { value - 1.0 } else { value };
            list.push(GuessedParameter {
                name: format!("{kind}{place}.{}", parameter.name),
                parameter: parameter.name,
                unit: parameter.unit(distribution),
                value,
                scale: if distance == 0.0 { 1.0 } else { distance },
            });
        }
    }
    list
}

/// The noise of one value: independent errors of this standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Relative to the value predicted.
    pub relative: f64,
    /// Absolute, in the unit of the value; added in squares.
    pub floor: f64,
}

impl Noise {
    /// A noise that is some.
    ///
    /// # Errors
    /// [`GuessError::Noise`] for negative numbers, and where both are 0.
    pub fn new(relative: f64, floor: f64) -> Result<Self, GuessError> {
        let is_number = |x: f64| (0.0..=1e60).contains(&x);
        let fine = is_number(relative) && is_number(floor) && relative + floor > 0.0;
        if fine { Ok(Self { relative, floor }) } else { Err(GuessError::Noise { relative, floor }) }
    }

    /// The standard deviation of a value.
    #[must_use]
    pub fn sigma(&self, value: f64) -> f64 {
        (self.relative * value).hypot(self.floor)
    }
}
