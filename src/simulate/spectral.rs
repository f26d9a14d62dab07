//! A surface under one spectrum and an observer: all that a colour is a sum of, and the three numbers per term that are left of it.

use ndarray::Array2;

use super::convex::Colours;
use crate::donaldson::{Extend, Light, Observer, Reradiation, steps};

/// The bispectral surface, the irradiance and the observer on the wavelengths of the matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectral {
    /// The irradiance that each excitation takes part in.
    pub(super) excitation: Vec<f64>,
    /// Luminescent density \[emission, excitation\], nm-1.
    pub(super) density: Array2<f64>,
    /// The irradiance at each emission.
    pub(super) irradiance: Vec<f64>,
    /// The elastic radiance factor at each emission.
    pub(super) elastic: Vec<f64>,
    /// What a unit at each emission adds to X, Y and Z: the perfect diffuser lit along the normal has a Y of 100.
    pub(super) weights: Vec<[f64; 3]>,
}

/// Why there is no colour.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoColours {
    /// A hole in the matrix.
    #[error(
        "the elastic radiance factor at {nm} nm is not known; expected a number at every emission wavelength: give a matrix that \
         covers the diagonal, or restrict it to the emission it covers"
    )]
    Elastic {
        /// The wavelength.
        nm: f64,
    },
    /// The light has nothing for the eye.
    #[error("light `{0}` has a Y of {1} over the emission of the matrix; expected one above 0")]
    Dark(String, f64),
}

impl Spectral {
    /// Sums are over the emission wavelengths of the matrix, each as wide as its cell ([`Reradiation::under`] sums over every
    /// nanometre between them).
    ///
    /// # Errors
    /// [`NoColours`].
    pub fn new(surface: &Reradiation, light: &Light, extend: Extend, observer: Observer) -> Result<Self, NoColours> {
        let nm = &surface.emission_nm;
        if let Some(hole) = surface.elastic.iter().position(|factor| !factor.is_finite()) {
            return Err(NoColours::Elastic { nm: nm[hole] });
        }
        let found = surface.under(light, extend);
        let lit = match extend {
            Extend::Zero => light.clone(),
            Extend::Flat => light.extended(surface.excitation_nm[0].min(nm[0]), nm[nm.len() - 1]),
        };
        let weights: Vec<[f64; 3]> = nm.iter().zip(steps(nm)).map(|(nm, width)| weight(observer, *nm, width)).collect();
        let white: f64 = weights.iter().zip(&found.irradiance).map(|(weight, e)| weight[1] * e).sum();
        let scale = 100.0 / white;
        if !(white > 0.0 && scale.is_finite()) {
            return Err(NoColours::Dark(light.name().to_owned(), white));
        }
        Ok(Self {
            excitation: surface.shares(&lit),
            density: surface.density.t().as_standard_layout().into_owned(),
            irradiance: found.irradiance,
            elastic: surface.elastic.clone(),
            weights: weights.into_iter().map(|weight| weight.map(|value| scale * value)).collect(),
        })
    }

    /// The three numbers per term: under one spectrum the product of matrix and light is made once, and not per pixel.
    #[must_use]
    pub fn colours(&self) -> Colours {
        let sum = |spectrum: &dyn Fn(usize) -> f64| {
            [0, 1, 2].map(|c| (0..self.weights.len()).map(|j| self.weights[j][c] * spectrum(j)).sum::<f64>())
        };
        let luminescent =
            |j: usize| self.density.row(j).iter().zip(&self.excitation).map(|(density, e)| density * e).sum::<f64>();
        Colours {
            luminescent: sum(&luminescent),
            diffuse: sum(&|j| self.elastic[j] * self.irradiance[j]),
            specular: sum(&|j| self.irradiance[j]),
        }
    }
}

/// The observer over a cell, straight between whole nanometres.
fn weight(observer: Observer, nm: f64, width: f64) -> [f64; 3] {
    let below = nm.max(0.0).floor();
    let (low, high) = (observer.matching(below as usize), observer.matching(below as usize + 1));
    [0, 1, 2].map(|c| width * (low[c] + (nm - below) * (high[c] - low[c])))
}
