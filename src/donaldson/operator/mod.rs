//! A surface as tables that lights on one axis are multiplied with: for many lights, or for a light at every pixel.
//!
//! [`Reradiation::under`] integrates a light exactly on the light's own wavelengths. Here lights are samples on an axis of one step,
//! straight between them, and everything is linear in them: what is integrated is integrated once. What the step loses is measured by
//! `bbrf cost eval`.

mod axis;
mod tables;

use ndarray::{Array2, s};

use self::tables::{Radiance, Tables, Whole};
use super::colour::{Colour, Observer};
use super::light::{Extend, Light};
use super::{Factors, Reradiation};
use crate::quantity::named;
pub(super) use axis::Axis;
pub use axis::STEPS_NM;

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

/// A surface as tables.
#[derive(Debug, Clone)]
pub struct Operator {
    axis: Axis,
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
        if way.by == By::Integrals {
            return None;
        }
        let axis = Axis::new(surface.needed_nm(), way.step_nm)?;
        let whole = Whole::new(surface, &axis)?;
        let Axis { nm, visible } = &axis;
        let mut white = Array2::zeros((nm.len(), 3));
        for row in visible.clone() {
            let weights = matching(observer, nm[row], way.step_nm);
            (0..3).for_each(|c| white[(row, c)] = weights[c]);
        }
        let weights = white.slice(s![visible.clone(), ..]).to_owned();
        let tables = match way.by {
            By::Integrals => return None,
            // The product with what a colour is a sum of, made once.
            By::Colour => Tables { radiance: Radiance::None, colour: whole.product(&axis).dot(&weights) },
            By::Product => Tables { radiance: Radiance::Product(whole.product(&axis)), colour: weights },
            By::Factors => {
                let factored = whole.factored(factors?, &axis);
                Tables { radiance: Radiance::Factors(factored), colour: weights }
            }
        };
        let tables = if way.single { Precision::Single(tables.cast()) } else { Precision::Double(tables) };
        Some(Self { axis, observer, white, tables })
    }

    /// The wavelengths of samples, nm.
    #[must_use]
    pub fn nm(&self) -> &[f64] {
        &self.axis.nm
    }

    /// The wavelengths of radiances, nm.
    #[must_use]
    pub fn visible_nm(&self) -> &[f64] {
        &self.axis.nm[self.axis.visible.clone()]
    }

    /// A light as samples. One that is given in finer steps is averaged from neighbour to neighbour, so that no line of it is lost.
    #[must_use]
    pub fn sampled(&self, light: &Light, extend: Extend) -> Vec<f64> {
        self.axis.sampled(light, extend)
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
        let fits = |found: usize| found == self.axis.nm.len();
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

/// The weights of a sample in X, Y and Z: between whole nanometres straight.
fn matching(observer: Observer, nm: f64, step: f64) -> [f64; 3] {
    let (below, part) = (nm.floor() as usize, nm.fract());
    let (low, high) = (observer.matching(below), observer.matching(below + 1));
    [0, 1, 2].map(|c| step * (low[c] * (1.0 - part) + high[c] * part))
}
