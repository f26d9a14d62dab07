//! How much of a fit hangs on each value: the diagonal of the hat matrix, exactly, from orthogonal columns of the weighted
//! Jacobian (Cook 1977, Technometrics 19, 15, for linear models; of the linearised one here).

use ndarray::Array2;

use super::columns::{Columns, Point};
use super::curvature::Share;
use super::outcome::Fit;
use super::samples::dot;
use super::solve::{Fitter, Prepared};
use super::statistics::SINGULAR;

/// Hat values and the number of parameters that they add up to.
pub(super) struct Leverage {
    /// \[B, N\]; NaN for a value that took no part.
    pub(super) hat: Array2<f64>,
    /// Parameters that are free and that the data can tell.
    pub(super) parameters: usize,
}

/// Columns that are made orthogonal one after the other.
#[derive(Default)]
struct Basis {
    columns: Vec<Vec<f64>>,
}

impl Basis {
    /// What the basis leaves of a column.
    fn reduce(&self, column: &mut [f64]) {
        // Twice is enough: the second time takes what rounding left the first time.
        for _ in 0..2 {
            for known in &self.columns {
                let share = dot(known, column);
                column.iter_mut().zip(known).for_each(|(x, known)| *x -= share * known);
            }
        }
    }

    /// Takes up what is left of a column whose length was `norm`, if anything is.
    fn take(&mut self, mut column: Vec<f64>, norm: f64) {
        self.reduce(&mut column);
        let left = dot(&column, &column).sqrt();
        if left > SINGULAR * norm {
            column.iter_mut().for_each(|x| *x /= left);
            self.columns.push(column);
        }
    }
}

impl Fitter<'_> {
    /// The leverage of each value on a fit. A parameter that ended on its bound is not free and takes no part.
    pub(super) fn leverage(&self, data: &Prepared, fit: &Fit) -> Leverage {
        let mut columns = Columns::default();
        let has_specular = fit.has_specular();
        if has_specular {
            columns.update(self.set, &Point { log: [fit.roughness.ln(), fit.index_minus_one.ln()] });
        }
        let (bands, points) = (data.samples.bands(), self.set.points());
        let is_shared = self.share == Share::ShapeAndIntensity && bands > 1;
        let mut squares = vec![0.0; bands * points];
        let mut parameters = 0;
        // Each emission value's own amplitudes first; what they leave of the common columns is stacked.
        let mut common: [Vec<f64>; 3] = Default::default();
        let mut norms = [0.0; 3];
        for (b, band) in fit.bands.iter().enumerate() {
            let root: Vec<f64> = data.samples.sample(b).weight.iter().map(|weight| weight.sqrt()).collect();
            let weighted = |column: &[f64], scale: f64| -> Vec<f64> {
                column.iter().zip(&root).map(|(x, root)| scale * root * x).collect()
            };
            let mut own = Basis::default();
            let mut take_own = |column: Vec<f64>| {
                let norm = dot(&column, &column).sqrt();
                own.take(column, norm);
            };
            if self.terms.diffuse && band.diffuse > 0.0 {
                take_own(weighted(&self.set.diffuse, 1.0));
            }
            if has_specular && band.intensity > 0.0 && !is_shared {
                take_own(weighted(&columns.specular, 1.0));
            }
            add_squares(&own, &mut squares[b * points..(b + 1) * points]);
            parameters += own.columns.len();
            if has_specular {
                let parts = [
                    (is_shared, &columns.specular, 1.0),
                    (!fit.at_bound[0], &columns.by_r, band.intensity),
                    (!fit.at_bound[1], &columns.by_m, band.intensity),
                ];
                for (k, (is_free, column, scale)) in parts.into_iter().enumerate() {
                    let mut column = if is_free { weighted(column, scale) } else { vec![0.0; points] };
                    norms[k] += dot(&column, &column);
                    own.reduce(&mut column);
                    common[k].extend(column);
                }
            }
        }
        let mut basis = Basis::default();
        for (column, norm) in common.into_iter().zip(norms).filter(|(_, norm)| *norm > 0.0) {
            basis.take(column, norm.sqrt());
        }
        add_squares(&basis, &mut squares);
        Leverage { hat: self.by_input(data, &squares), parameters: parameters + basis.columns.len() }
    }

    /// From the order of the set to that of the input.
    fn by_input(&self, data: &Prepared, sorted: &[f64]) -> Array2<f64> {
        let (bands, points) = (data.samples.bands(), self.set.points());
        let mut table = Array2::from_elem((bands, self.set.len()), f64::NAN);
        for b in 0..bands {
            let weight = data.samples.sample(b).weight;
            for (point, &input) in self.set.order.iter().enumerate() {
                if weight[point] > 0.0 {
                    table[(b, input)] = sorted[b * points + point];
                }
            }
        }
        table
    }
}

fn add_squares(basis: &Basis, sum: &mut [f64]) {
    for column in &basis.columns {
        sum.iter_mut().zip(column).for_each(|(sum, x)| *sum += x * x);
    }
}
