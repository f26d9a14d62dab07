//! What a surface does to light of any spectrum: it sends some of it on where it is, and some elsewhere.

use ndarray::Array2;

use super::factors::Factors;
use super::overlap::times_at_the_end;
use super::piecewise::Line;
use super::{Matrix, NoMatrix, Separated, steps};
use crate::dataset::Attached;
use crate::quantity::{Flag, named};

named! {
    /// Which luminescence of a separated matrix is applied.
    Luminescence, "luminescence" {
        /// What was measured, noise below the excitation included.
        Full = "full",
        /// The same without the cells further below the excitation than the thermal tail of the emission: no light can be there.
        Stokes = "stokes",
        /// What the factors say, where the emission lies at or above the excitation.
        Factors = "factors",
    }
}

/// Light further below its excitation than this is none, nm: at room temperature e^-5 of it at 500 nm, less below and more in the red.
const THERMAL_TAIL_NM: f64 = 25.0;

/// A surface as it re-radiates: an elastic part, a line at the wavelength that falls in, and a luminescent density.
#[derive(Debug, Clone, PartialEq)]
pub struct Reradiation {
    /// Centres of the excitation, nm, ascending.
    pub excitation_nm: Vec<f64>,
    /// Centres of the emission, nm, ascending.
    pub emission_nm: Vec<f64>,
    /// Radiance factor of the elastic part, one per emission; NaN where it is not known.
    pub elastic: Vec<f64>,
    /// Its standard uncertainty.
    pub elastic_sigma: Vec<f64>,
    /// Bispectral luminescent radiance factor \[excitation, emission\], nm-1: straight between the centres.
    pub density: Array2<f64>,
    /// Its standard uncertainty.
    pub density_sigma: Array2<f64>,
    /// Full width at half maximum of the emission, nm, where it is stated: what a spectrum is seen through.
    pub emission_fwhm_nm: Option<Vec<f64>>,
    /// What was missing, in words.
    pub findings: Vec<String>,
    /// What the parts share.
    common: Common,
}

/// How the errors of the parts go together.
#[derive(Debug, Clone, PartialEq)]
enum Common {
    /// Not at all.
    Nothing,
    /// So many times the luminescence of each cell, over its emission's width in nm, was subtracted to get the elastic part.
    Subtracted { times: Array2<f64>, width_nm: Vec<f64> },
    /// All luminescence is that of the factors, and so many times that of each cell was subtracted to get the elastic part.
    Factors(Box<OfFactors>),
}

/// What the elastic part and luminescence by factors share.
#[derive(Debug, Clone, PartialEq)]
struct OfFactors {
    factors: Factors,
    width_nm: Vec<f64>,
    /// How often the luminescence of each cell was subtracted.
    times: Array2<f64>,
    /// Variance of each elastic value without that of the factors.
    own: Vec<f64>,
}

/// Arrays that do not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{excitation} excitations, {emission} emissions, {elastic} elastic values, luminescence {luminescent:?}; expected ascending \
     wavelengths, two or more of each, an elastic value for each emission, luminescence [excitation, emission]"
)]
pub struct NotAligned {
    excitation: usize,
    emission: usize,
    elastic: usize,
    luminescent: (usize, usize),
}

impl Reradiation {
    /// The two parts of a matrix.
    #[must_use]
    pub fn of(matrix: &Matrix, separated: &Separated, luminescence: Luminescence) -> Self {
        let shape = matrix.values.dim();
        let width_nm = matrix.emission_width_nm();
        let offset = |(i, j): (usize, usize)| matrix.emission_nm[j] - matrix.excitation_nm[i];
        let is_left_out = |at: (usize, usize)| match luminescence {
            Luminescence::Full => false,
            Luminescence::Stokes => offset(at) < -THERMAL_TAIL_NM,
            Luminescence::Factors => offset(at) < 0.0,
        };
        let factors = &separated.factors;
        let is_missing = |at: (usize, usize)| !separated.luminescent[at].is_finite();
        let cell = |at: (usize, usize)| {
            let by_factors = luminescence == Luminescence::Factors || is_missing(at);
            match (is_left_out(at), by_factors) {
                (true, _) => (0.0, 0.0),
                (false, false) => (separated.luminescent[at], separated.luminescent_sigma[at]),
                (false, true) if offset(at) < 0.0 => (0.0, 0.0),
                (false, true) => (factors.value(at.0, at.1), factors.sigma(at.0, at.1)),
            }
        };
        let cells = Array2::from_shape_fn(shape, cell);
        let over_width =
            |part: fn(&(f64, f64)) -> f64| Array2::from_shape_fn(shape, |(i, j)| part(&cells[(i, j)]) / width_nm[j]);
        let (density, density_sigma) = (over_width(|cell| cell.0), over_width(|cell| cell.1));
        let is_elastic = |j: usize| separated.elastic[j].is_finite();
        let times =
            Array2::from_shape_fn(
                shape,
                |(i, j)| {
                    if is_elastic(j) { separated.overlap.times(matrix, i, j) } else { 0.0 }
                },
            );
        let common = match luminescence {
            Luminescence::Factors => Common::Factors(Box::new(OfFactors::new(matrix, separated, times, width_nm))),
            _ => Common::Subtracted { times, width_nm },
        };
        let mut findings = Vec::new();
        let missing = (0..shape.0).flat_map(|i| (0..shape.1).map(move |j| (i, j)));
        let missing = missing.filter(|at| is_missing(*at) && !is_left_out(*at)).count();
        if missing > 0 && luminescence != Luminescence::Factors {
            findings.push(format!("{missing} luminescent cells have no value; the factors stand in for them"));
        }
        findings.extend(without_elastic(&matrix.emission_nm, &separated.elastic));
        Self {
            excitation_nm: matrix.excitation_nm.clone(),
            emission_nm: matrix.emission_nm.clone(),
            elastic: separated.elastic.clone(),
            elastic_sigma: separated.elastic_sigma.clone(),
            density,
            density_sigma,
            emission_fwhm_nm: matrix.emission_fwhm_nm.clone(),
            findings,
            common,
        }
    }

    /// The two parts of a matrix as a document has them: the luminescence that was measured, the factors where it has no value.
    ///
    /// # Errors
    /// [`NoMatrix`].
    pub fn of_stored(parts: &Attached<'_>) -> Result<Self, NoMatrix> {
        let matrix = Matrix::of(parts.matrix)?;
        let (shape, width_nm) = (matrix.values.dim(), matrix.emission_width_nm());
        let (luminescent, factors) = (parts.luminescent, parts.factorisation);
        let measured = |(i, j): (usize, usize)| {
            let at = (matrix.rows[i], j);
            // What the separation estimated next to the diagonal counts; what nobody measured does not.
            let is_usable = luminescent
                .flags_at(at.0, at.1)
                .iter()
                .all(|flag| flag == Flag::Interpolated || !flag.excludes_from_fit());
            let sigma = luminescent.uncertainty.standard.as_ref().map_or(f64::NAN, |sigma| sigma[at]);
            (is_usable && luminescent.values[at].is_finite()).then(|| (luminescent.values[at], sigma))
        };
        let by_factors = |(i, j): (usize, usize)| {
            let (mut variance, mut sum) = (0.0, factors.luminescent(i, j).unwrap_or(f64::NAN));
            for k in 0..factors.rank() {
                let (x, m) = (factors.excitation[(k, i)], factors.emission_factor[(k, j)]);
                variance +=
                    (m * factors.excitation_u[(k, i)]).powi(2) + (x * factors.emission_factor_u[(k, j)]).powi(2);
            }
            if matrix.emission_nm[j] < matrix.excitation_nm[i] {
                (sum, variance) = (0.0, 0.0);
            }
            (sum, variance.sqrt())
        };
        let cells = Array2::from_shape_fn(shape, |at| measured(at).unwrap_or_else(|| by_factors(at)));
        let over_width =
            |part: fn(&(f64, f64)) -> f64| Array2::from_shape_fn(shape, |(i, j)| part(&cells[(i, j)]) / width_nm[j]);
        let is_estimated = |i: usize, j: usize| {
            let flags = luminescent.flags_at(matrix.rows[i], j);
            flags.iter().any(|flag| flag == Flag::Interpolated)
        };
        let times = Array2::from_shape_fn(shape, |(i, j)| match is_estimated(i, j) {
            true => times_at_the_end(&matrix, i, j),
            false => 0.0,
        });
        let missing = Array2::from_shape_fn(shape, |at| usize::from(measured(at).is_none())).sum();
        let elastic: Vec<f64> = parts.elastic.values.row(0).to_vec();
        let sigma = |j: usize| parts.elastic.uncertainty.standard.as_ref().map_or(f64::NAN, |sigma| sigma[(0, j)]);
        let elastic_sigma = (0..shape.1).map(sigma).collect();
        let mut findings: Vec<String> = (missing > 0)
            .then(|| format!("{missing} luminescent cells have no value; the factors stand in for them"))
            .into_iter()
            .collect();
        findings.extend(without_elastic(&matrix.emission_nm, &elastic));
        Ok(Self {
            density: over_width(|cell| cell.0),
            density_sigma: over_width(|cell| cell.1),
            common: Common::Subtracted { times, width_nm },
            excitation_nm: matrix.excitation_nm,
            emission_nm: matrix.emission_nm,
            elastic,
            elastic_sigma,
            emission_fwhm_nm: matrix.emission_fwhm_nm,
            findings,
        })
    }

    /// The same surface with all its values times a number.
    #[must_use]
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        for list in [&mut self.elastic, &mut self.elastic_sigma] {
            list.iter_mut().for_each(|value| *value *= factor);
        }
        self.density *= factor;
        self.density_sigma *= factor;
        self
    }

    /// A surface from its parts, without uncertainty: the elastic radiance factor, and the luminescent density
    /// \[excitation, emission\] in nm-1.
    ///
    /// # Errors
    /// [`NotAligned`].
    pub fn from_parts(
        excitation_nm: Vec<f64>,
        emission_nm: Vec<f64>,
        elastic: Vec<f64>,
        density: Array2<f64>,
    ) -> Result<Self, NotAligned> {
        let ascends = |nm: &[f64]| nm.len() >= 2 && nm.windows(2).all(|pair| pair[0] < pair[1]);
        let shape = (excitation_nm.len(), emission_nm.len());
        if !ascends(&excitation_nm) || !ascends(&emission_nm) || elastic.len() != shape.1 || density.dim() != shape {
            let (elastic, luminescent) = (elastic.len(), density.dim());
            return Err(NotAligned { excitation: shape.0, emission: shape.1, elastic, luminescent });
        }
        Ok(Self {
            findings: without_elastic(&emission_nm, &elastic).into_iter().collect(),
            elastic_sigma: vec![0.0; elastic.len()],
            density_sigma: Array2::zeros(shape),
            excitation_nm,
            emission_nm,
            elastic,
            density,
            emission_fwhm_nm: None,
            common: Common::Nothing,
        })
    }

    /// The elastic part as a line through the wavelengths at which it is known; `None` where those are fewer than two.
    pub(super) fn elastic_line(&self) -> Option<(Vec<usize>, Line)> {
        let known: Vec<usize> = (0..self.elastic.len()).filter(|j| self.elastic[*j].is_finite()).collect();
        let of = |list: &[f64]| known.iter().map(|j| list[*j]).collect();
        (known.len() >= 2).then(|| (known.clone(), Line::new(of(&self.emission_nm), of(&self.elastic))))
    }

    /// Luminescent energy out over in, for each excitation, nm-1 times nm.
    pub(super) fn luminescent_yield(&self) -> Vec<f64> {
        let steps = steps(&self.emission_nm);
        let row = |i: usize| steps.iter().enumerate().map(|(j, step)| self.density[(i, j)] * step).sum();
        (0..self.excitation_nm.len()).map(row).collect()
    }

    /// The variance, from independent errors of the cells, of a sum over `elastic[j]` times the elastic value of emission j and
    /// `excitation[i]` times `emission[j]` times the density of cell (i, j).
    pub(super) fn variance(&self, elastic: &[f64], excitation: &[f64], emission: &[f64]) -> f64 {
        let known = |value: f64| if value.is_finite() { value } else { 0.0 };
        let of_elastic: f64 = elastic.iter().zip(&self.elastic_sigma).map(|(a, s)| (a * known(*s)).powi(2)).sum();
        if let Common::Factors(common) = &self.common {
            return common.variance(elastic, |i, j| {
                let is_stokes = self.emission_nm[j] >= self.excitation_nm[i];
                if is_stokes { excitation[i] * emission[j] / common.width_nm[j] } else { 0.0 }
            });
        }
        let mut sum = of_elastic;
        for ((i, j), sigma) in self.density_sigma.indexed_iter() {
            let (weight, variance) = (excitation[i] * emission[j], known(*sigma).powi(2));
            sum += weight * weight * variance;
            if let Common::Subtracted { times, width_nm } = &self.common {
                // What was taken from the elastic part is wrong by as much, the other way round.
                sum -= 2.0 * times[(i, j)] * elastic[j] * weight * width_nm[j] * variance;
            }
        }
        sum.max(0.0)
    }
}

impl OfFactors {
    fn new(matrix: &Matrix, separated: &Separated, mut times: Array2<f64>, width_nm: Vec<f64>) -> Self {
        // Below the excitation nothing was subtracted.
        for ((i, j), times) in times.indexed_iter_mut() {
            *times = if matrix.emission_nm[j] >= matrix.excitation_nm[i] { *times } else { 0.0 };
        }
        let own = |j: usize| {
            let subtracted = times.column(j).into_iter().zip(separated.luminescent_sigma.column(j));
            let part: f64 =
                subtracted.map(|(times, sigma)| if *times > 0.0 { (times * sigma).powi(2) } else { 0.0 }).sum();
            (separated.elastic_sigma[j].powi(2) - part).max(0.0)
        };
        let own = (0..times.ncols()).map(own).collect();
        Self { factors: separated.factors.clone(), width_nm, own, times }
    }

    /// The variance of a sum over elastic values and cells of the factors, each times its weight. What the factors have too much the elastic
    /// part has too little; and so it is with what the factors leave in a cell.
    fn variance(&self, elastic: &[f64], weight: impl Fn(usize, usize) -> f64) -> f64 {
        let own =
            |(weight, variance): (&f64, &f64)| if variance.is_finite() { weight * weight * variance } else { 0.0 };
        let of_own: f64 = elastic.iter().zip(&self.own).map(own).sum();
        let net = |i: usize, j: usize| weight(i, j) - elastic[j] * self.times[(i, j)];
        let next_to = self.times.indexed_iter().filter(|(_, times)| **times > 0.0);
        let left: f64 = next_to.map(|((i, j), _)| net(i, j).powi(2)).sum();
        of_own + self.factors.sum_variance(net) + left * self.factors.rms.powi(2)
    }
}

fn without_elastic(emission_nm: &[f64], elastic: &[f64]) -> Option<String> {
    let unknown: Vec<f64> =
        emission_nm.iter().zip(elastic).filter(|(_, x)| !x.is_finite()).map(|(nm, _)| *nm).collect();
    let (first, last) = (unknown.first()?, unknown.last()?);
    Some(format!(
        "no elastic value at {} emission wavelengths from {first} to {last} nm: the spectrum has no value there, and colours go \
         straight from neighbour to neighbour",
        unknown.len()
    ))
}
