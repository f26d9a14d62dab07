//! The general problem: residuals and their Jacobian as dense arrays.

use nalgebra::{DMatrix, DVector};

use super::{Height, Landscape, SquareRootInformation};

/// Residuals over their standard uncertainties (model minus data), as functions of the parameters.
pub trait Residuals {
    /// The N residuals. What is not finite makes the step that led there one that is not taken.
    fn residuals(&self, parameters: &[f64]) -> DVector<f64>;

    /// Their derivatives, N x p.
    fn jacobian(&self, parameters: &[f64]) -> DMatrix<f64>;

    /// Rounding error of one residual, in its unit; 0 where that is far below the residuals.
    fn rounding(&self) -> f64 {
        0.0
    }
}

/// The landscape of a dense problem. The Jacobian is asked for at points only that are lower than all before.
#[derive(Debug, Clone)]
pub struct LeastSquares<P> {
    problem: P,
    at: Vec<f64>,
    residuals: DVector<f64>,
    /// Longest columns of the Jacobian so far.
    longest: Vec<f64>,
}

impl<P: Residuals> LeastSquares<P> {
    /// The landscape of a problem.
    pub fn new(problem: P) -> Self {
        Self { problem, at: Vec::new(), residuals: DVector::zeros(0), longest: Vec::new() }
    }
}

impl<P: Residuals> Landscape for LeastSquares<P> {
    type Slope = SquareRootInformation;

    fn height(&mut self, at: &[f64]) -> Height {
        self.at.clear();
        self.at.extend_from_slice(at);
        self.residuals = self.problem.residuals(at);
        let chi_square = self.residuals.norm_squared();
        // Each residual is off by its rounding and each square by one of its own; signs are random.
        let count = self.residuals.len() as f64;
        let one = self.problem.rounding();
        let noise = 4.0 * f64::EPSILON * chi_square + 2.0 * chi_square.sqrt() * one + count * one * one;
        Height { chi_square, noise }
    }

    fn slope(&mut self) -> Option<SquareRootInformation> {
        let mut slope = SquareRootInformation::of(self.problem.jacobian(&self.at), &self.residuals)?;
        slope.remember(&mut self.longest);
        Some(slope)
    }
}
