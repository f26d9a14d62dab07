//! The elastic and the luminescent part of a matrix.
//!
//! Next to the diagonal, as far as both bandpasses meet, a cell holds both. What the factors of the other cells say is
//! luminescence there; the rest is reflected light, which the bandpass spreads over neighbouring cells and which is
//! summed up again at its emission wavelength, so that a flat light gives the same spectrum before and after.

use ndarray::Array2;

use super::Matrix;
use super::balance::{Balance, balance};
use super::factors::{Factors, Known};
use super::overlap::{Floor, Overlap};

/// Ranks that are tried.
const MOST: usize = 4;
/// A residual of so many floors is noise: where light is there is more of it than where none is.
const AT_THE_FLOOR: f64 = 2.0;

/// So many dark cells say how noisy an excitation is.
const FEWEST_DARK: usize = 4;

/// What a separation is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Separate {
    /// How many factors; without it as few as leave no more than noise.
    pub rank: Option<usize>,
}

/// A separated matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Separated {
    /// Where reflected light is.
    pub overlap: Overlap,
    /// The noise where no light can be.
    pub floor: Floor,
    /// Factors of the luminescence.
    pub factors: Factors,
    /// Ranks that were tried, each with the root mean square of what it leaves in the known cells.
    pub tried: Vec<(usize, f64)>,
    /// Radiance factor of the elastic part, one per emission; NaN where no excitation is near enough.
    pub elastic: Vec<f64>,
    /// Its standard uncertainty.
    pub elastic_sigma: Vec<f64>,
    /// Luminescent part \[excitation, emission\]: what was measured where no reflected light is, negative noise included; what the
    /// factors say where there is, and 0 there below the excitation.
    pub luminescent: Array2<f64>,
    /// Its standard uncertainty.
    pub luminescent_sigma: Array2<f64>,
    /// Photons and energy out over in.
    pub balance: Vec<Balance>,
    /// Findings in words.
    pub findings: Vec<String>,
}

/// Why a matrix cannot be separated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotSeparated {
    /// No cell holds luminescence alone.
    #[error(
        "no cell of the matrix lies clear of the reflected light (bandpasses of up to {reach_nm} nm together): nothing says \
         what is luminescent"
    )]
    NothingClear {
        /// How far reflected light reaches, nm.
        reach_nm: f64,
    },
    /// A rank that makes no sense for this matrix.
    #[error("rank {rank}; expected 1 to {most}")]
    Rank {
        /// The rank asked for.
        rank: usize,
        /// The largest.
        most: usize,
    },
    /// No factors.
    #[error("the cells off the diagonal determine no factors: too few of them hold a value")]
    Undetermined,
}

/// Separates a matrix.
///
/// # Errors
/// [`NotSeparated`].
pub fn separate(matrix: &Matrix, asked: Separate) -> Result<Separated, NotSeparated> {
    let overlap = Overlap::of(matrix);
    let floor = Floor::of(matrix, &overlap);
    let known = known(matrix, &overlap, floor);
    let clear = known.weight.iter().filter(|weight| **weight > 0.0).count();
    if clear < matrix.excitation_nm.len() + matrix.emission_nm.len() {
        let reach_nm = overlap.reach_nm.iter().copied().fold(0.0, f64::max);
        return Err(NotSeparated::NothingClear { reach_nm });
    }
    if let Some(rank) = asked.rank.filter(|rank| !(1..=MOST).contains(rank)) {
        return Err(NotSeparated::Rank { rank, most: MOST });
    }
    let (factors, tried) = choose(&known, floor, asked.rank).ok_or(NotSeparated::Undetermined)?;
    Ok(separated_by(matrix, overlap, floor, factors, tried))
}

/// The parts that follow from factors.
pub(super) fn separated_by(
    matrix: &Matrix,
    overlap: Overlap,
    floor: Floor,
    factors: Factors,
    tried: Vec<(usize, f64)>,
) -> Separated {
    let noise = |at: (usize, usize)| {
        let stated = matrix.sigma.as_ref().map(|sigma| sigma[at]).filter(|sigma| sigma.is_finite());
        stated.unwrap_or(if floor.rms.is_finite() { floor.rms.max(factors.rms) } else { factors.rms })
    };
    let shape = matrix.values.dim();
    let is_inside = |(row, column): (usize, usize)| overlap.holds(matrix, row, column);
    let is_stokes = |(row, column): (usize, usize)| matrix.emission_nm[column] >= matrix.excitation_nm[row];
    let luminescent = Array2::from_shape_fn(shape, |at| match (is_inside(at), is_stokes(at)) {
        (true, true) => factors.value(at.0, at.1),
        (true, false) => 0.0,
        (false, _) => matrix.values[at],
    });
    let luminescent_sigma = Array2::from_shape_fn(shape, |at| match (is_inside(at), is_stokes(at)) {
        (true, true) => factors.sigma(at.0, at.1).hypot(factors.rms),
        (_, _) => noise(at),
    });
    let (mut elastic, mut elastic_sigma) = (Vec::new(), Vec::new());
    for column in 0..shape.1 {
        let cells: Vec<(usize, usize)> = (0..shape.0).map(|row| (row, column)).filter(|at| is_inside(*at)).collect();
        // The cell of the wavelength itself holds nearly all of it; without that one nothing is known.
        let own = cells.iter().any(|at| {
            matrix.values[*at].is_finite()
                && (matrix.excitation_nm[at.0] - matrix.emission_nm[column]).abs() <= overlap.reach_nm[at.0] / 2.0
        });
        let times = |at: (usize, usize)| overlap.times(matrix, at.0, at.1);
        let usable = || cells.iter().copied().filter(|at| matrix.values[*at].is_finite());
        let sum: f64 = usable().map(|at| times(at) * (matrix.values[at] - luminescent[at])).sum();
        let variance: f64 =
            usable().map(|at| times(at).powi(2) * (noise(at).powi(2) + luminescent_sigma[at].powi(2))).sum();
        elastic.push(if own { sum } else { f64::NAN });
        elastic_sigma.push(if own { variance.sqrt() } else { f64::NAN });
    }
    let reflectance = |nm: f64| {
        let column = matrix.emission_nm.iter().position(|emission| (emission - nm).abs() < 1e-6)?;
        elastic[column].is_finite().then(|| (elastic[column], elastic_sigma[column]))
    };
    let together = if matrix.sigma.is_none() { Floor::together(matrix, &overlap) } else { 1.0 };
    let balance = balance(matrix, |i, j| (luminescent[(i, j)], luminescent_sigma[(i, j)]), together, reflectance);
    let mut separated = Separated {
        overlap,
        floor,
        factors,
        tried,
        elastic,
        elastic_sigma,
        luminescent,
        luminescent_sigma,
        balance,
        findings: Vec::new(),
    };
    separated.findings = findings(matrix, &separated);
    separated
}

/// The cells that hold luminescence alone. Where no uncertainty is stated, an excitation whose dark cells are noisier than those of the
/// matrix weighs less by as much: an offset of a whole row would be taken for luminescence.
pub(super) fn known<'a>(matrix: &'a Matrix, overlap: &Overlap, floor: Floor) -> Known<'a> {
    let is_clear = |row: usize, column: usize| {
        matrix.emission_nm[column] > matrix.excitation_nm[row] && !overlap.holds(matrix, row, column)
    };
    let of_row: Vec<f64> = Floor::of_rows(matrix, overlap)
        .iter()
        .map(|row| if row.count >= FEWEST_DARK && row.rms > floor.rms { (floor.rms / row.rms).powi(2) } else { 1.0 })
        .collect();
    let weight = |at: (usize, usize)| match &matrix.sigma {
        _ if !is_clear(at.0, at.1) || !matrix.values[at].is_finite() => 0.0,
        None => of_row[at.0],
        Some(sigma) if sigma[at] > 0.0 && sigma[at].is_finite() => sigma[at].powi(-2),
        Some(_) => 0.0,
    };
    Known {
        values: &matrix.values,
        weight: Array2::from_shape_fn(matrix.values.dim(), weight),
        has_sigma: matrix.sigma.is_some(),
        noise: match &matrix.sigma {
            Some(_) => 1.0,
            None if floor.rms.is_finite() => floor.rms.powi(2),
            None => 0.0,
        },
    }
}

/// As few factors as leave no more than noise, with what each rank that was tried leaves.
fn choose(known: &Known<'_>, floor: Floor, asked: Option<usize>) -> Option<(Factors, Vec<(usize, f64)>)> {
    let (mut tried, mut best): (Vec<(usize, f64)>, Option<Factors>) = (Vec::new(), None);
    // What is stated of the cells is noise as well: a matrix without any below the excitation may still be uncertain.
    let stated: Vec<f64> = known.weight.iter().filter(|weight| **weight > 0.0).map(|weight| weight.recip()).collect();
    let stated = if known.has_sigma { (stated.iter().sum::<f64>() / stated.len() as f64).sqrt() } else { 0.0 };
    let noise = stated.max(floor.rms);
    for rank in asked.map_or(1..=MOST, |rank| rank..=rank) {
        let Some(factors) = Factors::of(known, rank) else { break };
        tried.push((rank, factors.rms));
        // A factor more that leaves nearly as much fits noise.
        let helps = best.as_ref().is_none_or(|best: &Factors| factors.rms < 0.8 * best.rms);
        let is_noise = factors.rms <= AT_THE_FLOOR * noise;
        if helps {
            best = Some(factors);
        }
        if is_noise || !helps {
            break;
        }
    }
    Some((best?, tried))
}

/// Root mean square of the cells that could hold luminescence alone, and how many there are.
fn held(matrix: &Matrix, overlap: &Overlap) -> (f64, usize) {
    let clear = matrix.values.indexed_iter().filter(|((i, j), value)| {
        value.is_finite() && matrix.emission_nm[*j] > matrix.excitation_nm[*i] && !overlap.holds(matrix, *i, *j)
    });
    let (square, count) = clear.fold((0.0, 0), |(square, count), (_, value)| (square + value * value, count + 1));
    ((square / f64::from(count.max(1) as u32)).sqrt(), count)
}

fn findings(matrix: &Matrix, separated: &Separated) -> Vec<String> {
    let mut list = Vec::new();
    let Separated { overlap, floor, factors, .. } = separated;
    let reach = overlap.reach_nm.iter().copied().fold(0.0, f64::max);
    if !overlap.is_stated {
        list.push(format!(
            "the bandpasses are unstated: reflected light was found within {reach} nm of the excitation, where values below \
             it rise above the noise"
        ));
    }
    if matrix.emission_fwhm_nm.is_none() {
        list.push(
            "the emission width is unstated: luminescent values are taken as sums over one step of the emission axis"
                .to_owned(),
        );
    }
    if floor.count == 0 {
        list.push("no cell lies well below its excitation: the noise of the matrix is not known".to_owned());
    } else if factors.rms > AT_THE_FLOOR * floor.rms {
        list.push(format!(
            "{} factors leave {:.2e} in the luminescent cells, {:.1} times the noise where no light can be ({:.2e}): the \
             matrix is not a sum of so few products",
            factors.rank(),
            factors.rms,
            factors.rms / floor.rms,
            floor.rms
        ));
    }
    let (held, cells) = held(matrix, overlap);
    if floor.count > 0 && cells > 0 && held <= AT_THE_FLOOR * floor.rms {
        list.push(format!(
            "no luminescence above the noise: the cells that could hold it have {held:.2e} (root mean square), those where no light can be \
             {:.2e}; the factor is what noise looks like",
            floor.rms
        ));
    }
    let negative = separated.elastic.iter().zip(&separated.elastic_sigma).filter(|(x, sigma)| **x < -3.0 * **sigma);
    let negative = negative.count();
    if negative > 0 {
        list.push(format!(
            "the elastic part is below 0 by more than three standard uncertainties at {negative} wavelengths"
        ));
    }
    let worst = |of: fn(&Balance) -> super::balance::Share| {
        let scores = separated.balance.iter().map(|balance| (balance.excitation_nm, of(balance)));
        scores.max_by(|a, b| a.1.value.total_cmp(&b.1.value))
    };
    for (what, of) in [
        ("photons", (|balance| balance.photons) as fn(&Balance) -> super::balance::Share),
        ("energy", |balance| balance.energy),
    ] {
        if let Some((nm, share)) = worst(of)
            && share.value > 1.0 + 3.0 * share.sigma
        {
            list.push(format!(
                "at {nm} nm {:.3} +- {:.3} of the {what} come out that fell in: more than physics allows",
                share.value, share.sigma
            ));
        }
    }
    list
}
