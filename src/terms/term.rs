//! The closed family of terms, and their value under each reference convention.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::torrance_sparrow::{Specular, TorranceSparrow};
use super::{Denominator, TermKind, Undefined, masking_over};
use crate::quantity::{Geometry, HalfAngles, Reference};

/// A term with its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Term {
    /// S_r cos(theta_i).
    Lambertian {
        /// S_r, dimensionless, at least 0.
        albedo: f64,
    },
    /// cos(theta_i) times the luminescent radiance factor under the light of the measurement.
    Luminescent {
        /// Luminescent radiance factor, dimensionless, at least 0.
        factor: f64,
    },
    /// c_s D G F / den.
    TorranceSparrow(TorranceSparrow),
}

/// A parameter outside what the standard allows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{term}: `{name}` is {found}; expected a finite number {expected}")]
pub struct InvalidParameter {
    /// Which term.
    pub term: TermKind,
    /// Which parameter.
    pub name: &'static str,
    /// The value found.
    pub found: f64,
    /// What is allowed.
    pub expected: String,
}

/// The value of a term with its derivatives in the term's parameters, in their order; all finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// Value.
    pub value: f64,
    /// Derivatives; entries beyond the term's parameters are 0.
    pub by: [f64; 3],
}

impl Evaluation {
    fn finite(self) -> Result<Self, Undefined> {
        let is_finite = self.value.is_finite() && self.by.iter().all(|derivative| derivative.is_finite());
        if is_finite { Ok(self) } else { Err(Undefined::NotFinite) }
    }
}

impl Term {
    /// Which term it is.
    #[must_use]
    pub const fn kind(&self) -> TermKind {
        match self {
            Self::Lambertian { .. } => TermKind::Lambertian,
            Self::Luminescent { .. } => TermKind::Luminescent,
            Self::TorranceSparrow(_) => TermKind::TorranceSparrow,
        }
    }

    /// The parameters, in the order of [`TermKind::parameters`]; entries beyond them are 0.
    #[must_use]
    pub const fn values(&self) -> [f64; 3] {
        match self {
            Self::Lambertian { albedo } => [*albedo, 0.0, 0.0],
            Self::Luminescent { factor } => [*factor, 0.0, 0.0],
            Self::TorranceSparrow(term) => [term.intensity, term.roughness, term.refractive_index],
        }
    }

    /// Checks the parameters against what the standard allows.
    ///
    /// # Errors
    /// [`InvalidParameter`], the first found.
    pub fn check(&self) -> Result<(), InvalidParameter> {
        for (parameter, found) in self.kind().parameters().iter().zip(self.values()) {
            if !parameter.allows(found) {
                let relation = if parameter.lower_excluded { "above" } else { "of at least" };
                let expected = format!("{relation} {}", parameter.lower);
                return Err(InvalidParameter { term: self.kind(), name: parameter.name, found, expected });
            }
        }
        Ok(())
    }

    /// Y/E divided by what the reference received of the beam (`Reference::None`: Y/E itself), with derivatives.
    ///
    /// A Lambertian term is a constant against a reference in the same geometry and follows cos(theta_i) against a
    /// fixed one. Dimensionless.
    ///
    /// # Errors
    /// [`Undefined`] where the limit is not unique, the reference is unstated, or the parameters are so far out (no
    /// [`Term::check`] is made here) that a number overflows.
    pub fn evaluate(&self, geometry: &Geometry, reference: &Reference) -> Result<Evaluation, Undefined> {
        match self {
            Self::Lambertian { albedo: amplitude } | Self::Luminescent { factor: amplitude } => {
                let shape = diffuse_factor(geometry, reference)?;
                Evaluation { value: amplitude * shape, by: [shape, 0.0, 0.0] }.finite()
            }
            Self::TorranceSparrow(term) => {
                let lit = reference.lit_fraction(geometry)?;
                if lit > 0.0 {
                    let Specular { value, by } = term.specular(geometry, lit)?;
                    return Evaluation { value, by }.finite();
                }
                let Specular { value, by } = term.specular(geometry, 1.0)?;
                let is_zero = value == 0.0 && by == [0.0; 3];
                if is_zero { Ok(Evaluation { value, by }) } else { Err(Undefined::Unbounded) }
            }
        }
    }
}

/// The angular factor of a diffuse term of amplitude 1: cos(theta_i) over what the reference received.
///
/// # Errors
/// [`Undefined::Reference`] where the reference is unstated or unlit.
pub fn diffuse_factor(geometry: &Geometry, reference: &Reference) -> Result<f64, Undefined> {
    if geometry.is_below_horizon() {
        return Ok(0.0);
    }
    // In the same geometry the cosines cancel, also where both are 0.
    let lit = reference.lit_fraction(geometry)?;
    Ok(if matches!(reference, Reference::SameGeometry) { 1.0 } else { geometry.incidence.cos_theta() / lit })
}

/// The angular factor of the specular term without D and F: G over the denominator and over what the reference
/// received.
///
/// # Errors
/// [`Undefined`] as [`Term::evaluate`].
pub fn specular_factor(
    denominator: Denominator,
    geometry: &Geometry,
    half: &HalfAngles,
    reference: &Reference,
) -> Result<f64, Undefined> {
    if geometry.is_below_horizon() {
        return Ok(0.0);
    }
    let lit = reference.lit_fraction(geometry)?;
    let angular = masking_over(denominator, geometry, half)?;
    if lit == 0.0 { Err(Undefined::Unbounded) } else { Ok(angular / lit) }
}
