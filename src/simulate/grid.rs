//! The wavelengths that a scene is simulated at, for what falls in and what comes out alike.

use crate::donaldson::{Light, Observer};

/// Longest wavelength that the observers of the CIE are summed to, nm.
const LAST_NM: usize = 780;

/// Wavelengths at one distance from each other, nm. Between them spectra are straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    nm: Vec<f64>,
    step: f64,
}

/// Numbers that make no grid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "wavelengths from {from} to {to} nm in steps of {step} nm; expected at least two, from 200 to 1100 nm, with steps of 0.1 to 100 nm"
)]
pub struct NoGrid {
    from: f64,
    to: f64,
    step: f64,
}

impl Grid {
    /// From a first wavelength, nm, in steps as far as the last.
    ///
    /// # Errors
    /// [`NoGrid`].
    pub fn new(from: f64, to: f64, step: f64) -> Result<Self, NoGrid> {
        let is_right = from >= 200.0 && to <= 1100.0 && (0.1..=100.0).contains(&step) && to >= from + step;
        if !is_right {
            return Err(NoGrid { from, to, step });
        }
        let steps = ((to - from) / step + 1e-9).floor() as usize;
        Ok(Self { nm: (0..=steps).map(|k| from + step * k as f64).collect(), step })
    }

    /// The same range in other steps; the last wavelength may be missed by less than a step.
    ///
    /// # Errors
    /// [`NoGrid`].
    pub fn in_steps_of(&self, step: f64) -> Result<Self, NoGrid> {
        Self::new(self.nm[0], self.nm[self.nm.len() - 1], step)
    }

    /// Wavelengths, nm.
    #[must_use]
    pub fn nm(&self) -> &[f64] {
        &self.nm
    }

    /// Their distance, nm.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// How much of the axis each wavelength stands for, nm: a step, half of one at the ends.
    pub(super) fn widths(&self) -> Vec<f64> {
        let last = self.nm.len() - 1;
        (0..=last).map(|k| if k == 0 || k == last { self.step / 2.0 } else { self.step }).collect()
    }

    /// A light as the mean about each wavelength: no line of a lamp is lost.
    pub(super) fn spectrum(&self, light: &Light) -> Vec<f64> {
        light.shares(&self.nm).iter().zip(self.widths()).map(|(share, width)| share / width).collect()
    }

    /// For X, Y and Z: the sum over whole nanometres (CIE 015:2018) of a spectrum that is straight between the wavelengths, as
    /// weights of its values.
    pub(super) fn weights(&self, observer: Observer) -> [Vec<f64>; 3] {
        let mut weights = [0, 1, 2].map(|_| vec![0.0; self.nm.len()]);
        let (first, last) = (self.nm[0], self.nm[self.nm.len() - 1]);
        for nm in first.ceil() as usize..=(last.floor() as usize).min(LAST_NM) {
            let matching = observer.matching(nm);
            let place = (nm as f64 - first) / self.step;
            let below = (place.floor() as usize).min(self.nm.len() - 2);
            let part = place - below as f64;
            for (weights, matching) in weights.iter_mut().zip(matching) {
                weights[below] += (1.0 - part) * matching;
                weights[below + 1] += part * matching;
            }
        }
        weights
    }
}
