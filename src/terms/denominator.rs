//! The denominator of the specular term, and G over it: together they keep their value at grazing angles, where each
//! alone is 0/0.

use crate::quantity::named;

named! {
    /// What the specular term is divided by.
    Denominator, "denominator" {
        /// cos(theta_i): the paper's, for radiance per unit of beam irradiance; not reciprocal.
        CosThetaI = "cos-theta-i",
        /// cos(theta_v): a reciprocal BRDF times cos(theta_i).
        CosThetaV = "cos-theta-v",
        /// cos(theta_i) cos(theta_v).
        CosICosV = "cos-i-cos-v",
    }
}
