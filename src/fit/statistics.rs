//! Covariance of a fit, from the singular values of its Jacobian at the solution.
//!
//! Each emission value has amplitudes of its own; roughness and index, and the specular amplitude where it is shared, are
//! common. A triangular factor of each emission value's four weighted columns separates them: what is left of the common
//! columns after its own amplitudes is stacked, and its singular values decide what the data can tell. Why no R^2: a non-linear weighted model has none;
//! reduced chi-square and the residual map answer the question it is asked.

use nalgebra::{DMatrix, DVector};

use super::curvature::Share;
use super::geometry_set::GeometrySet;
use super::outcome::Fit;
use super::polish::Reduced;
use super::products::Products;
use super::samples::{Sample, Samples, dot};

/// A direction of the common parameters whose column keeps less than this share of its length beside all others
/// cannot be told from them.
pub(super) const SINGULAR: f64 = 1e-8;
/// A column of which less than this share (of its square) is left beside the others is formed from the data themselves: its
/// inner products have lost too many digits.
const CANCELLED: f64 = 1e-5;

/// Upper triangular factor of the columns (diffuse, specular, by ln r, by ln(n - 1)) of one emission value.
type Triangle = [[f64; 4]; 4];

/// What is common to all emission values: the last columns of each triangle.
struct Common {
    /// How many columns are the emission value's own.
    own: usize,
    /// Covariance of the others for weight 1; NaN for a parameter with a part in a direction that cannot be told.
    covariance: [[f64; 3]; 3],
    /// Singular values of the columns, scaled to unit length, largest first.
    singular: Vec<f64>,
}

/// Fills chi-square and covariance of a fit whose amplitudes and point are set, and for whose point `reduced` was
/// evaluated last. `unit` is 1 over the variance that weight 1 stands for; `None` when it is to be taken from the
/// residuals.
#[inline(always)]
pub(super) fn complete(reduced: &Reduced<'_>, unit: Option<f64>, fit: &mut Fit) {
    let mut triangles = Vec::with_capacity(fit.bands.len());
    for (b, band) in fit.bands.iter_mut().enumerate() {
        let products = &reduced.products[b];
        let gram = gram(products, band.intensity, fit.at_bound);
        // A chi-square formed from sums is no better than their rounding.
        let exact = band.chi_square > CANCELLED * products.gram.syy;
        match cholesky(&gram).filter(|_| exact) {
            Some(triangle) => triangles.push(triangle),
            None => {
                let sample = reduced.samples.sample(b);
                let mut jacobian = jacobian(reduced, &sample, band.intensity, fit.at_bound);
                band.chi_square = residual_square(&jacobian, &sample, band.diffuse, band.intensity);
                triangles.push(triangle(&mut jacobian));
            }
        }
    }
    let own = match reduced.share {
        Share::ShapeAndIntensity if fit.bands.len() > 1 => 1,
        _ => 2,
    };
    let common = common(&triangles, own, fit.at_bound);
    finish(&triangles, &common, unit, fit);
}

/// The same for a fit without a specular term.
pub(super) fn complete_linear(set: &GeometrySet, samples: &Samples, unit: Option<f64>, fit: &mut Fit) {
    let mut triangles = Vec::with_capacity(fit.bands.len());
    for (b, band) in fit.bands.iter_mut().enumerate() {
        let (sample, gram) = (samples.sample(b), &samples.gram[b]);
        let column = if gram.s11 > 0.0 { &set.diffuse[..] } else { &[] };
        band.chi_square = residual_of(&sample, column, band.diffuse);
        let mut r = [[0.0; 4]; 4];
        r[0][0] = gram.s11.sqrt();
        triangles.push((r, [r[0][0], 0.0, 0.0, 0.0]));
    }
    let common = Common { own: 2, covariance: [[0.0; 3]; 3], singular: Vec::new() };
    finish(&triangles, &common, unit, fit);
}

#[inline(always)]
fn finish(triangles: &[(Triangle, [f64; 4])], common: &Common, unit: Option<f64>, fit: &mut Fit) {
    let weighted: f64 = fit.bands.iter().map(|band| band.chi_square).sum();
    let unit_or_residual = unit.unwrap_or(fit.degrees_of_freedom / weighted);
    let specular = !common.singular.is_empty();
    for (band, (r, norms)) in fit.bands.iter_mut().zip(triangles) {
        band.covariance = covariance(r, norms, common, unit_or_residual);
        to_parameters(&mut band.covariance, fit.roughness, fit.index_minus_one, specular);
        let [roughness, index] = fit.at_bound;
        let amplitude = |k: usize, value: f64| norms[k] > 0.0 && value == 0.0;
        let at_bound = [amplitude(0, band.diffuse), amplitude(1, band.intensity), roughness, index];
        forget(&mut band.covariance, at_bound);
        band.chi_square *= unit.unwrap_or(1.0);
    }
    fit.chi_square = weighted * unit.unwrap_or(1.0);
    if specular {
        let at = |k: usize| 2 - common.own + k;
        let sigma = |k: usize| (common.covariance[at(k)][at(k)] / unit_or_residual).sqrt();
        fit.log_sigma = [0, 1].map(|k| if fit.at_bound[k] { f64::NAN } else { sigma(k) });
    }
    // A held parameter is no direction that the data could tell: its zero, one of the last, is none of theirs.
    let held = fit.at_bound.iter().filter(|held| **held).count();
    fit.singular_values = common.singular[..common.singular.len().saturating_sub(held)].to_vec();
}

/// Inner products of the four columns. A parameter that is held on a bound has none: the others know it.
#[inline(always)]
fn gram(p: &Products, intensity: f64, held: [bool; 2]) -> Triangle {
    let [r, m] = held.map(|held| if held { 0.0 } else { intensity });
    let g = &p.gram;
    let upper = [
        [g.s11, g.s12, r * p.r1, m * p.m1],
        [0.0, g.s22, r * p.r2, m * p.m2],
        [0.0, 0.0, r * r * p.rr, r * m * p.rm],
        [0.0, 0.0, 0.0, m * m * p.mm],
    ];
    std::array::from_fn(|i| std::array::from_fn(|j| upper[i.min(j)][i.max(j)]))
}

/// The triangular factor from the inner products; `None` where they have lost too many digits for it.
#[inline(always)]
fn cholesky(gram: &Triangle) -> Option<(Triangle, [f64; 4])> {
    let norms = std::array::from_fn(|k| gram[k][k].sqrt());
    let mut r = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in i..4 {
            let known: f64 = (0..i).map(|k| r[k][i] * r[k][j]).sum();
            let left = gram[i][j] - known;
            if i != j {
                r[i][j] = if r[i][i] > 0.0 { left / r[i][i] } else { 0.0 };
            } else if gram[i][i] == 0.0 {
                r[i][i] = 0.0;
            } else if left > CANCELLED * gram[i][i] {
                r[i][i] = left.sqrt();
            } else {
                return None;
            }
        }
    }
    Some((r, norms))
}

/// The four weighted columns, each contiguous.
fn jacobian(reduced: &Reduced<'_>, sample: &Sample<'_>, intensity: f64, held: [bool; 2]) -> [Vec<f64>; 4] {
    let [by_r, by_m] = held.map(|held| if held { 0.0 } else { intensity });
    let root: Vec<f64> = sample.weight.iter().map(|weight| weight.sqrt()).collect();
    let scaled = |column: &[f64], scale: f64| column.iter().zip(&root).map(|(x, root)| scale * root * x).collect();
    let columns = &reduced.columns;
    [
        scaled(sample.diffuse, 1.0),
        scaled(&columns.specular, 1.0),
        scaled(&columns.by_r, by_r),
        scaled(&columns.by_m, by_m),
    ]
}

fn residual_square(jacobian: &[Vec<f64>; 4], sample: &Sample<'_>, diffuse: f64, intensity: f64) -> f64 {
    let columns = jacobian[0].iter().zip(&jacobian[1]);
    columns
        .zip(sample.rooted())
        .map(|((first, second), (_, value))| (value - diffuse * first - intensity * second).powi(2))
        .sum()
}

/// The same for a diffuse column alone; an empty one stands for none.
fn residual_of(sample: &Sample<'_>, diffuse: &[f64], amplitude: f64) -> f64 {
    let column = diffuse.iter().copied().chain(std::iter::repeat(0.0));
    sample.rooted().zip(column).map(|((root, value), column)| (value - amplitude * root * column).powi(2)).sum()
}

/// R of a QR decomposition by modified Gram-Schmidt, with the lengths of the columns before it.
fn triangle<const K: usize>(columns: &mut [Vec<f64>; K]) -> ([[f64; K]; K], [f64; K]) {
    let mut r = [[0.0; K]; K];
    let norms = std::array::from_fn(|k| dot(&columns[k], &columns[k]).sqrt());
    for k in 0..K {
        let (done, rest) = columns.split_at_mut(k + 1);
        let column = &mut done[k];
        r[k][k] = dot(column, column).sqrt();
        if r[k][k] <= 1e-15 * norms[k] || norms[k] == 0.0 {
            r[k][k] = 0.0;
            continue;
        }
        let scale = r[k][k].recip();
        column.iter_mut().for_each(|x| *x *= scale);
        for (offset, other) in rest.iter_mut().enumerate() {
            let projection = dot(column, other);
            r[k][k + 1 + offset] = projection;
            other.iter_mut().zip(column.iter()).for_each(|(x, q)| *x -= projection * q);
        }
    }
    (r, norms)
}

/// Stacks what each emission value's own columns leave of the common ones, and inverts it by its singular values.
#[inline(always)]
fn common(triangles: &[(Triangle, [f64; 4])], own: usize, held: [bool; 2]) -> Common {
    let count = 4 - own;
    let norm = |k: usize| triangles.iter().map(|(_, norms)| norms[own + k] * norms[own + k]).sum::<f64>().sqrt();
    // A held parameter has a column of zeros: a direction of its own, of which nothing is known, and which touches no other.
    let is_held = |k: usize| (own + k).checked_sub(2).is_some_and(|shape| held[shape]);
    let norms: [f64; 3] = std::array::from_fn(|k| if k < count && !is_held(k) { norm(k) } else { 1.0 });
    if norms.contains(&0.0) {
        return Common { own, covariance: [[f64::NAN; 3]; 3], singular: vec![0.0; count] };
    }
    let stacked: [Vec<f64>; 3] = std::array::from_fn(|k| {
        let rows = triangles.iter().flat_map(|(r, _)| (0..count).map(move |i| (r, i)));
        let mut column: Vec<f64> =
            rows.map(|(r, i)| if k < count { r[own + i][own + k] / norms[k] } else { 0.0 }).collect();
        column.resize(column.len().next_multiple_of(super::samples::LANES), 0.0);
        column
    });
    let (singular, v) = match triangles {
        [(r, _)] if count == 2 => decompose::<2>([[r[2][2] / norms[0], r[2][3] / norms[1]], [0.0, r[3][3] / norms[1]]]),
        _ if count == 2 => {
            let [first, second, _] = stacked;
            decompose::<2>(triangle(&mut [first, second]).0)
        }
        _ => decompose::<3>(triangle(&mut stacked.clone()).0),
    };
    let mut covariance = [[0.0; 3]; 3];
    for (k, &value) in singular.iter().enumerate() {
        for i in 0..count {
            for j in 0..count {
                let part = v[i][k] * v[j][k];
                covariance[i][j] += match value < SINGULAR {
                    true if part.abs() > 1e-6 => f64::NAN,
                    true => 0.0,
                    false => part / (norms[i] * norms[j]) / (value * value),
                };
            }
        }
    }
    Common { own, covariance, singular }
}

/// Singular values and right singular vectors (as columns) of a small triangle.
#[inline(always)]
fn decompose<const K: usize>(r: [[f64; K]; K]) -> (Vec<f64>, [[f64; 3]; 3]) {
    let mut v = [[0.0; 3]; 3];
    let (mut singular, mut right) = (DVector::zeros(0), DMatrix::zeros(0, 0));
    if K == 2 {
        let svd = nalgebra::Matrix2::new(r[0][0], r[0][1], r[1][0], r[1][1]).svd(false, true);
        if let Some(transposed) = svd.v_t {
            for (i, row) in v.iter_mut().enumerate().take(2) {
                (row[0], row[1]) = (transposed[(0, i)], transposed[(1, i)]);
            }
        }
        return (svd.singular_values.iter().copied().collect(), v);
    }
    let svd = DMatrix::from_fn(K, K, |i, j| r[i][j]).svd(false, true);
    if let Some(transposed) = svd.v_t {
        (singular, right) = (svd.singular_values, transposed);
    }
    for i in 0..K.min(right.nrows()) {
        for k in 0..K {
            v[i][k] = right[(k, i)];
        }
    }
    (singular.iter().copied().collect(), v)
}

/// Covariance of (diffuse, specular, ln r, ln(n - 1)) of one emission value, from its R = \[\[R11, R12\], \[0, R22\]\]:
/// its own amplitudes follow the common parameters by X = R11^-1 R12.
#[inline(always)]
fn covariance(r: &Triangle, norms: &[f64; 4], common: &Common, unit: f64) -> [[f64; 4]; 4] {
    let own = common.own;
    let mut inverse = [[0.0; 2]; 2];
    for k in 0..own {
        inverse[k][k] = match norms[k] > 0.0 {
            false => 0.0,
            true if r[k][k] > SINGULAR * norms[k] => r[k][k].recip(),
            true => f64::NAN,
        };
    }
    inverse[0][1] = -inverse[0][0] * r[0][1] * inverse[1][1];
    let mut x = [[0.0; 3]; 2];
    for i in 0..own {
        for j in 0..4 - own {
            let follows: f64 = (0..own).map(|k| finite_times(inverse[i][k], r[k][own + j])).sum();
            // What is rounding follows nothing: an unknown parameter, as the index of a co-located scan, hides none beside it.
            x[i][j] = if follows.abs() * norms[i] <= 1e-12 * norms[own + j] { 0.0 } else { follows };
        }
    }
    let product =
        |i: usize, j: usize| -> f64 { (0..4 - own).map(|k| finite_times(x[i][k], common.covariance[k][j])).sum() };
    let mut covariance = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            covariance[i][j] = match (i < own, j < own) {
                (true, true) => {
                    let alone: f64 = (0..own).map(|k| inverse[i][k] * inverse[j][k]).sum();
                    let carried: f64 = (0..4 - own).map(|k| finite_times(product(i, k), x[j][k])).sum();
                    alone + carried
                }
                (true, false) => -product(i, j - own),
                (false, true) => -product(j, i - own),
                (false, false) => common.covariance[i - own][j - own],
            } / unit;
        }
    }
    covariance
}

/// A product in which a coefficient of 0 hides an unknown.
fn finite_times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// From logarithms to (.., roughness, index).
fn to_parameters(covariance: &mut [[f64; 4]; 4], roughness: f64, index_minus_one: f64, specular: bool) {
    let scale = if specular { [1.0, 1.0, roughness, index_minus_one] } else { [1.0, 1.0, 0.0, 0.0] };
    for (i, row) in covariance.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = finite_times(*value, scale[i] * scale[j]);
        }
    }
}

/// A parameter on its bound is not free, and the curvature there is not its uncertainty: no number is given for it.
fn forget(covariance: &mut [[f64; 4]; 4], at_bound: [bool; 4]) {
    for (i, row) in covariance.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            if at_bound[i] || at_bound[j] {
                *value = f64::NAN;
            }
        }
    }
}
