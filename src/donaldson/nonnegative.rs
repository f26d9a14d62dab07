//! Quadratic minimisation over non-negative numbers, exact: the active set of Lawson and Hanson on the normal equations
//! (Bro and de Jong, J. Chemometrics 11 (1997) 393), started from all numbers free.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Passes after which the set is taken as it is; it settles in a few tens.
const PASSES: usize = 2000;

/// Minimises 1/2 a'Qa - g'a over a >= 0, for a positive definite Q; `None` where Q is not, or holds what is no number.
pub(crate) fn minimise(q: &DMatrix<f64>, g: &DVector<f64>) -> Option<DVector<f64>> {
    let count = g.len();
    let mut at = DVector::<f64>::zeros(count);
    let mut is_free = vec![true; count];
    // A gradient this small is rounding.
    let tolerance = 1e-13 * g.amax().max(f64::MIN_POSITIVE) * count as f64;
    for _ in 0..PASSES {
        let free: Vec<usize> = (0..count).filter(|k| is_free[*k]).collect();
        let target = solve(q, g, &free)?;
        let blocked: Vec<usize> = (0..free.len()).filter(|k| target[*k] <= 0.0).collect();
        if blocked.is_empty() {
            at.fill(0.0);
            free.iter().zip(target.iter()).for_each(|(k, value)| at[*k] = *value);
            let slope = g - q * &at;
            let worst = (0..count).filter(|k| !is_free[*k]).max_by(|a, b| slope[*a].total_cmp(&slope[*b]));
            match worst {
                Some(k) if slope[k] > tolerance => is_free[k] = true,
                _ => return Some(at),
            }
            continue;
        }
        // As far as the first of them that reaches 0; from the start, where all are 0, no way at all.
        let step = blocked.iter().map(|k| at[free[*k]] / (at[free[*k]] - target[*k])).fold(1.0, f64::min);
        let step = if step.is_finite() { step.clamp(0.0, 1.0) } else { 0.0 };
        for (k, index) in free.iter().enumerate() {
            at[*index] += step * (target[k] - at[*index]);
        }
        for k in blocked {
            let index = free[k];
            if at[index] <= 1e-14 * at.amax() {
                at[index] = 0.0;
                is_free[index] = false;
            }
        }
    }
    Some(at)
}

/// The unconstrained minimum over the free numbers.
fn solve(q: &DMatrix<f64>, g: &DVector<f64>, free: &[usize]) -> Option<DVector<f64>> {
    if free.is_empty() {
        return Some(DVector::zeros(0));
    }
    let rows = g.select_rows(free);
    let solved = cholesky(q, free)?.solve(&rows);
    solved.iter().all(|x| x.is_finite()).then_some(solved)
}

fn cholesky(q: &DMatrix<f64>, free: &[usize]) -> Option<Cholesky<f64, Dyn>> {
    q.select_rows(free).select_columns(free).cholesky()
}

/// The inverse of Q over the free numbers, with rows and columns of 0 for the others.
pub(crate) fn inverse_over(q: &DMatrix<f64>, free: &[usize]) -> Option<DMatrix<f64>> {
    let mut all = DMatrix::zeros(q.nrows(), q.ncols());
    if !free.is_empty() {
        let inverse = cholesky(q, free)?.inverse();
        for (i, row) in free.iter().enumerate() {
            for (j, column) in free.iter().enumerate() {
                all[(*row, *column)] = inverse[(i, j)];
            }
        }
    }
    Some(all)
}

/// Adds weight times the squares of the second differences of the numbers `offset`, `offset` + `stride`, ...: smoothness, that
/// leaves straight lines alone.
pub(crate) fn add_roughness(q: &mut DMatrix<f64>, count: usize, stride: usize, offset: usize, weight: f64) {
    for k in 1..count.saturating_sub(1) {
        let entries = [(k - 1, 1.0), (k, -2.0), (k + 1, 1.0)];
        for (i, a) in entries {
            for (j, b) in entries {
                q[(i * stride + offset, j * stride + offset)] += weight * a * b;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Karush, Kuhn and Tucker: no number below 0, no slope downhill from a number at 0, none at a free one.
    #[test]
    fn the_minimum_has_no_way_down() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for count in [1, 2, 7, 30, 80] {
            for _ in 0..20 {
                let root = DMatrix::from_fn(count + 2, count, |_, _| random());
                let q = root.transpose() * root + DMatrix::identity(count, count) * 1e-6;
                let g = DVector::from_fn(count, |_, _| random());
                let found = minimise(&q, &g).unwrap();
                let slope = &g - &q * &found;
                for k in 0..count {
                    assert!(found[k] >= 0.0);
                    let allowed = if found[k] > 0.0 { slope[k].abs() } else { slope[k] };
                    assert!(allowed < 1e-9, "{count}: {k}: {} {}", found[k], slope[k]);
                }
            }
        }
    }

    #[test]
    fn what_is_not_convex_has_no_answer() {
        let q = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -1.0]);
        assert!(minimise(&q, &DVector::from_vec(vec![1.0, 1.0])).is_none());
        let q = DMatrix::from_row_slice(1, 1, &[f64::NAN]);
        assert!(minimise(&q, &DVector::from_vec(vec![1.0])).is_none());
        assert_eq!(minimise(&DMatrix::zeros(0, 0), &DVector::zeros(0)).unwrap().len(), 0);
    }
}
