//! The two-parameter problem that is left when the amplitudes are solved for, as a landscape to descend in.

use super::columns::{Columns, Point};
use super::curvature::{Curvature, Held, Share, curvature};
use super::descent::{Bounds, End, Height, Landscape, Rules, descend, sharpen};
use super::geometry_set::GeometrySet;
use super::outcome::Stop;
use super::products::{Products, products};
use super::samples::Samples;

/// Most evaluations of one polish; five are usual.
const MOST_EVALUATIONS: usize = 60;
/// Longest step in ln r and ln(n - 1).
const LONGEST_STEPS: [f64; 2] = [0.7, 1.5];
/// Where rounding hides the tolerance the gradient goes on to this share of it, a thousandth of the distance to the minimum;
/// to the last digit it would take several evaluations more, and no measurement has those digits.
const SHARP: f64 = 1e-6;

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
    /// Where columns and products were evaluated last.
    pub(super) evaluated: Option<Point>,
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
        self.evaluate_products(point);
        curvature(&self.products, self.share, held)
    }

    /// Columns and products at a point, unless they are there.
    #[inline(always)]
    pub(super) fn evaluate_products(&mut self, point: &Point) {
        if self.evaluated != Some(*point) {
            self.columns.update(self.set, point);
            products(&self.columns, self.samples, &mut self.products);
            self.evaluated = Some(*point);
        }
    }

    /// The minimum that a start leads to; `None` where that is the one `known` already, or where the start has no
    /// chi-square.
    #[inline(always)]
    pub(super) fn polish(&mut self, start: Point, fixed: Fixed, known: Option<&Polished>) -> Option<Polished> {
        let bound = |k: usize| if fixed.shape[k] { (start.log[k], start.log[k]) } else { self.bounds[k] };
        let (roughness, index) = (bound(0), bound(1));
        let bounds = Bounds { low: &[roughness.0, index.0], high: &[roughness.1, index.1], longest: &LONGEST_STEPS };
        let tolerance = self.set.effort.tolerance;
        let rules = Rules { tolerance, freedom: self.freedom, evaluations: MOST_EVALUATIONS, damping: 1e-4 };
        let mut walk = Walk { held: fixed.amplitude, known, last: Curvature::default(), reduced: self };
        let mut descent = descend(&mut walk, &start.log, &bounds, &rules).ok()?;
        let enough = tolerance * descent.height.chi_square / walk.reduced.freedom;
        if descent.end == End::Converged && descent.left > enough {
            // The values are so exact, or so many, that the rounding of chi-square ended it, not the tolerance.
            sharpen(&mut walk, &mut descent, &bounds, SHARP * enough);
        }
        let on_edge = [0, 1].map(|k| descent.held[k] && !fixed.shape[k]);
        let stop = match descent.end {
            End::Known => return None,
            End::Converged if on_edge == [false, false] => Stop::Converged,
            End::Converged => Stop::AtBound,
            End::Stalled | End::Undefined => Stop::Stalled,
            End::EvaluationLimit => Stop::EvaluationLimit,
        };
        let point = Point { log: [descent.point[0], descent.point[1]] };
        Some(Polished { point, curvature: descent.slope, stop, on_edge })
    }
}

/// Chi-square over (ln r, ln(n - 1)), with the best amplitudes at every point.
struct Walk<'a, 'b> {
    reduced: &'a mut Reduced<'b>,
    held: Held,
    known: Option<&'a Polished>,
    /// At the point asked for last.
    last: Curvature,
}

impl Landscape for Walk<'_, '_> {
    type Slope = Curvature;

    #[inline(always)]
    fn height(&mut self, at: &[f64]) -> Height {
        self.last = self.reduced.evaluate(&Point { log: [at[0], at[1]] }, self.held);
        Height { chi_square: self.last.chi_square, noise: self.last.noise }
    }

    #[inline(always)]
    fn slope(&mut self) -> Option<Curvature> {
        Some(self.last)
    }

    fn is_known(&self, at: &[f64]) -> bool {
        self.known.is_some_and(|known| known.attracts(at, self.reduced.freedom))
    }
}

impl Polished {
    /// True for a point so near this minimum that its parabola lifts chi-square by less than one unit (of chi-square
    /// per degree of freedom): from there nothing but this minimum is reached.
    fn attracts(&self, at: &[f64], freedom: f64) -> bool {
        let [x, y] = [0, 1].map(|k| at[k] - self.point.log[k]);
        let h = &self.curvature.hessian;
        let lift = h[0][0] * x * x + 2.0 * h[0][1] * x * y + h[1][1] * y * y;
        // A direction without curvature attracts nobody: the point must be near in its logarithms, too.
        x.abs() < 0.2 && y.abs() < 0.2 && lift < self.curvature.chi_square / freedom
    }
}
