//! The paper's check (its Figs 3 and 4): is the factor a function of incidence times a function of viewing, the first
//! a cosine and the second a constant?

use std::collections::BTreeMap;

use crate::dataset::{Reduced, Separability};
use crate::quantity::Reference;

/// Passes of alternating least squares for the best product f(theta_i) g(theta_v); it converges linearly and fast.
const PASSES: usize = 60;

/// One cell of the angle table.
#[derive(Debug, Clone, Copy)]
struct Cell {
    incidence: usize,
    viewing: usize,
    /// Value times what the reference received: Y/E.
    value: f64,
}

/// Why the check is not made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotSeparable {
    /// A geometry leaves the plane, or fewer than three angles of incidence or of viewing were measured.
    #[error("separability: the geometries are no table of in-plane angles")]
    NoTable,
    /// What the departures are counted in is 0 or no number.
    #[error("separability: undefined, because {0}")]
    Undefined(&'static str),
}

/// The check over data whose geometries all lie in the plane, at three angles of incidence and of viewing or more. Several
/// emission values are averaged first.
///
/// The second average is taken after division by the fitted cosine: the retro gap lacks another incidence angle for
/// every viewing angle, so that a plain average over incidence would not be constant even for a perfect diffuser.
///
/// # Errors
/// [`NotSeparable`] when there is no such table, or nothing that a departure could be relative to.
pub fn separability(data: &Reduced, reference: &Reference) -> Result<Separability, NotSeparable> {
    let mut raw = Vec::with_capacity(data.geometry.len());
    for (row, geometry) in data.geometry.iter().enumerate() {
        let (theta_i, theta_v) = geometry.signed_deg().ok_or(NotSeparable::NoTable)?;
        let column = data.values.column(row);
        let mean = column.sum() / column.len() as f64;
        let lit = reference.lit_fraction(geometry).map_err(|_| NotSeparable::NoTable)?;
        if mean.is_finite() {
            raw.push((theta_i, theta_v, mean * lit));
        }
    }
    let theta_i_deg = distinct(raw.iter().map(|cell| cell.0));
    let theta_v_deg = distinct(raw.iter().map(|cell| cell.1));
    if theta_i_deg.len() < 3 || theta_v_deg.len() < 3 {
        return Err(NotSeparable::NoTable);
    }
    let index = |list: &[f64], angle: f64| list.iter().position(|a| *a == angle);
    let cells: Vec<Cell> = raw
        .iter()
        .filter_map(|&(i, v, value)| {
            Some(Cell { incidence: index(&theta_i_deg, i)?, viewing: index(&theta_v_deg, v)?, value })
        })
        .collect();
    if cells.iter().all(|cell| cell.value == 0.0) {
        return Err(NotSeparable::Undefined("every value of the table is 0"));
    }
    defined(check(theta_i_deg, theta_v_deg, &cells))
}

/// The check where each of its numbers is one.
fn defined(check: Separability) -> Result<Separability, NotSeparable> {
    let numbers = [
        (check.cosine_relative_rms, "the average over viewing has no part that follows a cosine"),
        (check.constancy_relative_rms, "the average over incidence is 0"),
        (check.rank_one_relative_rms, "the values have no finite mean square"),
    ];
    match numbers.into_iter().find(|(number, _)| !number.is_finite()) {
        Some((_, reason)) => Err(NotSeparable::Undefined(reason)),
        None => Ok(check),
    }
}

fn check(theta_i_deg: Vec<f64>, theta_v_deg: Vec<f64>, cells: &[Cell]) -> Separability {
    let cosine: Vec<f64> = theta_i_deg.iter().map(|theta| crate::quantity::cos_deg(*theta)).collect();
    let (mean_over_viewing, spread_over_viewing) =
        averages(theta_i_deg.len(), cells.iter().map(|cell| (cell.incidence, cell.value)));
    let product: f64 = cosine.iter().zip(&mean_over_viewing).map(|(c, mean)| c * mean).sum();
    let amplitude = product / cosine.iter().map(|c| c * c).sum::<f64>();
    let departure = cosine.iter().zip(&mean_over_viewing).map(|(c, mean)| mean - amplitude * c);
    let cosine_relative_rms = root_mean_square(departure) / amplitude.abs();
    // At 90 degrees nothing is received and the ratio says nothing.
    let normalised = cells
        .iter()
        .filter(|cell| cosine[cell.incidence] > 0.0)
        .map(|cell| (cell.viewing, cell.value / (amplitude * cosine[cell.incidence])));
    let (mean_over_incidence, spread_over_incidence) = averages(theta_v_deg.len(), normalised);
    let known: Vec<f64> = mean_over_incidence.iter().copied().filter(|mean| mean.is_finite()).collect();
    let level = known.iter().sum::<f64>() / known.len() as f64;
    let constancy_relative_rms = root_mean_square(known.iter().map(|mean| mean - level)) / level.abs();
    let rank_one_relative_rms = rank_one_residual(cells, theta_i_deg.len(), theta_v_deg.len());
    Separability {
        theta_i_deg,
        mean_over_viewing,
        spread_over_viewing,
        theta_v_deg,
        mean_over_incidence,
        spread_over_incidence,
        cosine_amplitude: amplitude,
        cosine_relative_rms,
        constancy_relative_rms,
        rank_one_relative_rms,
    }
}

/// Ascending distinct angles.
fn distinct(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut list: Vec<f64> = angles.collect();
    list.sort_by(f64::total_cmp);
    list.dedup();
    list
}

/// Mean and standard deviation per group; NaN for a group without members.
fn averages(groups: usize, members: impl Iterator<Item = (usize, f64)>) -> (Vec<f64>, Vec<f64>) {
    let mut lists: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (group, value) in members {
        lists.entry(group).or_default().push(value);
    }
    (0..groups)
        .map(|group| {
            let Some(list) = lists.get(&group) else { return (f64::NAN, f64::NAN) };
            let mean = list.iter().sum::<f64>() / list.len() as f64;
            let square: f64 = list.iter().map(|value| (value - mean).powi(2)).sum();
            (mean, (square / (list.len().max(2) - 1) as f64).sqrt())
        })
        .unzip()
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value * value, count + 1));
    (sum / count as f64).sqrt()
}

/// What the best product f(theta_i) g(theta_v) leaves of the measured cells, relative to their r.m.s.; cells that were
/// not measured have no say.
fn rank_one_residual(cells: &[Cell], incidences: usize, viewings: usize) -> f64 {
    let (mut f, mut g) = (vec![1.0; incidences], vec![1.0; viewings]);
    for _ in 0..PASSES {
        project(&mut f, cells.iter().map(|cell| (cell.incidence, g[cell.viewing], cell.value)));
        let fixed = f.clone();
        project(&mut g, cells.iter().map(|cell| (cell.viewing, fixed[cell.incidence], cell.value)));
    }
    let left = root_mean_square(cells.iter().map(|cell| cell.value - f[cell.incidence] * g[cell.viewing]));
    left / root_mean_square(cells.iter().map(|cell| cell.value))
}

/// Least squares for each factor of one side, the other side fixed.
fn project(side: &mut [f64], members: impl Iterator<Item = (usize, f64, f64)>) {
    let mut sums = vec![(0.0, 0.0); side.len()];
    for (group, other, value) in members {
        sums[group].0 += other * value;
        sums[group].1 += other * other;
    }
    for (factor, (product, square)) in side.iter_mut().zip(sums) {
        *factor = if square > 0.0 { product / square } else { 0.0 };
    }
}
