//! From the minimum of a joint fit to what is reported.

use super::super::descent::{Descent, End};
use super::super::outcome::{Fit, Stop};
use super::super::profile::{Interval, Intervals};
use super::Joint;
use super::information::{Information, Layout};
use crate::dataset::Effect;

/// Half an interval of 95 % in standard uncertainties.
const HALF: f64 = 1.959_963_984_540_054;

/// A fit with correlated errors and effects of the instrument.
#[derive(Debug, Clone)]
pub(in super::super) struct Refined {
    pub(in super::super) fit: Fit,
    /// From the curvature, on the scale of the logarithm where the parameter has one: many wavelengths together, or a prior,
    /// leave little else.
    pub(in super::super) intervals: Intervals,
    pub(in super::super) effects: Vec<FittedEffect>,
}

/// An effect of the instrument after the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct FittedEffect {
    pub(in super::super) effect: Effect,
    /// Degrees.
    pub(in super::super) value: f64,
    /// Degrees; 0 where it was not fitted.
    pub(in super::super) sigma: f64,
    /// What it was before: value and standard uncertainty, degrees.
    pub(in super::super) prior: (f64, f64),
}

pub(super) fn refined(
    joint: &Joint<'_>,
    layout: &Layout,
    start: &Fit,
    descent: &Descent<Information>,
) -> Option<Refined> {
    let (point, shape) = (&descent.point, layout.shape());
    let free: Vec<usize> = (0..layout.count()).filter(|&k| !descent.held[k]).collect();
    let covariance = descent.slope.covariance(&free)?;
    let at_bound = [descent.held[shape], descent.held[shape + 1]];
    let mut fit = start.clone();
    (fit.roughness, fit.index_minus_one) = (point[shape].exp(), point[shape + 1].exp());
    fit.chi_square = descent.height.chi_square;
    fit.evaluations += descent.evaluations;
    fit.at_bound = at_bound;
    fit.stop = match descent.end {
        End::EvaluationLimit => Stop::EvaluationLimit,
        End::Converged | End::Known if at_bound == [false; 2] => Stop::Converged,
        End::Converged | End::Known => Stop::AtBound,
        End::Stalled | End::Undefined => Stop::Stalled,
    };
    let sigma = |k: usize| if descent.held[k] { f64::NAN } else { covariance[(k, k)].sqrt() };
    fit.log_sigma = [sigma(shape), sigma(shape + 1)];
    for (b, band) in fit.bands.iter_mut().enumerate() {
        // Places of (diffuse, intensity, roughness, index), and the scale from logarithms.
        let places = [(layout.diffuse > 0).then_some(b), Some(layout.intensity(b)), Some(shape), Some(shape + 1)];
        let scales = [1.0, 1.0, fit.roughness, fit.index_minus_one];
        band.diffuse = places[0].map_or(0.0, |k| point[k]);
        band.intensity = point[layout.intensity(b)];
        band.covariance = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (places[i], places[j]) {
                (Some(k), Some(l)) if descent.held[k] || descent.held[l] => f64::NAN,
                (Some(k), Some(l)) => covariance[(k, l)] * scales[i] * scales[j],
                _ => 0.0,
            })
        });
    }
    fit.singular_values = singular(&descent.slope, &covariance, shape);
    let intervals = intervals(joint, &fit);
    let values = layout.effects(joint, point);
    let effects = joint.nuisances.iter().enumerate().map(|(k, nuisance)| {
        let place = layout.effects.iter().position(|&fitted| fitted == k);
        FittedEffect {
            effect: nuisance.effect,
            value: values[k],
            sigma: place.map_or(0.0, |place| sigma(shape + 2 + place)),
            prior: (nuisance.value, nuisance.sigma),
        }
    });
    Some(Refined { effects: effects.collect(), fit, intervals })
}

/// Singular values of the two columns of the shape beside all others, scaled to unit length.
fn singular(information: &Information, covariance: &nalgebra::DMatrix<f64>, shape: usize) -> Vec<f64> {
    let norm = |k: usize| information.matrix[(k, k)].sqrt();
    let scaled = |i: usize, j: usize| covariance[(i, j)] * norm(i) * norm(j);
    let (a, b, c) = (scaled(shape, shape), scaled(shape, shape + 1), scaled(shape + 1, shape + 1));
    let root = ((a - c) * (a - c) / 4.0 + b * b).sqrt();
    let eigenvalues = [(a + c) / 2.0 - root, (a + c) / 2.0 + root];
    if eigenvalues.iter().all(|value| *value > 0.0) {
        eigenvalues.iter().map(|value| value.sqrt().recip()).collect()
    } else {
        Vec::new()
    }
}

fn intervals(joint: &Joint<'_>, fit: &Fit) -> Intervals {
    let one = fit.bands.len() == 1;
    let of_log = |value: f64, sigma: f64, bounds: Option<(f64, f64)>| {
        let (low, high) = (value.ln() - HALF * sigma, value.ln() + HALF * sigma);
        let (least, most) = bounds.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let unknown = sigma.is_nan();
        Interval {
            low: low.max(least).exp(),
            high: high.min(most).exp(),
            low_open: unknown || low <= least,
            high_open: unknown || high >= most,
        }
    };
    let [diffuse, intensity, ..] = fit.standard_uncertainty(0);
    let band = &fit.bands[0];
    let of_diffuse = Interval {
        low: (band.diffuse - HALF * diffuse).max(0.0),
        high: band.diffuse + HALF * diffuse,
        low_open: diffuse.is_nan(),
        high_open: diffuse.is_nan(),
    };
    Intervals {
        probability: 0.95,
        diffuse: (one && joint.has_diffuse).then_some(of_diffuse),
        intensity: one.then(|| of_log(band.intensity, intensity / band.intensity, None)),
        roughness: Some(of_log(fit.roughness, fit.log_sigma[0], Some(joint.box_of_shape[0]))),
        index_minus_one: Some(of_log(fit.index_minus_one, fit.log_sigma[1], Some(joint.box_of_shape[1]))),
    }
}
