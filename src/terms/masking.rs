//! G: Torrance and Sparrow's geometric attenuation (masking and shadowing in V-grooves), alone and over the
//! denominator of the specular term: together they keep their value at grazing angles, where each alone is 0/0.

use super::{Denominator, Undefined};
use crate::quantity::{Geometry, HalfAngles};

/// G = min(1, 2 (N.Q)(N.V)/(V.Q), 2 (N.Q)(N.L)/(V.Q)), in \[0, 1\].
///
/// # Errors
/// [`Undefined::NoHalfVector`] where L = -V.
pub fn masking(geometry: &Geometry, half: &HalfAngles) -> Result<f64, Undefined> {
    if half.cos_q == 0.0 {
        return Err(Undefined::NoHalfVector);
    }
    let ratio = 2.0 * half.cos_phi / half.cos_q;
    let smaller = geometry.incidence.cos_theta().min(geometry.viewing.cos_theta());
    Ok((ratio * smaller).min(1.0))
}

/// G over the denominator; at grazing incidence or viewing its one-sided limit where that is unique.
///
/// # Errors
/// [`Undefined`] where L = -V or where the limit depends on the way to it.
pub fn masking_over(denominator: Denominator, geometry: &Geometry, half: &HalfAngles) -> Result<f64, Undefined> {
    let (cos_i, cos_v) = (geometry.incidence.cos_theta(), geometry.viewing.cos_theta());
    let g = masking(geometry, half)?;
    let twice_ratio = 2.0 * half.cos_phi / half.cos_q;
    match denominator {
        Denominator::CosThetaI => Ok(over_one(g, cos_i, cos_v, twice_ratio)),
        Denominator::CosThetaV => Ok(over_one(g, cos_v, cos_i, twice_ratio)),
        Denominator::CosICosV => match (cos_i == 0.0, cos_v == 0.0) {
            (false, false) => Ok(g / cos_i / cos_v),
            // G -> 2 (N.Q)(N.L)/(V.Q): the vanishing cosine cancels.
            (true, false) => Ok(twice_ratio / cos_v),
            (false, true) => Ok(twice_ratio / cos_i),
            (true, true) => Err(Undefined::PathDependent),
        },
    }
}

/// G over one cosine. Where that cosine is 0, G vanishes with it and 2 (N.Q)/(V.Q) is left; where the other is 0 too,
/// Q lies in the surface and that ratio is 0.
fn over_one(g: f64, cosine: f64, other: f64, twice_ratio: f64) -> f64 {
    if cosine > 0.0 {
        g / cosine
    } else if other > 0.0 {
        twice_ratio
    } else {
        0.0
    }
}
