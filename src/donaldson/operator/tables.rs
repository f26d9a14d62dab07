//! A surface as tables, and lights through them.

use ndarray::{Array2, LinalgScalar};

use super::super::piecewise::{Line, place};
use super::super::{Factors, Reradiation};
use super::axis::Axis;

#[derive(Debug, Clone)]
pub(super) struct Tables<T> {
    pub(super) radiance: Radiance<T>,
    /// X, Y and Z: of the visible samples of a radiance, or by [`By::Colour`] of all samples of the light.
    pub(super) colour: Array2<T>,
}

#[derive(Debug, Clone)]
pub(super) enum Radiance<T> {
    None,
    Product(Array2<T>),
    Factors(Factored<T>),
}

/// Elastic factors and products of factors.
#[derive(Debug, Clone)]
pub(super) struct Factored<T> {
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

/// A surface beside an axis of samples.
pub(super) struct Whole<'a> {
    surface: &'a Reradiation,
    elastic: Line,
    /// The share of each sample in each excitation \[sample, excitation\].
    shares: Array2<f64>,
}

impl<'a> Whole<'a> {
    pub(super) fn new(surface: &'a Reradiation, axis: &Axis) -> Option<Self> {
        let mut shares = Array2::zeros((axis.nm.len(), surface.excitation_nm.len()));
        for (row, unit) in axis.units()?.iter().enumerate() {
            surface.shares(unit).iter().enumerate().for_each(|(i, share)| shares[(row, i)] = *share);
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

    pub(super) fn product(&self, Axis { nm, visible }: &Axis) -> Array2<f64> {
        let mut product = self.shares.dot(&self.density(&nm[visible.clone()]));
        for (column, row) in visible.clone().enumerate() {
            product[(row, column)] += self.elastic_at(nm[row]);
        }
        product
    }

    pub(super) fn factored(&self, (factors, width_nm): (&Factors, &[f64]), axis: &Axis) -> Factored<f64> {
        let Axis { nm, visible } = axis;
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
    pub(super) fn cast(self) -> Tables<f32> {
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
    pub(super) fn apply(&self, lights: &Array2<T>) -> (Option<Array2<T>>, Array2<T>) {
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
