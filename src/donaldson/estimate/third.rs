//! Which further light would tell most.

use super::super::nonnegative::inverse_over;
use super::linear::{Normal, roughness};
use super::{Axes, Lit, NoEstimate, Seen, check};

/// A light that was not used, with what it would give.
#[derive(Debug, Clone, PartialEq)]
pub struct Helpful {
    /// Its name.
    pub name: String,
    /// Root mean square over the wavelengths of the standard uncertainty of the reflectance with it, prior included.
    pub reflectance_sigma: f64,
}

/// Ranks candidates by what the reflectance would be known to with them, the best first; the same relative noise as the
/// spectra have in the median. The second number is what it is known to without.
///
/// # Errors
/// [`NoEstimate`].
pub fn third_light(
    axes: &Axes,
    shape: &[f64],
    seen: &[Seen],
    candidates: &[Lit],
) -> Result<(Vec<Helpful>, f64), NoEstimate> {
    check(axes, seen)?;
    let now = Normal::of(axes, seen, shape);
    let prior = roughness(&now).ok_or(NoEstimate::Undetermined)?;
    let known = |normal: &Normal| {
        let n = axes.emission_nm.len();
        let all: Vec<usize> = (0..2 * n).collect();
        let covariance = inverse_over(&normal.with(prior), &all)?;
        Some(((0..n).map(|k| covariance[(k, k)]).sum::<f64>() / n as f64).sqrt())
    };
    let estimate = super::linear::at(&now, prior).ok_or(NoEstimate::Undetermined)?;
    let relative = {
        let ratios = seen.iter().flat_map(|one| one.sigma.iter().zip(&one.values)).map(|(s, v)| s / v.abs());
        super::super::overlap::median(ratios.filter(|ratio| ratio.is_finite()).collect())
    };
    let mut list = Vec::new();
    for light in candidates {
        let columns = super::linear::columns(axes, light, shape);
        let values: Vec<f64> = columns
            .iter()
            .enumerate()
            .map(|(j, (e, c))| estimate.reflectance[j] * e + estimate.emission[j] * c)
            .collect();
        let floor = 1e-3 * values.iter().copied().fold(0.0, f64::max);
        let sigma = values.iter().map(|value| (relative * value).max(relative * floor)).collect();
        let mut all = seen.to_vec();
        all.push(Seen { light: light.clone(), values, sigma });
        if check(axes, &all).is_ok()
            && let Some(reflectance_sigma) = known(&Normal::of(axes, &all, shape))
        {
            list.push(Helpful { name: light.name.clone(), reflectance_sigma });
        }
    }
    list.sort_by(|a, b| a.reflectance_sigma.total_cmp(&b.reflectance_sigma));
    Ok((list, known(&now).ok_or(NoEstimate::Undetermined)?))
}
