//! Profile-likelihood intervals: how far a parameter can go while all others follow, before chi-square says no.
//!
//! Where the likelihood is no parabola (index, roughness, and the intensity that is tied to them), a standard uncertainty
//! says too little and too much at once; the profile is exact in whatever scale the parameter is written (Venzon and
//! Moolgavkar 1988, Applied Statistics 37, 87).

mod curve;

use ndarray::ArrayView2;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::columns::Point;
use super::curvature::Held;
use super::error::DataError;
use super::outcome::Fit;
use super::polish::{Fixed, Polished, Reduced};
use super::solve::{Fitter, Prepared};

pub use curve::{ProfileCurve, Profiled};

/// Profile points for one end of an interval; four are usual.
const MOST_POINTS: usize = 60;
/// An end is found when the root of the rise of chi-square is met to this share.
const MET: f64 = 1e-4;
/// A profile that finds a chi-square lower by this much has found a better fit.
const BETTER: f64 = 1e-3;

/// The values of a parameter that the data do not contradict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end, in the parameter's unit.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// True where the interval reaches the edge of the searched box, and the lower end is that edge.
    pub low_open: bool,
    /// The same for the upper end.
    pub high_open: bool,
}

impl Interval {
    /// True where both ends lie inside the box.
    #[must_use]
    pub const fn is_closed(&self) -> bool {
        !self.low_open && !self.high_open
    }

    /// True for a value within, and for every value beyond an open end.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (value >= self.low || self.low_open) && (value <= self.high || self.high_open)
    }
}

/// Intervals of the parameters of a fit; an amplitude that each emission value has for itself has none here.
#[derive(Debug, Clone, PartialEq)]
pub struct Intervals {
    /// Probability with which each covers the true value.
    pub probability: f64,
    /// Amplitude of the diffuse term, of a fit of one emission value.
    pub diffuse: Option<Interval>,
    /// Amplitude of the specular term, of a fit of one emission value.
    pub intensity: Option<Interval>,
    /// Roughness, in the unit of the distribution; none without a specular term.
    pub roughness: Option<Interval>,
    /// n - 1; none without a specular term.
    pub index_minus_one: Option<Interval>,
}

/// A parameter of the profile, with the scale on which the profile is walked.
#[derive(Debug, Clone, Copy)]
enum Walk {
    /// ln r or ln(n - 1).
    Shape(usize),
    /// Logarithm of the intensity.
    Intensity,
    /// The diffuse amplitude.
    Diffuse,
}

impl Fitter<'_> {
    /// A fit with the intervals that cover the true value with this probability. Where a profile comes upon a lower
    /// chi-square, the fit is that one.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub fn fit_with_intervals(
        &self,
        values: ArrayView2<f64>,
        sigma: Option<ArrayView2<f64>>,
        probability: f64,
    ) -> Result<(Fit, Intervals), DataError> {
        let data = self.prepare(values, sigma)?;
        let mut fit = self.solve(&data);
        for _ in 0..3 {
            match self.intervals(&data, &fit, probability) {
                Ok(intervals) => return Ok((fit, intervals)),
                Err(lower) => fit = self.restarted(&data, lower, &fit),
            }
        }
        let intervals = self.intervals(&data, &fit, probability).unwrap_or_else(|_| Intervals::unknown(probability));
        Ok((fit, intervals))
    }

    /// The fit that a start leads to.
    fn restarted(&self, data: &Prepared, start: Point, fit: &Fit) -> Fit {
        let mut reduced = self.reduced(data);
        match reduced.polish(start, Fixed::default(), None) {
            Some(polished) => self.at(data, &mut reduced, &polished, fit.specular_gain),
            None => fit.clone(),
        }
    }

    /// Walks all profiles; fails with the point of a lower chi-square.
    fn intervals(&self, data: &Prepared, fit: &Fit, probability: f64) -> Result<Intervals, Point> {
        let mut intervals = Intervals::unknown(probability);
        let one = fit.bands.len() == 1;
        if !fit.has_specular() {
            intervals.diffuse = one.then(|| linear(fit, data.unit.is_some(), probability));
            return Ok(intervals);
        }
        let mut profile = self.profile(data, fit, probability);
        intervals.roughness = Some(profile.interval(Walk::Shape(0))?);
        intervals.index_minus_one = Some(profile.interval(Walk::Shape(1))?);
        if one {
            intervals.intensity = Some(profile.interval(Walk::Intensity)?);
            if fit.bands[0].diffuse > 0.0 || self.has_diffuse() {
                intervals.diffuse = Some(profile.interval(Walk::Diffuse)?);
            }
        }
        Ok(intervals)
    }
}

impl Fitter<'_> {
    /// The profiles of a fit with a specular term.
    fn profile<'b>(&'b self, data: &'b Prepared, fit: &'b Fit, probability: f64) -> Profile<'b> {
        let (unit, residual) = (data.unit.unwrap_or(1.0), fit.chi_square / data.freedom);
        let quantile = quantile(probability, data.unit.is_none().then_some(data.freedom));
        let rise = quantile * quantile * if data.unit.is_some() { 1.0 } else { residual } / unit;
        let best = Point { log: [fit.roughness.ln(), fit.index_minus_one.ln()] };
        let mut profile = Profile { reduced: self.reduced(data), best, lowest: 0.0, rise, quantile, fit };
        profile.lowest = profile.reduced.evaluate(&best, Held::Nothing).chi_square;
        profile
    }
}

impl Intervals {
    fn unknown(probability: f64) -> Self {
        Self { probability, diffuse: None, intensity: None, roughness: None, index_minus_one: None }
    }
}

/// Half the width of an interval in standard uncertainties: of the normal distribution, or of Student's where the variance
/// is that of the residuals.
fn quantile(probability: f64, freedom: Option<f64>) -> f64 {
    let upper = (1.0 + probability) / 2.0;
    match freedom.and_then(|freedom| StudentsT::new(0.0, 1.0, freedom).ok()) {
        Some(student) => student.inverse_cdf(upper),
        None => Normal::standard().inverse_cdf(upper),
    }
}

/// The interval of a diffuse amplitude beside nothing else: a parabola, cut at 0.
fn linear(fit: &Fit, has_sigma: bool, probability: f64) -> Interval {
    let half = quantile(probability, (!has_sigma).then_some(fit.degrees_of_freedom)) * fit.standard_uncertainty(0)[0];
    let value = fit.bands[0].diffuse;
    Interval { low: (value - half).max(0.0), high: value + half, low_open: half.is_nan(), high_open: half.is_nan() }
}

/// The profiles of one fit.
struct Profile<'a> {
    reduced: Reduced<'a>,
    best: Point,
    /// Chi-square of the fit, in units of the smallest variance, as all here.
    lowest: f64,
    /// What chi-square may rise by.
    rise: f64,
    quantile: f64,
    fit: &'a Fit,
}

impl Profile<'_> {
    fn interval(&mut self, walk: Walk) -> Result<Interval, Point> {
        let (low, low_open) = self.end(walk, -1.0)?;
        let (high, high_open) = self.end(walk, 1.0)?;
        Ok(Interval { low, high, low_open, high_open })
    }

    /// Where the walk begins, its first step, and how far it may go, on its scale.
    fn route(&self, walk: Walk, sign: f64) -> (f64, f64, f64) {
        let sigma = self.fit.standard_uncertainty(0);
        let band = &self.fit.bands[0];
        let (start, step, limit) = match walk {
            Walk::Shape(k) => {
                let (low, high) = self.reduced.bounds[k];
                (self.best.log[k], self.fit.log_sigma[k], if sign > 0.0 { high } else { low })
            }
            Walk::Intensity => {
                let start = band.intensity.ln();
                (start, sigma[1] / band.intensity, start + sign * 40.0)
            }
            Walk::Diffuse => {
                let most = if sign > 0.0 { f64::INFINITY } else { 0.0 };
                (band.diffuse, sigma[0], most)
            }
        };
        // On a bound, or where the curvature cannot tell, there is no step to go by.
        let usual = if matches!(walk, Walk::Diffuse) { 1e-3 * band.diffuse.abs().max(1e-12) } else { 0.05 };
        (start, if step.is_finite() && step > 0.0 { step } else { usual }, limit)
    }

    /// One end of the interval and whether it lies at the edge of what can be searched.
    fn end(&mut self, walk: Walk, sign: f64) -> Result<(f64, bool), Point> {
        let (start, step, limit) = self.route(walk, sign);
        let mut follow = self.best;
        // The root of the rise of chi-square is nearly linear in the parameter: secants meet it fast. Where it is flat and then
        // a wall, as where another parameter comes to its bound, they creep, and halving is faster.
        let (mut inner, mut inner_root) = (start, 0.0);
        let mut outer: Option<(f64, f64)> = None;
        let mut stopped = false;
        let mut at = start + sign * step * self.quantile;
        for point in 0..MOST_POINTS {
            let clipped = if sign > 0.0 { at.min(limit) } else { at.max(limit) };
            let polished = self.at(walk, clipped, follow)?;
            let root = ((polished.curvature.chi_square - self.lowest).max(0.0) / self.rise).sqrt();
            if (root - 1.0).abs() < MET {
                return Ok(self.found(walk, clipped, polished.on_edge.contains(&true)));
            }
            if root < 1.0 {
                follow = polished.point;
                if clipped == limit {
                    return Ok((self.natural(walk, limit), !matches!(walk, Walk::Diffuse)));
                }
                (inner, inner_root) = (clipped, root);
            } else {
                outer = Some((clipped, root));
                stopped = polished.on_edge.contains(&true);
            }
            at = match outer {
                None => inner + (inner - start) * ((1.1 - inner_root) / inner_root).clamp(0.3, 2.0),
                Some((outer, outer_root)) => {
                    if (outer - inner).abs() <= 1e-9 * (1.0 + outer.abs()) {
                        return Ok(self.found(walk, outer, stopped));
                    }
                    let secant = ((1.0 - inner_root) / (outer_root - inner_root)).clamp(0.05, 0.95);
                    inner + if point % 3 == 2 { 0.5 } else { secant } * (outer - inner)
                }
            };
        }
        Ok(self.found(walk, at, stopped))
    }

    /// The end on the parameter's own scale. An intensity that index or roughness stopped at their bounds is open.
    fn found(&self, walk: Walk, at: f64, stopped: bool) -> (f64, bool) {
        (self.natural(walk, at), stopped && matches!(walk, Walk::Intensity))
    }

    fn natural(&self, walk: Walk, at: f64) -> f64 {
        match walk {
            Walk::Shape(_) | Walk::Intensity => at.exp(),
            Walk::Diffuse => at,
        }
    }

    /// The best fit with the parameter held; an error where it is better than the fit itself.
    fn at(&mut self, walk: Walk, value: f64, follow: Point) -> Result<Polished, Point> {
        let mut start = follow;
        let mut fixed = Fixed::default();
        match walk {
            Walk::Shape(k) => {
                start.log[k] = value;
                fixed.shape[k] = true;
            }
            Walk::Intensity => fixed.amplitude = Held::Specular(value.exp()),
            Walk::Diffuse => fixed.amplitude = Held::Diffuse(value),
        }
        let Some(polished) = self.reduced.polish(start, fixed, None) else { return Err(start) };
        let unit = self.rise / (self.quantile * self.quantile);
        if polished.curvature.chi_square < self.lowest - BETTER * unit {
            return Err(polished.point);
        }
        Ok(polished)
    }
}

impl Interval {
    /// The interval of n from that of n - 1.
    #[must_use]
    pub fn plus_one(self) -> Self {
        Self { low: 1.0 + self.low, high: 1.0 + self.high, ..self }
    }
}
