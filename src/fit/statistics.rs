//! Covariance of a fit, from the singular values of its Jacobian at the solution.
//!
//! Each emission value has two amplitudes of its own; roughness and index are common. A QR decomposition of each
//! emission value's four weighted columns separates them: what is left of the two common columns after the amplitudes
//! is stacked and its singular values decide what the data can tell. Why no R^2: a non-linear weighted model has none;
//! reduced chi-square and the residual map answer the question it is asked.

use nalgebra::{DMatrix, Matrix2};

use super::curvature::Columns;
use super::geometry_set::GeometrySet;
use super::outcome::Fit;
use super::solve::Band;

/// A direction of the common parameters whose column keeps less than this share of its length beside all others
/// cannot be told from them.
const SINGULAR: f64 = 1e-8;

/// Upper triangular factor of the columns (diffuse, specular, by ln r, by ln(n - 1)) of one emission value.
type Triangle = [[f64; 4]; 4];

/// Fills chi-square and covariance of a fit whose amplitudes and point are set. `unit` is 1 over the variance that
/// weight 1 stands for; `None` when it is to be taken from the residuals.
pub(super) fn complete(set: &GeometrySet, bands: &[Band], columns: Option<&Columns>, unit: Option<f64>, fit: &mut Fit) {
    let triangles: Vec<(Triangle, [f64; 4])> = bands
        .iter()
        .enumerate()
        .map(|(b, band)| {
            let mut jacobian = jacobian(set, band, columns, fit.bands[b].intensity);
            fit.bands[b].chi_square = residual_square(&jacobian, band, fit.bands[b].diffuse, fit.bands[b].intensity);
            triangle(&mut jacobian)
        })
        .collect();
    let weighted: f64 = fit.bands.iter().map(|band| band.chi_square).sum();
    let unit_or_residual = unit.unwrap_or(fit.degrees_of_freedom / weighted);
    let common = if columns.is_some() { common_covariance(&triangles) } else { [[0.0; 2]; 2] };
    for (band, (r, norms)) in fit.bands.iter_mut().zip(&triangles) {
        band.covariance = covariance(r, norms, &common, unit_or_residual);
        to_parameters(&mut band.covariance, fit.roughness, fit.index_minus_one, columns.is_some());
        let [roughness, index] = fit.at_bound;
        let amplitude = |k: usize, value: f64| norms[k] > 0.0 && value == 0.0;
        let at_bound = [amplitude(0, band.diffuse), amplitude(1, band.intensity), roughness, index];
        forget(&mut band.covariance, at_bound);
        band.chi_square *= unit.unwrap_or(1.0);
    }
    fit.chi_square = weighted * unit.unwrap_or(1.0);
    if columns.is_some() {
        let sigma = |k: usize| (common[k][k] / unit_or_residual).sqrt();
        fit.log_sigma = [0, 1].map(|k| if fit.at_bound[k] { f64::NAN } else { sigma(k) });
    }
}

/// The four weighted columns, each contiguous.
fn jacobian(set: &GeometrySet, band: &Band, columns: Option<&Columns>, intensity: f64) -> [Vec<f64>; 4] {
    let n = band.weight.len();
    let root: Vec<f64> = band.weight.iter().map(|weight| weight.sqrt()).collect();
    let over_root = |weighted: &f64, root: &f64| if *root > 0.0 { weighted / root } else { 0.0 };
    let diffuse = band.weighted_diffuse.iter().zip(&root).map(|(w, r)| over_root(w, r)).collect();
    let mut rest = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    if let Some(columns) = columns {
        for (k, segment) in set.segments.iter().enumerate() {
            let (d, dr) = (columns.d[k], columns.d_by_r[k]);
            for p in segment.start..segment.end {
                let f = root[p] * columns.fg[p];
                rest[0][p] = d * f;
                rest[1][p] = intensity * dr * f;
                rest[2][p] = intensity * d * root[p] * columns.fg_by_m[p];
            }
        }
    }
    let [specular, by_r, by_m] = rest;
    [diffuse, specular, by_r, by_m]
}

fn residual_square(jacobian: &[Vec<f64>; 4], band: &Band, diffuse: f64, intensity: f64) -> f64 {
    let columns = jacobian[0].iter().zip(&jacobian[1]);
    let data = band.value.iter().zip(&band.weight);
    columns
        .zip(data)
        .map(|((first, second), (value, weight))| {
            let residual = value * weight.sqrt() - diffuse * first - intensity * second;
            residual * residual
        })
        .sum()
}

/// R of a QR decomposition by modified Gram-Schmidt, with the lengths of the columns before it.
fn triangle(columns: &mut [Vec<f64>; 4]) -> (Triangle, [f64; 4]) {
    let mut r = [[0.0; 4]; 4];
    let norms = std::array::from_fn(|k| dot(&columns[k], &columns[k]).sqrt());
    for k in 0..4 {
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

/// Four sums side by side, so that the compiler may use vector instructions.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (chunks_a, chunks_b) = (a.chunks_exact(4), b.chunks_exact(4));
    let tail: f64 = chunks_a.remainder().iter().zip(chunks_b.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in chunks_a.zip(chunks_b) {
        for lane in 0..4 {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + tail
}

/// Covariance of (ln r, ln(n - 1)) for weight 1; NaN for a parameter with a part in a direction that cannot be told.
fn common_covariance(triangles: &[(Triangle, [f64; 4])]) -> [[f64; 2]; 2] {
    let norm = |k: usize| triangles.iter().map(|(_, norms)| norms[k] * norms[k]).sum::<f64>().sqrt();
    let norms = [norm(2), norm(3)];
    if norms.contains(&0.0) {
        return [[f64::NAN; 2]; 2];
    }
    let rows: Vec<f64> =
        triangles.iter().flat_map(|(r, _)| [r[2][2] / norms[0], r[2][3] / norms[1], 0.0, r[3][3] / norms[1]]).collect();
    let (singular, v) = match triangles {
        [_] => singular_values(Matrix2::new(rows[0], rows[1], rows[2], rows[3])),
        _ => {
            let r = DMatrix::from_row_slice(rows.len() / 2, 2, &rows).qr().r();
            singular_values(Matrix2::new(r[(0, 0)], r[(0, 1)], r[(1, 0)], r[(1, 1)]))
        }
    };
    let mut covariance = [[0.0; 2]; 2];
    for (k, &value) in singular.iter().enumerate() {
        for i in 0..2 {
            for j in 0..2 {
                let part = v[(i, k)] * v[(j, k)] / (norms[i] * norms[j]);
                let untold = value < SINGULAR && part.abs() * norms[i] * norms[j] > 1e-6;
                covariance[i][j] += if untold {
                    f64::NAN
                } else if value < SINGULAR {
                    0.0
                } else {
                    part / (value * value)
                };
            }
        }
    }
    covariance
}

/// Singular values and right singular vectors (as columns).
fn singular_values(matrix: Matrix2<f64>) -> ([f64; 2], Matrix2<f64>) {
    let svd = matrix.svd(false, true);
    let v = svd.v_t.unwrap_or_else(Matrix2::identity).transpose();
    ([svd.singular_values[0], svd.singular_values[1]], v)
}

/// Covariance of (diffuse, specular, ln r, ln(n - 1)) of one emission value, from its R = \[\[R11, R12\], \[0, R22\]\]:
/// the amplitudes follow the common parameters by X = R11^-1 R12.
fn covariance(r: &Triangle, norms: &[f64; 4], common: &[[f64; 2]; 2], unit: f64) -> [[f64; 4]; 4] {
    let fitted = [norms[0] > 0.0, norms[1] > 0.0];
    let told = |k: usize| r[k][k] > SINGULAR * norms[k];
    let mut inverse = [[0.0; 2]; 2];
    for k in 0..2 {
        inverse[k][k] = match (fitted[k], told(k)) {
            (false, _) => 0.0,
            (true, true) => r[k][k].recip(),
            (true, false) => f64::NAN,
        };
    }
    inverse[0][1] = -inverse[0][0] * r[0][1] * inverse[1][1];
    let x: [[f64; 2]; 2] =
        std::array::from_fn(|i| std::array::from_fn(|j| inverse[i][0] * r[0][2 + j] + inverse[i][1] * r[1][2 + j]));
    let product = |i: usize, j: usize| -> f64 { (0..2).map(|k| finite_times(x[i][k], common[k][j])).sum() };
    let mut covariance = [[0.0; 4]; 4];
    for i in 0..2 {
        for j in 0..2 {
            let own: f64 = (0..2).map(|k| inverse[i][k] * inverse[j][k]).sum();
            let carried: f64 = (0..2).map(|k| finite_times(product(i, k), x[j][k])).sum();
            covariance[i][j] = (own + carried) / unit;
            covariance[i][2 + j] = -product(i, j) / unit;
            covariance[2 + j][i] = covariance[i][2 + j];
            covariance[2 + i][2 + j] = common[i][j] / unit;
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
