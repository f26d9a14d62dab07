//! The fit itself: starting grid, polish, result.

use ndarray::{ArrayView1, ArrayView2, Axis};

use super::curvature::{Columns, Curvature, Point, amplitudes};
use super::descent::{Bounds, End, Rules, descend};
use super::geometry_set::{GeometrySet, INDEX_BOX, INDEX_NODES};
use super::left_out::{LeftOut, reason};
use super::linear::{Amplitudes, Gram};
use super::magnitude;
use super::outcome::{BandFit, Fit, Stop};
use super::reduced::Reduced;
use super::statistics;

/// Stop when the predicted decrease of chi-square is below this share of chi-square per degree of freedom: the
/// minimum is then 1e-4 standard uncertainties away.
const TOLERANCE: f64 = 1e-8;
/// Most evaluations of one polish; five are usual.
const MOST_EVALUATIONS: usize = 60;
/// Longest step in ln r and ln(n - 1).
const LONGEST_STEPS: [f64; 2] = [0.7, 1.5];
/// A specular term must lower chi-square by this much to be reported: of two thousand pure diffusers the luckiest
/// noise gained 13.
pub(super) const SEEN: f64 = 15.0;

/// Which terms are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Terms {
    /// A diffuse term (Lambertian or luminescent: under one light they have one angular form).
    pub diffuse: bool,
    /// The specular term.
    pub specular: bool,
}

/// Data that cannot be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DataError {
    /// Arrays of another length than the geometries.
    #[error("{found} values for {expected} geometries")]
    Length {
        /// Length found.
        found: usize,
        /// Number of geometries.
        expected: usize,
    },
    /// Fewer usable values than parameters.
    #[error("{usable} usable values for {parameters} parameters ({left_out}); a fit needs more values than parameters")]
    TooFew {
        /// Values that are finite, have a positive uncertainty, and a geometry where every term is defined.
        usable: usize,
        /// Number of parameters.
        parameters: usize,
        /// The others, by reason.
        left_out: LeftOut,
    },
    /// A number whose square is none.
    #[error(
        "a {what} of {found:e}: its square is beyond the range of numbers; expected magnitudes from 1e-60 to 1e60 (or 0): \
         state the values in another unit"
    )]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// The number.
        found: f64,
    },
    /// No term to fit.
    #[error("no term to fit")]
    NoTerm,
}

/// One emission value's data in the order of the set, weighted.
#[derive(Debug, Clone)]
pub(super) struct Band {
    /// (smallest sigma / sigma)^2; 0 for a value that is not used.
    pub(super) weight: Vec<f64>,
    pub(super) weighted_diffuse: Vec<f64>,
    pub(super) weighted_value: Vec<f64>,
    pub(super) value: Vec<f64>,
    /// Inner products that do not depend on the specular term.
    pub(super) gram: Gram,
    pub(super) count: usize,
    left_out: LeftOut,
}

/// Fits scans over one set of geometries.
#[derive(Debug, Clone, Copy)]
pub struct Fitter<'a> {
    set: &'a GeometrySet,
    terms: Terms,
}

/// A polished start.
struct Polished {
    point: Point,
    curvature: Curvature,
    stop: Stop,
    /// Which of (roughness, index) are held on the edge of the box.
    held: [bool; 2],
    evaluations: usize,
}

impl<'a> Fitter<'a> {
    /// A fitter of these terms over these geometries.
    #[must_use]
    pub fn new(set: &'a GeometrySet, terms: Terms) -> Self {
        Self { set, terms }
    }

    /// Fits one scan: N values, with their standard uncertainties if known. Values that are not finite or whose
    /// uncertainty is not positive are left out. Without uncertainties all values weigh the same and the covariance
    /// is scaled by the residuals.
    ///
    /// # Errors
    /// [`DataError`] when the arrays do not fit or too few values are usable.
    pub fn fit(&self, values: &[f64], sigma: Option<&[f64]>) -> Result<Fit, DataError> {
        let one_row = |values| ArrayView1::from(values).insert_axis(Axis(0));
        self.fit_bands(one_row(values), sigma.map(one_row))
    }

    /// Fits several emission values \[B, N\] with a common roughness and index, and amplitudes of their own.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub fn fit_bands(&self, values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> Result<Fit, DataError> {
        if !self.terms.diffuse && !self.terms.specular {
            return Err(DataError::NoTerm);
        }
        let expected = self.set.len();
        for found in [values.ncols(), sigma.map_or(expected, |sigma| sigma.ncols())] {
            if found != expected {
                return Err(DataError::Length { found, expected });
            }
        }
        magnitude::check(values, sigma)?;
        let unit = smallest_sigma(sigma).powi(-2);
        let bands: Vec<Band> = (0..values.nrows()).map(|b| self.band(values, sigma, b, unit.sqrt())).collect();
        let usable: usize = bands.iter().map(|band| band.count).sum();
        let left_out = self.left_out(&bands);
        let parameters = self.parameters(bands.len());
        if usable <= parameters || bands.is_empty() {
            return Err(DataError::TooFew { usable, parameters, left_out });
        }
        let unit = sigma.is_some().then_some(unit);
        Ok(self.solve(&bands, unit, (usable - parameters) as f64, left_out))
    }

    fn parameters(&self, bands: usize) -> usize {
        let linear = usize::from(self.terms.diffuse) + usize::from(self.terms.specular);
        linear * bands + 2 * usize::from(self.terms.specular)
    }

    /// What takes no part, summed over the emission values.
    fn left_out(&self, bands: &[Band]) -> LeftOut {
        let mut sum = LeftOut { undefined_geometry: self.set.undefined().len() * bands.len(), ..LeftOut::default() };
        for LeftOut { no_value, undefined_geometry, zero_sigma, unknown_sigma } in
            bands.iter().map(|band| band.left_out)
        {
            sum.no_value += no_value;
            sum.undefined_geometry += undefined_geometry;
            sum.zero_sigma += zero_sigma;
            sum.unknown_sigma += unknown_sigma;
        }
        sum
    }

    /// Sorts and weights one emission value; `root_unit` is 1 over the smallest sigma, so that no weight overflows.
    fn band(&self, values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>, b: usize, root_unit: f64) -> Band {
        let n = self.set.order.len();
        let mut band = Band {
            weight: Vec::with_capacity(n),
            weighted_diffuse: Vec::with_capacity(n),
            weighted_value: Vec::with_capacity(n),
            value: Vec::with_capacity(n),
            gram: Gram::default(),
            count: 0,
            left_out: LeftOut::default(),
        };
        for (&input, &diffuse) in self.set.order.iter().zip(&self.set.diffuse) {
            let value = values[(b, input)];
            let relative = sigma.map_or(1.0, |sigma| root_unit * sigma[(b, input)]);
            let reason = reason(value, sigma.map(|sigma| sigma[(b, input)]));
            let used = reason.is_none();
            reason.into_iter().for_each(|reason| band.left_out.add(reason));
            let weight = if used { (relative * relative).recip() } else { 0.0 };
            let value = if used { value } else { 0.0 };
            let diffuse = if self.terms.diffuse { diffuse } else { 0.0 };
            band.gram.s11 += weight * diffuse * diffuse;
            band.gram.s1y += weight * diffuse * value;
            band.gram.syy += weight * value * value;
            band.weight.push(weight);
            band.weighted_diffuse.push(weight * diffuse);
            band.weighted_value.push(weight * value);
            band.value.push(value);
            band.count += usize::from(used);
        }
        band
    }

    fn solve(&self, bands: &[Band], unit: Option<f64>, freedom: f64, left_out: LeftOut) -> Fit {
        let diffuse_only: f64 = bands.iter().map(|band| band.gram.solve().chi_square).sum();
        let polished = if self.terms.specular { self.specular(bands, freedom) } else { None };
        let Some(polished) = polished else {
            return self.without_specular(bands, unit, freedom, left_out, 0.0, 0);
        };
        let chi_square = polished.curvature.chi_square.max(polished.curvature.noise);
        let scale = unit.unwrap_or(freedom / chi_square);
        let gain = scale * (diffuse_only - polished.curvature.chi_square);
        let seen = gain > SEEN && diffuse_only - polished.curvature.chi_square > polished.curvature.noise;
        if self.terms.diffuse && !seen {
            return self.without_specular(bands, unit, freedom, left_out, gain, polished.evaluations);
        }
        let mut columns = Columns::default();
        columns.update(self.set, &polished.point);
        let amplitudes = amplitudes(self.set, &columns, bands);
        let mut fit = Fit {
            roughness: polished.point.roughness(),
            index_minus_one: polished.point.index_minus_one(),
            bands: band_fits(bands, &amplitudes),
            chi_square: 0.0,
            degrees_of_freedom: freedom,
            specular_gain: gain,
            log_sigma: [f64::NAN; 2],
            stop: polished.stop,
            at_bound: polished.held,
            evaluations: polished.evaluations,
            left_out,
        };
        statistics::complete(self.set, bands, Some(&columns), unit, &mut fit);
        fit
    }

    fn without_specular(
        &self,
        bands: &[Band],
        unit: Option<f64>,
        freedom: f64,
        left_out: LeftOut,
        gain: f64,
        evaluations: usize,
    ) -> Fit {
        let amplitudes: Vec<Amplitudes> = bands.iter().map(|band| band.gram.solve()).collect();
        let given_up = if self.terms.specular { (bands.len() + 2) as f64 } else { 0.0 };
        let mut fit = Fit {
            roughness: f64::NAN,
            index_minus_one: f64::NAN,
            bands: band_fits(bands, &amplitudes),
            chi_square: 0.0,
            degrees_of_freedom: freedom + given_up,
            specular_gain: gain,
            log_sigma: [f64::NAN; 2],
            stop: Stop::Linear,
            at_bound: [false; 2],
            evaluations,
            left_out,
        };
        statistics::complete(self.set, bands, None, unit, &mut fit);
        fit
    }

    /// The best of the polished starts; `None` when no start has a specular amplitude.
    fn specular(&self, bands: &[Band], freedom: f64) -> Option<Polished> {
        let summed;
        let start = if let [band] = bands {
            band
        } else {
            summed = self.summed(bands);
            &summed
        };
        let mut columns = Columns::default();
        let mut best: Option<Polished> = None;
        for point in self.starts(start).into_iter().flatten() {
            let Some(polished) = self.polish(bands, point, freedom, &mut columns) else { continue };
            let evaluations = polished.evaluations + best.as_ref().map_or(0, |best| best.evaluations);
            let better = best.as_ref().is_none_or(|b| polished.curvature.chi_square < b.curvature.chi_square);
            best = if better { Some(polished) } else { best };
            best.iter_mut().for_each(|best| best.evaluations = evaluations);
        }
        best
    }

    /// The sum over emission values obeys the same model with the same roughness and index: one grid serves all.
    fn summed(&self, bands: &[Band]) -> Band {
        let mut sum = bands[0].clone();
        let n = sum.weight.len();
        let mut gram = Gram::default();
        for point in 0..n {
            let used = bands.iter().filter(|band| band.weight[point] > 0.0);
            let complete = used.clone().count() == bands.len();
            let variance: f64 = used.clone().map(|band| band.weight[point].recip()).sum();
            let value: f64 = used.map(|band| band.value[point]).sum();
            let weight = if complete { variance.recip() } else { 0.0 };
            let diffuse = if self.terms.diffuse { self.set.diffuse[point] } else { 0.0 };
            sum.weight[point] = weight;
            sum.weighted_diffuse[point] = weight * diffuse;
            sum.weighted_value[point] = weight * value;
            sum.value[point] = value;
            gram.s11 += weight * diffuse * diffuse;
            gram.s1y += weight * diffuse * value;
            gram.syy += weight * value * value;
        }
        sum.gram = gram;
        sum
    }

    /// The best node of the grid and the best with another roughness, among those with a specular amplitude.
    fn starts(&self, band: &Band) -> [Option<Point>; 2] {
        let grid = &self.set.grid;
        let nodes = grid.roughness.len();
        let mut chosen = vec![(f64::INFINITY, 0_usize); nodes];
        for index_node in 0..INDEX_NODES.len() {
            let sums = self.segment_sums(band, index_node);
            for (node, best) in chosen.iter_mut().enumerate() {
                let mut gram = band.gram;
                for (&d, &[ff, f1, fy]) in grid.distribution.row(node).iter().zip(&sums) {
                    gram.s22 += d * d * ff;
                    gram.s12 += d * f1;
                    gram.s2y += d * fy;
                }
                let amplitudes = gram.solve();
                if amplitudes.specular > 0.0 && amplitudes.chi_square < best.0 {
                    *best = (amplitudes.chi_square, index_node);
                }
            }
        }
        let mut order: Vec<usize> = (0..nodes).collect();
        order.sort_by(|&a, &b| chosen[a].0.total_cmp(&chosen[b].0));
        [0, 1].map(|rank| {
            let node = order[rank];
            let (chi_square, index_node) = chosen[node];
            chi_square.is_finite().then(|| Point { log: [grid.roughness[node].ln(), INDEX_NODES[index_node].ln()] })
        })
    }

    /// Per segment the inner products of F G/den at an index node with itself, the diffuse column and the data.
    fn segment_sums(&self, band: &Band, index_node: usize) -> Vec<[f64; 3]> {
        let specular = self.set.grid.specular.row(index_node);
        self.set
            .segments
            .iter()
            .map(|segment| {
                let mut sums = [0.0; 3];
                for point in segment.start..segment.end {
                    let f = specular[point];
                    sums[0] += band.weight[point] * f * f;
                    sums[1] += band.weighted_diffuse[point] * f;
                    sums[2] += band.weighted_value[point] * f;
                }
                sums
            })
            .collect()
    }

    /// Goes down to the minimum over (ln r, ln(n - 1)) within the box; `None` where the start has no chi-square.
    fn polish(&self, bands: &[Band], start: Point, freedom: f64, columns: &mut Columns) -> Option<Polished> {
        let (low, high) = self.set.roughness_box;
        let bounds = Bounds {
            low: &[low.ln(), INDEX_BOX.0.ln()],
            high: &[high.ln(), INDEX_BOX.1.ln()],
            longest: &LONGEST_STEPS,
        };
        let rules = Rules { tolerance: TOLERANCE, freedom, evaluations: MOST_EVALUATIONS, damping: 1e-4 };
        let mut landscape = Reduced { set: self.set, bands, columns, last: Curvature::default() };
        let descent = descend(&mut landscape, &start.log, &bounds, &rules).ok()?;
        let held = [descent.held[0], descent.held[1]];
        let stop = match descent.end {
            End::Converged if held == [false, false] => Stop::Converged,
            End::Converged => Stop::AtBound,
            End::Stalled | End::Undefined => Stop::Stalled,
            End::EvaluationLimit => Stop::EvaluationLimit,
        };
        let point = Point { log: [descent.point[0], descent.point[1]] };
        Some(Polished { point, curvature: descent.slope, stop, held, evaluations: descent.evaluations })
    }
}

fn smallest_sigma(sigma: Option<ArrayView2<f64>>) -> f64 {
    sigma.map_or(1.0, |sigma| sigma.iter().copied().filter(|s| *s > 0.0 && s.is_finite()).fold(f64::INFINITY, f64::min))
}

fn band_fits(bands: &[Band], amplitudes: &[Amplitudes]) -> Vec<BandFit> {
    bands
        .iter()
        .zip(amplitudes)
        .map(|(band, amplitudes)| BandFit {
            diffuse: amplitudes.diffuse,
            intensity: amplitudes.specular,
            chi_square: 0.0,
            count: band.count,
            covariance: [[0.0; 4]; 4],
        })
        .collect()
}
