//! Levenberg-Marquardt on (ln r, ln(n - 1)) within the box, with projected gradient.

use super::columns::{Columns, Point};
use super::curvature::{Curvature, Held, Share, curvature};
use super::geometry_set::GeometrySet;
use super::outcome::Stop;
use super::products::{Products, products};
use super::samples::Samples;

/// Stop when the predicted decrease of chi-square is below this share of chi-square per degree of freedom: the
/// minimum is then 1e-4 standard uncertainties away.
const TOLERANCE: f64 = 1e-8;
/// Most evaluations of one polish; five are usual.
const MOST_EVALUATIONS: usize = 60;
/// Longest step in ln r and ln(n - 1).
const STEP_CAPS: [f64; 2] = [0.7, 1.5];

/// The reduced problem of one set of samples, with the room that its evaluations need.
#[derive(Debug)]
pub(super) struct Reduced<'a> {
    pub(super) set: &'a GeometrySet,
    pub(super) samples: &'a Samples,
    pub(super) share: Share,
    /// Bounds of ln r and ln(n - 1).
    pub(super) bounds: [(f64, f64); 2],
    /// Chi-square per degree of freedom is in units of this.
    pub(super) freedom: f64,
    pub(super) columns: Columns,
    pub(super) products: Vec<Products>,
    pub(super) evaluations: usize,
}

/// What of a fit stands still.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fixed {
    /// ln r, ln(n - 1).
    pub(super) shape: [bool; 2],
    pub(super) amplitude: Held,
}

/// A polished start.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polished {
    pub(super) point: Point,
    pub(super) curvature: Curvature,
    pub(super) stop: Stop,
    /// Which of (roughness, index) are held on the edge of the box.
    pub(super) on_edge: [bool; 2],
}

impl<'a> Reduced<'a> {
    #[inline(always)]
    pub(super) fn evaluate(&mut self, point: &Point, held: Held) -> Curvature {
        self.evaluations += 1;
        self.columns.update(self.set, point);
        products(&self.columns, self.samples, &mut self.products);
        curvature(&self.products, self.share, held)
    }

    /// The minimum that a start leads to; `None` where it leads to the one that is `known` already.
    #[inline(always)]
    pub(super) fn polish(&mut self, start: Point, fixed: Fixed, known: Option<&Polished>) -> Option<Polished> {
        let mut point = start;
        let mut current = self.evaluate(&point, fixed.amplitude);
        let mut damping = 1e-4;
        for _ in 1..MOST_EVALUATIONS {
            let inside = inside(&point, &current, &self.bounds);
            let free = [0, 1].map(|k| inside[k] && !fixed.shape[k]);
            let threshold = (TOLERANCE * current.chi_square / self.freedom).max(current.noise);
            let undamped = damped_step(&current, free, 0.0);
            let decrease = -(current.gradient[0] * undamped[0] + current.gradient[1] * undamped[1]);
            if decrease.is_nan() || decrease <= threshold {
                return Some(Polished::ended(point, current, inside));
            }
            let step = damped_step(&current, free, damping);
            let trial = Point {
                log: std::array::from_fn(|k| {
                    let (low, high) = self.bounds[k];
                    let moved = point.log[k] + step[k].clamp(-STEP_CAPS[k], STEP_CAPS[k]);
                    if fixed.shape[k] { point.log[k] } else { moved.clamp(low, high) }
                }),
            };
            let next = self.evaluate(&trial, fixed.amplitude);
            if next.chi_square <= current.chi_square {
                point = trial;
                current = next;
                damping = (damping * 0.1).max(1e-12);
                if known.is_some_and(|known| known.attracts(&point, self.freedom)) {
                    return None;
                }
            } else if current.chi_square - next.chi_square > -threshold {
                // No decrease left that rounding would let through.
                return Some(Polished::ended(point, current, inside));
            } else {
                damping = (damping * 10.0).max(1e-3);
            }
        }
        let on_edge = inside(&point, &current, &self.bounds).map(|inside| !inside);
        Some(Polished { point, curvature: current, stop: Stop::EvaluationLimit, on_edge })
    }
}

impl Polished {
    /// A polish that found no step to take.
    fn ended(point: Point, curvature: Curvature, inside: [bool; 2]) -> Self {
        let stop = if inside == [true, true] { Stop::Converged } else { Stop::AtBound };
        Self { point, curvature, stop, on_edge: inside.map(|inside| !inside) }
    }

    /// True for a point so near this minimum that its parabola lifts chi-square by less than one unit (of chi-square
    /// per degree of freedom): from there nothing but this minimum is reached.
    #[inline(always)]
    fn attracts(&self, point: &Point, freedom: f64) -> bool {
        let [x, y] = [0, 1].map(|k| point.log[k] - self.point.log[k]);
        let h = &self.curvature.hessian;
        let lift = h[0][0] * x * x + 2.0 * h[0][1] * x * y + h[1][1] * y * y;
        // A direction without curvature attracts nobody: the point must be near in its logarithms, too.
        x.abs() < 0.2 && y.abs() < 0.2 && lift < self.curvature.chi_square / freedom
    }
}

/// A parameter on its bound whose gradient points outwards is not inside.
#[inline(always)]
fn inside(point: &Point, curvature: &Curvature, bounds: &[(f64, f64); 2]) -> [bool; 2] {
    std::array::from_fn(|k| {
        let (low, high) = bounds[k];
        let outwards = (point.log[k] <= low && curvature.gradient[k] > 0.0)
            || (point.log[k] >= high && curvature.gradient[k] < 0.0);
        !outwards
    })
}

/// The Gauss-Newton step with Marquardt's damping; a held parameter does not move, nor does one without curvature.
#[inline(always)]
fn damped_step(curvature: &Curvature, free: [bool; 2], damping: f64) -> [f64; 2] {
    let h = &curvature.hessian;
    let g = &curvature.gradient;
    let (h0, h1) = (h[0][0] * (1.0 + damping), h[1][1] * (1.0 + damping));
    let alone = |h: f64, g: f64, free: bool| if free && h > 0.0 { -g / h } else { 0.0 };
    let determinant = h0 * h1 - h[0][1] * h[0][1];
    if free == [true, true] && determinant > 1e-14 * h0 * h1 {
        return [(h[0][1] * g[1] - h1 * g[0]) / determinant, (h[0][1] * g[0] - h0 * g[1]) / determinant];
    }
    [alone(h0, g[0], free[0]), alone(h1, g[1], free[1])]
}
