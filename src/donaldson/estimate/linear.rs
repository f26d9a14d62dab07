//! Reflectance and emission for a given excitation spectrum: linear, smooth, not negative.

use nalgebra::{DMatrix, DVector};

use super::super::nonnegative::{add_roughness, inverse_over, minimise};
use super::{Axes, Lit, NoEstimate, Seen, UNTOLD, check};

/// Reflectances are expected to be about so large where nothing is known.
const REFLECTANCE: f64 = 1.0;
/// And emissions, per unit of the matrix: a matrix rarely has more than .2.
const EMISSION: f64 = 0.3;
/// Standard deviations of the second differences, per axis step, that are tried: the data choose.
const ROUGHNESS: [f64; 9] = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0];

/// An estimate for a known excitation spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Reflectance, one per emission.
    pub reflectance: Vec<f64>,
    /// Its standard uncertainty, prior included.
    pub reflectance_sigma: Vec<f64>,
    /// Emission spectrum: the matrix where the excitation spectrum is 1.
    pub emission: Vec<f64>,
    /// Its standard uncertainty, prior included.
    pub emission_sigma: Vec<f64>,
    /// Standard uncertainty of the reflectance from the lights alone at this wavelength; infinite where they cannot tell.
    pub lights_alone: Vec<f64>,
    /// Weighted sum of squares that is left.
    pub chi_square: f64,
    /// Values that it sums over.
    pub count: usize,
    /// The prior in words.
    pub prior: String,
}

impl Estimate {
    /// True where the lights tell reflection from luminescence without the prior.
    #[must_use]
    pub fn is_told(&self, emission: usize) -> bool {
        self.lights_alone.get(emission).is_some_and(|sigma| *sigma <= UNTOLD)
    }
}

/// The two columns of each light at each emission: (E, C).
pub(super) fn columns(axes: &Axes, light: &Lit, shape: &[f64]) -> Vec<(f64, f64)> {
    let cells = axes.excitation_nm.iter().zip(&light.excitation).zip(shape);
    let cells: Vec<(f64, f64)> = cells.map(|((nm, energy), x)| (*nm, energy * x)).collect();
    let below = |emission: f64| cells.iter().take_while(|(nm, _)| *nm < emission).map(|(_, part)| part).sum();
    axes.emission_nm.iter().zip(&light.emission).map(|(nm, energy)| (*energy, below(*nm))).collect()
}

/// The normal equations of the data: reflectances, then emissions.
pub(super) struct Normal {
    pub(super) q: DMatrix<f64>,
    pub(super) g: DVector<f64>,
    /// Weighted sum of squares of the values.
    pub(super) square: f64,
    pub(super) count: usize,
}

impl Normal {
    pub(super) fn of(axes: &Axes, seen: &[Seen], shape: &[f64]) -> Self {
        let n = axes.emission_nm.len();
        let (mut q, mut g) = (DMatrix::zeros(2 * n, 2 * n), DVector::zeros(2 * n));
        let (mut square, mut count) = (0.0, 0);
        for Seen { light, values, sigma } in seen {
            for (j, (e, c)) in columns(axes, light, shape).into_iter().enumerate() {
                if values[j].is_nan() {
                    continue;
                }
                let weight = sigma[j].powi(-2);
                q[(j, j)] += weight * e * e;
                q[(j, n + j)] += weight * e * c;
                q[(n + j, j)] += weight * e * c;
                q[(n + j, n + j)] += weight * c * c;
                g[j] += weight * e * values[j];
                g[n + j] += weight * c * values[j];
                square += weight * values[j] * values[j];
                count += 1;
            }
        }
        Self { q, g, square, count }
    }

    /// The curvature with the prior's.
    pub(super) fn with(&self, roughness: (f64, f64)) -> DMatrix<f64> {
        &self.q + precision(self.g.len() / 2, roughness)
    }

    /// Logarithm of the evidence of a prior, but for a constant: how probable the data are under it, whatever the spectra.
    pub(super) fn evidence(&self, roughness: (f64, f64)) -> Option<f64> {
        let posterior = self.with(roughness).cholesky()?;
        let prior = precision(self.g.len() / 2, roughness).cholesky()?;
        let log = |factor: &DMatrix<f64>| factor.diagonal().iter().map(|x| x.ln()).sum::<f64>();
        let found = posterior.solve(&self.g);
        let left = self.square - self.g.dot(&found);
        Some(-0.5 * left - log(posterior.l_dirty()) + log(prior.l_dirty()))
    }
}

/// The prior's curvature: smooth, and not huge.
fn precision(n: usize, (reflectance, emission): (f64, f64)) -> DMatrix<f64> {
    let mut p = DMatrix::zeros(2 * n, 2 * n);
    for k in 0..n {
        p[(k, k)] = REFLECTANCE.powi(-2);
        p[(n + k, n + k)] = EMISSION.powi(-2);
    }
    let (mut smooth_r, mut smooth_m) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
    add_roughness(&mut smooth_r, n, 1, 0, reflectance.powi(-2));
    add_roughness(&mut smooth_m, n, 1, 0, (emission * EMISSION).powi(-2));
    let mut block = p.view_mut((0, 0), (n, n));
    block += smooth_r;
    let mut block = p.view_mut((n, n), (n, n));
    block += smooth_m;
    p
}

/// Spectra have edges, and one number for all wavelengths must let the steepest pass.
const EDGES: f64 = 6.0;

/// The roughness that the data find most probable, with room for edges.
pub(super) fn roughness(normal: &Normal) -> Option<(f64, f64)> {
    let pairs = ROUGHNESS.iter().flat_map(|r| ROUGHNESS.iter().map(move |m| (*r, *m)));
    let scored = pairs.filter_map(|pair| Some((pair, normal.evidence(pair)?)));
    scored.max_by(|a, b| a.1.total_cmp(&b.1)).map(|((r, m), _)| (EDGES * r, EDGES * m))
}

/// Standard uncertainty of the reflectance at each wavelength from the lights there alone.
fn lights_alone(normal: &Normal) -> Vec<f64> {
    let n = normal.g.len() / 2;
    let alone = |j: usize| {
        let (ee, ec, cc) = (normal.q[(j, j)], normal.q[(j, n + j)], normal.q[(n + j, n + j)]);
        if cc == 0.0 {
            return if ee > 0.0 { ee.sqrt().recip() } else { f64::INFINITY };
        }
        // The determinant over cc: what luminescence leaves of the knowledge about reflection.
        let left = ee - ec * ec / cc;
        if left > 1e-12 * ee { left.sqrt().recip() } else { f64::INFINITY }
    };
    (0..n).map(alone).collect()
}

/// Estimates reflectance and emission for a known excitation spectrum, 1 at its peak.
///
/// # Errors
/// [`NoEstimate`].
pub fn estimate_known(axes: &Axes, shape: &[f64], seen: &[Seen]) -> Result<Estimate, NoEstimate> {
    check(axes, seen)?;
    if shape.len() != axes.excitation_nm.len() {
        let (found, expected) = (shape.len(), axes.excitation_nm.len());
        return Err(NoEstimate::Length { light: "all".to_owned(), what: "the excitation spectrum", found, expected });
    }
    let normal = Normal::of(axes, seen, shape);
    let chosen = roughness(&normal).ok_or(NoEstimate::Undetermined)?;
    at(&normal, chosen).ok_or(NoEstimate::Undetermined)
}

/// The estimate under one prior.
pub(super) fn at(normal: &Normal, roughness: (f64, f64)) -> Option<Estimate> {
    let n = normal.g.len() / 2;
    let q = normal.with(roughness);
    let found = minimise(&q, &normal.g)?;
    let free: Vec<usize> = (0..2 * n).filter(|k| found[*k] > 0.0).collect();
    let covariance = inverse_over(&q, &free)?;
    // What ended at 0 is known to be small: by how much, its curvature beside the others says.
    let sigma = |k: usize| if found[k] > 0.0 { covariance[(k, k)].sqrt() } else { q[(k, k)].sqrt().recip() };
    let chi_square = normal.square - 2.0 * normal.g.dot(&found) + found.dot(&(&normal.q * &found));
    Some(Estimate {
        reflectance: found.rows(0, n).iter().copied().collect(),
        reflectance_sigma: (0..n).map(sigma).collect(),
        emission: found.rows(n, n).iter().copied().collect(),
        emission_sigma: (n..2 * n).map(sigma).collect(),
        lights_alone: lights_alone(normal),
        chi_square: chi_square.max(0.0),
        count: normal.count,
        prior: format!(
            "reflectance and emission not negative and smooth: second differences from step to step of {:.0e} and {:.0e} (standard \
             deviations, six times what the evidence of the data chooses)",
            roughness.0,
            roughness.1 * EMISSION
        ),
    })
}
