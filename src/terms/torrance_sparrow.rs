//! The specular term c_s D(phi) G(V, L) F(theta_Q, n) / den (Torrance and Sparrow 1967; the paper's eq. 4).
//!
//! Left out on purpose: reflection more than once between facets, polarisation, absorption (an index with an imaginary
//! part). With the denominator cos(theta_i) the term is not reciprocal; the paper has it so.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Denominator, Distribution, Undefined, fresnel, masking, masking_over};
use crate::quantity::Geometry;

/// The specular term.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorranceSparrow {
    /// c_s, dimensionless, at least 0.
    pub intensity: f64,
    /// Width of the distribution in its unit, above 0.
    pub roughness: f64,
    /// n, above 1.
    pub refractive_index: f64,
    /// Form of D.
    #[serde(default = "default_distribution")]
    pub distribution: Distribution,
    /// Denominator.
    #[serde(default = "default_denominator")]
    pub denominator: Denominator,
}

fn default_distribution() -> Distribution {
    Distribution::GaussianHalfHeight
}

fn default_denominator() -> Denominator {
    Denominator::CosThetaI
}

/// The factors of the specular term at one geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Angle between the half vector and the normal, rad.
    pub phi_rad: f64,
    /// D.
    pub d: f64,
    /// G.
    pub g: f64,
    /// F.
    pub f: f64,
}

/// Y/E of the term with its derivatives in intensity, roughness and refractive index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Specular {
    pub(super) value: f64,
    pub(super) by: [f64; 3],
}

impl TorranceSparrow {
    /// phi, D, G and F; below the horizon D, G and F are 0.
    ///
    /// # Errors
    /// [`Undefined::NoHalfVector`] where L = -V, [`Undefined::NotFinite`] where a parameter is so far out that a factor
    /// overflows.
    pub fn factors(&self, geometry: &Geometry) -> Result<Factors, Undefined> {
        let half = geometry.half_angles();
        if geometry.is_below_horizon() {
            return Ok(Factors { phi_rad: half.phi, d: 0.0, g: 0.0, f: 0.0 });
        }
        let factors = Factors {
            g: masking(geometry, &half)?,
            phi_rad: half.phi,
            d: self.distribution.evaluate(&half, self.roughness).value,
            f: fresnel(&half, self.refractive_index - 1.0).value,
        };
        if factors.d.is_finite() && factors.f.is_finite() { Ok(factors) } else { Err(Undefined::NotFinite) }
    }

    /// Y/E over `lit`, what the reference received of the beam. D is multiplied last: its product with a small reflectance
    /// may be below the range of numbers where the quotient is not.
    pub(super) fn specular(&self, geometry: &Geometry, lit: f64) -> Result<Specular, Undefined> {
        if geometry.is_below_horizon() {
            return Ok(Specular { value: 0.0, by: [0.0; 3] });
        }
        let half = geometry.half_angles();
        let d = self.distribution.evaluate(&half, self.roughness);
        let f = fresnel(&half, self.refractive_index - 1.0);
        let angular = match masking_over(self.denominator, geometry, &half) {
            Err(Undefined::PathDependent) if d.value == 0.0 => 0.0,
            other => other?,
        };
        let angular = angular / lit;
        let over = angular * f.value;
        let shape = d.value * over;
        let by_roughness = if d.by_log_roughness == 0.0 { 0.0 } else { d.by_log_roughness / self.roughness };
        Ok(Specular {
            value: self.intensity * shape,
            by: [shape, self.intensity * over * by_roughness, self.intensity * d.value * (angular * f.by_index)],
        })
    }
}
