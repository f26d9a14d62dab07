//! One physical term each: value and exact derivatives, stable everywhere.
//!
//! *May use:* `quantity`. No files, no fitting.
//!
//! *Invariant:* below the horizon every term is exactly 0; where a one-sided limit exists it is returned, else a typed
//! [`Undefined`]; whatever the parameters, never NaN and never infinite.

mod albedo;
mod denominator;
mod distribution;
mod fresnel;
mod gaussian_integral;
mod masking;
mod parameter;
mod quadrature;
mod term;
mod torrance_sparrow;

pub use denominator::Denominator;
pub use distribution::{Distribution, DistributionValue, Lobe};
pub use fresnel::{FresnelValue, fresnel};
pub use gaussian_integral::{GaussianIntegral, gaussian_integral};
pub use masking::{masking, masking_over};
pub use parameter::{ALBEDO, INTENSITY, LUMINESCENT_FACTOR, Parameter, REFRACTIVE_INDEX, ROUGHNESS};
pub use term::{Evaluation, InvalidParameter, Term, diffuse_factor, specular_factor};
pub use torrance_sparrow::{Factors, TorranceSparrow};

use crate::quantity::{ConversionRefused, named};

named! {
    /// Which physical term.
    TermKind, "term" {
        /// S_r cos(theta_i): diffuse reflection.
        Lambertian = "lambertian",
        /// cos(theta_i) times the integral of S_l E over excitation: diffuse luminescence.
        Luminescent = "luminescent",
        /// c_s D G F / den: reflection at the interface.
        TorranceSparrow = "torrance-sparrow",
    }
}

/// Why a term has no value at a geometry.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undefined {
    /// L = -V: source and detector face each other along the surface, and there is no half vector.
    #[error("source and detector face each other along the surface (L = -V): there is no half vector")]
    NoHalfVector,
    /// Both directions graze: the limit depends on which does first.
    #[error("incidence and viewing both at 90 degrees: the limit depends on the way to it")]
    PathDependent,
    /// The specular term over the light that the reference received at the same grazing incidence grows without bound.
    #[error("incidence at 90 degrees: the specular term over cos(theta_i) grows without bound")]
    Unbounded,
    /// A value or a derivative leaves the range of numbers, as D does for a roughness of 1e-160.
    #[error(
        "the term or a derivative of it has no finite value for these parameters (double precision): a parameter is far \
         beyond what any surface has"
    )]
    NotFinite,
    /// The reference convention does not say what to divide by.
    #[error(transparent)]
    Reference(#[from] ConversionRefused),
}
