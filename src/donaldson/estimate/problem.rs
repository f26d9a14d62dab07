//! Reflectance and emission for a given excitation spectrum: a convex problem. Least squares and a smooth prior, numbers not
//! below 0, and a photon balance that is not above 1.

use nalgebra::{DMatrix, DVector};

use super::super::nonnegative::minimise;
use super::prior;
use super::{Axes, Lit, Seen};

/// Passes of the active sets; they settle in a few.
const PASSES: usize = 40;
/// After so many a balance that was at its bound stays there: no set comes twice.
const STAYS: usize = 20;

/// What does not depend on the excitation spectrum.
pub(super) struct Problem<'a> {
    pub(super) axes: &'a Axes,
    pub(super) seen: &'a [Seen],
    prior: DMatrix<f64>,
}

/// The problem of one excitation spectrum.
pub(super) struct Given {
    /// Curvature of the data alone.
    pub(super) data: DMatrix<f64>,
    /// Curvature of data and prior.
    pub(super) curvature: DMatrix<f64>,
    pub(super) gradient: DVector<f64>,
    /// Photons out over photons in, one row per excitation: each at most 1.
    pub(super) balance: DMatrix<f64>,
    /// Weighted sum of squares of the values, and how many.
    square: f64,
    pub(super) count: usize,
}

/// Its optimum.
pub(super) struct Best {
    /// Reflectances, then emissions.
    pub(super) at: DVector<f64>,
    /// Sum of squares, prior and balance: twice the negative logarithm of the probability, but for a constant.
    pub(super) cost: f64,
    /// The sum of squares of the data.
    pub(super) chi_square: f64,
    /// Curvature with the balances that are at their bound.
    pub(super) curvature: DMatrix<f64>,
}

/// The two columns of each light at each emission: (E, C), C summing what is excited up to the emission, as in the factors of a
/// matrix ([`crate::dataset::Factorisation::luminescent`]).
pub(super) fn columns(axes: &Axes, light: &Lit, shape: &[f64]) -> Vec<(f64, f64)> {
    let cells = axes.excitation_nm.iter().zip(&light.excitation).zip(shape);
    let cells: Vec<(f64, f64)> = cells.map(|((nm, energy), x)| (*nm, energy * x)).collect();
    let up_to = |emission: f64| cells.iter().take_while(|(nm, _)| *nm <= emission).map(|(_, part)| part).sum();
    axes.emission_nm.iter().zip(&light.emission).map(|(nm, energy)| (*energy, up_to(*nm))).collect()
}

impl<'a> Problem<'a> {
    pub(super) fn new(axes: &'a Axes, seen: &'a [Seen]) -> Self {
        Self { axes, seen, prior: prior::curvature(axes) }
    }

    pub(super) fn given(&self, shape: &[f64]) -> Given {
        let n = self.axes.emission_nm.len();
        let (mut data, mut gradient) = (DMatrix::zeros(2 * n, 2 * n), DVector::zeros(2 * n));
        let (mut square, mut count) = (0.0, 0);
        for Seen { light, values, sigma } in self.seen {
            for (j, (e, c)) in columns(self.axes, light, shape).into_iter().enumerate() {
                if values[j].is_nan() {
                    continue;
                }
                let weight = sigma[j].powi(-2);
                data[(j, j)] += weight * e * e;
                data[(j, n + j)] += weight * e * c;
                data[(n + j, j)] += weight * e * c;
                data[(n + j, n + j)] += weight * c * c;
                gradient[j] += weight * e * values[j];
                gradient[n + j] += weight * c * values[j];
                square += weight * values[j] * values[j];
                count += 1;
            }
        }
        let curvature = &data + &self.prior;
        Given { data, curvature, gradient, balance: prior::balance(self.axes, shape), square, count }
    }
}

impl Given {
    /// The optimum: a balance above 1 costs what it exceeds by, over the prior's allowance, squared. `None` where the numbers
    /// are none.
    pub(super) fn best(&self) -> Option<Best> {
        let weight = prior::BALANCE.powi(-2);
        let mut full = vec![false; self.balance.nrows()];
        let (mut curvature, mut at);
        let mut pass = 0;
        loop {
            curvature = self.curvature.clone();
            let mut gradient = self.gradient.clone();
            for row in (0..full.len()).filter(|row| full[*row]) {
                let photons = self.balance.row(row).transpose();
                curvature.ger(weight, &photons, &photons, 1.0);
                gradient.axpy(weight, &photons, 1.0);
            }
            at = minimise(&curvature, &gradient)?;
            let photons = &self.balance * &at;
            let stays = pass > STAYS;
            let now: Vec<bool> = (0..full.len()).map(|row| photons[row] > 1.0 || stays && full[row]).collect();
            if now == full || pass == PASSES {
                break;
            }
            full = now;
            pass += 1;
        }
        let chi_square = (self.square - 2.0 * self.gradient.dot(&at) + at.dot(&(&self.data * &at))).max(0.0);
        let over = (&self.balance * &at).iter().map(|photons| (photons - 1.0).max(0.0).powi(2)).sum::<f64>() * weight;
        let prior = at.dot(&(&self.curvature * &at)) - at.dot(&(&self.data * &at));
        let cost = chi_square + prior + over;
        cost.is_finite().then_some(Best { at, cost, chi_square, curvature })
    }

    /// Standard uncertainty of the reflectance at each wavelength from the lights there alone; infinite where they cannot tell
    /// reflection from luminescence.
    pub(super) fn lights_alone(&self) -> Vec<f64> {
        let n = self.gradient.len() / 2;
        let alone = |j: usize| {
            let (ee, ec, cc) = (self.data[(j, j)], self.data[(j, n + j)], self.data[(n + j, n + j)]);
            if cc == 0.0 {
                return if ee > 0.0 { ee.sqrt().recip() } else { f64::INFINITY };
            }
            // The determinant over cc: what luminescence leaves of the knowledge about reflection.
            let left = ee - ec * ec / cc;
            if left > 1e-12 * ee { left.sqrt().recip() } else { f64::INFINITY }
        };
        (0..n).map(alone).collect()
    }
}
