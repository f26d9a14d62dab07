//! The `varpro` crate on the same scan: two columns, ln r and ln(n - 1), exact derivatives, weights 1/sigma.

use std::convert::Infallible;

use bbrf::terms::{Distribution, fresnel};
use nalgebra::{DMatrix, DVector, OMatrix, OVector};
use varpro::model::SeparableNonlinearModel;
use varpro::problem::SeparableProblemBuilder;
use varpro::solvers::levmar::LevMarSolver;

use crate::common::scans::{Prepared, Truth};

struct Model<'a> {
    grid: &'a [Prepared],
    log: [f64; 2],
}

impl Model<'_> {
    /// The specular column and its derivatives.
    fn column(&self, of: impl Fn(f64, f64, f64, f64) -> f64) -> DVector<f64> {
        let (roughness, m) = (self.log[0].exp(), self.log[1].exp());
        DVector::from_fn(self.grid.len(), |k, _| {
            let d = Distribution::GaussianHalfHeight.evaluate(&self.grid[k].half, roughness);
            let f = fresnel(&self.grid[k].half, m);
            self.grid[k].masked * of(d.value, d.by_log_roughness, f.value, f.by_index * m)
        })
    }
}

impl SeparableNonlinearModel for Model<'_> {
    type ScalarType = f64;
    type Error = Infallible;

    fn parameter_count(&self) -> usize {
        2
    }

    fn base_function_count(&self) -> usize {
        2
    }

    fn output_len(&self) -> usize {
        self.grid.len()
    }

    fn set_params(&mut self, parameters: OVector<f64, nalgebra::Dyn>) -> Result<(), Infallible> {
        self.log = [parameters[0], parameters[1]];
        Ok(())
    }

    fn params(&self) -> OVector<f64, nalgebra::Dyn> {
        DVector::from_row_slice(&self.log)
    }

    fn eval(&self) -> Result<OMatrix<f64, nalgebra::Dyn, nalgebra::Dyn>, Infallible> {
        let diffuse = DVector::from_fn(self.grid.len(), |k, _| self.grid[k].diffuse);
        Ok(DMatrix::from_columns(&[diffuse, self.column(|d, _, f, _| d * f)]))
    }

    fn eval_partial_deriv(&self, k: usize) -> Result<OMatrix<f64, nalgebra::Dyn, nalgebra::Dyn>, Infallible> {
        let by = self.column(|d, by_r, f, by_m| if k == 0 { by_r * f } else { d * by_m });
        Ok(DMatrix::from_columns(&[DVector::zeros(self.grid.len()), by]))
    }
}

/// Chi-square that the peer finds from a start; infinite where it finds none.
pub fn fit(grid: &[Prepared], values: &[f64], sigma: &[f64], start: &Truth) -> f64 {
    let model = Model { grid, log: [start.roughness.ln(), start.index_minus_one.ln()] };
    let weights = DVector::from_iterator(sigma.len(), sigma.iter().map(|sigma| sigma.recip()));
    let problem = SeparableProblemBuilder::new(model)
        .observations(DVector::from_row_slice(values))
        .weights(weights)
        .build()
        .unwrap();
    // Where the crate reports a failure its last point counts all the same; far from the lobe it meets a NaN and panics.
    let solve = || LevMarSolver::default().solve(problem).unwrap_or_else(|failed| failed);
    let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(solve));
    found.map_or(f64::INFINITY, |found| 2.0 * found.minimization_report.objective_function)
}
