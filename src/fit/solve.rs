//! The fit itself: starts, polish, result.

use ndarray::{ArrayView1, ArrayView2, Axis};

use super::columns::{Columns, Point};
use super::curvature::{Share, amplitudes};
use super::error::DataError;
use super::geometry_set::{GeometrySet, INDEX_BOX};
use super::left_out::LeftOut;
use super::linear::{Amplitudes, Gram};
use super::magnitude::{self, Checked};
use super::outcome::{BandFit, Fit, Stop};
use super::polish::{Fixed, Polished, Reduced};
use super::row::{has_one_gap_pattern, has_one_sigma};
use super::samples::Samples;
use super::starts::starts;
use super::statistics;

/// A specular term must lower chi-square by this much to be reported: of two thousand pure diffusers the luckiest
/// noise gained 13.
pub(super) const SEEN: f64 = 15.0;

/// Which terms are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Terms {
    /// A diffuse term (Lambertian or luminescent: under one light they have one angular form).
    pub diffuse: bool,
    /// The specular term.
    pub specular: bool,
}

/// Fits scans over one set of geometries.
#[derive(Debug, Clone, Copy)]
pub struct Fitter<'a> {
    pub(super) set: &'a GeometrySet,
    pub(super) terms: Terms,
    pub(super) share: Share,
    /// Bounds of ln r and ln(n - 1).
    pub(super) bounds: [(f64, f64); 2],
    /// The processor's vector instructions, as far as they are used.
    arch: pulp::Arch,
}

/// A whole fit, as what is compiled for several kinds of processor.
struct Whole<'a, 'b> {
    fitter: Fitter<'a>,
    values: ArrayView2<'b, f64>,
    sigma: Option<ArrayView2<'b, f64>>,
}

impl pulp::WithSimd for Whole<'_, '_> {
    type Output = Result<Fit, DataError>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let Self { fitter, values, sigma } = self;
        Ok(fitter.solve(&fitter.prepare(values, sigma)?))
    }
}

/// The data of one fit, ready, with what is known of them.
#[derive(Debug)]
pub(super) struct Prepared {
    pub(super) samples: Samples,
    /// 1 over the variance that weight 1 stands for; `None` where the residuals decide.
    pub(super) unit: Option<f64>,
    pub(super) freedom: f64,
    pub(super) left_out: LeftOut,
}

impl<'a> Fitter<'a> {
    /// A fitter of these terms over these geometries.
    #[must_use]
    pub fn new(set: &'a GeometrySet, terms: Terms) -> Self {
        let log = |(low, high): (f64, f64)| (low.ln(), high.ln());
        let bounds = [log(set.roughness_box), log(INDEX_BOX)];
        Self { set, terms, share: Share::default(), bounds, arch: pulp::Arch::new() }
    }

    /// The same without vector instructions beyond those that the program was built for. The result is the same to the
    /// last bit, and later: this is for comparisons.
    #[must_use]
    pub fn plain(self) -> Self {
        Self { arch: pulp::Arch::Scalar, ..self }
    }

    /// The same with something else in common between emission values.
    #[must_use]
    pub fn sharing(self, share: Share) -> Self {
        Self { share, ..self }
    }

    /// The same within a narrower box: bounds (low, high) of the roughness in the unit of the distribution, and of n - 1.
    /// What lies beyond the box that can be searched at all is cut off.
    #[must_use]
    pub fn within(self, roughness: (f64, f64), index_minus_one: (f64, f64)) -> Self {
        let narrowed = |(low, high): (f64, f64), asked: (f64, f64)| {
            let (from, to) = (asked.0.ln().max(low), asked.1.ln().min(high));
            (from.min(high), to.max(low))
        };
        let bounds = [narrowed(self.bounds[0], roughness), narrowed(self.bounds[1], index_minus_one)];
        Self { bounds, ..self }
    }

    /// Fits one scan: N values, with their standard uncertainties if known. Values that are not finite or whose
    /// uncertainty is not positive are left out. Without uncertainties all values weigh the same and the covariance
    /// is scaled by the residuals.
    ///
    /// # Errors
    /// [`DataError`] when the arrays do not fit or too few values are usable.
    pub fn fit(&self, values: &[f64], sigma: Option<&[f64]>) -> Result<Fit, DataError> {
        let one_row = |values| ArrayView1::from(values).insert_axis(Axis(0));
        self.fit_bands(one_row(values), sigma.map(one_row))
    }

    /// Fits several emission values \[B, N\] with a common roughness and index, and amplitudes of their own (or a common
    /// specular one: [`Fitter::sharing`]). Uncertainties that are the same for all emission values make it faster.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub fn fit_bands(&self, values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> Result<Fit, DataError> {
        // The sums below are compiled once more for processors with wider vectors; their order is the same in each.
        self.arch.dispatch(Whole { fitter: *self, values, sigma })
    }

    /// Checks, sorts and weights the data.
    #[inline(always)]
    pub(super) fn prepare(
        &self,
        values: ArrayView2<f64>,
        sigma: Option<ArrayView2<f64>>,
    ) -> Result<Prepared, DataError> {
        if !self.terms.diffuse && !self.terms.specular {
            return Err(DataError::NoTerm);
        }
        self.check_shape(values, sigma)?;
        let one_sigma = has_one_sigma(sigma);
        let Checked { smallest_sigma: smallest, complete } = magnitude::check(values, sigma, one_sigma)?;
        let shared = values.nrows() > 1 && one_sigma && (complete || has_one_gap_pattern(values));
        let samples = Samples::new(self.set, self.terms.diffuse, values, sigma, smallest.recip(), shared);
        let mut left_out = samples.left_out;
        left_out.undefined_geometry = self.set.undefined().len() * samples.bands();
        let (usable, parameters) = (samples.used(), self.parameters(samples.bands()));
        if usable <= parameters || samples.bands() == 0 {
            return Err(DataError::TooFew { usable, parameters, left_out });
        }
        let unit = sigma.is_some().then(|| smallest.powi(-2));
        Ok(Prepared { samples, unit, freedom: (usable - parameters) as f64, left_out })
    }

    /// One number per geometry, and one uncertainty per number.
    pub(super) fn check_shape(&self, values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> Result<(), DataError> {
        let expected = self.set.len();
        for found in [values.ncols(), sigma.map_or(expected, |sigma| sigma.ncols())] {
            if found != expected {
                return Err(DataError::Length { found, expected });
            }
        }
        match sigma.map(|sigma| sigma.nrows()) {
            Some(found) if found != values.nrows() => Err(DataError::Rows { found, expected: values.nrows() }),
            _ => Ok(()),
        }
    }

    pub(super) fn has_diffuse(&self) -> bool {
        self.terms.diffuse
    }

    pub(super) fn parameters(&self, bands: usize) -> usize {
        let diffuse = usize::from(self.terms.diffuse) * bands;
        let specular = match self.share {
            Share::Shape => bands + 2,
            Share::ShapeAndIntensity => 3,
        };
        diffuse + if self.terms.specular { specular } else { 0 }
    }

    /// The reduced problem of prepared data.
    #[inline(always)]
    pub(super) fn reduced<'b>(&'b self, data: &'b Prepared) -> Reduced<'b> {
        Reduced {
            set: self.set,
            samples: &data.samples,
            share: self.share,
            bounds: self.bounds,
            freedom: data.freedom,
            columns: Columns::default(),
            products: Vec::with_capacity(data.samples.bands()),
            evaluated: None,
            evaluations: 0,
        }
    }

    #[inline(always)]
    pub(super) fn solve(&self, data: &Prepared) -> Fit {
        let diffuse_only: f64 = data.samples.gram.iter().map(|gram| gram.solve().chi_square).sum();
        let mut reduced = self.reduced(data);
        let polished = if self.terms.specular { self.specular(data, &mut reduced) } else { None };
        let Some(polished) = polished else {
            return self.without_specular(data, 0.0, reduced.evaluations);
        };
        let chi_square = polished.curvature.chi_square.max(polished.curvature.noise);
        let scale = data.unit.unwrap_or(data.freedom / chi_square);
        let gain = scale * (diffuse_only - polished.curvature.chi_square);
        let seen = gain > SEEN && diffuse_only - polished.curvature.chi_square > polished.curvature.noise;
        if self.terms.diffuse && !seen {
            return self.without_specular(data, gain, reduced.evaluations);
        }
        self.at(data, &mut reduced, &polished, gain)
    }

    /// The fit at a polished point, with its statistics.
    #[inline(always)]
    pub(super) fn at(&self, data: &Prepared, reduced: &mut Reduced<'_>, polished: &Polished, gain: f64) -> Fit {
        let evaluations = reduced.evaluations;
        reduced.evaluate_products(&polished.point);
        let grams: Vec<Gram> = reduced.products.iter().map(|products| products.gram).collect();
        let mut fit = Fit {
            roughness: polished.point.roughness(),
            index_minus_one: polished.point.index_minus_one(),
            bands: band_fits(&data.samples, &amplitudes(&grams, self.share)),
            chi_square: 0.0,
            degrees_of_freedom: data.freedom,
            specular_gain: gain,
            log_sigma: [f64::NAN; 2],
            singular_values: Vec::new(),
            stop: polished.stop,
            at_bound: polished.on_edge,
            evaluations,
            left_out: data.left_out,
        };
        statistics::complete(reduced, data.unit, &mut fit);
        fit
    }

    fn without_specular(&self, data: &Prepared, gain: f64, evaluations: usize) -> Fit {
        let amplitudes: Vec<Amplitudes> = data.samples.gram.iter().map(Gram::solve).collect();
        let bands = data.samples.bands();
        let given_up = self.parameters(bands) - usize::from(self.terms.diffuse) * bands;
        let mut fit = Fit {
            roughness: f64::NAN,
            index_minus_one: f64::NAN,
            bands: band_fits(&data.samples, &amplitudes),
            chi_square: 0.0,
            degrees_of_freedom: data.freedom + given_up as f64,
            specular_gain: gain,
            log_sigma: [f64::NAN; 2],
            singular_values: Vec::new(),
            stop: Stop::Linear,
            at_bound: [false; 2],
            evaluations,
            left_out: data.left_out,
        };
        statistics::complete_linear(self.set, &data.samples, data.unit, &mut fit);
        fit
    }

    /// The best of the polished starts; `None` when no start has a specular amplitude.
    #[inline(always)]
    fn specular(&self, data: &Prepared, reduced: &mut Reduced<'_>) -> Option<Polished> {
        let starts = match data.samples.bands() {
            1 => self.starts(&data.samples),
            _ => self.common_starts(data),
        };
        let mut best: Option<Polished> = None;
        for start in starts {
            let Some(polished) = reduced.polish(start, Fixed::default(), best.as_ref()) else { continue };
            let better = best.as_ref().is_none_or(|b| polished.curvature.chi_square < b.curvature.chi_square);
            best = if better { Some(polished) } else { best };
        }
        best
    }

    /// The best nodes of the grid, within the box.
    #[inline(always)]
    fn starts(&self, samples: &Samples) -> Vec<Point> {
        let mut starts = starts(self.set, samples);
        for start in &mut starts {
            start.log = [0, 1].map(|k| start.log[k].clamp(self.bounds[k].0, self.bounds[k].1));
        }
        starts
    }

    /// Starts of several emission values: the minima of their sum, those beside the best where they are nearly as good.
    #[inline(always)]
    fn common_starts(&self, data: &Prepared) -> Vec<Point> {
        let summed = data.samples.summed(self.set);
        let freedom = (summed.used() as f64 - self.parameters(1) as f64).max(1.0);
        let alone = Prepared { samples: summed, unit: None, freedom, left_out: LeftOut::default() };
        let mut reduced = self.reduced(&alone);
        let mut minima: Vec<Polished> = Vec::new();
        for start in self.starts(&alone.samples) {
            minima.extend(reduced.polish(start, Fixed::default(), minima.first()));
        }
        let best = minima.iter().map(|polished| polished.curvature.chi_square).fold(f64::INFINITY, f64::min);
        // One unit of chi-square per degree of freedom is one unit of chi-square of data that fit.
        minima.retain(|polished| polished.curvature.chi_square - best <= SEEN * best / freedom);
        if minima.is_empty() {
            // The sum shows no specular term, or lacks every point, because each is missing somewhere.
            return self.starts(&data.samples);
        }
        minima.into_iter().map(|polished| polished.point).collect()
    }
}

fn band_fits(samples: &Samples, amplitudes: &[Amplitudes]) -> Vec<BandFit> {
    samples
        .count
        .iter()
        .zip(amplitudes)
        .map(|(&count, amplitudes)| BandFit {
            diffuse: amplitudes.diffuse,
            intensity: amplitudes.specular,
            chi_square: amplitudes.chi_square,
            count,
            covariance: [[0.0; 4]; 4],
        })
        .collect()
}
