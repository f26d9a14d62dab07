//! All inner products that one evaluation needs, in one walk over the points.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use super::columns::Columns;
use super::linear::Gram;
use super::samples::{LANES, Sample, Samples, total};

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
    let mut common = among_columns(columns, &samples.sample(0));
    for band in 0..samples.bands() {
        let sample = samples.sample(band);
        if band > 0 && !samples.is_shared() {
            common = among_columns(columns, &sample);
        }
        let mut products = common;
        products.with_data(columns, sample.weighted_value, &samples.gram[band]);
        into.push(products);
    }
}

/// Products of the columns with each other.
#[inline(always)]
fn among_columns(columns: &Columns, sample: &Sample<'_>) -> Products {
    let (s, r, m) = (
        columns.specular.as_chunks::<LANES>().0,
        columns.by_r.as_chunks::<LANES>().0,
        columns.by_m.as_chunks::<LANES>().0,
    );
    let w = sample.weight.as_chunks::<LANES>().0;
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
    let [s22, r2, m2, rr, rm, mm] = sums.map(total);
    let [s12, r1, m1] = with_column(columns, sample.weighted_diffuse);
    Products { gram: Gram { s12, s22, ..Gram::default() }, r1, r2, m1, m2, rr, rm, mm, ..Products::default() }
}

/// Products of the three columns with one weighted column.
#[inline(always)]
fn with_column(columns: &Columns, weighted: &[f64]) -> [f64; 3] {
    let (s, r, m) = (
        columns.specular.as_chunks::<LANES>().0,
        columns.by_r.as_chunks::<LANES>().0,
        columns.by_m.as_chunks::<LANES>().0,
    );
    let w = weighted.as_chunks::<LANES>().0;
    let count = w.len().min(s.len()).min(r.len()).min(m.len());
    let (s, r, m, w) = (&s[..count], &r[..count], &m[..count], &w[..count]);
    let mut sums = [[0.0; LANES]; 3];
    for k in 0..count {
        for lane in 0..LANES {
            sums[0][lane] += w[k][lane] * s[k][lane];
            sums[1][lane] += w[k][lane] * r[k][lane];
            sums[2][lane] += w[k][lane] * m[k][lane];
        }
    }
    sums.map(total)
}

impl Products {
    /// Adds what holds the data.
    #[inline(always)]
    fn with_data(&mut self, columns: &Columns, weighted_value: &[f64], data: &Gram) {
        [self.gram.s2y, self.ry, self.my] = with_column(columns, weighted_value);
        (self.gram.s11, self.gram.s1y, self.gram.syy) = (data.s11, data.s1y, data.syy);
    }
}
