//! Square-root information: R and q with chi-square = |R s + q|^2 + a constant, the local picture of a least-squares
//! problem. J'J would square the condition of the problem and lose half of its digits.

use nalgebra::{DMatrix, DVector};

use super::Slope;

/// A column whose part beside the others is below this share of its length moves no step.
const DEPENDENT: f64 = 1e-14;

/// What is left of a length after one step.
const REMEMBERED: f64 = 0.9;

/// R and q of a problem with p parameters: |R s + q|^2 is chi-square after a step s, up to a constant.
///
/// R is p x p from a QR decomposition of the Jacobian (q is then Q'r), or what a problem with structure has instead, such
/// as a Cholesky factor of its information; any number of rows will do.
#[derive(Debug, Clone)]
pub struct SquareRootInformation {
    r: DMatrix<f64>,
    q: DVector<f64>,
    gradient: DVector<f64>,
    /// Lengths of the columns of R, which are those of the Jacobian; 1 for a column of zeros.
    scale: Vec<f64>,
    /// What damping measures steps in: those lengths, or longer ones that were seen before.
    metric: Vec<f64>,
}

impl SquareRootInformation {
    /// From R and q; `None` where they do not fit together or hold something that is no number.
    #[must_use]
    pub fn new(r: DMatrix<f64>, q: DVector<f64>) -> Option<Self> {
        if r.nrows() != q.len() || !r.iter().chain(q.iter()).all(|x| x.is_finite()) {
            return None;
        }
        let gradient = r.tr_mul(&q);
        let length = |norm: f64| if norm > 0.0 { norm } else { 1.0 };
        let scale: Vec<f64> = r.column_iter().map(|column| length(column.norm())).collect();
        let is_finite = gradient.iter().chain(&scale).all(|x| x.is_finite());
        is_finite.then_some(Self { r, q, gradient, metric: scale.clone(), scale })
    }

    /// From the residuals and their Jacobian, by a QR decomposition; `None` as [`SquareRootInformation::new`].
    #[must_use]
    pub fn of(jacobian: DMatrix<f64>, residuals: &DVector<f64>) -> Option<Self> {
        if jacobian.nrows() != residuals.len() || !jacobian.iter().all(|x| x.is_finite()) {
            return None;
        }
        if jacobian.nrows() <= jacobian.ncols() {
            return Self::new(jacobian, residuals.clone());
        }
        let (qr, mut q) = (jacobian.qr(), residuals.clone());
        qr.q_tr_mul(&mut q);
        let r = qr.r();
        let rows = r.nrows();
        Self::new(r, q.rows(0, rows).into_owned())
    }

    /// The covariance of the parameters for a chi-square in units of the variance, (R'R)^-1. A `held` parameter takes no
    /// part: its row and column are NaN. So are those of a parameter that has a part in a direction whose singular value
    /// is below `cut` times the largest, with columns scaled to length 1: the data cannot tell it.
    #[must_use]
    pub fn covariance(&self, held: &[bool], cut: f64) -> DMatrix<f64> {
        let p = self.r.ncols();
        let mut covariance = DMatrix::from_element(p, p, f64::NAN);
        let free: Vec<usize> = (0..p).filter(|k| held.get(*k) != Some(&true)).collect();
        if free.is_empty() {
            return covariance;
        }
        let svd = self.scaled(&free).svd(false, true);
        let Some(v_t) = svd.v_t else { return covariance };
        let smallest = cut * svd.singular_values.max();
        for (i, &row) in free.iter().enumerate() {
            for (j, &column) in free.iter().enumerate() {
                let part = |k: usize, value: f64| {
                    let part = v_t[(k, i)] * v_t[(k, j)];
                    match value > smallest {
                        true => part / (value * value),
                        // A direction that cannot be told hides only what has a part in it.
                        false if part.abs() > 1e-6 => f64::NAN,
                        false => 0.0,
                    }
                };
                let sum: f64 = svd.singular_values.iter().enumerate().map(|(k, value)| part(k, *value)).sum();
                covariance[(row, column)] = sum / (self.scale[row] * self.scale[column]);
            }
        }
        covariance
    }

    /// Measures damped steps in the longest columns seen, which are forgotten by a tenth each time (Moré 1978 never
    /// forgets). A column that collapses would else set its parameter free to leave for a plateau without return.
    /// `longest` is kept between the slopes of one descent, empty at first.
    pub fn remember(&mut self, longest: &mut Vec<f64>) {
        longest.resize(self.metric.len(), 0.0);
        for (metric, longest) in self.metric.iter_mut().zip(longest) {
            *longest = metric.max(REMEMBERED * *longest);
            *metric = *longest;
        }
    }

    /// Columns of R scaled to length 1.
    fn scaled(&self, columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(self.r.nrows(), columns.len(), |row, k| self.r[(row, columns[k])] / self.scale[columns[k]])
    }
}

impl Slope for SquareRootInformation {
    fn gradient(&self) -> &[f64] {
        self.gradient.as_slice()
    }

    fn step(&self, pinned: &[Option<f64>], damping: f64, step: &mut [f64]) {
        let mut right = -&self.q;
        for (k, pin) in pinned.iter().enumerate() {
            step[k] = pin.unwrap_or(0.0);
            if step[k] != 0.0 {
                right.axpy(-step[k], &self.r.column(k), 1.0);
            }
        }
        let free: Vec<usize> = (0..pinned.len()).filter(|k| pinned[*k].is_none()).collect();
        if free.is_empty() {
            return;
        }
        let mut matrix = self.scaled(&free);
        if damping > 0.0 {
            let rows = matrix.nrows();
            matrix = matrix.resize_vertically(rows + free.len(), 0.0);
            (0..free.len())
                .for_each(|k| matrix[(rows + k, k)] = damping.sqrt() * self.metric[free[k]] / self.scale[free[k]]);
            right = right.resize_vertically(rows + free.len(), 0.0);
        }
        for (k, x) in free.iter().zip(&basic_solution(matrix, right)) {
            step[*k] = x / self.scale[*k];
        }
    }

    fn decrease(&self, step: &[f64]) -> f64 {
        let moved = &self.r * DVector::from_column_slice(step);
        // |q|^2 - |q + R s|^2 without the difference.
        -(2.0 * self.q.dot(&moved) + moved.norm_squared())
    }
}

/// Least squares by QR with column pivoting; 0 for columns that depend on those before them.
fn basic_solution(matrix: DMatrix<f64>, mut right: DVector<f64>) -> Vec<f64> {
    let columns = matrix.ncols();
    let qr = matrix.col_piv_qr();
    qr.q_tr_mul(&mut right);
    let r = qr.r();
    let most = columns.min(r.nrows());
    let smallest = DEPENDENT * r.get((0, 0)).map_or(0.0, |x| x.abs());
    let rank = (0..most).take_while(|&k| r[(k, k)].abs() > smallest).count();
    let mut x = DVector::zeros(columns);
    for k in (0..rank).rev() {
        let known: f64 = (k + 1..rank).map(|j| r[(k, j)] * x[j]).sum();
        x[k] = (right[k] - known) / r[(k, k)];
    }
    qr.p().inv_permute_rows(&mut x);
    x.as_slice().to_vec()
}
