//! Two spectra of one shape? The scale between them is fitted away; what is left is held against what is known of both.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::super::matrix::steps;
use super::super::overlap::median;
use super::super::piecewise::place;

/// Share of pairs of one shape that are called different: one check in a hundred.
pub(super) const FALSE_ALARMS: f64 = 0.01;
/// The scale and the weights that depend on it are found in turn; after so many passes they stand still.
const PASSES: usize = 20;

/// A spectrum with what is known of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Spectrum {
    /// Wavelengths, nm, ascending.
    pub(super) nm: Vec<f64>,
    pub(super) values: Vec<f64>,
    /// Standard uncertainties; NaN where unknown.
    pub(super) sigma: Vec<f64>,
    /// Full width at half maximum of what it was seen through, nm, where stated.
    pub(super) fwhm_nm: Option<f64>,
}

impl Spectrum {
    /// Those of its points that fulfil a condition.
    pub(super) fn only(&self, keep: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.nm.len()).filter(|k| keep(*k)).collect();
        let of = |list: &[f64]| kept.iter().map(|k| list[*k]).collect();
        Self { nm: of(&self.nm), values: of(&self.values), sigma: of(&self.sigma), fwhm_nm: self.fwhm_nm }
    }

    fn step(&self) -> f64 {
        median(steps(&self.nm))
    }

    /// The second difference at a point, in the unit of the values: how far it bends over one step.
    fn bend(&self, k: usize) -> f64 {
        let k = k.clamp(1, self.nm.len().saturating_sub(2).max(1));
        match (self.values.get(k - 1), self.values.get(k), self.values.get(k + 1)) {
            (Some(a), Some(b), Some(c)) => a - 2.0 * b + c,
            _ => 0.0,
        }
    }

    /// Straight between its points, with the uncertainty of that: of the values, and of what a straight line cuts off.
    fn at(&self, nm: f64) -> Option<(f64, f64)> {
        let (low, high, part) = place(&self.nm, nm)?;
        if low == high {
            return Some((self.values[low], self.sigma[low]));
        }
        let value = (1.0 - part) * self.values[low] + part * self.values[high];
        let sigma = ((1.0 - part) * self.sigma[low]).hypot(part * self.sigma[high]);
        let bend = self.bend(low).abs().max(self.bend(high).abs());
        Some((value, sigma.hypot(part * (1.0 - part) / 2.0 * bend)))
    }
}

/// Where two spectra are furthest apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// The wavelength, nm.
    pub nm: f64,
    /// Measured minus predicted there, relative to the largest predicted value.
    pub relative: f64,
    /// The same in standard uncertainties of the difference.
    pub sigmas: f64,
}

/// What a comparison gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Compared {
    pub(super) count: usize,
    pub(super) from_nm: f64,
    pub(super) to_nm: f64,
    /// Measured over predicted.
    pub(super) scale: f64,
    pub(super) scale_sigma: f64,
    pub(super) reduced_chi_square: f64,
    /// What one pair of one shape in a hundred exceeds.
    pub(super) limit: f64,
    pub(super) largest: Deviation,
}

/// Compares a measured spectrum with a predicted one where both are, at the wavelengths of the one with wider steps; `None`
/// where fewer than three are left, and where nothing is known of their uncertainty.
pub(super) fn compare(measured: &Spectrum, predicted: &Spectrum) -> Option<Compared> {
    if measured.nm.len() < 3 || predicted.nm.len() < 3 {
        return None;
    }
    let at_measured = measured.step() > predicted.step();
    let nodes = if at_measured { &measured.nm } else { &predicted.nm };
    // A wider bandpass on one side makes its peaks lower: by the variance of the triangle over two, times the curvature.
    let smearing = match (measured.fwhm_nm, predicted.fwhm_nm) {
        (Some(a), Some(b)) => (a * a - b * b).abs() / 12.0 / predicted.step().powi(2),
        _ => 0.0,
    };
    let points: Vec<[f64; 5]> = nodes
        .iter()
        .filter_map(|nm| {
            let ((y, y_sigma), (p, p_sigma)) = (measured.at(*nm)?, predicted.at(*nm)?);
            let (low, high, _) = place(&predicted.nm, *nm)?;
            let bend = predicted.bend(low).abs().max(predicted.bend(high).abs());
            let p_sigma = p_sigma.hypot(smearing * bend);
            [y, y_sigma, p, p_sigma].iter().all(|number| number.is_finite()).then_some([*nm, y, y_sigma, p, p_sigma])
        })
        .collect();
    let count = points.len();
    let freedom = count.checked_sub(1).filter(|freedom| *freedom >= 2)? as f64;
    let mut scale = points.iter().map(|[_, y, _, p, _]| y * p).sum::<f64>()
        / points.iter().map(|[_, _, _, p, _]| p * p).sum::<f64>();
    let variance = |scale: f64, [_, _, y_sigma, _, p_sigma]: &[f64; 5]| y_sigma.powi(2) + (scale * p_sigma).powi(2);
    let mut information = 0.0;
    for _ in 0..PASSES {
        information = points.iter().map(|point| point[3].powi(2) / variance(scale, point)).sum();
        scale = points.iter().map(|point| point[1] * point[3] / variance(scale, point)).sum::<f64>() / information;
    }
    let off = |point: &[f64; 5]| point[1] - scale * point[3];
    let sigmas = |point: &[f64; 5]| off(point) / variance(scale, point).sqrt();
    let peak = points.iter().map(|point| (scale * point[3]).abs()).fold(0.0, f64::max);
    let worst = points.iter().max_by(|a, b| sigmas(a).abs().total_cmp(&sigmas(b).abs()))?;
    let reduced_chi_square = points.iter().map(|point| sigmas(point).powi(2)).sum::<f64>() / freedom;
    let limit = ChiSquared::new(freedom).ok()?.inverse_cdf(1.0 - FALSE_ALARMS) / freedom;
    (reduced_chi_square.is_finite() && scale.is_finite() && peak > 0.0).then_some(Compared {
        count,
        from_nm: points[0][0],
        to_nm: points[count - 1][0],
        scale,
        scale_sigma: information.sqrt().recip(),
        reduced_chi_square,
        limit,
        largest: Deviation { nm: worst[0], relative: off(worst) / peak, sigmas: sigmas(worst) },
    })
}
