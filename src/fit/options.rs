//! What is asked of a fit, and why it cannot be done.

use super::curvature::Share;
use super::effort::Effort;
use super::error::DataError;
use super::geometry_set::SetError;
use super::joint::Nuisance;
use super::loss::Loss;
use super::solve::Terms;
use crate::dataset::{Mask, ReduceError, Reduction, TermsError};
use crate::quantity::{Part, QuantityKind, Reference};
use crate::terms::{Denominator, Distribution, TermKind};

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
    /// What emission values that are fitted together have in common; `None` for nothing: each is fitted by itself.
    pub share: Option<Share>,
    /// What a residual costs.
    pub loss: Loss,
    /// Bounds of the roughness, in the unit of the distribution, where narrower ones than the usual are wanted.
    pub roughness_box: Option<(f64, f64)>,
    /// Bounds of the refractive index, likewise.
    pub index_box: Option<(f64, f64)>,
    /// How much the fit works for its result.
    pub effort: Effort,
    /// Rows to leave out.
    pub mask: Mask,
    /// Effects of the instrument on the geometry, known or to be fitted.
    pub nuisances: Vec<Nuisance>,
    /// Standard uncertainty of a wavelength shift between the sample's and the reference's records, nm.
    pub wavelength_shift_nm: f64,
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
            share: Some(Share::Shape),
            loss: Loss::Squares,
            roughness_box: None,
            index_box: None,
            effort: Effort::default(),
            mask: Mask::default(),
            nuisances: Vec::new(),
            wavelength_shift_nm: 0.0,
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
    pub(super) fn new(terms: &[TermKind], part: Part) -> Result<Self, FitError> {
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
