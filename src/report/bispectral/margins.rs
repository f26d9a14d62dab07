//! The sums over either axis of a matrix, in numbers of their own meaning: what light of equal energy makes it radiate, and
//! how much of what falls in comes out luminescent.

use super::cells::Cells;
use crate::donaldson::steps;

/// Numbers along an axis with their standard uncertainties.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Margin {
    /// NaN where cells are missing in which light can be.
    pub(super) values: Vec<f64>,
    /// From independent errors of the cells; NaN where they are not known.
    pub(super) sigma: Vec<f64>,
}

/// Luminescent radiance factor under light of equal energy, one per emission: the sum over the excitations of the values over
/// the emission width w that they hold, times the step of the excitation, `sum lum(ex, em) / w(em) step(ex)`. `None` with one excitation,
/// which has no step.
pub(super) fn over_emission(cells: &Cells) -> Option<Margin> {
    let steps = steps(&cells.excitation_nm);
    let rows = cells.excitation_nm.len();
    (rows > 1).then(|| Margin::of(cells.emission_nm.len(), |j| sum(cells, (0..rows).map(|i| ((i, j), steps[i])), j)))
}

/// Luminescent energy out over energy in, one per excitation: `sum lum(ex, em) step(em) / w(em)`. `None` with one emission.
pub(super) fn over_excitation(cells: &Cells) -> Option<Margin> {
    let steps = steps(&cells.emission_nm);
    let columns = cells.emission_nm.len();
    let row = |i: usize| {
        let parts = (0..columns).map(|j| total(cells, std::iter::once(((i, j), steps[j] / cells.width_nm[j]))));
        parts.fold((0.0, 0.0), |(value, variance), part| (value + part.0, variance + part.1))
    };
    (columns > 1).then(|| Margin::of(cells.excitation_nm.len(), row))
}

/// What lies next to the diagonal, summed over the excitations: the reflected radiance factor, with the luminescence of these
/// cells. NaN where the excitation nearest to the emission has no value.
pub(super) fn next_to_diagonal(cells: &Cells) -> Margin {
    let reflected = |j: usize| {
        let nm = cells.emission_nm[j];
        let column = cells.reflected.column(j);
        let near = (0..column.len())
            .min_by(|a, b| (cells.excitation_nm[*a] - nm).abs().total_cmp(&(cells.excitation_nm[*b] - nm).abs()));
        if !near.is_some_and(|i| column[i].is_finite()) {
            return (f64::NAN, f64::NAN);
        }
        let known = (0..column.len()).filter(|i| column[*i].is_finite());
        known
            .fold((0.0, 0.0), |(value, variance), i| (value + column[i], variance + uncertainty(cells, (i, j)).powi(2)))
    };
    Margin::of(cells.emission_nm.len(), reflected)
}

impl Margin {
    /// From values with their variances.
    fn of(count: usize, at: impl Fn(usize) -> (f64, f64)) -> Self {
        let (values, sigma) = (0..count).map(at).map(|(value, variance)| (value, variance.sqrt())).unzip();
        Self { values, sigma }
    }
}

fn sum(cells: &Cells, parts: impl Iterator<Item = ((usize, usize), f64)>, emission: usize) -> (f64, f64) {
    let width = cells.width_nm[emission];
    total(cells, parts.map(|(cell, weight)| (cell, weight / width)))
}

/// The sum of luminescent cells times their weights, and its variance. A cell without value counts as 0 where no light can be,
/// and otherwise leaves the sum unknown.
fn total(cells: &Cells, parts: impl Iterator<Item = ((usize, usize), f64)>) -> (f64, f64) {
    let (mut value, mut variance) = (0.0, 0.0);
    for (cell, weight) in parts {
        let is_dark = cells.emission_nm[cell.1] < cells.excitation_nm[cell.0];
        if cells.luminescent[cell].is_finite() {
            value += weight * cells.luminescent[cell];
            variance += (weight * uncertainty(cells, cell)).powi(2);
        } else if cells.is_missing(cell) && !is_dark {
            return (f64::NAN, f64::NAN);
        }
    }
    (value, variance)
}

/// The standard uncertainty of a cell: the stated one, else the noise where no light can be.
fn uncertainty(cells: &Cells, cell: (usize, usize)) -> f64 {
    cells.sigma.as_ref().map_or(cells.floor.rms, |sigma| sigma[cell])
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::*;
    use crate::donaldson::Floor;

    /// Luminescence of a density in nm-1, wherever emission lies above excitation.
    fn cells(excitation_step: f64, emission_step: f64, width: f64) -> Cells {
        let axis = |from: f64, to: f64, step: f64| -> Vec<f64> {
            (0..).map(|k| from + step * f64::from(k)).take_while(|nm| *nm <= to).collect()
        };
        let (excitation_nm, emission_nm) = (axis(300.0, 400.0, excitation_step), axis(450.0, 650.0, emission_step));
        let shape = (excitation_nm.len(), emission_nm.len());
        let bell = |x: f64, peak: f64| (-((x - peak) / 15.0).powi(2)).exp();
        Cells {
            id: "a".to_owned(),
            luminescent: Array2::from_shape_fn(shape, |(i, j)| {
                1e-3 * width * bell(excitation_nm[i], 350.0) * bell(emission_nm[j], 550.0)
            }),
            reflected: Array2::from_elem(shape, f64::NAN),
            is_marked: Array2::from_elem(shape, false),
            sigma: Some(Array2::from_elem(shape, 1e-4)),
            floor: Floor { rms: f64::NAN, mean: f64::NAN, count: 0 },
            width_nm: vec![width; shape.1],
            excitation_nm,
            emission_nm,
            block: (1, 1),
        }
    }

    #[test]
    fn sums_do_not_depend_on_steps_or_widths() {
        let peak = 15.0 * std::f64::consts::PI.sqrt() * 1e-3;
        for (excitation, emission, width) in [(10.0, 10.0, 10.0), (5.0, 10.0, 10.0), (10.0, 2.0, 4.0), (2.0, 5.0, 1.0)]
        {
            let cells = cells(excitation, emission, width);
            for margin in [over_emission(&cells).unwrap(), over_excitation(&cells).unwrap()] {
                let most = margin.values.iter().copied().fold(0.0, f64::max);
                assert!((most / peak - 1.0).abs() < 1e-3, "{excitation} {emission} {width}: {most} {peak}");
            }
        }
    }

    #[test]
    fn the_uncertainty_of_a_sum_is_that_of_independent_cells() {
        let cells = cells(10.0, 10.0, 10.0);
        let (over_emission, over_excitation) = (over_emission(&cells).unwrap(), over_excitation(&cells).unwrap());
        // Eleven excitations of a step as wide as the emission; twenty-one emissions.
        assert!((over_emission.sigma[3] / (1e-4 * 11f64.sqrt()) - 1.0).abs() < 1e-12, "{over_emission:?}");
        assert!((over_excitation.sigma[3] / (1e-4 * 21f64.sqrt()) - 1.0).abs() < 1e-12, "{over_excitation:?}");
    }

    #[test]
    fn a_missing_cell_leaves_a_gap_in_both_sums_and_nowhere_else() {
        let mut cells = cells(10.0, 10.0, 10.0);
        cells.luminescent[(4, 7)] = f64::NAN;
        let gaps = |margin: Option<Margin>| {
            let values = margin.unwrap().values;
            (0..values.len()).filter(|k| values[*k].is_nan()).collect::<Vec<_>>()
        };
        assert_eq!((gaps(over_emission(&cells)), gaps(over_excitation(&cells))), (vec![7], vec![4]));
        // Where no light can be a missing cell holds none.
        cells.excitation_nm.iter_mut().for_each(|nm| *nm += 500.0);
        assert_eq!((gaps(over_emission(&cells)), gaps(over_excitation(&cells))), (vec![], vec![]));
    }
}
