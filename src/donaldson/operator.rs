//! A surface as tables that lights on one axis are multiplied with: for many lights, or for a light at every pixel.
//!
//! [`Reradiation::under`] integrates a light exactly on the light's own wavelengths. Here lights are samples on an axis of one step,
//! straight between them, and everything is linear in them: what is integrated is integrated once. What the step loses is measured by
//! `bbrf cost eval`.

use ndarray::{Array2, LinalgScalar, s};

use super::colour::{Colour, Observer, VISIBLE_NM};
use super::light::{Extend, Light};
use super::piecewise::{Line, place};
use super::{Factors, Reradiation};
use crate::quantity::{QuantityKind, named};

named! {
    /// How the radiance under a light is found.
    By, "way" {
        /// Exact integrals over the light's own wavelengths.
        Integrals = "integrals",
        /// The product of the light's samples with a table of all wavelengths.
        Product = "product",
        /// The samples go through the factors of the luminescence, and the elastic part.
        Factors = "factors",
        /// X, Y and Z alone: three numbers for each sample.
        Colour = "colour",
    }
}

/// A way to predict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// How.
    pub by: By,
    /// Step of the samples, nm: 380 nm is one of them. From 0.5 to 50.
    pub step_nm: f64,
    /// Single precision.
    pub single: bool,
}

/// Smallest and largest step, nm.
pub const STEPS_NM: (f64, f64) = (0.5, 50.0);

/// A surface as tables.
#[derive(Debug, Clone)]
pub struct Operator {
    nm: Vec<f64>,
    visible: std::ops::Range<usize>,
    observer: Observer,
    /// X, Y and Z of the perfect diffuser \[sample, 3\].
    white: Array2<f64>,
    tables: Precision,
}

#[derive(Debug, Clone)]
enum Precision {
    Double(Tables<f64>),
    Single(Tables<f32>),
}

/// Lights as samples \[light, wavelength\], in the precision of an operator.
#[derive(Debug, Clone)]
pub enum Samples {
    /// In double precision.
    Double(Array2<f64>),
    /// In single precision.
    Single(Array2<f32>),
}

/// What an operator gives for each light: pi times the radiance at the visible samples (none by [`By::Colour`]), and X, Y, Z as sums.
type Applied = (Option<Array2<f64>>, Array2<f64>);

#[derive(Debug, Clone)]
struct Tables<T> {
    radiance: Radiance<T>,
    /// X, Y and Z: of the visible samples of a radiance, or by [`By::Colour`] of all samples of the light.
    colour: Array2<T>,
}

#[derive(Debug, Clone)]
enum Radiance<T> {
    None,
    Product(Array2<T>),
    Factors(Factored<T>),
}

/// Elastic factors and products of factors.
#[derive(Debug, Clone)]
struct Factored<T> {
    visible: std::ops::Range<usize>,
    elastic: Vec<T>,
    /// For each excitation where its share begins among the samples, and the weights from there.
    shares: Vec<(usize, Vec<T>)>,
    /// Excitations at or below each emission.
    below: Vec<usize>,
    /// Factors \[excitation, k\] and, over the emission's width, \[emission, k\].
    excited: Array2<T>,
    emitted: Array2<T>,
    /// For each visible sample the emissions around it with their parts; none outside.
    between: Vec<Option<(usize, usize, T)>>,
}

impl Operator {
    /// Tables of a surface; `factors` with the widths of its emissions, nm, are needed by [`By::Factors`]. `None` where they are
    /// missing, the surface has no elastic part or the step is out of [`STEPS_NM`]; and by [`By::Integrals`], which needs no table.
    #[must_use]
    pub fn new(
        surface: &Reradiation,
        factors: Option<(&Factors, &[f64])>,
        observer: Observer,
        way: Way,
    ) -> Option<Self> {
        if !(STEPS_NM.0..=STEPS_NM.1).contains(&way.step_nm) || way.by == By::Integrals {
            return None;
        }
        let (nm, visible) = axis(surface.needed_nm(), way.step_nm);
        let whole = Whole::new(surface, &nm)?;
        let mut white = Array2::zeros((nm.len(), 3));
        for row in visible.clone() {
            let weights = matching(observer, nm[row], way.step_nm);
            (0..3).for_each(|c| white[(row, c)] = weights[c]);
        }
        let weights = white.slice(s![visible.clone(), ..]).to_owned();
        let tables = match way.by {
            By::Integrals => return None,
            // The product with what a colour is a sum of, made once.
            By::Colour => Tables { radiance: Radiance::None, colour: whole.product(&nm, &visible).dot(&weights) },
            By::Product => Tables { radiance: Radiance::Product(whole.product(&nm, &visible)), colour: weights },
            By::Factors => {
                let factored = whole.factored(factors?, &nm, &visible);
                Tables { radiance: Radiance::Factors(factored), colour: weights }
            }
        };
        let tables = if way.single { Precision::Single(tables.cast()) } else { Precision::Double(tables) };
        Some(Self { nm, visible, observer, white, tables })
    }

    /// The wavelengths of samples, nm.
    #[must_use]
    pub fn nm(&self) -> &[f64] {
        &self.nm
    }

    /// The wavelengths of radiances, nm.
    #[must_use]
    pub fn visible_nm(&self) -> &[f64] {
        &self.nm[self.visible.clone()]
    }

    /// A light as samples. One that is given in finer steps is averaged from neighbour to neighbour, so that no line of it is lost.
    #[must_use]
    pub fn sampled(&self, light: &Light, extend: Extend) -> Vec<f64> {
        let (low, high) = (self.nm[0], self.nm[self.nm.len() - 1]);
        let light = if extend == Extend::Flat { light.extended(low, high) } else { light.clone() };
        let step = self.nm[1] - self.nm[0];
        let is_finer = light.nm().windows(2).any(|pair| pair[1] - pair[0] < step * 0.999);
        let at = |nm: f64| match is_finer {
            true => light.line().average_over(&Line::triangle(nm - step, nm, nm + step), nm),
            false => light.line().at(nm),
        };
        self.nm.iter().map(|nm| at(*nm).unwrap_or(0.0)).collect()
    }

    /// Lights \[light, sample\] in the precision of this operator.
    #[must_use]
    pub fn samples(&self, lights: &Array2<f64>) -> Samples {
        match &self.tables {
            Precision::Double(_) => Samples::Double(lights.clone()),
            Precision::Single(_) => Samples::Single(lights.mapv(|value| value as f32)),
        }
    }

    /// Pi times the radiance at the visible samples, and X, Y and Z, for each light. Samples of another precision or number give none.
    #[must_use]
    pub fn apply(&self, samples: &Samples) -> Applied {
        let fits = |found: usize| found == self.nm.len();
        match (&self.tables, samples) {
            (Precision::Double(tables), Samples::Double(lights)) if fits(lights.ncols()) => tables.apply(lights),
            (Precision::Single(tables), Samples::Single(lights)) if fits(lights.ncols()) => {
                let (radiance, xyz) = tables.apply(lights);
                (radiance.map(|values| values.mapv(f64::from)), xyz.mapv(f64::from))
            }
            _ => (None, Array2::zeros((0, 3))),
        }
    }

    /// The same without bringing the numbers to double precision: what is timed. The sum of all, so that nothing is left out.
    #[must_use]
    pub fn apply_only(&self, samples: &Samples) -> f64 {
        match (&self.tables, samples) {
            (Precision::Double(tables), Samples::Double(lights)) => tables.apply(lights).1.sum(),
            (Precision::Single(tables), Samples::Single(lights)) => f64::from(tables.apply(lights).1.sum()),
            _ => f64::NAN,
        }
    }

    /// The colour of sums beside the white of a light, Y of which is 100. `None` under a light that nobody sees.
    #[must_use]
    pub fn colour(&self, samples: &[f64], xyz: [f64; 3]) -> Option<Colour> {
        let sum =
            |c: usize| samples.iter().zip(self.white.column(c)).map(|(light, weight)| light * weight).sum::<f64>();
        let white = [0, 1, 2].map(sum);
        let scale = 100.0 / white[1];
        let is_seen = white[1] > 0.0 && scale.is_finite() && xyz.iter().all(|value| value.is_finite());
        let times = |numbers: [f64; 3]| numbers.map(|value| scale * value);
        is_seen.then(|| Colour { observer: self.observer, xyz: times(xyz), white: times(white) })
    }
}

/// Samples that reach over the wavelengths needed, and which of them an observer sees.
fn axis(needed: (f64, f64), step: f64) -> (Vec<f64>, std::ops::Range<usize>) {
    let (from, to) = (VISIBLE_NM.0 as f64, VISIBLE_NM.1 as f64);
    let before = ((from - needed.0) / step - 1e-9).ceil().max(0.0) as usize;
    let after = ((needed.1 - from) / step - 1e-9).ceil().max(1.0) as usize;
    let nm = (0..=before + after).map(|k| from + (k as f64 - before as f64) * step).collect();
    (nm, before..before + ((to - from) / step + 1e-9).floor() as usize + 1)
}

/// The weights of a sample in X, Y and Z: between whole nanometres straight.
fn matching(observer: Observer, nm: f64, step: f64) -> [f64; 3] {
    let (below, part) = (nm.floor() as usize, nm.fract());
    let (low, high) = (observer.matching(below), observer.matching(below + 1));
    [0, 1, 2].map(|c| step * (low[c] * (1.0 - part) + high[c] * part))
}

/// A surface beside an axis of samples.
struct Whole<'a> {
    surface: &'a Reradiation,
    elastic: Line,
    /// The share of each sample in each excitation \[sample, excitation\].
    shares: Array2<f64>,
}

impl<'a> Whole<'a> {
    fn new(surface: &'a Reradiation, nm: &[f64]) -> Option<Self> {
        let mut shares = Array2::zeros((nm.len(), surface.excitation_nm.len()));
        for row in 0..nm.len() {
            let values = (0..nm.len()).map(|k| if k == row { 1.0 } else { 0.0 }).collect();
            let unit = Light::new("unit", QuantityKind::RelativeSpectrum, nm.to_vec(), values, None).ok()?;
            surface.shares(&unit).iter().enumerate().for_each(|(i, share)| shares[(row, i)] = *share);
        }
        Some(Self { surface, elastic: surface.elastic_line()?.1, shares })
    }

    fn elastic_at(&self, nm: f64) -> f64 {
        let (low, high) = self.elastic.range();
        self.elastic.at(nm.clamp(low, high)).unwrap_or(0.0)
    }

    /// Luminescent density at other emissions \[excitation, wavelength\]: straight between those known, 0 outside.
    fn density(&self, nm: &[f64]) -> Array2<f64> {
        let known = &self.surface.emission_nm;
        let mut all = Array2::zeros((self.surface.excitation_nm.len(), nm.len()));
        for (column, nm) in nm.iter().enumerate() {
            let Some((below, above, part)) = place(known, *nm) else { continue };
            for row in 0..all.nrows() {
                let density = &self.surface.density;
                all[(row, column)] = density[(row, below)] * (1.0 - part) + density[(row, above)] * part;
            }
        }
        all
    }

    fn product(&self, nm: &[f64], visible: &std::ops::Range<usize>) -> Array2<f64> {
        let mut product = self.shares.dot(&self.density(&nm[visible.clone()]));
        for (column, row) in visible.clone().enumerate() {
            product[(row, column)] += self.elastic_at(nm[row]);
        }
        product
    }

    fn factored(
        &self,
        (factors, width_nm): (&Factors, &[f64]),
        nm: &[f64],
        visible: &std::ops::Range<usize>,
    ) -> Factored<f64> {
        let surface = self.surface;
        let band = |column: ndarray::ArrayView1<'_, f64>| {
            let used: Vec<usize> = (0..column.len()).filter(|row| column[*row] != 0.0).collect();
            let (first, last) = (used.first().copied().unwrap_or(0), used.last().copied().unwrap_or(0));
            (first, (first..=last).map(|row| column[row]).collect())
        };
        let below = |nm: &f64| surface.excitation_nm.partition_point(|excitation| excitation <= nm);
        Factored {
            visible: visible.clone(),
            elastic: nm[visible.clone()].iter().map(|nm| self.elastic_at(*nm)).collect(),
            shares: self.shares.columns().into_iter().map(band).collect(),
            below: surface.emission_nm.iter().map(below).collect(),
            excited: factors.excitation.t().to_owned(),
            emitted: Array2::from_shape_fn((surface.emission_nm.len(), factors.rank()), |(j, k)| {
                factors.emission[(k, j)] / width_nm.get(j).copied().unwrap_or(1.0)
            }),
            between: nm[visible.clone()].iter().map(|nm| place(&surface.emission_nm, *nm)).collect(),
        }
    }
}

impl Tables<f64> {
    fn cast(self) -> Tables<f32> {
        let narrow = |array: &Array2<f64>| array.mapv(|value| value as f32);
        let list = |list: &[f64]| list.iter().map(|value| *value as f32).collect();
        let radiance = match &self.radiance {
            Radiance::None => Radiance::None,
            Radiance::Product(product) => Radiance::Product(narrow(product)),
            Radiance::Factors(one) => Radiance::Factors(Factored {
                visible: one.visible.clone(),
                elastic: list(&one.elastic),
                shares: one.shares.iter().map(|(first, weights)| (*first, list(weights))).collect(),
                below: one.below.clone(),
                excited: narrow(&one.excited),
                emitted: narrow(&one.emitted),
                between: one.between.iter().map(|place| place.map(|(a, b, part)| (a, b, part as f32))).collect(),
            }),
        };
        Tables { radiance, colour: narrow(&self.colour) }
    }
}

impl<T: LinalgScalar> Tables<T> {
    fn apply(&self, lights: &Array2<T>) -> (Option<Array2<T>>, Array2<T>) {
        let radiance = match &self.radiance {
            Radiance::None => return (None, lights.dot(&self.colour)),
            Radiance::Product(product) => lights.dot(product),
            Radiance::Factors(factored) => factored.apply(lights),
        };
        let xyz = radiance.dot(&self.colour);
        (Some(radiance), xyz)
    }
}

impl<T: LinalgScalar> Factored<T> {
    /// An emission is excited at or below its wavelength only: the product of factors alone would let red light shine in the blue.
    fn apply(&self, lights: &Array2<T>) -> Array2<T> {
        let rank = self.excited.ncols();
        let mut out = Array2::zeros((lights.nrows(), self.visible.len()));
        let (mut excited, mut luminescent) = (vec![T::zero(); rank], vec![T::zero(); self.below.len()]);
        for (mut out, light) in out.rows_mut().into_iter().zip(lights.rows()) {
            excited.fill(T::zero());
            let mut excitation = 0;
            for (j, value) in luminescent.iter_mut().enumerate() {
                while excitation < self.below[j] {
                    let (first, weights) = &self.shares[excitation];
                    let share = weights.iter().enumerate().fold(T::zero(), |sum, (k, w)| sum + light[first + k] * *w);
                    excited.iter_mut().zip(self.excited.row(excitation)).for_each(|(sum, x)| *sum = *sum + share * *x);
                    excitation += 1;
                }
                *value = excited.iter().zip(self.emitted.row(j)).fold(T::zero(), |sum, (a, b)| sum + *a * *b);
            }
            for (k, value) in out.iter_mut().enumerate() {
                let luminescence = self.between[k].map_or(T::zero(), |(below, above, part)| {
                    luminescent[below] + part * (luminescent[above] - luminescent[below])
                });
                *value = self.elastic[k] * light[self.visible.start + k] + luminescence;
            }
        }
        out
    }
}
