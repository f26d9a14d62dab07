//! The profile of a parameter as a curve, to be seen beside the parabola that a standard uncertainty stands for.

use super::{Interval, Intervals, Profile, Walk, quantile};
use crate::fit::outcome::Fit;
use crate::fit::solve::{Fitter, Prepared};

/// Points on each side of the best value.
const POINTS: usize = 14;
/// How far beyond a closed end the curve goes, as a share of the way to it.
const BEYOND: f64 = 1.25;

/// A parameter that has a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profiled {
    /// Amplitude of the diffuse term.
    Diffuse,
    /// Amplitude of the specular term.
    Intensity,
    /// Roughness, in the unit of the distribution.
    Roughness,
    /// n - 1.
    IndexMinusOne,
}

/// How chi-square rises when a parameter is held beside its best value and all others follow.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileCurve {
    /// Which parameter.
    pub parameter: Profiled,
    /// Its best value.
    pub best: f64,
    /// Its standard uncertainty from the curvature, whose parabola is ((value - best) / sigma)^2; NaN where it has none.
    pub standard_uncertainty: f64,
    /// (value, rise), values ascending, the best one among them. The unit of the rise is one degree of freedom: of
    /// chi-square where uncertainties are stated, of chi-square per degree of freedom where not.
    pub points: Vec<(f64, f64)>,
    /// The rise at the ends of the interval.
    pub level: f64,
    /// The interval.
    pub interval: Interval,
}

impl Fitter<'_> {
    /// The profile of each parameter that has an interval.
    pub(in crate::fit) fn curves(&self, data: &Prepared, fit: &Fit, intervals: &Intervals) -> Vec<ProfileCurve> {
        let probability = intervals.probability;
        if !fit.has_specular() {
            let level = quantile(probability, data.unit.is_none().then_some(data.freedom)).powi(2);
            return intervals.diffuse.map(|interval| parabola(fit, interval, level)).into_iter().collect();
        }
        let mut profile = self.profile(data, fit, probability);
        let all = [
            (Walk::Diffuse, Profiled::Diffuse, intervals.diffuse),
            (Walk::Intensity, Profiled::Intensity, intervals.intensity),
            (Walk::Shape(0), Profiled::Roughness, intervals.roughness),
            (Walk::Shape(1), Profiled::IndexMinusOne, intervals.index_minus_one),
        ];
        let known = all.into_iter().filter_map(|(walk, parameter, interval)| Some((walk, parameter, interval?)));
        known.map(|(walk, parameter, interval)| profile.curve(walk, parameter, interval)).collect()
    }
}

/// A diffuse amplitude beside nothing else is linear.
fn parabola(fit: &Fit, interval: Interval, level: f64) -> ProfileCurve {
    let (best, sigma) = (fit.bands[0].diffuse, fit.standard_uncertainty(0)[0]);
    let reach = BEYOND * level.sqrt();
    let root = |k: i32| reach * f64::from(k) / POINTS as f64;
    let ends = -(POINTS as i32)..=POINTS as i32;
    let points = ends.map(|k| (best + root(k) * sigma, root(k).powi(2))).filter(|(value, _)| *value >= 0.0).collect();
    ProfileCurve { parameter: Profiled::Diffuse, best, standard_uncertainty: sigma, points, level, interval }
}

impl Profile<'_> {
    fn curve(&mut self, walk: Walk, parameter: Profiled, interval: Interval) -> ProfileCurve {
        let level = self.quantile * self.quantile;
        let sigma = self.fit.standard_uncertainty(0);
        let (best, standard_uncertainty) = match parameter {
            Profiled::Diffuse => (self.fit.bands[0].diffuse, sigma[0]),
            Profiled::Intensity => (self.fit.bands[0].intensity, sigma[1]),
            Profiled::Roughness => (self.fit.roughness, sigma[2]),
            Profiled::IndexMinusOne => (self.fit.index_minus_one, sigma[3]),
        };
        let mut points = self.side(walk, -1.0, (interval.low, interval.low_open));
        points.reverse();
        points.push((best, 0.0));
        points.extend(self.side(walk, 1.0, (interval.high, interval.high_open)));
        ProfileCurve { parameter, best, standard_uncertainty, points, level, interval }
    }

    /// From the best value outwards, to somewhat beyond the end of the interval; an open end is as far as it goes.
    fn side(&mut self, walk: Walk, sign: f64, (end, is_open): (f64, bool)) -> Vec<(f64, f64)> {
        let (start, _, limit) = self.route(walk, sign);
        let end = if matches!(walk, Walk::Diffuse) { end } else { end.ln() };
        let reach = (end - start) * if is_open { 1.0 } else { BEYOND };
        let unit = self.rise / (self.quantile * self.quantile);
        let (mut follow, mut points) = (self.best, Vec::with_capacity(POINTS));
        if reach.is_nan() || reach * sign <= 0.0 {
            return points;
        }
        for k in 1..=POINTS {
            let wanted = start + reach * k as f64 / POINTS as f64;
            let at = if sign > 0.0 { wanted.min(limit) } else { wanted.max(limit) };
            // A fit that is better than the best one is none of this curve.
            let Ok(polished) = self.at(walk, at, follow) else { break };
            follow = polished.point;
            points.push((self.natural(walk, at), (polished.curvature.chi_square - self.lowest).max(0.0) / unit));
            if at == limit {
                break;
            }
        }
        points
    }
}
