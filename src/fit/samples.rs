//! The data of a fit in the order of the geometry set: weighted, and padded so that sums run over whole lanes.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use ndarray::ArrayView2;

use super::geometry_set::GeometrySet;
use super::left_out::{LeftOut, reason};
use super::linear::Gram;
use super::row::Row;

/// One or several emission values, sorted and weighted.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    /// Padded number of points.
    points: usize,
    /// True where all emission values have the same weights, so that they are kept once.
    shared: bool,
    /// Weights \[1 or B, points\], (smallest sigma / sigma)^2, 0 for a value that is not used and for padding; then weights
    /// times values \[B, points\]. One piece of memory, which an allocator keeps for the next fit; of several it
    /// gives some back to the system, and pages that come anew take as long as an evaluation.
    numbers: Vec<f64>,
    /// The diffuse column \[points\], of zeros without a diffuse term.
    diffuse: Vec<f64>,
    /// The sum of each row of weights.
    total_weight: Vec<f64>,
    /// Inner products that do not depend on the specular term, one per emission value.
    pub(super) gram: Vec<Gram>,
    /// Values used, one per emission value.
    pub(super) count: Vec<usize>,
    pub(super) left_out: LeftOut,
}

/// The columns of one emission value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample<'a> {
    pub(super) weight: &'a [f64],
    pub(super) diffuse: &'a [f64],
    pub(super) weighted_value: &'a [f64],
}

impl Sample<'_> {
    /// The square root of each weight, and the value times it.
    pub(super) fn rooted(&self) -> impl Iterator<Item = (f64, f64)> {
        self.weight.iter().zip(self.weighted_value).map(|(weight, weighted)| {
            let root = weight.sqrt();
            (root, if root > 0.0 { weighted / root } else { 0.0 })
        })
    }
}

impl Samples {
    /// Sorts and weights values \[B, N\]; `root_unit` is 1 over the smallest sigma, so that no weight overflows. `shared`
    /// says that every row has the uncertainties and the gaps of the first.
    #[inline(always)]
    pub(super) fn new(
        set: &GeometrySet,
        diffuse: bool,
        values: ArrayView2<f64>,
        sigma: Option<ArrayView2<f64>>,
        root_unit: f64,
        shared: bool,
    ) -> Self {
        let bands = values.nrows();
        let column = if diffuse { set.diffuse.clone() } else { vec![0.0; set.points()] };
        let mut samples = Self::zeros(bands, shared, column);
        let weightings = samples.weightings();
        let mut row = Row::new(samples.points);
        for band in 0..bands {
            // Under the weights of the first no other uncertainties are looked at.
            row.fill(set, values.row(band), sigma.as_ref().filter(|_| band < weightings).map(|sigma| sigma.row(band)));
            if band < weightings {
                samples.weigh(band, &row, root_unit);
                // Without uncertainties every sigma is 1, in no unit.
                samples.count_left_out(set, band, &row, sigma.is_some());
            } else {
                samples.weigh_as_first(band, &row);
            }
        }
        if shared {
            let first = samples.left_out;
            (1..bands).for_each(|_| samples.left_out.add_all(&first));
        }
        samples
    }

    fn zeros(bands: usize, shared: bool, diffuse: Vec<f64>) -> Self {
        let (points, weightings) = (diffuse.len(), if shared { 1 } else { bands });
        Self {
            points,
            shared,
            numbers: vec![0.0; (weightings + bands) * points],
            diffuse,
            total_weight: vec![0.0; weightings],
            gram: vec![Gram::default(); bands],
            count: vec![0; bands],
            left_out: LeftOut::default(),
        }
    }

    /// Weights one emission value, with the sums that belong to it.
    #[inline(always)]
    fn weigh(&mut self, band: usize, row: &Row, root_unit: f64) {
        let points = self.points;
        let (weights, values) = self.numbers.split_at_mut(self.total_weight.len() * points);
        let range = band * points..(band + 1) * points;
        let (weight, weighted_value) = (chunks_mut(&mut weights[range.clone()]), chunks_mut(&mut values[range]));
        let (value, sigma, diffuse) = (chunks(&row.value), chunks(&row.sigma), chunks(&self.diffuse));
        // Of one length, which needs no test at each index.
        let count = diffuse.len().min(value.len()).min(sigma.len()).min(weight.len()).min(weighted_value.len());
        let (weight, weighted_value) = (&mut weight[..count], &mut weighted_value[..count]);
        let (value, sigma, diffuse) = (&value[..count], &sigma[..count], &diffuse[..count]);
        let mut sums = [[0.0; LANES]; 4];
        for k in 0..count {
            // Whole lanes are read before any is written: so it becomes vectors.
            let (value, sigma, d) = (value[k], sigma[k], diffuse[k]);
            let (mut w, mut weighted) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                // Without a branch, and without a form that the compiler takes for a test of bits, for the same reason.
                let used = (value[lane].abs() <= f64::MAX) & (sigma[lane] > 0.0) & (sigma[lane] <= f64::MAX);
                let relative = root_unit * sigma[lane];
                w[lane] = if used { (relative * relative).recip() } else { 0.0 };
                let value = if used { value[lane] } else { 0.0 };
                weighted[lane] = w[lane] * value;
                sums[0][lane] += weighted[lane] * value;
                sums[1][lane] += (w[lane] * d[lane]) * d[lane];
                sums[2][lane] += weighted[lane] * d[lane];
                sums[3][lane] += w[lane];
            }
            (weight[k], weighted_value[k]) = (w, weighted);
        }
        let [syy, s11, s1y, total_weight] = totals(sums);
        self.gram[band] = Gram { s11, s1y, syy, ..Gram::default() };
        self.total_weight[band] = total_weight;
    }

    /// Another emission value under the weights of the first.
    #[inline(always)]
    fn weigh_as_first(&mut self, band: usize, row: &Row) {
        let points = self.points;
        let (weight, values) = self.numbers.split_at_mut(points);
        let (weight, weighted_value) = (chunks(weight), chunks_mut(&mut values[band * points..(band + 1) * points]));
        let (value, diffuse) = (chunks(&row.value), chunks(&self.diffuse));
        let count = diffuse.len().min(value.len()).min(weight.len()).min(weighted_value.len());
        let (weight, weighted_value) = (&weight[..count], &mut weighted_value[..count]);
        let (value, diffuse) = (&value[..count], &diffuse[..count]);
        let mut sums = [[0.0; LANES]; 2];
        for k in 0..count {
            let (w, value, d) = (weight[k], value[k], diffuse[k]);
            let mut weighted = [0.0; LANES];
            for lane in 0..LANES {
                // A value that no emission value uses may be no number.
                let value = if w[lane] > 0.0 { value[lane] } else { 0.0 };
                weighted[lane] = w[lane] * value;
                sums[0][lane] += weighted[lane] * value;
                sums[1][lane] += weighted[lane] * d[lane];
            }
            weighted_value[k] = weighted;
        }
        let [syy, s1y] = totals(sums);
        self.gram[band] = Gram { s11: self.gram[0].s11, s1y, syy, ..Gram::default() };
        self.count[band] = self.count[0];
    }

    /// Counts what is used, and what is not by its reason.
    #[inline(always)]
    fn count_left_out(&mut self, set: &GeometrySet, band: usize, row: &Row, has_sigma: bool) {
        let weight = &self.numbers[band * self.points..(band + 1) * self.points];
        let used: usize = weight.iter().map(|weight| usize::from(*weight > 0.0)).sum();
        self.count[band] = used;
        if used == set.order.len() {
            return;
        }
        let unused = |k: &usize| weight[*k] == 0.0;
        for k in (0..set.order.len()).filter(unused) {
            if let Some(reason) = reason(row.value[k], has_sigma.then_some(row.sigma[k])) {
                self.left_out.add(reason);
            }
        }
    }

    /// A weighted sum over emission values obeys the same model with the same roughness and index: one grid serves all. A
    /// point counts where every emission value has one. Each emission value weighs by its signal over its variance, so
    /// that one that is lost in noise drowns no other.
    #[inline(always)]
    pub(super) fn summed(&self, set: &GeometrySet) -> Self {
        let mut sum = vec![0.0; self.points];
        let mut variance: Vec<f64> = vec![0.0; self.points];
        let mut weighed = 0.0;
        for band in 0..self.bands() {
            let sample = self.sample(band);
            let share = (self.gram[band].syy * self.total_weight[if self.shared { 0 } else { band }]).sqrt();
            weighed += share * share;
            if self.shared {
                for (sum, weighted) in sum.iter_mut().zip(sample.weighted_value) {
                    *sum += share * weighted;
                }
                continue;
            }
            let points = sum.iter_mut().zip(&mut variance).zip(sample.weighted_value).zip(sample.weight);
            for (((sum, variance), weighted), weight) in points {
                // A weight of 0 makes the variance infinite, which marks the point for all.
                let inverse = weight.recip();
                *sum += share * weighted * inverse;
                *variance += share * share * inverse;
            }
        }
        if self.shared {
            for ((sum, variance), weight) in sum.iter_mut().zip(&mut variance).zip(self.sample(0).weight) {
                let inverse = weight.recip();
                (*sum, *variance) = (*sum * inverse, weighed * inverse);
            }
        }
        let largest = variance.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
        let root = largest.sqrt();
        let mut row = Row::new(self.points);
        row.value.fill(f64::NAN);
        for point in 0..set.order.len() {
            // Not known where the variance is 0 or infinite: sigma then says so, too.
            (row.value[point], row.sigma[point]) = (sum[point] / root, variance[point].sqrt());
        }
        let mut total = Self::zeros(1, false, self.diffuse.clone());
        total.weigh(0, &row, root.recip());
        total.count_left_out(set, 0, &row, true);
        total
    }

    pub(super) fn bands(&self) -> usize {
        self.gram.len()
    }

    /// True where the weights are kept once for all.
    pub(super) fn is_shared(&self) -> bool {
        self.shared
    }

    #[inline(always)]
    pub(super) fn sample(&self, band: usize) -> Sample<'_> {
        let range = |band: usize| band * self.points..(band + 1) * self.points;
        let weighting = if self.shared { 0 } else { band };
        Sample {
            weight: &self.numbers[range(weighting)],
            diffuse: &self.diffuse,
            weighted_value: &self.numbers[range(self.weightings() + band)],
        }
    }

    /// How many rows of weights there are.
    fn weightings(&self) -> usize {
        self.total_weight.len()
    }

    /// Values used, over all emission values.
    pub(super) fn used(&self) -> usize {
        self.count.iter().sum()
    }
}

/// Lanes of every sum: the order of additions, and so the result, is the same on every machine.
pub(super) const LANES: usize = 4;

/// A padded column in whole lanes.
#[inline(always)]
pub(super) fn chunks(column: &[f64]) -> &[[f64; LANES]] {
    column.as_chunks().0
}

#[inline(always)]
fn chunks_mut(column: &mut [f64]) -> &mut [[f64; LANES]] {
    column.as_chunks_mut().0
}

/// The inner product of two padded columns.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    for (x, y) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    total(lanes)
}

/// The totals of several sums.
#[inline(always)]
pub(super) fn totals<const K: usize>(sums: [[f64; LANES]; K]) -> [f64; K] {
    // Seen through, the compiler makes vectors of the first lanes of all sums, of their second lanes, and so on, which it
    // then gathers lane by lane in the loop over the points.
    std::hint::black_box(sums).map(total)
}

#[inline(always)]
pub(super) fn total(lanes: [f64; LANES]) -> f64 {
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
}
