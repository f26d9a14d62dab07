//! The luminescence of a matrix as a sum of k products excitation x emission, no factor below 0.
//!
//! Next to the diagonal reflected light hides the luminescence: those cells are unknown. A mask alone leaves ranks of 2 and
//! more free to grow there without bound; a weak wish for smooth factors takes that freedom and nothing else.

use nalgebra::{DMatrix, DVector};
use ndarray::Array2;

use super::nonnegative::{add_roughness, inverse_over, minimise};

/// Weight of the squared second differences, relative to the data's: 1 would be as strong as all of them.
const SMOOTH: f64 = 1e-3;
/// Weight that pulls what nothing else determines to 0, relative to the data's.
const RIDGE: f64 = 1e-9;
/// An excitation spectrum of peak 1 is expected to be about so large where a row says nothing.
const EXPECTED: f64 = 0.3;
/// The errors of a row hang together (its dark signal, its monitor): their sum has about so many times the variance of
/// independent ones. Where a row holds little more than that, its excitation is drawn to 0 and not to what its errors look like.
const TOGETHER: f64 = 10.0;
/// Passes over both factors.
const PASSES: usize = 400;
/// A pass that changes no excitation, of which the strongest is 1, by more than this is the last. The cost does not tell: each side
/// has wishes of its own in it.
const SETTLED: f64 = 1e-4;

/// Factors of the luminescence.
#[derive(Debug, Clone, PartialEq)]
pub struct Factors {
    /// Excitation spectra \[k, excitation\], each 1 where its luminescence is strongest.
    pub excitation: Array2<f64>,
    /// Emission spectra \[k, emission\], in the unit of the matrix: its values where the excitation is 1.
    pub emission: Array2<f64>,
    /// Standard uncertainties of both, alike: from the residuals, or from those of the data.
    pub excitation_sigma: Array2<f64>,
    /// Of the emission.
    pub emission_sigma: Array2<f64>,
    /// Root mean square of what is left in the known cells.
    pub rms: f64,
    /// Known cells.
    pub count: usize,
    /// Covariance of all numbers: excitations of each factor, then emissions.
    covariance: DMatrix<f64>,
}

/// Cells that are known, with their weights \[excitation, emission\]; 0 for one that is not.
pub(super) struct Known<'a> {
    pub(super) values: &'a Array2<f64>,
    pub(super) weight: Array2<f64>,
    /// True where a weight is 1/sigma^2 of the data; otherwise the residuals scale the covariance.
    pub(super) has_sigma: bool,
    /// Variance of a value of weight 1; 0 where it is not known.
    pub(super) noise: f64,
}

impl Known<'_> {
    /// Values and weights with excitation and emission changed over.
    fn turned(&self) -> (Array2<f64>, Array2<f64>) {
        (self.values.t().to_owned(), self.weight.t().to_owned())
    }
}

impl Factors {
    /// The best k factors; `None` where the cells do not determine them at all.
    pub(super) fn of(known: &Known<'_>, k: usize) -> Option<Self> {
        let mut start: Option<(DMatrix<f64>, DMatrix<f64>)> = None;
        for rank in 1..=k {
            let (excitation, emission) = grown(known, start.as_ref(), rank);
            start = Some(alternate(known, excitation, emission)?);
        }
        let (excitation, emission) = start?;
        complete(known, excitation, emission)
    }

    /// Factors that were found before, \[k, excitation\] and \[k, emission\], with the covariance that the cells give them; `None` where
    /// they do not fit the cells.
    pub(super) fn given(known: &Known<'_>, excitation: &Array2<f64>, emission: &Array2<f64>) -> Option<Self> {
        let ((k, rows), (other, columns)) = (excitation.dim(), emission.dim());
        let is_number = |value: &f64| value.is_finite() && *value >= 0.0;
        if k == 0 || k != other || (rows, columns) != known.values.dim() {
            return None;
        }
        if !excitation.iter().chain(emission).all(is_number) {
            return None;
        }
        let [x, m] = [excitation, emission].map(|side| DMatrix::from_fn(side.ncols(), k, |i, a| side[(a, i)]));
        complete(known, x, m)
    }

    /// The luminescence of a cell.
    #[must_use]
    pub fn value(&self, excitation: usize, emission: usize) -> f64 {
        let pairs = self.excitation.column(excitation).into_iter().zip(self.emission.column(emission));
        pairs.map(|(x, m)| x * m).sum()
    }

    /// Its standard uncertainty, by the covariance of the factors.
    #[must_use]
    pub fn sigma(&self, excitation: usize, emission: usize) -> f64 {
        let (k, rows) = self.excitation.dim();
        let columns = self.emission.ncols();
        let mut gradient = Vec::with_capacity(2 * k);
        for factor in 0..k {
            gradient.push((factor * rows + excitation, self.emission[(factor, emission)]));
            gradient.push((k * rows + factor * columns + emission, self.excitation[(factor, excitation)]));
        }
        let pairs = gradient.iter().flat_map(|a| gradient.iter().map(move |b| (a, b)));
        pairs.map(|((i, a), (j, b))| a * self.covariance[(*i, *j)] * b).sum::<f64>().max(0.0).sqrt()
    }

    /// The variance of a sum of cells, each times its weight.
    pub(super) fn sum_variance(&self, weight: impl Fn(usize, usize) -> f64) -> f64 {
        let ((k, rows), columns) = (self.excitation.dim(), self.emission.ncols());
        let mut gradient = DVector::zeros(k * (rows + columns));
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let weight = weight(i, j);
            for factor in 0..k {
                gradient[factor * rows + i] += weight * self.emission[(factor, j)];
                gradient[k * rows + factor * columns + j] += weight * self.excitation[(factor, i)];
            }
        }
        gradient.dot(&(&self.covariance * &gradient)).max(0.0)
    }

    /// How many factors.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.excitation.nrows()
    }
}

/// The factors so far and one more, which begins as what they leave above 0.
fn grown(known: &Known<'_>, start: Option<&(DMatrix<f64>, DMatrix<f64>)>, rank: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let (rows, columns) = known.values.dim();
    let (mut excitation, mut emission) = (DMatrix::zeros(rows, rank), DMatrix::zeros(columns, rank));
    if let Some((x, m)) = start {
        excitation.columns_mut(0, rank - 1).copy_from(x);
        emission.columns_mut(0, rank - 1).copy_from(m);
    }
    let mut left = DMatrix::zeros(rows, columns);
    for ((i, j), weight) in known.weight.indexed_iter().filter(|(_, weight)| **weight > 0.0) {
        let product = excitation.row(i).dot(&emission.row(j));
        left[(i, j)] = weight * (known.values[(i, j)] - product).max(0.0);
    }
    let last = rank - 1;
    for i in 0..rows {
        excitation[(i, last)] = left.row(i).sum();
    }
    for j in 0..columns {
        emission[(j, last)] = left.column(j).sum();
    }
    (excitation, emission)
}

/// Alternates between the best excitations of given emissions and the best emissions of given excitations.
fn alternate(
    known: &Known<'_>,
    mut excitation: DMatrix<f64>,
    mut emission: DMatrix<f64>,
) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    let (values, weight) = known.turned();
    let turned = Known { values: &values, weight, ..*known };
    for _ in 0..PASSES {
        normalise(known, &mut excitation, &mut emission);
        let better = best(known, &emission, pull(known))?;
        let change = (&better - &excitation).amax();
        excitation = better;
        normalise(known, &mut excitation, &mut emission);
        emission = best(&turned, &excitation, 0.0)?;
        if change <= SETTLED {
            break;
        }
    }
    normalise(known, &mut excitation, &mut emission);
    Some((excitation, emission))
}

/// What draws excitations to 0: so strong that a row which holds as much as its errors do is halved.
fn pull(known: &Known<'_>) -> f64 {
    TOGETHER * known.noise / EXPECTED.powi(2)
}

/// Each excitation 1 where its luminescence is strongest over the noise. Its largest value may be noise, at an excitation of
/// which the tail of the emission alone is left.
fn normalise(known: &Known<'_>, excitation: &mut DMatrix<f64>, emission: &mut DMatrix<f64>) {
    for k in 0..excitation.ncols() {
        let peak = excitation[(strongest(known, excitation, emission, k), k)];
        if peak > 0.0 {
            excitation.column_mut(k).scale_mut(peak.recip());
            emission.column_mut(k).scale_mut(peak);
        }
    }
}

/// The excitation whose known cells hold most of a factor.
fn strongest(known: &Known<'_>, excitation: &DMatrix<f64>, emission: &DMatrix<f64>, k: usize) -> usize {
    let mut held = vec![0.0; excitation.nrows()];
    for ((i, j), weight) in cells(known) {
        held[i] += weight * (excitation[(i, k)] * emission[(j, k)]).powi(2);
    }
    (0..held.len()).max_by(|a, b| held[*a].total_cmp(&held[*b])).unwrap_or(0)
}

/// The best factor of one side, given that of the other.
fn best(known: &Known<'_>, other: &DMatrix<f64>, ridge: f64) -> Option<DMatrix<f64>> {
    let (q, g) = normal(known, other, ridge);
    let found = minimise(&q, &g)?;
    Some(DMatrix::from_fn(known.values.nrows(), other.ncols(), |i, c| found[i * other.ncols() + c]))
}

/// The normal equations of one side: unknowns row by row, k in each.
fn normal(known: &Known<'_>, other: &DMatrix<f64>, ridge: f64) -> (DMatrix<f64>, DVector<f64>) {
    let (rows, k) = (known.values.nrows(), other.ncols());
    let mut q = DMatrix::zeros(rows * k, rows * k);
    let mut g = DVector::zeros(rows * k);
    for ((i, j), weight) in cells(known) {
        for a in 0..k {
            g[i * k + a] += weight * known.values[(i, j)] * other[(j, a)];
            for b in 0..k {
                q[(i * k + a, i * k + b)] += weight * other[(j, a)] * other[(j, b)];
            }
        }
    }
    for a in 0..k {
        // What a row with every cell would weigh.
        let whole = mean_weight(known) * other.column(a).norm_squared();
        add_roughness(&mut q, rows, k, a, SMOOTH * whole);
        (0..rows).for_each(|i| q[(i * k + a, i * k + a)] += ridge + RIDGE * whole.max(f64::MIN_POSITIVE));
    }
    (q, g)
}

fn cells<'a>(known: &'a Known<'_>) -> impl Iterator<Item = ((usize, usize), f64)> + 'a {
    known.weight.indexed_iter().map(|(at, weight)| (at, *weight)).filter(|(_, weight)| *weight > 0.0)
}

fn mean_weight(known: &Known<'_>) -> f64 {
    let (sum, count) = cells(known).fold((0.0, 0), |(sum, count), (_, weight)| (sum + weight, count + 1));
    sum / f64::from(count.max(1))
}

/// What is left, and the covariance: the inverse of the curvature of both sides together. The scale between the two sides of
/// a factor is fixed where the excitation is 1, which has no uncertainty; neither has what ended at 0.
fn complete(known: &Known<'_>, excitation: DMatrix<f64>, emission: DMatrix<f64>) -> Option<Factors> {
    let ((rows, columns), k) = (known.values.dim(), excitation.ncols());
    let (values, weight) = known.turned();
    let turned = Known { values: &values, weight, ..*known };
    let (q_excitation, _) = normal(known, &emission, pull(known));
    let (q_emission, _) = normal(&turned, &excitation, 0.0);
    let size = k * (rows + columns);
    let x = |factor: usize, i: usize| factor * rows + i;
    let m = |factor: usize, j: usize| k * rows + factor * columns + j;
    let mut q = DMatrix::zeros(size, size);
    for a in 0..k {
        for b in 0..k {
            for (i, other) in (0..rows).flat_map(|i| (0..rows).map(move |other| (i, other))) {
                q[(x(a, i), x(b, other))] = q_excitation[(i * k + a, other * k + b)];
            }
            for (j, other) in (0..columns).flat_map(|j| (0..columns).map(move |other| (j, other))) {
                q[(m(a, j), m(b, other))] = q_emission[(j * k + a, other * k + b)];
            }
        }
    }
    let (mut square, mut sum, mut count) = (0.0, 0.0, 0_usize);
    for ((i, j), weight) in cells(known) {
        for (a, b) in (0..k).flat_map(|a| (0..k).map(move |b| (a, b))) {
            let mixed = weight * emission[(j, a)] * excitation[(i, b)];
            q[(x(a, i), m(b, j))] += mixed;
            q[(m(b, j), x(a, i))] += mixed;
        }
        let residual = known.values[(i, j)] - excitation.row(i).dot(&emission.row(j));
        square += residual * residual;
        sum += weight * residual * residual;
        count += 1;
    }
    let fixed: Vec<usize> = (0..k).map(|factor| strongest(known, &excitation, &emission, factor)).collect();
    let is_free = |index: usize| {
        let (factor, i) = (index / rows, index % rows);
        if index < k * rows {
            excitation[(i, factor)] > 0.0 && i != fixed[factor]
        } else {
            emission[((index - k * rows) % columns, (index - k * rows) / columns)] > 0.0
        }
    };
    let free: Vec<usize> = (0..size).filter(|index| is_free(*index)).collect();
    let freedom = (count as f64 - free.len() as f64).max(1.0);
    let unit = if known.has_sigma { 1.0 } else { sum / freedom };
    let covariance = inverse_over(&q, &free)? * unit;
    // What ended at 0 is known to be small: by how much, its own curvature says.
    let deviation = |index: usize| match covariance[(index, index)] {
        variance if variance > 0.0 => variance.sqrt(),
        _ if fixed.iter().enumerate().any(|(factor, i)| index == x(factor, *i)) => 0.0,
        _ => (unit / q[(index, index)]).max(0.0).sqrt(),
    };
    Some(Factors {
        excitation: Array2::from_shape_fn((k, rows), |(a, i)| excitation[(i, a)]),
        emission: Array2::from_shape_fn((k, columns), |(a, j)| emission[(j, a)]),
        excitation_sigma: Array2::from_shape_fn((k, rows), |(a, i)| deviation(x(a, i))),
        emission_sigma: Array2::from_shape_fn((k, columns), |(a, j)| deviation(m(a, j))),
        rms: (square / count.max(1) as f64).sqrt(),
        count,
        covariance,
    })
}
