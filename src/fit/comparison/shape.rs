//! The forms that are compared.

use std::fmt;

use ndarray::Array2;

use crate::dataset::{Reduced, predict};
use crate::fit::outcome::Fit;
use crate::fit::solve::Terms;
use crate::quantity::Reference;
use crate::terms::{Denominator, Distribution, Term, TermKind, TorranceSparrow};

/// Forms of D that are functions of their own. The other Gaussians are exact twins of the first: the same fit.
const FUNCTIONS: [Distribution; 3] =
    [Distribution::GaussianHalfHeight, Distribution::Beckmann, Distribution::TrowbridgeReitz];

/// Which terms a model has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// A diffuse term.
    pub diffuse: bool,
    /// The specular term's form.
    pub specular: Option<(Distribution, Denominator)>,
}

impl Shape {
    /// All of them: the diffuse term alone, and each form of the specular one with and without it.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut shapes = vec![Self { diffuse: true, specular: None }];
        for diffuse in [true, false] {
            for distribution in FUNCTIONS {
                let of = |denominator: &Denominator| Self { diffuse, specular: Some((distribution, *denominator)) };
                shapes.extend(Denominator::ALL.iter().map(of));
            }
        }
        shapes
    }

    pub(super) fn terms(self) -> Terms {
        Terms { diffuse: self.diffuse, specular: self.specular.is_some() }
    }

    /// The other names of its distribution: the same function with another width or norm.
    #[must_use]
    pub fn twins(self) -> Vec<Distribution> {
        let is_gaussian = |distribution: Distribution| distribution.gaussian_width(1.0).is_some();
        let own = self.specular.map(|(distribution, _)| distribution).filter(|one| is_gaussian(*one));
        own.map_or(Vec::new(), |own| {
            Distribution::ALL.iter().copied().filter(|other| is_gaussian(*other) && *other != own).collect()
        })
    }

    /// The terms of a fit at one emission value.
    pub(super) fn terms_of(self, fit: &Fit, band: usize, diffuse: TermKind) -> Vec<Term> {
        let band = &fit.bands[band];
        let mut terms = Vec::new();
        if self.diffuse {
            terms.push(match diffuse {
                TermKind::Luminescent => Term::Luminescent { factor: band.diffuse },
                _ => Term::Lambertian { albedo: band.diffuse },
            });
        }
        if let (Some((distribution, denominator)), true) = (self.specular, band.intensity > 0.0) {
            terms.push(Term::TorranceSparrow(TorranceSparrow {
                intensity: band.intensity,
                roughness: fit.roughness,
                refractive_index: fit.refractive_index(),
                distribution,
                denominator,
            }));
        }
        terms
    }

    /// What a fit predicts \[emission, N\]; NaN where there is no value.
    pub(super) fn predictions(
        self,
        fit: &Fit,
        data: &Reduced,
        reference: &Reference,
        diffuse: TermKind,
    ) -> Array2<f64> {
        let terms: Vec<Vec<Term>> = (0..fit.bands.len()).map(|band| self.terms_of(fit, band, diffuse)).collect();
        Array2::from_shape_fn(data.values.dim(), |(band, row)| {
            predict(&terms[band], &data.geometry[row], reference).map_or(f64::NAN, |prediction| prediction.total())
        })
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let diffuse = if self.diffuse { "diffuse" } else { "" };
        match self.specular {
            None => f.write_str(diffuse),
            Some((distribution, denominator)) => {
                let and = if self.diffuse { " + " } else { "" };
                write!(f, "{diffuse}{and}{distribution} / {denominator}")
            }
        }
    }
}
