//! All inner products that one evaluation needs, in one walk over the points.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use super::columns::Columns;
use super::linear::Gram;
use super::samples::{LANES, Sample, Samples, chunks, totals};

/// Inner products of one emission value, each weighted with 1/sigma^2. 1: the diffuse column, 2: the specular one, y: the
/// data, r and m: the specular column's derivatives by ln r and ln(n - 1), without its amplitude.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Products {
    pub(super) gram: Gram,
    pub(super) r1: f64,
    pub(super) r2: f64,
    pub(super) ry: f64,
    pub(super) m1: f64,
    pub(super) m2: f64,
    pub(super) my: f64,
    pub(super) rr: f64,
    pub(super) rm: f64,
    pub(super) mm: f64,
}

/// The products of every emission value; those that do not hold the data are formed once where the weights are shared.
#[inline(always)]
pub(super) fn products(columns: &Columns, samples: &Samples, into: &mut Vec<Products>) {
    into.clear();
    // Loops and not adapters: what is called out of line is not compiled for wider vectors.
    let mut weighted_diffuse = vec![0.0; columns.specular.len()];
    if !samples.is_shared() {
        for band in 0..samples.bands() {
            let sample = samples.sample(band);
            let mut products = among_columns(columns, &sample);
            weigh(sample.weight, sample.diffuse, &mut weighted_diffuse);
            let [diffuse, data] = with_two(columns, &weighted_diffuse, sample.weighted_value);
            products.set_diffuse(diffuse);
            products.set_data(data, &samples.gram[band]);
            into.push(products);
        }
        return;
    }
    let first = samples.sample(0);
    let mut common = among_columns(columns, &first);
    weigh(first.weight, first.diffuse, &mut weighted_diffuse);
    common.set_diffuse(with_two(columns, &weighted_diffuse, first.weighted_value)[0]);
    into.resize(samples.bands(), common);
    for band in (0..samples.bands()).step_by(2) {
        // Of an odd number the last goes with itself.
        let next = (band + 1).min(samples.bands() - 1);
        let [one, two] = [band, next].map(|band| samples.sample(band).weighted_value);
        let [one, two] = with_two(columns, one, two);
        into[band].set_data(one, &samples.gram[band]);
        into[next].set_data(two, &samples.gram[next]);
    }
}

/// Products of the columns with each other.
#[inline(always)]
fn among_columns(columns: &Columns, sample: &Sample<'_>) -> Products {
    let (s, r, m, w) = (chunks(&columns.specular), chunks(&columns.by_r), chunks(&columns.by_m), chunks(sample.weight));
    let count = w.len().min(s.len()).min(r.len()).min(m.len());
    let (s, r, m, w) = (&s[..count], &r[..count], &m[..count], &w[..count]);
    let mut sums = [[0.0; LANES]; 6];
    for k in 0..count {
        for lane in 0..LANES {
            let (s, r, m, w) = (s[k][lane], r[k][lane], m[k][lane], w[k][lane]);
            let (ws, wr, wm) = (w * s, w * r, w * m);
            sums[0][lane] += ws * s;
            sums[1][lane] += ws * r;
            sums[2][lane] += ws * m;
            sums[3][lane] += wr * r;
            sums[4][lane] += wr * m;
            sums[5][lane] += wm * m;
        }
    }
    let [s22, r2, m2, rr, rm, mm] = totals(sums);
    Products { gram: Gram { s22, ..Gram::default() }, r2, m2, rr, rm, mm, ..Products::default() }
}

/// A column times its weights.
#[inline(always)]
fn weigh(weight: &[f64], column: &[f64], into: &mut [f64]) {
    for k in 0..into.len().min(weight.len()).min(column.len()) {
        into[k] = weight[k] * column[k];
    }
}

/// Products of the three columns with two weighted ones: a sum waits for its last addition, and six of them at once keep
/// the processor busy where three do not.
#[inline(always)]
fn with_two(columns: &Columns, one: &[f64], two: &[f64]) -> [[f64; 3]; 2] {
    let (s, r, m) = (chunks(&columns.specular), chunks(&columns.by_r), chunks(&columns.by_m));
    let (one, two) = (chunks(one), chunks(two));
    let count = one.len().min(two.len()).min(s.len()).min(r.len()).min(m.len());
    let (s, r, m, one, two) = (&s[..count], &r[..count], &m[..count], &one[..count], &two[..count]);
    let mut sums = [[0.0; LANES]; 6];
    for k in 0..count {
        for lane in 0..LANES {
            sums[0][lane] += one[k][lane] * s[k][lane];
            sums[1][lane] += one[k][lane] * r[k][lane];
            sums[2][lane] += one[k][lane] * m[k][lane];
            sums[3][lane] += two[k][lane] * s[k][lane];
            sums[4][lane] += two[k][lane] * r[k][lane];
            sums[5][lane] += two[k][lane] * m[k][lane];
        }
    }
    let [s1, r1, m1, s2, r2, m2] = totals(sums);
    [[s1, r1, m1], [s2, r2, m2]]
}

impl Products {
    /// Products with the diffuse column.
    #[inline(always)]
    fn set_diffuse(&mut self, [s12, r1, m1]: [f64; 3]) {
        (self.gram.s12, self.r1, self.m1) = (s12, r1, m1);
    }

    /// What holds the data.
    #[inline(always)]
    fn set_data(&mut self, [s2y, ry, my]: [f64; 3], data: &Gram) {
        (self.gram.s2y, self.ry, self.my) = (s2y, ry, my);
        (self.gram.s11, self.gram.s1y, self.gram.syy) = (data.s11, data.s1y, data.syy);
    }
}
