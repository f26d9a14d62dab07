//! The data of a fit in the order of the geometry set: weighted, and padded so that sums run over whole lanes.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use ndarray::ArrayView2;

use super::geometry_set::GeometrySet;
use super::left_out::{LeftOut, reason};
use super::linear::Gram;
use super::row::{Row, has_one_weighting};

/// One or several emission values, sorted and weighted.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    /// Padded number of points.
    points: usize,
    /// True where all emission values have the same weights, so that they are kept once.
    shared: bool,
    /// (smallest sigma / sigma)^2 \[1 or B, points\]; 0 for a value that is not used and for padding.
    weight: Vec<f64>,
    /// Weight times the diffuse column \[1 or B, points\].
    weighted_diffuse: Vec<f64>,
    /// Weight times value \[B, points\].
    weighted_value: Vec<f64>,
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
    pub(super) weighted_diffuse: &'a [f64],
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
    /// Sorts and weights values \[B, N\]; `root_unit` is 1 over the smallest sigma, so that no weight overflows.
    #[inline(always)]
    pub(super) fn new(
        set: &GeometrySet,
        diffuse: bool,
        values: ArrayView2<f64>,
        sigma: Option<ArrayView2<f64>>,
        root_unit: f64,
    ) -> Self {
        let (bands, points) = (values.nrows(), set.points());
        let shared = bands > 1 && has_one_weighting(values, sigma);
        let weightings = if shared { 1 } else { bands };
        let mut samples = Self {
            points,
            shared,
            weight: vec![0.0; weightings * points],
            weighted_diffuse: vec![0.0; weightings * points],
            weighted_value: vec![0.0; bands * points],
            gram: vec![Gram::default(); bands],
            count: vec![0; bands],
            left_out: LeftOut::default(),
        };
        let mut row = Row::new(points);
        for band in 0..bands {
            // Under the weights of the first no other uncertainties are looked at.
            row.fill(set, values.row(band), sigma.as_ref().filter(|_| band < weightings).map(|sigma| sigma.row(band)));
            if band < weightings {
                samples.weigh(set, diffuse, band, &row, root_unit);
                // Without uncertainties every sigma is 1, in no unit.
                samples.count_left_out(set, band, &row, sigma.is_some());
            } else {
                samples.weigh_as_first(band, &row);
            }
            samples.complete_gram(set, band);
        }
        if shared {
            let first = samples.left_out;
            (1..bands).for_each(|_| samples.left_out.add_all(&first));
        }
        samples
    }

    /// Weights one emission value.
    #[inline(always)]
    fn weigh(&mut self, set: &GeometrySet, diffuse: bool, band: usize, row: &Row, root_unit: f64) {
        let range = band * self.points..(band + 1) * self.points;
        let (weight, weighted_diffuse) = (&mut self.weight[range.clone()], &mut self.weighted_diffuse[range.clone()]);
        let weighted_value = &mut self.weighted_value[range];
        let column = if diffuse { 1.0 } else { 0.0 };
        let mut syy = [0.0; LANES];
        for chunk in 0..self.points / LANES {
            for lane in 0..LANES {
                let k = chunk * LANES + lane;
                let (value, sigma) = (row.value[k], row.sigma[k]);
                // Without a branch, and without a form that the compiler takes for a test of bits: so it becomes vectors.
                let used = (value.abs() <= f64::MAX) & (sigma > 0.0) & (sigma <= f64::MAX);
                let relative = root_unit * sigma;
                let w = if used { (relative * relative).recip() } else { 0.0 };
                let value = if used { value } else { 0.0 };
                weight[k] = w;
                weighted_diffuse[k] = w * (column * set.diffuse[k]);
                weighted_value[k] = w * value;
                syy[lane] += w * value * value;
            }
        }
        self.gram[band].syy = total(syy);
    }

    /// Another emission value under the weights of the first.
    #[inline(always)]
    fn weigh_as_first(&mut self, band: usize, row: &Row) {
        let weighted_value = &mut self.weighted_value[band * self.points..(band + 1) * self.points];
        let mut syy = [0.0; LANES];
        for chunk in 0..self.points / LANES {
            for lane in 0..LANES {
                let k = chunk * LANES + lane;
                // A value that no emission value uses may be no number.
                let value = if self.weight[k] > 0.0 { row.value[k] } else { 0.0 };
                weighted_value[k] = self.weight[k] * value;
                syy[lane] += self.weight[k] * value * value;
            }
        }
        self.gram[band].syy = total(syy);
        self.count[band] = self.count[0];
    }

    /// Counts what is used, and what is not by its reason.
    #[inline(always)]
    fn count_left_out(&mut self, set: &GeometrySet, band: usize, row: &Row, has_sigma: bool) {
        let weight = &self.weight[band * self.points..(band + 1) * self.points];
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

    #[inline(always)]
    fn complete_gram(&mut self, set: &GeometrySet, band: usize) {
        let sample = self.sample(band);
        let s11 = dot(sample.weighted_diffuse, &set.diffuse);
        // Without a diffuse term its column is 0, and so is its product with the data.
        let s1y = if s11 > 0.0 { dot(sample.weighted_value, &set.diffuse) } else { 0.0 };
        let gram = &mut self.gram[band];
        (gram.s11, gram.s1y) = (s11, s1y);
    }

    /// A weighted sum over emission values obeys the same model with the same roughness and index: one grid serves all. A
    /// point counts where every emission value has one. Each emission value weighs by its signal over its variance, so
    /// that one that is lost in noise drowns no other.
    #[inline(always)]
    pub(super) fn summed(&self, set: &GeometrySet, diffuse: bool) -> Self {
        let mut sum = vec![0.0; self.points];
        let mut variance: Vec<f64> = vec![0.0; self.points];
        let mut weighed = 0.0;
        for band in 0..self.bands() {
            let sample = self.sample(band);
            let share = (self.gram[band].syy * sum_of(sample.weight)).sqrt();
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
        let mut total = Self {
            points: self.points,
            shared: false,
            weight: vec![0.0; self.points],
            weighted_diffuse: vec![0.0; self.points],
            weighted_value: vec![0.0; self.points],
            gram: vec![Gram::default()],
            count: vec![0],
            left_out: LeftOut::default(),
        };
        let known = |point: &usize| variance[*point] > 0.0 && variance[*point].is_finite();
        for point in (0..set.order.len()).filter(known) {
            let (weight, value) = (largest / variance[point], sum[point] / largest.sqrt());
            total.weight[point] = weight;
            total.weighted_diffuse[point] = if diffuse { weight * set.diffuse[point] } else { 0.0 };
            total.weighted_value[point] = weight * value;
            total.gram[0].syy += weight * value * value;
            total.count[0] += 1;
        }
        total.complete_gram(set, 0);
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
            weight: &self.weight[range(weighting)],
            weighted_diffuse: &self.weighted_diffuse[range(weighting)],
            weighted_value: &self.weighted_value[range(band)],
        }
    }

    /// Values used, over all emission values.
    pub(super) fn used(&self) -> usize {
        self.count.iter().sum()
    }
}

/// Lanes of every sum: the order of additions, and so the result, is the same on every machine.
pub(super) const LANES: usize = 4;

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

/// The sum of a padded column.
#[inline(always)]
fn sum_of(column: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    for x in column.as_chunks::<LANES>().0 {
        for lane in 0..LANES {
            lanes[lane] += x[lane];
        }
    }
    total(lanes)
}

#[inline(always)]
pub(super) fn total(lanes: [f64; LANES]) -> f64 {
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
}
