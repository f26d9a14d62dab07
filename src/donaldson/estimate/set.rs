//! What fits, as an answer: for each number the best and an interval.

use nalgebra::{DMatrix, DVector};
use ndarray::Array2;
use rayon::prelude::*;

use super::problem::{Best, Given, Problem, columns};
use super::random::Random;
use super::truncated::Truncated;
use super::walk::shapes_that_fit;
use super::{Axes, NoEstimate, Seen, check, prior};
use crate::quantity::named;

/// Draws over all shapes, about.
const DRAWS: usize = 960;
/// Draws that lead away from where the first one starts.
const AWAY: usize = 3;
/// How close the family of excitation spectra comes to a real one, in what is seen.
const FAMILY: f64 = 0.01;
/// What an interval covers, and how many standard deviations that is for a normal distribution.
const COVERED: f64 = 0.95;
const DEVIATIONS: f64 = 1.959_963_984_540_054;
/// Standard uncertainty of the reflectance, from the lights alone, beyond which a band counts as not told.
pub const UNTOLD: f64 = 0.05;

/// A number with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The best.
    pub best: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Interval {
    /// The standard uncertainty of a normal distribution whose interval is as wide.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        (self.high - self.low) / (2.0 * DEVIATIONS)
    }
}

named! {
    /// What a wavelength radiates.
    Range, "range" {
        /// Reflected light alone: what luminescence there could be is below the noise of every spectrum.
        ReflectionOnly = "reflection-only",
        /// Reflected light and luminescence.
        Mixed = "mixed",
        /// The spectra leave it open.
        Open = "open",
    }
}

/// What is known of the excitation spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Excitation<'a> {
    /// All of it: one number per excitation, 1 at the peak.
    Known(&'a [f64]),
    /// Nothing but what absorption spectra look like.
    Unknown,
}

/// A matrix, as an elastic and a luminescent part of one factor, as far as lights tell it. 95 % intervals, prior included.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Excitation spectrum, 1 at its peak.
    pub excitation: Vec<Interval>,
    /// Reflectance, one per emission.
    pub reflectance: Vec<Interval>,
    /// Emission spectrum: the matrix where the excitation spectrum is 1.
    pub emission: Vec<Interval>,
    /// The luminescent matrix \[excitation, emission\].
    pub luminescent: Array2<Interval>,
    /// Standard uncertainty of the reflectance from the lights alone at this wavelength; infinite where they cannot tell.
    pub lights_alone: Vec<f64>,
    /// What each emission wavelength radiates.
    pub ranges: Vec<Range>,
    /// Excitation spectra in the set; 1 of a known one.
    pub shapes: usize,
    /// How far the shapes lie from the middle of their prior, as the mean square of their numbers: 1 where they are as it has them.
    pub strain: f64,
    /// Weighted sum of squares that the best leaves.
    pub chi_square: f64,
    /// Values that it sums over.
    pub count: usize,
    /// The prior in words.
    pub prior: String,
}

impl Estimate {
    /// True where the lights tell reflection from luminescence without the prior.
    #[must_use]
    pub fn is_told(&self, emission: usize) -> bool {
        self.lights_alone.get(emission).is_some_and(|sigma| *sigma <= UNTOLD)
    }
}

/// One shape, solved.
struct Member {
    shape: Vec<f64>,
    given: Given,
    best: Best,
}

/// Estimates reflectance and emission, and the excitation spectrum where it is unknown. Deterministic.
///
/// For a known excitation spectrum the problem is convex. For an unknown one it is solved for each of a set of shapes, each
/// as frequent in the set as it is probable, and the intervals are over all of them. An interval holds the most probable 95 % of what
/// fits, and what the best alone says (its curvature): at a bound, where many numbers of a surface lie, either alone covers less.
///
/// # Errors
/// [`NoEstimate`].
pub fn estimate(axes: &Axes, seen: &[Seen], excitation: Excitation<'_>) -> Result<Estimate, NoEstimate> {
    check(axes, seen)?;
    let widened: Vec<Seen>;
    let seen = match excitation {
        Excitation::Known(_) => seen,
        Excitation::Unknown => {
            widened = seen.iter().map(widened_by_the_family).collect();
            &widened
        }
    };
    let problem = Problem::new(axes, seen);
    let (shapes, strain) = match excitation {
        Excitation::Known(shape) if shape.len() != axes.excitation_nm.len() => {
            let (found, expected) = (shape.len(), axes.excitation_nm.len());
            return Err(NoEstimate::Length {
                light: "all".to_owned(),
                what: "the excitation spectrum",
                found,
                expected,
            });
        }
        Excitation::Known(shape) => (vec![shape.to_vec()], 1.0),
        Excitation::Unknown => shapes_that_fit(&problem),
    };
    let solve = |shape: Vec<f64>| {
        let given = problem.given(&shape);
        Some(Member { best: given.best()?, given, shape })
    };
    let members: Vec<Member> = shapes.into_par_iter().filter_map(solve).collect();
    let central = central(&members).ok_or(NoEstimate::Undetermined)?;
    if central.given.count < axes.emission_nm.len() {
        return Err(NoEstimate::Few { found: central.given.count, emissions: axes.emission_nm.len() });
    }
    let is_known = matches!(excitation, Excitation::Known(_));
    Ok(Estimate { strain, ..collect(&problem, &members, central, is_known) })
}

/// No member of the family is a real spectrum: none comes closer to what is seen than this.
fn widened_by_the_family(seen: &Seen) -> Seen {
    let sigma = seen.sigma.iter().zip(&seen.values).map(|(sigma, value)| sigma.hypot(FAMILY * value));
    Seen { sigma: sigma.collect(), ..seen.clone() }
}

/// The member whose shape is nearest to the median of all.
fn central(members: &[Member]) -> Option<&Member> {
    let rows = members.first()?.shape.len();
    let median = |i: usize| super::super::overlap::median(members.iter().map(|member| member.shape[i]).collect());
    let middle: Vec<f64> = (0..rows).map(median).collect();
    let away = |member: &Member| member.shape.iter().zip(&middle).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    members.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// Reflectances and emissions that fit a shape.
fn draws(member: &Member, count: usize, seed: u64) -> Vec<DVector<f64>> {
    let Member { given, best, .. } = member;
    let n = given.gradient.len();
    let rows = given.balance.nrows();
    let mut bounds = DMatrix::zeros(n + rows, n);
    bounds.view_mut((0, 0), (n, n)).fill_with_identity();
    bounds.view_mut((n, 0), (rows, n)).copy_from(&-&given.balance);
    let offset = DVector::from_fn(n + rows, |k, _| if k < n { 0.0 } else { 1.0 });
    // Just inside.
    let start = best.at.map(|value| value.max(1e-6));
    let most = (&given.balance * &start).max();
    let start = if most >= 0.999 { start * (0.999 / most) } else { start };
    let Some(mut truncated) = Truncated::new(&given.curvature, &given.gradient, &bounds, &offset, &start) else {
        return vec![best.at.clone()];
    };
    let mut random = Random::new(seed);
    (0..AWAY + count).map(|_| truncated.draw(&mut random)).skip(AWAY).collect()
}

fn collect(problem: &Problem<'_>, members: &[Member], central: &Member, is_known: bool) -> Estimate {
    let axes = problem.axes;
    let each = DRAWS.div_ceil(members.len());
    let all: Vec<(&[f64], DVector<f64>)> = members
        .par_iter()
        .enumerate()
        .flat_map_iter(|(k, member)| draws(member, each, k as u64).into_iter().map(|z| (&member.shape[..], z)))
        .collect();
    let (rows, n) = (axes.excitation_nm.len(), axes.emission_nm.len());
    let at = &central.best.at;
    let sigma = sigma(&central.best);
    let number = |k: usize| {
        let interval = shortest(all.iter().map(|(_, z)| z[k].max(0.0)).collect(), at[k]);
        let reach = DEVIATIONS * sigma[k];
        Interval { low: interval.low.min((at[k] - reach).max(0.0)), high: interval.high.max(at[k] + reach), ..interval }
    };
    let excited = |i: usize| match is_known {
        true => Interval { best: central.shape[i], low: central.shape[i], high: central.shape[i] },
        false => shortest(members.iter().map(|member| member.shape[i]).collect(), central.shape[i]),
    };
    let cell = |(i, j): (usize, usize)| {
        if axes.emission_nm[j] < axes.excitation_nm[i] {
            return Interval { best: 0.0, low: 0.0, high: 0.0 };
        }
        let x = central.shape[i];
        let interval = shortest(all.iter().map(|(shape, z)| shape[i] * z[n + j].max(0.0)).collect(), x * at[n + j]);
        let (value, reach) = (x * at[n + j], x * DEVIATIONS * sigma[n + j]);
        Interval { low: interval.low.min((value - reach).max(0.0)), high: interval.high.max(value + reach), ..interval }
    };
    let alone: Vec<Vec<f64>> = members.iter().map(|member| member.given.lights_alone()).collect();
    let median = |j: usize| super::super::overlap::median(alone.iter().map(|list| list[j]).collect());
    let emission: Vec<Interval> = (n..2 * n).map(number).collect();
    Estimate {
        excitation: (0..rows).map(excited).collect(),
        reflectance: (0..n).map(number).collect(),
        ranges: ranges(problem, &central.shape, &emission),
        emission,
        luminescent: Array2::from_shape_fn((rows, n), cell),
        lights_alone: (0..n).map(median).collect(),
        shapes: members.len(),
        strain: 1.0,
        chi_square: central.best.chi_square,
        count: central.given.count,
        prior: prior::words(is_known),
    }
}

/// Luminescence is there where nothing that fits lacks it; it is not where its upper end stays below every spectrum's noise.
fn ranges(problem: &Problem<'_>, shape: &[f64], emission: &[Interval]) -> Vec<Range> {
    let lit: Vec<Vec<(f64, f64)>> = problem.seen.iter().map(|one| columns(problem.axes, &one.light, shape)).collect();
    let range = |(j, interval): (usize, &Interval)| {
        let is_below = |(one, lit): (&Seen, &Vec<(f64, f64)>)| interval.high * lit[j].1 <= 2.0 * one.sigma[j];
        match interval.low > 0.0 {
            true => Range::Mixed,
            false if problem.seen.iter().zip(&lit).all(is_below) => Range::ReflectionOnly,
            false => Range::Open,
        }
    };
    emission.iter().enumerate().map(range).collect()
}

/// Standard uncertainties from the curvature, of the numbers that are not at 0; 0 for those.
fn sigma(best: &Best) -> Vec<f64> {
    let free: Vec<usize> = (0..best.at.len()).filter(|k| best.at[*k] > 0.0).collect();
    let inverse = super::super::nonnegative::inverse_over(&best.curvature, &free);
    (0..best.at.len()).map(|k| inverse.as_ref().map_or(0.0, |inverse| inverse[(k, k)].max(0.0).sqrt())).collect()
}

/// The shortest interval that covers 95 % of the draws, and the best. One that begins with the smallest draw, close to
/// 0, begins at 0: nothing speaks against it there.
fn shortest(mut draws: Vec<f64>, best: f64) -> Interval {
    draws.sort_by(f64::total_cmp);
    let inside = ((COVERED * draws.len() as f64).ceil() as usize).clamp(1, draws.len());
    let width = |first: &usize| draws[first + inside - 1] - draws[*first];
    let first = (0..=draws.len() - inside).min_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or(0);
    let high = draws[first + inside - 1];
    let is_at_bound = first == 0 && draws[0] < 0.2 * (high - draws[0]);
    let low = if is_at_bound { 0.0 } else { draws[first] };
    Interval { best, low: low.min(best), high: high.max(best) }
}
