//! A bound on the light that comes by way of other bodies.
//!
//! The irradiance of a body by others is at most the radiance of the brightest of them, in the shares of the hemisphere that they may
//! take up. So the largest irradiances of one order bound those of the next, wavelength by wavelength. The bound of an order is
//! monotone and homogeneous in that of the one before: once all of it falls by a factor r, what follows is at most r / (1 - r) of it.

use super::super::material::OnGrid;

/// Orders that are added up before the rest is bounded.
const ORDERS: u32 = 3000;
/// What falls by this factor in every order is bounded from there on.
const FALLS: f64 = 0.999;

/// Bodies as light goes between them.
pub(super) struct Between<'a> {
    /// The material of each.
    pub(super) materials: Vec<&'a OnGrid>,
    /// The share of the hemisphere of one (first) that another may take up.
    pub(super) shares: Vec<Vec<f64>>,
    /// Largest irradiance of each body by the lights themselves.
    pub(super) lit: Vec<Vec<f64>>,
}

/// pi times the radiance of a body under an irradiance; noise below 0 counts in full.
fn radiated(material: &OnGrid, incident: &[f64]) -> Vec<f64> {
    let mut out: Vec<f64> = material.elastic.iter().zip(incident).map(|(rho, e)| rho.abs() * e).collect();
    if let Some(matrix) = &material.luminescence {
        for (out, row) in out.iter_mut().zip(matrix.outer_iter()) {
            *out += row.iter().zip(incident).map(|(value, e)| value.abs() * e).sum::<f64>();
        }
    }
    out
}

impl Between<'_> {
    fn next(&self, incident: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let out: Vec<Vec<f64>> =
            self.materials.iter().zip(incident).map(|(material, e)| radiated(material, e)).collect();
        let count = self.lit[0].len();
        let one = |from: usize| {
            let at = |j: usize| {
                let mut seen: Vec<(f64, f64)> = (0..out.len()).map(|of| (out[of][j], self.shares[from][of])).collect();
                seen.sort_by(|a, b| b.0.total_cmp(&a.0));
                // The brightest first, until the hemisphere is full.
                let mut left = 1.0_f64;
                seen.into_iter().fold(0.0, |sum, (value, share)| {
                    let taken = share.min(left);
                    left -= taken;
                    sum + taken * value
                })
            };
            (0..count).map(at).collect()
        };
        (0..out.len()).map(one).collect()
    }

    /// The largest irradiance of each body by light that has gone from body to body more than `kept` times and at most `most`;
    /// `None` where no bound was found.
    pub(super) fn beyond(&self, kept: u32, most: Option<u32>) -> Option<Vec<Vec<f64>>> {
        let zero = || self.lit.iter().map(|list| vec![0.0; list.len()]).collect::<Vec<_>>();
        let (mut sum, mut order) = (zero(), self.lit.clone());
        for k in 1..=most.unwrap_or(ORDERS) {
            let next = self.next(&order);
            let ratio = next.iter().flatten().zip(order.iter().flatten()).map(|(new, old)| match (*new, *old) {
                (0.0, _) => 0.0,
                (_, 0.0) => f64::INFINITY,
                (new, old) => new / old,
            });
            let ratio = ratio.fold(0.0, f64::max);
            order = next;
            if k > kept {
                add(&mut sum, &order, 1.0);
                if ratio < FALLS && (most.is_none() || k > 50) {
                    add(&mut sum, &order, ratio / (1.0 - ratio));
                    return Some(sum);
                }
            }
            if order.iter().flatten().all(|value| *value == 0.0) {
                return Some(sum);
            }
            if k >= ORDERS {
                return None;
            }
        }
        most.is_some().then_some(sum)
    }
}

fn add(sum: &mut [Vec<f64>], order: &[Vec<f64>], factor: f64) {
    for (sum, order) in sum.iter_mut().flatten().zip(order.iter().flatten()) {
        *sum += factor * order;
    }
}

/// The same for what a body radiates.
pub(super) fn of(material: &OnGrid, incident: &[f64]) -> Vec<f64> {
    radiated(material, incident)
}
