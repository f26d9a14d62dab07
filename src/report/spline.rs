//! Filling the gaps of an angle map for the eye. What is filled here is drawn as interpolated and never fitted.

use ndarray::{Array2, ArrayView1};

use super::angle_map::AngleMap;

/// The fewest measured points that a spline is drawn through.
const FEWEST: usize = 4;

/// Interpolated values where a map has gaps between measured cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Filled {
    /// \[incidence, viewing\]; NaN where the map has a value or nothing lies on both sides.
    values: Array2<f64>,
}

impl Filled {
    /// Natural cubic splines along each row and each column; where both reach a gap, their mean.
    pub(super) fn of(map: &AngleMap) -> Self {
        let mut along_viewing = Array2::from_elem(map.values.raw_dim(), f64::NAN);
        let mut along_incidence = along_viewing.clone();
        for (row, mut filled) in map.values.rows().into_iter().zip(along_viewing.rows_mut()) {
            filled.assign(&fill(&map.theta_v_deg, row));
        }
        for (column, mut filled) in map.values.columns().into_iter().zip(along_incidence.columns_mut()) {
            filled.assign(&fill(&map.theta_i_deg, column));
        }
        let mut values = along_viewing;
        values.zip_mut_with(&along_incidence, |first, second| *first = mean_of_finite(*first, *second));
        Self { values }
    }

    pub(super) fn at(&self, incidence: usize, viewing: usize) -> Option<f64> {
        Some(self.values[(incidence, viewing)]).filter(|value| value.is_finite())
    }

    pub(super) fn count(&self) -> usize {
        self.values.iter().filter(|value| value.is_finite()).count()
    }
}

fn mean_of_finite(first: f64, second: f64) -> f64 {
    match (first.is_finite(), second.is_finite()) {
        (true, true) => first / 2.0 + second / 2.0,
        (true, false) => first,
        _ => second,
    }
}

/// The spline's values at the gaps between the first and the last measured point, NaN elsewhere.
fn fill(at: &[f64], values: ArrayView1<'_, f64>) -> ndarray::Array1<f64> {
    let known: Vec<(f64, f64)> =
        at.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite()).collect();
    let spline = (known.len() >= FEWEST).then(|| NaturalSpline::through(&known));
    let gap = |(x, value): (&f64, &f64)| match &spline {
        Some(spline) if !value.is_finite() => spline.value(*x).unwrap_or(f64::NAN),
        _ => f64::NAN,
    };
    at.iter().zip(values.iter()).map(gap).collect()
}

/// A natural cubic spline: second derivative zero at both ends.
#[derive(Debug)]
struct NaturalSpline<'a> {
    points: &'a [(f64, f64)],
    second: Vec<f64>,
}

impl<'a> NaturalSpline<'a> {
    /// The spline through at least two points with ascending abscissae.
    fn through(points: &'a [(f64, f64)]) -> Self {
        let count = points.len();
        let mut second = vec![0.0; count];
        let mut carried = vec![0.0; count];
        // The tridiagonal system for the second derivatives, eliminated forwards, then substituted backwards.
        for k in 1..count.saturating_sub(1) {
            let (before, here, after) = (points[k - 1], points[k], points[k + 1]);
            let share = (here.0 - before.0) / (after.0 - before.0);
            let pivot = share * second[k - 1] + 2.0;
            let bend = (after.1 - here.1) / (after.0 - here.0) - (here.1 - before.1) / (here.0 - before.0);
            second[k] = (share - 1.0) / pivot;
            carried[k] = (6.0 * bend / (after.0 - before.0) - share * carried[k - 1]) / pivot;
        }
        for k in (1..count.saturating_sub(1)).rev() {
            second[k] = second[k] * second[k + 1] + carried[k];
        }
        Self { points, second }
    }

    /// The value between the first and the last point; beyond them there is none.
    fn value(&self, x: f64) -> Option<f64> {
        let after = self.points.partition_point(|point| point.0 < x);
        if after == 0 || after >= self.points.len() {
            return None;
        }
        let ((x0, y0), (x1, y1)) = (self.points[after - 1], self.points[after]);
        let width = x1 - x0;
        let (a, b) = ((x1 - x) / width, (x - x0) / width);
        let bend = (a * a * a - a) * self.second[after - 1] + (b * b * b - b) * self.second[after];
        Some(a * y0 + b * y1 + bend * width * width / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_continued_exactly_and_a_cosine_closely() {
        let line: Vec<_> = [0.0, 1.0, 3.0, 4.0].map(|x| (x, 2.0 * x - 1.0)).to_vec();
        assert!((NaturalSpline::through(&line).value(2.0).unwrap() - 3.0).abs() < 1e-14);
        let degrees = (-8..=8).filter(|step| *step != 3).map(|step| f64::from(step) * 10.0);
        let cosine: Vec<_> = degrees.map(|angle| (angle, angle.to_radians().cos())).collect();
        let value = NaturalSpline::through(&cosine).value(30.0).unwrap();
        assert!((value - 30f64.to_radians().cos()).abs() < 1e-3, "{value}");
    }

    #[test]
    fn nothing_is_extrapolated() {
        let points = [(0.0, 1.0), (1.0, 2.0), (2.0, 2.0), (3.0, 5.0)];
        let spline = NaturalSpline::through(&points);
        assert_eq!((spline.value(-0.1), spline.value(3.1)), (None, None));
    }
}
