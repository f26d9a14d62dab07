//! All parameters at once, where their errors hang together: the wavelengths of one record share its scale, and the
//! instrument may see other angles than it says.
//!
//! The covariance of a record's values is diag(sigma^2) + u u', u the record's relative scale times the prediction; its
//! inverse is that of the diagonal less one dyad (Sherman and Morrison), so that the information of a scan is what its
//! emission values have each by itself, less one dyad for each record. A nuisance parameter enters with its prior.

mod columns;
mod information;
mod result;

use ndarray::ArrayView2;

use super::curvature::Share;
use super::descent::{Bounds, Rules, descend};
use super::outcome::Fit;
use crate::dataset::{Bound, Effect};
use crate::quantity::{Geometry, Reference};
use crate::terms::{Denominator, Distribution};
use columns::Columns;
use information::{Layout, Scan};
pub(super) use result::{FittedEffect, Refined};

/// A nuisance parameter: an effect of the instrument, with what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nuisance {
    /// Which effect.
    pub effect: Effect,
    /// What it is known to be, degrees.
    pub value: f64,
    /// Standard uncertainty of that, degrees; 0 for a value that is not fitted.
    pub sigma: f64,
}

/// What is fitted jointly.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint<'a> {
    pub(super) geometry: &'a [Geometry],
    pub(super) reference: &'a Reference,
    pub(super) distribution: Distribution,
    pub(super) denominator: Denominator,
    pub(super) has_diffuse: bool,
    pub(super) share: Share,
    /// Values \[B, N\] and their standard uncertainties, a record's scale included.
    pub(super) values: ArrayView2<'a, f64>,
    pub(super) sigma: ArrayView2<'a, f64>,
    /// Relative scale of a record, one per emission value.
    pub(super) record_relative: &'a [f64],
    pub(super) nuisances: &'a [Nuisance],
    /// Which of the values stand for bounds.
    pub(super) bounds: &'a [Bound],
    /// Bounds of ln r and ln(n - 1).
    pub(super) box_of_shape: [(f64, f64); 2],
}

/// Stop when the minimum is 1e-4 standard uncertainties away.
const TOLERANCE: f64 = 1e-8;
const MOST_EVALUATIONS: usize = 60;
/// Longest steps of ln r and ln(n - 1), and of an effect, degrees.
const LONGEST: [f64; 3] = [0.7, 1.5, 2.0];

impl Joint<'_> {
    /// Goes on from a fit that took all values for independent and the geometry for true. `None` where that fit has no
    /// specular term, or the joint problem has no solution near it.
    pub(super) fn refine(&self, start: &Fit) -> Option<Refined> {
        if !start.has_specular() {
            return None;
        }
        let layout = Layout::new(self, start.bands.len());
        let first = layout.start(self, start);
        let mut scan = Scan::new(self, &layout, &first)?;
        let (low, high, longest) = layout.bounds(self);
        let bounds = Bounds { low: &low, high: &high, longest: &longest };
        let rules = Rules {
            tolerance: TOLERANCE,
            freedom: start.degrees_of_freedom,
            evaluations: MOST_EVALUATIONS,
            damping: 1e-4,
        };
        let descent = descend(&mut scan, &first, &bounds, &rules).ok()?;
        result::refined(self, &layout, start, &descent)
    }

    fn columns(&self, shape: [f64; 2], effects: &[f64]) -> Columns {
        Columns::new(self, shape, effects)
    }
}
