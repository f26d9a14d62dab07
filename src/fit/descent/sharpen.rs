//! The last digits: below the rounding of chi-square the gradient still tells where the minimum is.

use super::{Bounds, Descent, Landscape, Room, Slope, look};

/// A step must bring the predicted decrease to below this share of what it was.
const CONTRACTION: f64 = 0.9;
/// Chi-square may rise by this many times its estimated rounding: a model that cancels rounds worse than its residuals
/// tell, and the gradient is the judge here.
const ROUNDINGS: f64 = 1e3;
/// Most steps; each needs one evaluation.
const MOST_STEPS: usize = 200;

/// Takes undamped steps from where a descent ended, as long as each brings the minimum nearer by the measure of the
/// gradient and chi-square does not rise beyond its rounding, until it says that chi-square could decrease by no more than
/// `enough`; 0 asks for the last digit.
///
/// Chi-square is flat at its minimum, so that its rounding hides half of the digits of the parameters; the gradient is
/// not. For certified values; a measurement has no use for digits that its noise has not.
pub fn sharpen<L: Landscape>(landscape: &mut L, descent: &mut Descent<L::Slope>, bounds: &Bounds<'_>, enough: f64) {
    let lowest = descent.height;
    let mut room = Room::new(descent.point.len());
    for _ in 0..MOST_STEPS {
        if descent.left <= enough {
            return;
        }
        bounds.damped_step(&descent.slope, &descent.point, 0.0, &mut room);
        if room.trial == descent.point {
            return;
        }
        descent.evaluations += 1;
        let Some((height, slope)) = look(landscape, &room.trial) else { return };
        let trial = room.trial.clone();
        bounds.step(&slope, &trial, 0.0, &mut room);
        let left = slope.decrease(&room.step);
        let is_nearer = left <= CONTRACTION * descent.left;
        if !is_nearer || height.chi_square > lowest.chi_square + ROUNDINGS * lowest.noise.max(height.noise) {
            return;
        }
        descent.point.copy_from_slice(&trial);
        descent.held = bounds.held(&slope, &trial);
        (descent.height, descent.slope, descent.left) = (height, slope, left);
    }
}
