//! Numbers over the two signed in-plane angles.

use ndarray::Array2;

use super::{AnglePoints, ReportError};

/// The most cells that a map draws.
const CELL_LIMIT: usize = 40_000;

/// Numbers over signed in-plane angles (`mirror-at-equal`, degrees), as a table with gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleMap {
    /// Incidence, degrees, ascending.
    pub theta_i_deg: Vec<f64>,
    /// Viewing, degrees, ascending.
    pub theta_v_deg: Vec<f64>,
    /// Values \[incidence, viewing\]; NaN is a gap.
    pub values: Array2<f64>,
    /// The quantity, in words.
    pub label: String,
    /// Its unit, `1` for none.
    pub unit: String,
}

impl AngleMap {
    /// Sorts numbers, one per geometry, into a table; several in one cell are averaged, what is not finite is left out.
    ///
    /// # Errors
    /// [`ReportError`] when nothing is finite, when directions leave the plane, or when there are too many cells.
    pub fn from_points(
        points: &AnglePoints,
        values: &[f64],
        label: impl Into<String>,
        unit: impl Into<String>,
    ) -> Result<Self, ReportError> {
        let label = label.into();
        let angles = signed_angles(points, values, &label)?;
        let theta_i_deg = distinct(angles.iter().map(|(i, _, _)| *i));
        let theta_v_deg = distinct(angles.iter().map(|(_, v, _)| *v));
        let (incidences, viewings) = (theta_i_deg.len(), theta_v_deg.len());
        if incidences.saturating_mul(viewings) > CELL_LIMIT {
            return Err(ReportError::TooManyCells { figure: label, incidences, viewings, limit: CELL_LIMIT });
        }
        let mut sums = Array2::zeros((incidences, viewings));
        let mut counts = Array2::<f64>::zeros((incidences, viewings));
        for (i, v, value) in angles {
            let at = (index_of(&theta_i_deg, i), index_of(&theta_v_deg, v));
            sums[at] += value;
            counts[at] += 1.0;
        }
        // 0/0 is NaN: a cell without a number is a gap.
        Ok(Self { theta_i_deg, theta_v_deg, values: sums / counts, label, unit: unit.into() })
    }

    /// True where source and detector have the same direction: left out by design.
    #[must_use]
    pub fn is_retro(&self, incidence: usize, viewing: usize) -> bool {
        (self.theta_i_deg[incidence] + self.theta_v_deg[viewing]).abs() < 1e-6
    }

    /// The finite values.
    pub fn finite(&self) -> impl Iterator<Item = f64> {
        self.values.iter().copied().filter(|value| value.is_finite())
    }

    /// How many cells are gaps: (in the retro direction, elsewhere).
    #[must_use]
    pub fn gaps(&self) -> (usize, usize) {
        let gaps = self.values.indexed_iter().filter(|(_, value)| !value.is_finite());
        let (retro, other): (Vec<_>, Vec<_>) = gaps.partition(|((i, v), _)| self.is_retro(*i, *v));
        (retro.len(), other.len())
    }

    /// Checks that the table has the shape of its axes and something to draw.
    pub(super) fn check(&self) -> Result<(), ReportError> {
        let figure = || self.label.clone();
        let (expected, found) = (self.theta_i_deg.len() * self.theta_v_deg.len(), self.values.len());
        if self.values.shape() != [self.theta_i_deg.len(), self.theta_v_deg.len()] {
            return Err(ReportError::Lengths { figure: figure(), what: "values", found, expected });
        }
        if self.finite().next().is_none() {
            return Err(ReportError::Empty { figure: figure() });
        }
        Ok(())
    }
}

fn signed_angles(points: &AnglePoints, values: &[f64], figure: &str) -> Result<Vec<(f64, f64, f64)>, ReportError> {
    points.check(figure)?;
    let total = points.geometry.len();
    if values.len() != total {
        let (figure, found) = (figure.to_owned(), values.len());
        return Err(ReportError::Lengths { figure, what: "values", found, expected: total });
    }
    let signed: Vec<Option<(f64, f64)>> = points.geometry.iter().map(|geometry| geometry.signed_deg()).collect();
    let outside = signed.iter().filter(|angles| angles.is_none()).count();
    if outside > 0 {
        return Err(ReportError::NotInPlane { figure: figure.to_owned(), outside, total });
    }
    let finite = signed.into_iter().flatten().zip(values).filter(|(_, value)| value.is_finite());
    let angles: Vec<_> = finite.map(|((i, v), value)| (i, v, *value)).collect();
    if angles.is_empty() { Err(ReportError::Empty { figure: figure.to_owned() }) } else { Ok(angles) }
}

/// The different numbers, ascending.
fn distinct(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = numbers.collect();
    sorted.sort_by(f64::total_cmp);
    // Positive and negative zero are one angle.
    sorted.dedup_by(|a, b| *a == *b);
    sorted
}

fn index_of(sorted: &[f64], number: f64) -> usize {
    sorted.partition_point(|candidate| *candidate < number)
}
