//! A complete model at one excitation: its luminescence as a density, its reflection as a line. The two are never one array.

use super::super::piecewise::place;
use super::Complete;
use super::directional::Part;
use crate::dataset::ReflectanceSource;
use crate::quantity::Geometry;
use crate::terms::Undefined;

/// What one wavelength that falls in becomes, over its irradiance across the beam.
#[derive(Debug, Clone, PartialEq)]
pub struct Bispectral {
    /// The luminescence at each emission of the model, nm-1: Y_l over the irradiance of the line.
    pub luminescent: Vec<f64>,
    /// Its standard uncertainty (k = 1) from independent errors.
    pub luminescent_sigma: Vec<f64>,
    /// What is reflected at the wavelength of the excitation; `None` outside the emission of the model.
    pub reflected: Option<Reflected>,
    /// Why the specular term has no value.
    pub undefined: Option<Undefined>,
}

/// Reflection at one wavelength: Y over the irradiance across the beam, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflected {
    /// Y_d/E; NaN where the matrix does not tell.
    pub diffuse: f64,
    /// Its standard uncertainty (k = 1).
    pub diffuse_sigma: f64,
    /// Y_s/E; NaN where its term is undefined.
    pub specular: f64,
    /// Its standard uncertainty.
    pub specular_sigma: f64,
    /// Standard uncertainty of their sum.
    pub total_sigma: f64,
}

impl Reflected {
    /// Both.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.diffuse + self.specular
    }
}

/// An excitation of which the matrix says nothing.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("excitation {nm} nm: the matrix was excited from {first_nm} to {last_nm} nm, and is not continued outside")]
pub struct OutsideExcitation {
    /// What was asked for, nm.
    pub nm: f64,
    /// First excitation of the matrix, nm.
    pub first_nm: f64,
    /// Last, nm.
    pub last_nm: f64,
}

impl Complete {
    /// The model at one excitation, straight between those of the matrix.
    ///
    /// # Errors
    /// [`OutsideExcitation`] below the first and above the last excitation of the matrix.
    pub fn bispectral(&self, excitation_nm: f64, geometry: &Geometry) -> Result<Bispectral, OutsideExcitation> {
        let surface = &self.surface;
        let axis = &surface.excitation_nm;
        let Some((low, high, part)) = place(axis, excitation_nm) else {
            let (first_nm, last_nm) = (axis[0], axis[axis.len() - 1]);
            return Err(OutsideExcitation { nm: excitation_nm, first_nm, last_nm });
        };
        let mut shares = vec![0.0; axis.len()];
        shares[low] += 1.0 - part;
        shares[high] += part;
        let columns = surface.emission_nm.len();
        let cosine = if geometry.is_below_horizon() { 0.0 } else { geometry.incidence.cos_theta().max(0.0) };
        let nothing = vec![0.0; columns];
        let sigma = |j: usize| {
            let unit: Vec<f64> = (0..columns).map(|k| f64::from(u8::from(k == j))).collect();
            cosine * surface.variance(&nothing, &shares, &unit).sqrt()
        };
        let density = |j: usize| (1.0 - part) * surface.density[(low, j)] + part * surface.density[(high, j)];
        let angular = self.directional.at(geometry);
        Ok(Bispectral {
            luminescent: (0..columns).map(|j| cosine * density(j)).collect(),
            luminescent_sigma: (0..columns).map(sigma).collect(),
            reflected: place(&surface.emission_nm, excitation_nm).map(|at| {
                let part = angular.as_ref().map_or(Part::UNKNOWN, |angular| angular.at(excitation_nm));
                self.reflected(at, cosine, part)
            }),
            undefined: angular.as_ref().err().cloned(),
        })
    }

    fn reflected(&self, (low, high, way): (usize, usize, f64), cosine: f64, part: Part) -> Reflected {
        let surface = &self.surface;
        let lit = |value: f64| if cosine == 0.0 { 0.0 } else { cosine * value };
        let on_line = |list: &[f64]| if way == 0.0 { list[low] } else { (1.0 - way) * list[low] + way * list[high] };
        let (specular, specular_sigma) = (part.specular, part.specular_sigma);
        if self.reflectance == ReflectanceSource::Terms {
            let (diffuse, diffuse_sigma) = (part.diffuse, part.diffuse_sigma);
            return Reflected { diffuse, diffuse_sigma, specular, specular_sigma, total_sigma: part.sum_sigma };
        }
        let sigma = if way == 0.0 {
            surface.elastic_sigma[low]
        } else {
            ((1.0 - way) * surface.elastic_sigma[low]).hypot(way * surface.elastic_sigma[high])
        };
        Reflected {
            diffuse: lit(on_line(&surface.elastic) - part.in_matrix),
            diffuse_sigma: lit(sigma.hypot(part.in_matrix_sigma)),
            specular,
            specular_sigma,
            total_sigma: lit(sigma).hypot(part.sum_sigma),
        }
    }
}
