//! The two-parameter problem that is left when the amplitudes are solved for, as a landscape to descend in.

use super::curvature::{Columns, Curvature, Point, evaluate};
use super::descent::{Height, Landscape, Slope};
use super::geometry_set::GeometrySet;
use super::solve::Band;

/// Chi-square over (ln r, ln(n - 1)), with the best amplitudes at every point.
pub(super) struct Reduced<'a> {
    pub(super) set: &'a GeometrySet,
    pub(super) bands: &'a [Band],
    pub(super) columns: &'a mut Columns,
    /// At the point asked for last.
    pub(super) last: Curvature,
}

impl Landscape for Reduced<'_> {
    type Slope = Curvature;

    fn height(&mut self, at: &[f64]) -> Height {
        self.columns.update(self.set, &Point { log: [at[0], at[1]] });
        self.last = evaluate(self.set, self.columns, self.bands);
        Height { chi_square: self.last.chi_square, noise: self.last.noise }
    }

    fn slope(&mut self) -> Option<Curvature> {
        Some(self.last)
    }
}

impl Slope for Curvature {
    fn gradient(&self) -> &[f64] {
        &self.gradient
    }

    fn step(&self, pinned: &[Option<f64>], damping: f64, step: &mut [f64]) {
        let ([[a, b], [_, c]], [g, h]) = (self.hessian, self.gradient);
        let (a, c) = (a * (1.0 + damping), c * (1.0 + damping));
        let determinant = a * c - b * b;
        let alone = |curvature: f64, gradient: f64| if curvature > 0.0 { -gradient / curvature } else { 0.0 };
        let [first, second] = match [pinned[0], pinned[1]] {
            [None, None] if determinant > 1e-14 * a * c => {
                [(b * h - c * g) / determinant, (b * g - a * h) / determinant]
            }
            // Columns that agree to rounding: each goes its own way, and the loop sees whether that is down.
            [None, None] => [alone(a, g), alone(c, h)],
            [None, Some(second)] => [alone(a, g + b * second), second],
            [Some(first), None] => [first, alone(c, h + b * first)],
            [Some(first), Some(second)] => [first, second],
        };
        step[0] = first;
        step[1] = second;
    }

    fn decrease(&self, step: &[f64]) -> f64 {
        let ([[a, b], [_, c]], [g, h]) = (self.hessian, self.gradient);
        let (x, y) = (step[0], step[1]);
        -(2.0 * (g * x + h * y) + a * x * x + 2.0 * b * x * y + c * y * y)
    }
}
