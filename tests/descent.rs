//! Least squares within a box: what ends a descent, and what it says of it.
#![allow(clippy::unwrap_used)]

use bbrf::fit::descent::{Bounds, Descent, End, LeastSquares, Residuals, Rules, SquareRootInformation, descend};
use nalgebra::{DMatrix, DVector};

/// Residuals and their rows of derivatives by closure.
struct Problem<R, J>(R, J);

impl<R: Fn(&[f64]) -> Vec<f64>, J: Fn(&[f64]) -> Vec<f64>> Residuals for Problem<R, J> {
    fn residuals(&self, x: &[f64]) -> DVector<f64> {
        DVector::from_vec(self.0(x))
    }

    fn jacobian(&self, x: &[f64]) -> DMatrix<f64> {
        let rows = self.1(x);
        DMatrix::from_row_slice(rows.len() / x.len(), x.len(), &rows)
    }
}

fn rules() -> Rules {
    Rules { tolerance: 1e-12, freedom: 1.0, evaluations: 500, damping: 1.0 }
}

fn run(problem: impl Residuals, start: &[f64], low: &[f64], high: &[f64]) -> Descent<SquareRootInformation> {
    let longest = vec![f64::INFINITY; start.len()];
    descend(&mut LeastSquares::new(problem), start, &Bounds { low, high, longest: &longest }, &rules()).unwrap()
}

const FREE: f64 = f64::INFINITY;

/// Rosenbrock's valley.
fn valley(x: &[f64]) -> Vec<f64> {
    vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]
}

fn valley_slopes(x: &[f64]) -> Vec<f64> {
    vec![-20.0 * x[0], 10.0, -1.0, 0.0]
}

#[test]
fn a_curved_valley_is_followed_to_its_end() {
    let found = run(Problem(valley, valley_slopes), &[-1.2, 1.0], &[-FREE; 2], &[FREE; 2]);
    assert_eq!((found.end, found.held), (End::Converged, vec![false, false]));
    assert!((found.point[0] - 1.0).abs() < 1e-6 && (found.point[1] - 1.0).abs() < 1e-6, "{:?}", found.point);
}

/// With x <= 0.5 the minimum is at (0.5, 0.25), where chi-square is 0.25.
#[test]
fn a_minimum_outside_the_box_ends_on_its_face_and_names_the_parameter() {
    for start in [[-1.2, 1.0], [0.5, 1.0], [0.5, 0.25], [7.0, -9.0]] {
        let found = run(Problem(valley, valley_slopes), &start, &[-FREE; 2], &[0.5, FREE]);
        assert_eq!((found.end, found.held), (End::Converged, vec![true, false]), "{start:?}");
        // So near is the tolerance: chi-square rises by the square of ten times the distance.
        let near = (rules().tolerance * 0.25).sqrt() / 10.0;
        assert!(found.point[0] == 0.5 && (found.point[1] - 0.25).abs() <= near, "{:?}", found.point);
        assert!((found.height.chi_square - 0.25).abs() < 1e-12);
    }
}

/// A search that takes a start on a bound for a solution stays there (scipy 18793, 19103).
#[test]
fn a_start_on_a_bound_leaves_it_when_the_minimum_is_inside() {
    let found = run(Problem(valley, valley_slopes), &[-2.0, 4.0], &[-2.0; 2], &[4.0; 2]);
    assert_eq!((found.end, found.held), (End::Converged, vec![false, false]));
    assert!((found.point[0] - 1.0).abs() < 1e-6, "{:?}", found.point);
}

/// The logarithm has no value below 0, where the first undamped step leads.
#[test]
fn a_step_to_where_the_model_has_no_value_is_not_taken() {
    let found =
        run(Problem(|x: &[f64]| vec![x[0].ln() - 1.0], |x: &[f64]| vec![x[0].recip()]), &[30.0], &[-FREE], &[FREE]);
    assert_eq!(found.end, End::Converged);
    assert!((found.point[0] - 1_f64.exp()).abs() < 1e-6, "{:?}", found.point);
}

#[test]
fn a_jacobian_that_is_no_number_makes_a_step_not_taken_and_a_start_an_error() {
    let broken = |x: &[f64]| vec![if x[0] < 1.0 { f64::NAN } else { 2.0 * x[0] }];
    let found = run(Problem(|x: &[f64]| vec![x[0] * x[0]], broken), &[3.0], &[-FREE], &[FREE]);
    assert!(found.point[0] >= 1.0 && found.end != End::Converged, "{found:?}");
    for start in [0.5, f64::NAN] {
        let longest = [FREE];
        let bounds = Bounds { low: &[-FREE], high: &[FREE], longest: &longest };
        let mut landscape = LeastSquares::new(Problem(|x: &[f64]| vec![x[0] * x[0]], broken));
        assert!(descend(&mut landscape, &[start], &bounds, &rules()).is_err());
    }
}

/// A loop that takes a rejected step for the end calls this converged.
#[test]
fn wrong_derivatives_are_a_stall_and_not_convergence() {
    let found = run(Problem(|x: &[f64]| vec![x[0] - 5.0], |_: &[f64]| vec![-1.0]), &[1.0], &[-FREE], &[FREE]);
    assert_eq!((found.end, found.point[0]), (End::Stalled, 1.0));
    assert!(found.left > 10.0, "what is predicted is said: {}", found.left);
}

#[test]
fn the_limit_of_evaluations_is_not_convergence() {
    let rules = Rules { evaluations: 3, ..rules() };
    let bounds = Bounds { low: &[-FREE; 2], high: &[FREE; 2], longest: &[FREE; 2] };
    let mut landscape = LeastSquares::new(Problem(valley, valley_slopes));
    let found = descend(&mut landscape, &[-1.2, 1.0], &bounds, &rules).unwrap();
    assert_eq!((found.end, found.evaluations), (End::EvaluationLimit, 3));
}

/// x + y = 3 four times: the sum is known, x and y are not, and z has no column.
#[test]
fn what_the_data_cannot_tell_stays_where_it_was_or_has_no_uncertainty() {
    let residuals = |x: &[f64]| vec![x[0] + x[1] - 3.0; 4];
    let slopes = |_: &[f64]| [1.0, 1.0, 0.0].repeat(4);
    let found = run(Problem(residuals, slopes), &[0.0, 0.0, 7.0], &[-FREE; 3], &[FREE; 3]);
    assert_eq!((found.end, found.point[2]), (End::Converged, 7.0));
    assert!((found.point[0] + found.point[1] - 3.0).abs() < 1e-9);
    let covariance = found.slope.covariance(&found.held, 1e-12);
    assert!((0..3).all(|k| covariance[(k, k)].is_nan()), "{covariance}");
    // With x held the sum tells y.
    let covariance = found.slope.covariance(&[true, false, true], 1e-12);
    assert!((covariance[(1, 1)] - 0.25).abs() < 1e-15 && covariance[(0, 0)].is_nan(), "{covariance}");
}

/// A problem with structure hands in a Cholesky factor of its information in place of a Jacobian.
#[test]
fn square_root_information_from_a_cholesky_factor_gives_the_same_step() {
    use bbrf::fit::descent::Slope;
    let jacobian = DMatrix::from_row_slice(4, 2, &[1.0, 2.0, 0.5, -1.0, 3.0, 0.25, -2.0, 1.0]);
    let residuals = DVector::from_row_slice(&[1.0, -2.0, 0.5, 4.0]);
    let information = jacobian.tr_mul(&jacobian);
    let r = information.cholesky().unwrap().l().transpose();
    let q = r.tr_solve_upper_triangular(&jacobian.tr_mul(&residuals)).unwrap();
    let (dense, factor) =
        (SquareRootInformation::of(jacobian, &residuals).unwrap(), SquareRootInformation::new(r, q).unwrap());
    for (pinned, damping) in [([None, None], 0.0), ([None, None], 0.7), ([Some(0.3), None], 0.1)] {
        let (mut first, mut second) = ([0.0; 2], [0.0; 2]);
        dense.step(&pinned, damping, &mut first);
        factor.step(&pinned, damping, &mut second);
        for (a, b) in first.iter().zip(&second) {
            assert!((a - b).abs() < 1e-13, "{first:?} {second:?}");
        }
        assert!((dense.decrease(&first) - factor.decrease(&second)).abs() < 1e-12);
    }
}
