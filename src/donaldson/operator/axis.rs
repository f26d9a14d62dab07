//! Lights as samples of one step.

use std::ops::Range;

use super::super::colour::VISIBLE_NM;
use super::super::light::{Extend, Light};
use super::super::piecewise::Line;
use crate::quantity::QuantityKind;

/// Smallest and largest step, nm.
pub const STEPS_NM: (f64, f64) = (0.5, 50.0);

/// Wavelengths of one step; 380 nm is one of them.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct Axis {
    /// nm.
    pub(in super::super) nm: Vec<f64>,
    /// Which of them an observer sees.
    pub(super) visible: Range<usize>,
}

impl Axis {
    /// Samples that reach over the wavelengths needed; `None` where the step is out of [`STEPS_NM`].
    pub(in super::super) fn new(needed: (f64, f64), step: f64) -> Option<Self> {
        if !(STEPS_NM.0..=STEPS_NM.1).contains(&step) {
            return None;
        }
        let (from, to) = (VISIBLE_NM.0 as f64, VISIBLE_NM.1 as f64);
        let before = ((from - needed.0) / step - 1e-9).ceil().max(0.0) as usize;
        let after = ((needed.1 - from) / step - 1e-9).ceil().max(1.0) as usize;
        let nm = (0..=before + after).map(|k| from + (k as f64 - before as f64) * step).collect();
        Some(Self { nm, visible: before..before + ((to - from) / step + 1e-9).floor() as usize + 1 })
    }

    /// A light as samples. One that is given in finer steps is averaged from neighbour to neighbour, so that no line of it is lost.
    pub(in super::super) fn sampled(&self, light: &Light, extend: Extend) -> Vec<f64> {
        let (low, high) = (self.nm[0], self.nm[self.nm.len() - 1]);
        let light = if extend == Extend::Flat { light.extended(low, high) } else { light.clone() };
        let step = self.nm[1] - self.nm[0];
        let is_finer = light.nm().windows(2).any(|pair| pair[1] - pair[0] < step * 0.999);
        let at = |nm: f64| match is_finer {
            true => light.line().average_over(&Line::triangle(nm - step, nm, nm + step), nm),
            false => light.line().at(nm),
        };
        self.nm.iter().map(|nm| at(*nm).unwrap_or(0.0)).collect()
    }

    /// For each sample the light that is 1 there and 0 at all others: what is linear in lights is known by these.
    pub(in super::super) fn units(&self) -> Option<Vec<Light>> {
        let one = |row: usize| {
            let values = (0..self.nm.len()).map(|k| if k == row { 1.0 } else { 0.0 }).collect();
            Light::new("unit", QuantityKind::RelativeSpectrum, self.nm.clone(), values, None).ok()
        };
        (0..self.nm.len()).map(one).collect()
    }
}
