//! What a body is made of.

use ndarray::Array2;

use super::grid::Grid;
use crate::donaldson::Reradiation;
use crate::donaldson::piecewise::place;
use crate::terms::{InvalidParameter, Term, TorranceSparrow};

/// A bispectral surface with an interface.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// What the scene calls it.
    pub name: String,
    /// Diffuse reflection and luminescence, in all directions alike.
    pub surface: Reradiation,
    /// Reflection at the interface; its `intensity` is the first of [`Material::intensity`] where that is not empty.
    pub specular: Option<TorranceSparrow>,
    /// c_s where it depends on the wavelength: (nm, c_s), ascending; straight between them, level outside.
    pub intensity: Vec<(f64, f64)>,
}

/// A material on the wavelengths of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OnGrid {
    /// Diffuse reflectance.
    pub(super) elastic: Vec<f64>,
    /// What a mean spectral irradiance about each wavelength makes at each other: \[out, in\]. `None` where there is no luminescence.
    pub(super) luminescence: Option<Array2<f64>>,
    /// c_s.
    pub(super) intensity: Vec<f64>,
}

/// What no body is made of.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoMaterial {
    /// No reflectance.
    #[error("material `{0}`: its elastic reflectance is known at no wavelength; expected one at least")]
    Elastic(String),
    /// A number that is none.
    #[error("material `{0}`: a luminescence or an intensity that is not a finite number")]
    Number(String),
    /// A parameter of its interface.
    #[error("material `{0}`: {1}")]
    Parameter(String, InvalidParameter),
}

impl Material {
    /// Its interface, where that reflects at any wavelength: one of no intensity is none.
    pub(super) fn interface(&self) -> Option<TorranceSparrow> {
        let reflects = |term: &TorranceSparrow| match self.intensity.as_slice() {
            [] => term.intensity != 0.0,
            list => list.iter().any(|(_, c)| *c != 0.0),
        };
        self.specular.filter(reflects)
    }

    /// Looks whether it can be drawn.
    ///
    /// # Errors
    /// [`NoMaterial`].
    pub fn check(&self) -> Result<(), NoMaterial> {
        if !self.surface.elastic.iter().any(|factor| factor.is_finite()) {
            return Err(NoMaterial::Elastic(self.name.clone()));
        }
        let numbers = self.surface.density.iter().chain(self.intensity.iter().map(|(_, c)| c));
        if numbers.into_iter().any(|number| !number.is_finite()) {
            return Err(NoMaterial::Number(self.name.clone()));
        }
        if let Some(term) = self.specular {
            Term::TorranceSparrow(term).check().map_err(|why| NoMaterial::Parameter(self.name.clone(), why))?;
        }
        Ok(())
    }

    pub(super) fn on(&self, grid: &Grid) -> OnGrid {
        let surface = &self.surface;
        let known: Vec<(f64, f64)> = surface
            .emission_nm
            .iter()
            .copied()
            .zip(surface.elastic.iter().copied())
            .filter(|at| at.1.is_finite())
            .collect();
        let elastic = grid.nm().iter().map(|nm| level(&known, *nm)).collect();
        let constant = self.specular.map_or(0.0, |term| term.intensity);
        let intensity =
            grid.nm().iter().map(|nm| if self.intensity.is_empty() { constant } else { level(&self.intensity, *nm) });
        Self::luminescence(surface, grid, elastic, intensity.collect())
    }

    fn luminescence(surface: &Reradiation, grid: &Grid, elastic: Vec<f64>, intensity: Vec<f64>) -> OnGrid {
        let is_dark = surface.density.iter().all(|value| *value == 0.0);
        let luminescence = (!is_dark).then(|| {
            let places = |axis: &[f64]| grid.nm().iter().map(|nm| place(axis, *nm)).collect::<Vec<_>>();
            let (ins, outs, widths) = (places(&surface.excitation_nm), places(&surface.emission_nm), grid.widths());
            Array2::from_shape_fn((outs.len(), ins.len()), |(j, i)| {
                let (Some((j, after, m)), Some((k, next, x))) = (outs[j], ins[i]) else { return 0.0 };
                let at = |k: usize| (1.0 - m) * surface.density[(k, j)] + m * surface.density[(k, after)];
                widths[i] * ((1.0 - x) * at(k) + x * at(next))
            })
        });
        OnGrid { elastic, luminescence, intensity }
    }
}

impl OnGrid {
    /// The largest share of the energy of a wavelength that leaves again by diffuse reflection and luminescence.
    pub(super) fn albedo(&self, grid: &Grid) -> f64 {
        self.sent_back(grid, |_, _| 1.0).fold(0.0, f64::max)
    }

    /// The share of the energy of each wavelength that leaves again, `interface` being that of an interface of intensity 1.
    pub(super) fn energy(&self, grid: &Grid, interface: f64) -> f64 {
        self.with_interface(self.sent_back(grid, |_, _| 1.0), interface)
    }

    /// The same of its photons: those that are reflected were not absorbed, and cannot be emitted as well.
    pub(super) fn photons(&self, grid: &Grid, interface: f64) -> f64 {
        self.with_interface(self.sent_back(grid, |out, into| out / into), interface)
    }

    fn with_interface(&self, shares: impl Iterator<Item = f64>, interface: f64) -> f64 {
        shares.zip(&self.intensity).map(|(share, intensity)| share + intensity * interface).fold(0.0, f64::max)
    }

    /// Of each wavelength what leaves again by diffuse reflection and luminescence, where energy of one wavelength counts so much
    /// more than that of another.
    fn sent_back<'a>(&'a self, grid: &'a Grid, worth: impl Fn(f64, f64) -> f64 + 'a) -> impl Iterator<Item = f64> + 'a {
        let (widths, nm) = (grid.widths(), grid.nm());
        (0..nm.len()).map(move |i| {
            let emitted = self.luminescence.as_ref().map_or(0.0, |matrix| {
                let column = matrix.column(i).into_iter().zip(&widths).zip(nm);
                column.map(|((value, width), out)| value * width * worth(*out, nm[i])).sum::<f64>() / widths[i]
            });
            self.elastic[i] + emitted
        })
    }
}

/// Straight between points, level outside them; 0 without any.
fn level(points: &[(f64, f64)], nm: f64) -> f64 {
    let after = points.partition_point(|(at, _)| *at <= nm);
    match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
        (Some((low, a)), Some((high, b))) => a + (nm - low) / (high - low) * (b - a),
        (Some((_, only)), None) => only,
        (None, Some((_, only))) => *only,
        (None, None) => 0.0,
    }
}
