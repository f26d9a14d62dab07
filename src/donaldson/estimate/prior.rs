//! What is taken for granted where spectra say nothing, each with its number, and where the numbers come from.
//!
//! Eight measured fluorescent surfaces (steps of 10 nm) have second differences of the reflectance of 0.02 to 0.04 (root mean
//! square, 0.14 at an edge), of the emission spectrum of 0.1 of its peak, which is 0.05 to 0.1; photon balances up to 0.98.

use nalgebra::DMatrix;

use super::Axes;

/// Standard deviation of the second differences of a reflectance at steps of 10 nm: an edge is three of them.
const REFLECTANCE_ROUGHNESS: f64 = 0.15;
/// And of an emission spectrum, in a matrix whose emission is 10 nm wide.
const EMISSION_ROUGHNESS: f64 = 0.03;
/// Reflectances are expected to be about so large.
const REFLECTANCE: f64 = 1.0;
/// And emissions, in a matrix whose emission is 10 nm wide; one rarely has more than 0.2.
const EMISSION: f64 = 0.3;
/// The step that these numbers are for, nm.
const STEP_NM: f64 = 10.0;
/// By how much photons out may seem to exceed photons in.
pub(super) const BALANCE: f64 = 0.02;

/// The curvature of the prior: reflectances, then emissions. A spectrum is an integrated random walk: the integral of its
/// squared second derivative counts, whatever the steps.
pub(super) fn curvature(axes: &Axes) -> DMatrix<f64> {
    let n = axes.emission_nm.len();
    let size = axes.width_nm / STEP_NM;
    let mut all = DMatrix::zeros(2 * n, 2 * n);
    for (offset, expected, rough) in
        [(0, REFLECTANCE, REFLECTANCE_ROUGHNESS), (n, EMISSION * size, EMISSION_ROUGHNESS * size)]
    {
        for k in 0..n {
            all[(offset + k, offset + k)] += expected.powi(-2);
        }
        for k in 1..n.saturating_sub(1) {
            let (before, after) =
                (axes.emission_nm[k] - axes.emission_nm[k - 1], axes.emission_nm[k + 1] - axes.emission_nm[k]);
            let mean = (before + after) / 2.0;
            let weight = STEP_NM.powi(3) * mean / (rough * rough);
            let entries = [(k - 1, 1.0 / (before * mean)), (k, -2.0 / (before * after)), (k + 1, 1.0 / (after * mean))];
            for (i, a) in entries {
                for (j, b) in entries {
                    all[(offset + i, offset + j)] += weight * a * b;
                }
            }
        }
    }
    all
}

/// One row per excitation: photons reflected there and radiated by luminescence over photons that fall in. Between two
/// emissions the reflectance is straight; outside them it is not known and not counted.
pub(super) fn balance(axes: &Axes, shape: &[f64]) -> DMatrix<f64> {
    let n = axes.emission_nm.len();
    let steps = super::super::matrix::steps(&axes.emission_nm);
    let mut rows = DMatrix::zeros(axes.excitation_nm.len(), 2 * n);
    for (i, excited) in axes.excitation_nm.iter().enumerate() {
        for (j, emitted) in axes.emission_nm.iter().enumerate().filter(|(_, emitted)| *emitted >= excited) {
            rows[(i, n + j)] = shape[i] * emitted / excited * steps[j] / axes.width_nm;
        }
        let after = axes.emission_nm.partition_point(|nm| nm < excited);
        if after < n && axes.emission_nm[after] == *excited {
            rows[(i, after)] = 1.0;
        } else if (1..n).contains(&after) {
            let (low, high) = (axes.emission_nm[after - 1], axes.emission_nm[after]);
            let part = (excited - low) / (high - low);
            rows[(i, after - 1)] = 1.0 - part;
            rows[(i, after)] = part;
        }
    }
    rows
}

/// The prior in words.
pub(super) fn words(is_known: bool) -> String {
    let spectra = format!(
        "reflectance and emission are not negative and smooth (second differences of {REFLECTANCE_ROUGHNESS} and \
         {EMISSION_ROUGHNESS} at steps of {STEP_NM} nm, standard deviations), and no more photons leave the surface than fall in"
    );
    if is_known { spectra } else { format!("{spectra}; the excitation spectrum has {}", super::shapes::WORDS) }
}
