//! The optimum of a scan as another program finds it: the `levenberg-marquardt` crate from many starts, and its profile with
//! a parameter held. Needs `scans` beside it.
#![allow(dead_code, unreachable_pub, missing_docs, missing_debug_implementations, clippy::unwrap_used)]

use bbrf::terms::{Distribution, fresnel};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DVector, Dyn, OMatrix, U3, Vector3, Vector4};

use super::scans::{Peer, Prepared, Random, Truth, peer_fit_within, random_start};

/// The box that the fit searches: roughness and n - 1.
pub const BOX: [(f64, f64); 2] = [(2e-3, 3.0), (1e-3, 5.0)];
/// A start that has not arrived after 5 times as many evaluations goes on to where nothing is; another takes its place.
const PATIENCE: usize = 20;
/// What chi-square rises by at the ends of a 95 % interval of one parameter.
const RISE: f64 = 3.841_458_820_694_124;

/// What the peer is given: the values that there are.
pub struct Known {
    pub grid: Vec<Prepared>,
    pub values: Vec<f64>,
    pub sigma: Vec<f64>,
}

impl Known {
    pub fn new(grid: &[Prepared], values: &[f64], sigma: &[f64]) -> Self {
        let is_known = |k: &usize| values[*k].is_finite();
        let kept: Vec<usize> = (0..values.len()).filter(is_known).collect();
        let of = |list: &[f64]| kept.iter().map(|k| list[*k]).collect::<Vec<f64>>();
        Self { grid: kept.iter().map(|k| grid[*k]).collect(), values: of(values), sigma: of(sigma) }
    }

    /// The least chi-square within the box that the peer finds from the truth and from `starts` random starts.
    pub fn least(&self, truth: &Truth, starts: usize, random: &mut Random) -> f64 {
        let starts = (0..starts).map(|_| random_start(random)).chain([*truth]);
        starts.map(|start| self.from(&start)).fold(f64::INFINITY, f64::min)
    }

    /// Chi-square that a start leads to; where the peer leaves the box, that of the nearest point of the box.
    pub fn from(&self, start: &Truth) -> f64 {
        let (chi_square, found) = peer_fit_within(&self.grid, &self.values, &self.sigma, start, PATIENCE);
        let is_inside = |value: f64, (low, high): (f64, f64)| low <= value && value <= high;
        let inside = is_inside(found.roughness, BOX[0]) && is_inside(found.index_minus_one, BOX[1]);
        let positive = found.albedo >= 0.0 && found.intensity >= 0.0;
        if inside && positive && chi_square.is_finite() { chi_square } else { self.with_shape(found) }
    }

    /// Chi-square of the best non-negative amplitudes at the point of the box that is nearest to this shape.
    fn with_shape(&self, shape: Truth) -> f64 {
        let into = |value: f64, (low, high): (f64, f64)| if value.is_nan() { low } else { value.clamp(low, high) };
        let (roughness, m) = (into(shape.roughness, BOX[0]), into(shape.index_minus_one, BOX[1]));
        let [mut aa, mut ab, mut bb, mut ay, mut by, mut yy] = [0.0; 6];
        for (point, (value, sigma)) in self.grid.iter().zip(self.values.iter().zip(&self.sigma)) {
            let d = Distribution::GaussianHalfHeight.evaluate(&point.half, roughness).value;
            let (a, b) = (point.diffuse / sigma, d * fresnel(&point.half, m).value * point.masked / sigma);
            let y = value / sigma;
            (aa, ab, bb, ay, by, yy) = (aa + a * a, ab + a * b, bb + b * b, ay + a * y, by + b * y, yy + y * y);
        }
        let chi_square = |p: f64, q: f64| yy - 2.0 * (p * ay + q * by) + p * p * aa + 2.0 * p * q * ab + q * q * bb;
        let determinant = aa * bb - ab * ab;
        let (p, q) = ((bb * ay - ab * by) / determinant, (aa * by - ab * ay) / determinant);
        if p >= 0.0 && q >= 0.0 {
            return chi_square(p, q);
        }
        let second = if bb > 0.0 { chi_square(0.0, (by / bb).max(0.0)) } else { f64::INFINITY };
        chi_square((ay / aa).max(0.0), 0.0).min(second)
    }

    /// True where the profile of roughness (0) or n - 1 (1) rises, at both edges of the box, above what a 95 % interval lets
    /// through: the interval is closed. `least` is the least chi-square, `near` where it is.
    pub fn closes(&self, parameter: usize, least: f64, near: &[Truth], random: &mut Random) -> bool {
        let (low, high) = BOX[parameter];
        [low, high].into_iter().all(|edge| {
            let mut starts: Vec<Truth> = near.to_vec();
            starts.extend((0..6).map(|_| random_start(random)));
            starts.into_iter().all(|start| self.held(parameter, edge, &start) > least + RISE)
        })
    }

    fn held(&self, parameter: usize, value: f64, start: &Truth) -> f64 {
        let mut p = Vector4::new(start.albedo, start.intensity, start.roughness.ln(), start.index_minus_one.ln());
        p[2 + parameter] = value.ln();
        let peer = Peer { grid: &self.grid, values: &self.values, sigma: &self.sigma, p };
        let (problem, report) = LevenbergMarquardt::new().with_tol(1e-10).minimize(Held { peer, held: 2 + parameter });
        let found = problem.peer.truth();
        let other = [found.roughness, found.index_minus_one][1 - parameter];
        let (low, high) = BOX[1 - parameter];
        let chi_square = 2.0 * report.objective_function;
        let valid = found.albedo >= 0.0 && found.intensity >= 0.0 && (low..=high).contains(&other);
        if valid && chi_square.is_finite() { chi_square } else { self.with_shape(found) }
    }
}

/// The peer's problem with one parameter held.
struct Held<'a> {
    peer: Peer<'a>,
    held: usize,
}

impl Held<'_> {
    fn free(&self) -> [usize; 3] {
        let mut free = (0..4).filter(|k| *k != self.held);
        std::array::from_fn(|_| free.next().unwrap())
    }
}

impl LeastSquaresProblem<f64, Dyn, U3> for Held<'_> {
    type ParameterStorage = Owned<f64, U3>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U3>;

    fn set_params(&mut self, p: &Vector3<f64>) {
        for (k, free) in self.free().into_iter().enumerate() {
            self.peer.p[free] = p[k];
        }
    }

    fn params(&self) -> Vector3<f64> {
        Vector3::from(self.free().map(|free| self.peer.p[free]))
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.peer.residuals()
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U3>> {
        let all = self.peer.jacobian()?;
        let free = self.free();
        Some(OMatrix::<f64, Dyn, U3>::from_fn(all.nrows(), |i, k| all[(i, free[k])]))
    }
}
