//! A complete model without its uncertainties: what a program needs that asks for many geometries, or many lights.

use ndarray::{Array2, s};

use super::super::operator::Axis;
use super::Complete;
use super::directional::{Angular, Part};
use crate::dataset::ReflectanceSource;
use crate::donaldson::{Extend, Light};
use crate::quantity::Geometry;
use crate::terms::Undefined;

/// The values of [`super::Radiated`], and nothing beside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Values {
    /// Y_l: light of other wavelengths.
    pub luminescent: Vec<f64>,
    /// Y_d: reflected diffusely; NaN where the matrix does not tell.
    pub diffuse: Vec<f64>,
    /// Y_s: reflected at the interface; NaN where its term is undefined.
    pub specular: Vec<f64>,
    /// Y.
    pub total: Vec<f64>,
    /// Why the specular term has no value.
    pub undefined: Option<Undefined>,
}

/// What a light is to a complete model, whatever the geometry: one number per emission.
#[derive(Debug, Clone, PartialEq)]
pub struct Incident {
    /// The luminescence under light along the normal.
    pub luminescent: Vec<f64>,
    /// What falls in across the beam, seen through the bandpass of the emission.
    pub irradiance: Vec<f64>,
}

impl Complete {
    /// What a light is to the model, by exact integrals.
    #[must_use]
    pub fn incident(&self, light: &Light, extend: Extend) -> Incident {
        let surface = &self.surface;
        let of = |light: &Light| Incident {
            luminescent: surface.luminescent(&surface.shares(light)),
            irradiance: surface.seen(light),
        };
        let (low, high) = surface.needed_nm();
        if extend == Extend::Flat { of(&light.extended(low, high)) } else { of(light) }
    }

    /// The values at one geometry: those of [`super::Lit::at`] to the last bit.
    #[must_use]
    pub fn values(&self, incident: &Incident, geometry: &Geometry) -> Values {
        let angular = self.directional.values_at(geometry);
        self.valued((&incident.luminescent, &incident.irradiance), geometry, &angular)
    }

    /// The same of a luminescence and an irradiance, with the terms at the geometry.
    pub(super) fn valued(
        &self,
        (luminescent, irradiance): (&[f64], &[f64]),
        geometry: &Geometry,
        angular: &Result<Angular<'_>, Undefined>,
    ) -> Values {
        let cosine = lit_share(geometry);
        // Nothing falls in at a right angle: what is not known is nothing, too.
        let lit = |value: f64| if cosine == 0.0 { 0.0 } else { cosine * value };
        let by_terms = self.reflectance == ReflectanceSource::Terms;
        let mut all = Values {
            luminescent: luminescent.iter().map(|value| lit(*value)).collect(),
            diffuse: Vec::with_capacity(irradiance.len()),
            specular: Vec::with_capacity(irradiance.len()),
            total: Vec::with_capacity(irradiance.len()),
            undefined: angular.as_ref().err().cloned(),
        };
        for (j, (nm, irradiance)) in self.surface.emission_nm.iter().zip(irradiance).enumerate() {
            let part = angular.as_ref().map_or(Part::UNKNOWN, |angular| angular.at(*nm));
            let diffuse = if by_terms {
                part.diffuse * irradiance
            } else {
                lit(self.surface.elastic[j] * irradiance - part.in_matrix * irradiance)
            };
            let specular = part.specular * irradiance;
            all.diffuse.push(diffuse);
            all.specular.push(specular);
            all.total.push(all.luminescent[j] + diffuse + specular);
        }
        all
    }
}

/// The cosine of the incidence; 0 where nothing is seen or lit.
pub(super) fn lit_share(geometry: &Geometry) -> f64 {
    if geometry.is_below_horizon() { 0.0 } else { geometry.incidence.cos_theta().max(0.0) }
}

/// A complete model as a table that lights are multiplied with, samples of one step.
#[derive(Debug, Clone)]
pub struct CompleteTable {
    axis: Axis,
    /// Luminescence and irradiance of each emission from each sample \[sample, 2 x emission\].
    table: Array2<f64>,
}

impl CompleteTable {
    /// Of a model, in steps of so many nm; `None` where the step is out of [`super::super::STEPS_NM`].
    #[must_use]
    pub fn new(model: &Complete, step_nm: f64) -> Option<Self> {
        let surface = &model.surface;
        let axis = Axis::new(surface.needed_nm(), step_nm)?;
        let columns = surface.emission_nm.len();
        let mut table = Array2::zeros((axis.nm.len(), 2 * columns));
        for (row, unit) in axis.units()?.iter().enumerate() {
            let (luminescent, irradiance) = (surface.luminescent(&surface.shares(unit)), surface.seen(unit));
            for j in 0..columns {
                table[(row, j)] = luminescent[j];
                table[(row, columns + j)] = irradiance[j];
            }
        }
        Some(Self { axis, table })
    }

    /// A light as samples.
    #[must_use]
    pub fn sampled(&self, light: &Light, extend: Extend) -> Vec<f64> {
        self.axis.sampled(light, extend)
    }

    /// What a light of such samples is to the model; nothing for another number of samples.
    #[must_use]
    pub fn incident(&self, samples: &[f64]) -> Incident {
        let columns = self.table.ncols() / 2;
        let product = match samples.len() == self.table.nrows() {
            true => ndarray::ArrayView1::from(samples).dot(&self.table),
            false => ndarray::Array1::zeros(2 * columns),
        };
        Incident {
            luminescent: product.slice(s![..columns]).to_vec(),
            irradiance: product.slice(s![columns..]).to_vec(),
        }
    }
}
