//! A complete model under one light, in any pair of directions.

use super::super::predict::Prediction;
use super::Complete;
use super::directional::Part;
use super::values::{Values, lit_share};
use crate::dataset::ReflectanceSource;
use crate::quantity::Geometry;
use crate::terms::Undefined;

/// A complete model under a light.
#[derive(Debug, Clone)]
pub struct Lit<'a> {
    model: &'a Complete,
    prediction: Prediction,
}

/// Pi times the radiance in one direction under light from another: W m-2 nm-1 under a spectral irradiance across the beam, else in
/// the unit of the light. One number per emission of the model; sigmas are standard uncertainties (k = 1) from the independent
/// errors of matrix and scan, NaN where the covariance of the fit does not say.
#[derive(Debug, Clone, PartialEq)]
pub struct Radiated {
    /// Y_l: light of other wavelengths.
    pub luminescent: Vec<f64>,
    /// Its standard uncertainty.
    pub luminescent_sigma: Vec<f64>,
    /// Y_d: reflected diffusely; NaN where the matrix does not tell.
    pub diffuse: Vec<f64>,
    /// Its standard uncertainty.
    pub diffuse_sigma: Vec<f64>,
    /// Y_s: reflected at the interface; NaN where its term is undefined.
    pub specular: Vec<f64>,
    /// Its standard uncertainty.
    pub specular_sigma: Vec<f64>,
    /// Y.
    pub total: Vec<f64>,
    /// Its standard uncertainty: what was measured together is better known than its parts.
    pub total_sigma: Vec<f64>,
    /// Standard uncertainty of Y that its values share: the scale of the matrix, that of the scan. Not contained in the other.
    pub shared_sigma: Vec<f64>,
    /// Why the specular term has no value.
    pub undefined: Option<Undefined>,
}

impl<'a> Lit<'a> {
    pub(super) fn new(model: &'a Complete, prediction: Prediction) -> Self {
        Self { model, prediction }
    }

    /// The same under light along the normal without an interface: what there is of it whatever the direction, and where the
    /// light says too little.
    #[must_use]
    pub fn prediction(&self) -> &Prediction {
        &self.prediction
    }

    /// At one geometry.
    #[must_use]
    pub fn at(&self, geometry: &Geometry) -> Radiated {
        let prediction = &self.prediction;
        let angular = self.model.directional.at(geometry);
        let values = self.model.valued((&prediction.luminescent, &prediction.irradiance), geometry, &angular);
        let cosine = lit_share(geometry);
        let lit = |value: f64| if cosine == 0.0 { 0.0 } else { cosine * value };
        let by_terms = self.model.reflectance == ReflectanceSource::Terms;
        let count = prediction.emission_nm.len();
        let Values { luminescent, diffuse, specular, total, undefined } = values;
        let mut all = Radiated {
            luminescent,
            luminescent_sigma: prediction.luminescent_sigma.iter().map(|sigma| lit(*sigma)).collect(),
            diffuse,
            diffuse_sigma: Vec::with_capacity(count),
            specular,
            specular_sigma: Vec::with_capacity(count),
            total,
            total_sigma: Vec::with_capacity(count),
            shared_sigma: Vec::with_capacity(count),
            undefined,
        };
        for (j, nm) in prediction.emission_nm.iter().enumerate() {
            let irradiance = prediction.irradiance[j];
            let part = angular.as_ref().map_or(Part::UNKNOWN, |angular| angular.at(*nm));
            all.diffuse_sigma.push(if by_terms {
                part.diffuse_sigma * irradiance
            } else {
                lit(prediction.elastic_sigma[j].hypot(part.in_matrix_sigma * irradiance))
            });
            // The two parts of the matrix are known better together.
            let of_matrix = if by_terms { all.luminescent_sigma[j] } else { lit(prediction.total_sigma[j]) };
            let of_scale = if by_terms { all.luminescent[j] } else { lit(prediction.total(j)) };
            all.specular_sigma.push(part.specular_sigma * irradiance);
            all.total_sigma.push(of_matrix.hypot(part.sum_sigma * irradiance));
            let scale = self.model.shared_relative[j];
            all.shared_sigma.push((scale * of_scale).hypot(part.shared_sigma * irradiance));
        }
        all
    }
}
