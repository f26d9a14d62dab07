//! Where two models differ most: what to measure to tell them apart.

use super::Shape;
use crate::dataset::{Reduced, predict};
use crate::fit::design::{CandidateGrid, Noise};
use crate::fit::outcome::Fit;
use crate::quantity::{Geometry, Reference};
use crate::terms::TermKind;

/// Directions that are offered: in the plane of incidence, and not nearer to the source than most instruments can look.
const OFFERED: CandidateGrid = CandidateGrid { step: 5.0, max: 85.0, azimuths: 2 };
const RETRO_GAP: f64 = 10.0;
/// How many are named, and how far apart they are, degrees.
const NAMED: usize = 5;
const APART: f64 = 10.0;

/// A geometry at which two models differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The geometry.
    pub geometry: Geometry,
    /// The difference of the predictions over the standard deviation of one value.
    pub in_sigma: f64,
}

pub(super) fn differences(
    (shape, fit): (Shape, &Fit),
    (other_shape, other): (Shape, &Fit),
    data: &Reduced,
    reference: &Reference,
    diffuse: TermKind,
) -> Vec<Difference> {
    let band = strongest(fit);
    let terms = shape.terms_of(fit, band, diffuse);
    let other_terms = other_shape.terms_of(other, band, diffuse);
    let noise = noise(data, fit, band);
    let difference = |geometry: Geometry| {
        let one = predict(&terms, &geometry, reference).ok()?.total();
        let two = predict(&other_terms, &geometry, reference).ok()?.total();
        let in_sigma = (one - two).abs() / noise.sigma(one.abs().max(two.abs()));
        in_sigma.is_finite().then_some(Difference { geometry, in_sigma })
    };
    let mut all: Vec<Difference> = OFFERED.geometries(RETRO_GAP).into_iter().filter_map(difference).collect();
    all.sort_by(|a, b| b.in_sigma.total_cmp(&a.in_sigma));
    let mut named: Vec<Difference> = Vec::new();
    for one in all {
        if named.len() < NAMED && named.iter().all(|other| is_apart(&one.geometry, &other.geometry)) {
            named.push(one);
        }
    }
    named
}

/// The emission value of the largest amplitudes.
fn strongest(fit: &Fit) -> usize {
    let size = |band: usize| fit.bands[band].diffuse + fit.bands[band].intensity;
    (0..fit.bands.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0)
}

/// The noise of the scan: the middle of the relative uncertainties, or of the relative residuals' scale.
fn noise(data: &Reduced, fit: &Fit, band: usize) -> Noise {
    let values = data.values.row(band);
    let mut relative: Vec<f64> = match &data.sigma {
        Some(sigma) => values.iter().zip(sigma.row(band)).map(|(value, sigma)| sigma / value.abs()).collect(),
        None => {
            let scale = (fit.bands[band].chi_square / fit.degrees_of_freedom.max(1.0)).sqrt();
            values.iter().map(|value| scale / value.abs()).collect()
        }
    };
    relative.retain(|one| *one > 0.0 && one.is_finite());
    relative.sort_by(f64::total_cmp);
    Noise { relative: relative.get(relative.len() / 2).copied().unwrap_or(0.01), floor: 0.0 }
}

fn is_apart(a: &Geometry, b: &Geometry) -> bool {
    let signed = |geometry: &Geometry| geometry.signed_deg().unwrap_or_default();
    let ((i, v), (other_i, other_v)) = (signed(a), signed(b));
    (i - other_i).abs().max((v - other_v).abs()) >= APART
}
