//! Which cells hold reflected light beside luminescence, and how noisy a matrix is where no light can be.

use super::Matrix;
use super::matrix::steps;

/// How many steps below the excitation physics leaves nothing: further than any bandpass and than the thermal tail of the
/// emission, which reaches some 25 nm.
const DARK_STEPS: f64 = 3.0;
/// An offset whose values are this much above the floor in the median holds reflected light.
const LEAK: f64 = 3.0;

/// Where reflected light is.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlap {
    /// Reflected light reaches cells whose emission is less than this from the excitation, nm, one for each excitation.
    pub reach_nm: Vec<f64>,
    /// True where both bandpasses are stated; otherwise it was found in the values below the excitation.
    pub is_stated: bool,
}

impl Overlap {
    /// By the stated bandpasses: triangles of these half widths meet within the sum of both (see
    /// [`crate::quantity::Cell::is_diagonal`]). Without them, as far below the excitation as the values rise above the floor: what
    /// is there is no luminescence, and the bandpass is as wide on the other side.
    #[must_use]
    pub fn of(matrix: &Matrix) -> Self {
        if let (Some(excitation), Some(emission)) = (&matrix.excitation_fwhm_nm, &matrix.emission_fwhm_nm) {
            let widest = emission.iter().copied().fold(0.0, f64::max);
            return Self { reach_nm: excitation.iter().map(|width| width + widest).collect(), is_stated: true };
        }
        let step = median(steps(&matrix.emission_nm)).max(median(steps(&matrix.excitation_nm)));
        let medians = |from: f64, to: f64| median(below(matrix, from, to).map(|(_, value)| value.abs()).collect());
        let floor = medians(DARK_STEPS * step, f64::INFINITY);
        let mut steps_reached = 0.5;
        // Half a step to either side of each offset.
        for offset in [1.0, 2.0] {
            if medians((offset - 0.5) * step, (offset + 0.5) * step) > LEAK * floor {
                steps_reached = offset + 0.5;
            } else {
                break;
            }
        }
        Self { reach_nm: vec![steps_reached * step; matrix.excitation_nm.len()], is_stated: false }
    }

    /// True where a cell may hold reflected light.
    #[must_use]
    pub fn holds(&self, matrix: &Matrix, excitation: usize, emission: usize) -> bool {
        (matrix.emission_nm[emission] - matrix.excitation_nm[excitation]).abs() < self.reach_nm[excitation]
    }
}

impl Overlap {
    /// How often a cell counts when reflected light is summed at its emission: where the axis of the excitation ends, what its other side
    /// would hold is what this side holds. 0 where the cell holds none, or no value.
    pub(super) fn times(&self, matrix: &Matrix, excitation: usize, emission: usize) -> f64 {
        if self.holds(matrix, excitation, emission) { times_at_the_end(matrix, excitation, emission) } else { 0.0 }
    }
}

/// How often a cell next to the diagonal counts, see [`Overlap::times`].
pub(super) fn times_at_the_end(matrix: &Matrix, excitation: usize, emission: usize) -> f64 {
    if !matrix.values[(excitation, emission)].is_finite() {
        return 0.0;
    }
    let nm = &matrix.excitation_nm;
    let twin = 2.0 * matrix.emission_nm[emission] - nm[excitation];
    if twin < nm[0] || twin > nm[nm.len() - 1] { 2.0 } else { 1.0 }
}

/// The noise of a matrix where no light can be: emission well below the excitation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Root mean square of the values; NaN where there are none.
    pub rms: f64,
    /// Their mean: a stray light or an offset that is not subtracted.
    pub mean: f64,
    /// How many.
    pub count: usize,
}

impl Floor {
    /// The floor of a matrix.
    #[must_use]
    pub fn of(matrix: &Matrix, overlap: &Overlap) -> Self {
        Self::over(dark(matrix, overlap).map(|(_, value)| value))
    }

    /// The floor of each excitation alone; of those below all emissions there is none.
    pub(super) fn of_rows(matrix: &Matrix, overlap: &Overlap) -> Vec<Self> {
        let mut rows = vec![Vec::new(); matrix.excitation_nm.len()];
        dark(matrix, overlap).for_each(|(row, value)| rows[row].push(value));
        rows.into_iter().map(|values| Self::over(values.into_iter())).collect()
    }

    /// By how much the standard uncertainty of a sum over emissions is larger than that of independent errors, where no light can be:
    /// what a row has in common (its dark signal, its monitor) does not average out. 1 where too little says it.
    pub(super) fn together(matrix: &Matrix, overlap: &Overlap) -> f64 {
        let rows: Vec<Self> = Self::of_rows(matrix, overlap).into_iter().filter(|row| row.count > 1).collect();
        let sums: f64 = rows.iter().map(|row| (row.mean * row.count as f64).powi(2)).sum();
        let squares: f64 = rows.iter().map(|row| row.rms.powi(2) * row.count as f64).sum();
        if rows.len() > 3 && squares > 0.0 { (sums / squares).sqrt().max(1.0) } else { 1.0 }
    }

    fn over(values: impl Iterator<Item = f64>) -> Self {
        let (mut count, mut sum, mut square) = (0, 0.0, 0.0);
        for value in values {
            (count, sum, square) = (count + 1, sum + value, square + value * value);
        }
        Self { rms: (square / count as f64).sqrt(), mean: sum / count as f64, count }
    }
}

/// The values where no light can be, each with its row.
fn dark<'a>(matrix: &'a Matrix, overlap: &'a Overlap) -> impl Iterator<Item = (usize, f64)> + 'a {
    let step = median(steps(&matrix.emission_nm)).max(median(steps(&matrix.excitation_nm)));
    below(matrix, 0.0, f64::INFINITY)
        .filter(move |((row, column), _)| {
            let from = overlap.reach_nm[*row].max(DARK_STEPS * step);
            matrix.excitation_nm[*row] - matrix.emission_nm[*column] >= from
        })
        .map(|((row, _), value)| (row, value))
}

/// The values whose emission lies that far below their excitation, in nm.
fn below(matrix: &Matrix, from: f64, to: f64) -> impl Iterator<Item = ((usize, usize), f64)> {
    matrix.values.indexed_iter().map(|(at, value)| (at, *value)).filter(move |((row, column), value)| {
        let distance = matrix.excitation_nm[*row] - matrix.emission_nm[*column];
        value.is_finite() && distance >= from && distance < to && distance > 0.0
    })
}

/// The median; NaN of nothing.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return f64::NAN;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
