//! Which further light would tell most.

use super::problem::{Problem, columns};
use super::{Axes, Estimate, Lit, NoEstimate, Seen, check};
use crate::donaldson::nonnegative::inverse_over;
use crate::donaldson::overlap::median;

/// A light that was not used, with what it would give.
#[derive(Debug, Clone, PartialEq)]
pub struct Helpful {
    /// Its name.
    pub name: String,
    /// Root mean square over the wavelengths of the standard uncertainty of the reflectance with it, prior included, for the
    /// best excitation spectrum.
    pub reflectance_sigma: f64,
}

/// Ranks candidates by what the reflectance would be known to with them, the best first; the same relative noise as the
/// spectra have in the median. The second number is what it is known to without.
///
/// # Errors
/// [`NoEstimate`].
pub fn third_light(
    axes: &Axes,
    found: &Estimate,
    seen: &[Seen],
    candidates: &[Lit],
) -> Result<(Vec<Helpful>, f64), NoEstimate> {
    check(axes, seen)?;
    let shape: Vec<f64> = found.excitation.iter().map(|x| x.best).collect();
    let n = axes.emission_nm.len();
    let known = |seen: &[Seen]| {
        let curvature = Problem::new(axes, seen).given(&shape).curvature;
        let covariance = inverse_over(&curvature, &(0..2 * n).collect::<Vec<_>>())?;
        Some(((0..n).map(|k| covariance[(k, k)]).sum::<f64>() / n as f64).sqrt())
    };
    let relative = {
        let ratios = seen.iter().flat_map(|one| one.sigma.iter().zip(&one.values)).map(|(s, v)| s / v.abs());
        median(ratios.filter(|ratio| ratio.is_finite()).collect())
    };
    let mut list = Vec::new();
    for light in candidates {
        let lit = columns(axes, light, &shape);
        let value = |j: usize| found.reflectance[j].best * lit[j].0 + found.emission[j].best * lit[j].1;
        let values: Vec<f64> = (0..n).map(value).collect();
        let floor = 1e-3 * values.iter().copied().fold(0.0, f64::max);
        let sigma = values.iter().map(|value| relative * value.max(floor)).collect();
        let mut all = seen.to_vec();
        all.push(Seen { light: light.clone(), values, sigma });
        if check(axes, &all).is_ok()
            && let Some(reflectance_sigma) = known(&all)
        {
            list.push(Helpful { name: light.name.clone(), reflectance_sigma });
        }
    }
    list.sort_by(|a, b| a.reflectance_sigma.total_cmp(&b.reflectance_sigma));
    Ok((list, known(seen).ok_or(NoEstimate::Undetermined)?))
}
