//! One evaluation of the reduced problem: amplitudes, chi-square, gradient and curvature in ln r and ln(n-1).

use super::geometry_set::GeometrySet;
use super::linear::{Amplitudes, Gram};
use super::solve::Band;
use crate::terms::fresnel;

/// A point of the reduced problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// \[ln r, ln(n - 1)\].
    pub(super) log: [f64; 2],
}

impl Point {
    pub(super) fn roughness(&self) -> f64 {
        self.log[0].exp()
    }

    pub(super) fn index_minus_one(&self) -> f64 {
        self.log[1].exp()
    }
}

/// Half the chi-square's gradient and Gauss-Newton curvature (Kaufman's form), summed over bands.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Curvature {
    pub(super) chi_square: f64,
    pub(super) gradient: [f64; 2],
    pub(super) hessian: [[f64; 2]; 2],
    /// Rounding error of the chi-square.
    pub(super) noise: f64,
    /// True where some band has a specular amplitude.
    pub(super) sees_specular: bool,
}

/// Columns of the specular term at a point, without its amplitude: per segment D and dD/d ln r, per sorted point
/// F G/den and its derivative in ln(n - 1).
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    pub(super) d: Vec<f64>,
    pub(super) d_by_r: Vec<f64>,
    pub(super) fg: Vec<f64>,
    pub(super) fg_by_m: Vec<f64>,
    fresnel: Vec<(f64, f64)>,
}

impl Columns {
    pub(super) fn update(&mut self, set: &GeometrySet, point: &Point) {
        let (roughness, m) = (point.roughness(), point.index_minus_one());
        self.d.clear();
        self.d_by_r.clear();
        let lobe = set.distribution.lobe(roughness);
        for segment in &set.segments {
            let value = lobe.evaluate(&segment.half);
            self.d.push(value.value);
            self.d_by_r.push(value.by_log_roughness);
        }
        self.fresnel.clear();
        self.fresnel.extend(set.halves.iter().map(|half| {
            let value = fresnel(half, m);
            (value.value, value.by_index * m)
        }));
        self.fg.clear();
        self.fg_by_m.clear();
        for (masked, &half) in set.masked.iter().zip(&set.half_of) {
            let (value, by_m) = self.fresnel[half as usize];
            self.fg.push(masked * value);
            self.fg_by_m.push(masked * by_m);
        }
    }
}

/// Inner products with the derivative columns, beside the Gram matrix. r: by ln r; m: by ln(n - 1).
#[derive(Debug, Clone, Copy, Default)]
struct Derivatives {
    r1: f64,
    r2: f64,
    ry: f64,
    m1: f64,
    m2: f64,
    my: f64,
    rr: f64,
    rm: f64,
    mm: f64,
}

/// All inner products of one band. D is constant in a segment, so it is taken out of the inner loop.
fn inner_products(set: &GeometrySet, columns: &Columns, band: &Band) -> (Gram, Derivatives) {
    let mut gram = band.gram;
    let mut by = Derivatives::default();
    for (k, segment) in set.segments.iter().enumerate() {
        let (d, dr) = (columns.d[k], columns.d_by_r[k]);
        if d == 0.0 && dr == 0.0 {
            continue;
        }
        let range = segment.start..segment.end;
        let (mut ff, mut fm, mut mm) = (0.0, 0.0, 0.0);
        let (mut f1, mut fy, mut m1, mut my) = (0.0, 0.0, 0.0, 0.0);
        let points = columns.fg[range.clone()]
            .iter()
            .zip(&columns.fg_by_m[range.clone()])
            .zip(&band.weight[range.clone()])
            .zip(&band.weighted_diffuse[range.clone()])
            .zip(&band.weighted_value[range]);
        for ((((&f, &m), &w), &w1), &wy) in points {
            let (wf, wm) = (w * f, w * m);
            ff += wf * f;
            fm += wf * m;
            mm += wm * m;
            f1 += w1 * f;
            fy += wy * f;
            m1 += w1 * m;
            my += wy * m;
        }
        gram.s22 += d * d * ff;
        gram.s12 += d * f1;
        gram.s2y += d * fy;
        by.r1 += dr * f1;
        by.r2 += d * dr * ff;
        by.ry += dr * fy;
        by.m1 += d * m1;
        by.m2 += d * d * fm;
        by.my += d * my;
        by.rr += dr * dr * ff;
        by.rm += d * dr * fm;
        by.mm += d * d * mm;
    }
    (gram, by)
}

/// Evaluates the reduced problem at the point for which `columns` were made.
pub(super) fn evaluate(set: &GeometrySet, columns: &Columns, bands: &[Band]) -> Curvature {
    let mut sum = Curvature::default();
    for band in bands {
        let (gram, by) = inner_products(set, columns, band);
        let amplitudes = gram.solve();
        sum.chi_square += amplitudes.chi_square;
        sum.noise += gram.noise();
        if amplitudes.specular > 0.0 {
            sum.sees_specular = true;
            add_curvature(&mut sum, &gram, &by, &amplitudes);
        }
    }
    sum
}

/// The amplitudes of each band at the point for which `columns` were made.
pub(super) fn amplitudes(set: &GeometrySet, columns: &Columns, bands: &[Band]) -> Vec<Amplitudes> {
    bands.iter().map(|band| inner_products(set, columns, band).0.solve()).collect()
}

/// Adds one band: the derivative columns, minus their part in the span of the columns whose amplitudes are free.
fn add_curvature(sum: &mut Curvature, gram: &Gram, by: &Derivatives, amplitudes: &Amplitudes) {
    let (a, s) = (amplitudes.diffuse, amplitudes.specular);
    let (inverse11, inverse12, inverse22) = if a > 0.0 {
        let determinant = gram.s11 * gram.s22 - gram.s12 * gram.s12;
        (gram.s22 / determinant, -gram.s12 / determinant, gram.s11 / determinant)
    } else {
        (0.0, 0.0, 1.0 / gram.s22)
    };
    let inner = |x: (f64, f64), y: (f64, f64)| {
        inverse11 * x.0 * y.0 + inverse12 * (x.0 * y.1 + x.1 * y.0) + inverse22 * x.1 * y.1
    };
    let (r, m) = ((by.r1, by.r2), (by.m1, by.m2));
    let rm = s * s * (by.rm - inner(r, m));
    sum.hessian[0][0] += s * s * (by.rr - inner(r, r)).max(0.0);
    sum.hessian[1][1] += s * s * (by.mm - inner(m, m)).max(0.0);
    sum.hessian[0][1] += rm;
    sum.hessian[1][0] += rm;
    sum.gradient[0] -= s * (by.ry - a * by.r1 - s * by.r2);
    sum.gradient[1] -= s * (by.my - a * by.m1 - s * by.m2);
}
