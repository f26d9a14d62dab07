//! Levenberg-Marquardt within a box: one loop for every least-squares problem of this crate.
//!
//! A problem is a [`Landscape`]: it tells its chi-square at a point and then the [`Slope`] there, a local second-order
//! picture that can propose damped steps. The loop owns all the rest: damping, acceptance, the box, the limit of
//! evaluations, and the reason why it ended. [`LeastSquares`] makes a landscape of residuals and their Jacobian;
//! a problem with structure hands in its own [`SquareRootInformation`], or its own [`Slope`].
//!
//! What the loop promises. A step that was not taken is never called convergence: the end is [`End::Converged`] only
//! where the step without damping, within the box, would lower chi-square by less than asked for (or by less than the
//! rounding of chi-square). A parameter on its bound counts for that only if its gradient points inwards. A point where
//! chi-square or its slope is not a number is a step not taken.

mod bounds;
mod dense;
mod sharpen;
mod square_root;

pub use bounds::Bounds;
use bounds::Room;
pub use dense::{LeastSquares, Residuals};
pub use sharpen::sharpen;
pub use square_root::SquareRootInformation;

/// Chi-square at a point, with what its rounding may have changed it by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Height {
    /// Chi-square; NaN or infinite where the model has no value.
    pub chi_square: f64,
    /// Rounding error of the chi-square: differences below it mean nothing.
    pub noise: f64,
}

/// A least-squares problem as the loop sees it.
pub trait Landscape {
    /// The local picture.
    type Slope: Slope;

    /// Chi-square at a point.
    fn height(&mut self, at: &[f64]) -> Height;

    /// The local picture at the point whose height was asked for last; `None` where it has none.
    fn slope(&mut self) -> Option<Self::Slope>;

    /// True for a point from which only a minimum can be reached that is known already: the descent ends there.
    fn is_known(&self, _at: &[f64]) -> bool {
        false
    }
}

/// Chi-square to second order about a point, in Gauss and Newton's approximation.
pub trait Slope {
    /// Half the gradient of chi-square.
    fn gradient(&self) -> &[f64];

    /// Writes the step to the minimum of the picture plus `damping` times the squared step (in units of the length of
    /// each parameter's column). A parameter with a `pinned` displacement moves by that; one without curvature of its own
    /// does not move.
    fn step(&self, pinned: &[Option<f64>], damping: f64, step: &mut [f64]);

    /// By how much the picture says that chi-square decreases with a step.
    fn decrease(&self, step: &[f64]) -> f64;
}

/// When to end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// End when the predicted decrease of chi-square is below this share of chi-square per degree of freedom: the minimum
    /// is then the square root of it away, in standard uncertainties. 0 asks for what the rounding of chi-square lets
    /// through; [`sharpen`] goes beyond.
    pub tolerance: f64,
    /// Degrees of freedom: values minus parameters.
    pub freedom: f64,
    /// Most evaluations of chi-square.
    pub evaluations: usize,
    /// Damping of the first step: small for a start near the minimum, 100 for one far away.
    pub damping: f64,
}

/// Why a descent ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The predicted decrease fell below the tolerance or below the rounding of chi-square.
    Converged,
    /// A decrease is predicted, but however short the step there is none: the model has a kink here, its derivatives are
    /// wrong, or chi-square has more rounding than it says.
    Stalled,
    /// The point leads to a minimum that the landscape knows.
    Known,
    /// The limit of evaluations was reached.
    EvaluationLimit,
    /// The picture predicts no number: the Jacobian is beyond what numbers hold.
    Undefined,
}

/// Where a descent ended.
#[derive(Debug, Clone)]
pub struct Descent<S> {
    /// The parameters of the lowest point found.
    pub point: Vec<f64>,
    /// Chi-square there.
    pub height: Height,
    /// The local picture there.
    pub slope: S,
    /// Which parameters are held on a bound: the data ask for a value beyond it.
    pub held: Vec<bool>,
    /// By how much the picture says that chi-square could still decrease within the box.
    pub left: f64,
    /// How often chi-square was evaluated.
    pub evaluations: usize,
    /// Why it ended.
    pub end: End,
}

/// The model has no value at the start, so there is nowhere to go from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the model has no finite value or slope at the start; give a start where it has")]
pub struct UndefinedStart;

/// Smallest damping.
const LEAST_DAMPING: f64 = 1e-12;
/// Most that one step multiplies the damping by where its prediction came true. Between that and 1 it goes by the share
/// that came true, and a row of steps not taken doubles its factor each time (Nielsen 1999, IMM-REP-1999-05).
const LARGEST_CUT: f64 = 0.1;
/// Factors beyond this are as good as infinite.
const MOST_DOUBLINGS: i32 = 64;

/// Goes down from a start until `rules` say to end. The start is moved into the box.
///
/// # Errors
/// [`UndefinedStart`].
#[inline(always)]
pub fn descend<L: Landscape>(
    landscape: &mut L,
    start: &[f64],
    bounds: &Bounds<'_>,
    rules: &Rules,
) -> Result<Descent<L::Slope>, UndefinedStart> {
    let mut point: Vec<f64> = start.iter().enumerate().map(|(k, x)| bounds.clamp(k, *x)).collect();
    let (mut height, mut slope) = look(landscape, &point).ok_or(UndefinedStart)?;
    let (mut evaluations, mut damping) = (1, rules.damping);
    let mut room = Room::new(point.len());
    let mut rejections = 0;
    loop {
        bounds.step(&slope, &point, 0.0, &mut room);
        let left = slope.decrease(&room.step);
        let threshold = (rules.tolerance * height.chi_square / rules.freedom).max(height.noise);
        let mut predicted = left;
        let mut end = match left {
            left if left.is_nan() => Some(End::Undefined),
            left if left <= threshold => Some(End::Converged),
            _ if landscape.is_known(&point) => Some(End::Known),
            _ if evaluations >= rules.evaluations => Some(End::EvaluationLimit),
            _ => None,
        };
        if end.is_none() {
            bounds.damped_step(&slope, &point, damping, &mut room);
            // A step too short to be told from rounding, and a longer one went up.
            predicted = slope.decrease(&room.step);
            let short = room.trial == point || predicted <= height.noise;
            end = (rejections > 0 && short).then_some(End::Stalled);
        }
        if let Some(end) = end {
            let held = bounds.held(&slope, &point);
            return Ok(Descent { point, height, slope, held, left, evaluations, end });
        }
        evaluations += 1;
        match lower(landscape, &room.trial, &height) {
            Some(next) => {
                // Where the picture was right to a percent the next step may trust it ten times as much.
                let share = (height.chi_square - next.0.chi_square) / predicted;
                damping = (damping * (1.0 - (2.0 * share - 1.0).powi(3)).clamp(LARGEST_CUT, 1.0)).max(LEAST_DAMPING);
                (height, slope) = next;
                point.copy_from_slice(&room.trial);
                rejections = 0;
            }
            None => {
                rejections = (rejections + 1).min(MOST_DOUBLINGS);
                damping = (damping * 2.0_f64.powi(rejections)).min(f64::MAX);
            }
        }
    }
}

#[inline(always)]
fn look<L: Landscape>(landscape: &mut L, at: &[f64]) -> Option<(Height, L::Slope)> {
    let height = landscape.height(at);
    if height.chi_square.is_finite() { landscape.slope().map(|slope| (height, slope)) } else { None }
}

#[inline(always)]
/// The picture at a trial that is not higher than `height` and has numbers throughout.
fn lower<L: Landscape>(landscape: &mut L, trial: &[f64], height: &Height) -> Option<(Height, L::Slope)> {
    let next = landscape.height(trial);
    if next.chi_square <= height.chi_square { landscape.slope().map(|slope| (next, slope)) } else { None }
}
