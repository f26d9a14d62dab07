//! The geometries that help most: one after another, then each against all others until no exchange helps; from several
//! first ones, for an exchange of one ends where two would have to go together.
//!
//! Adding a row j to information M changes ln det M by ln(1 + j' V j) and the variance of parameter k by
//! -(V j)_k^2 / (1 + j' V j), with V = M^-1: one candidate costs one quadratic form. The exchange is Fedorov's as Cook
//! and Nachtsheim (1980) modified it. V itself is made anew for every M, so that no error adds up.

use std::str::FromStr;

use nalgebra::DMatrix;

use super::candidates::is_same;
use super::guess::Guess;
use super::prediction::predict;
use super::sensitivity::Sensitivities;
use crate::quantity::Geometry;

/// Information that the criterion adds to every parameter: what one value of a relative standard uncertainty of 100 would
/// tell. With it the first geometries can be chosen where the list alone determines nothing.
const REGULAR: f64 = 1e-4;
/// Passes of the exchange; two or three are usual.
const MOST_PASSES: usize = 30;
/// How many first geometries are tried.
const STARTS: usize = 8;
/// An exchange must gain this share.
const GAIN: f64 = 1e-9;

/// What the choice makes small.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Goal {
    /// The volume of the uncertainty of all parameters (D-optimal).
    All,
    /// The uncertainty of the parameter of this name.
    Parameter(String),
}

/// A goal that the guess does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{found}` is nothing to optimise; expected `d` for all parameters together, or one of: {expected}")]
pub struct UnknownGoal {
    /// What was asked for.
    pub found: String,
    /// The parameters that there are.
    pub expected: String,
}

impl FromStr for Goal {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(if text == "d" { Self::All } else { Self::Parameter(text.replace('-', "_")) })
    }
}

impl Goal {
    /// The parameter's position in the guess: by its full name or by its own, the first of that name.
    fn position(&self, guess: &Guess) -> Result<Option<usize>, UnknownGoal> {
        let Self::Parameter(name) = self else { return Ok(None) };
        let parameters = guess.parameters();
        let full = |text: &str| text.replace('-', "_");
        let found = parameters.iter().position(|one| full(&one.name) == *name || one.parameter == name);
        let expected = || parameters.iter().map(|one| one.parameter.replace('_', "-")).collect::<Vec<_>>().join(", ");
        found.map(Some).ok_or_else(|| UnknownGoal { found: name.replace('_', "-"), expected: expected() })
    }
}

/// A geometry that was chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Added {
    /// Its index among the candidates.
    pub candidate: usize,
    /// Standard uncertainty of each parameter with it and those before it; NaN where still undetermined.
    pub standard_uncertainty: Vec<f64>,
}

/// Chooses `count` candidates, each at most once and none that is planned already, in the order in which they help.
///
/// A list that determines nothing is no obstacle: the criterion alone is regularised (with what one value of a hundredfold
/// relative uncertainty would tell of each parameter); the uncertainties returned contain nothing of that.
///
/// # Errors
/// [`UnknownGoal`] where the guess has no such parameter.
pub fn choose(
    guess: &Guess,
    (planned, known): (&[Geometry], &Sensitivities),
    (candidates, offered): (&[Geometry], &Sensitivities),
    goal: &Goal,
    count: usize,
) -> Result<Vec<Added>, UnknownGoal> {
    let search = Search { base: information(known), offered, parameter: goal.position(guess)? };
    let mut free: Vec<bool> =
        candidates.iter().map(|candidate| !planned.iter().any(|geometry| is_same(geometry, candidate))).collect();
    offered.without_value().iter().for_each(|index| free[*index] = false);
    let chosen = search.best_of_starts(&free, count);
    let mut among = vec![false; candidates.len()];
    chosen.iter().for_each(|index| among[*index] = true);
    let ordered = search.greedy(&mut among, chosen.len());
    let after = |last: usize| {
        let taken = &ordered[..=last];
        let geometry: Vec<Geometry> =
            planned.iter().copied().chain(taken.iter().map(|index| candidates[*index])).collect();
        predict(guess, &geometry, &known.with(offered, taken)).standard_uncertainty
    };
    Ok(ordered
        .iter()
        .enumerate()
        .map(|(k, candidate)| Added { candidate: *candidate, standard_uncertainty: after(k) })
        .collect())
}

/// Information of all rows, with what the criterion adds.
fn information(rows: &Sensitivities) -> DMatrix<f64> {
    let p = rows.parameters();
    let mut sum = DMatrix::identity(p, p) * REGULAR;
    (0..rows.len()).for_each(|index| add(&mut sum, rows.row(index)));
    sum
}

fn add(information: &mut DMatrix<f64>, row: &[f64]) {
    for (i, a) in row.iter().enumerate() {
        for (j, b) in row.iter().enumerate() {
            information[(i, j)] += a * b;
        }
    }
}

struct Search<'a> {
    base: DMatrix<f64>,
    offered: &'a Sensitivities,
    /// The parameter whose variance is made small; `None` for all.
    parameter: Option<usize>,
}

impl Search<'_> {
    /// The covariance with some of the candidates; `None` where rounding has taken the information's rank.
    fn covariance(&self, chosen: impl Iterator<Item = usize>) -> Option<DMatrix<f64>> {
        let mut information = self.base.clone();
        chosen.for_each(|index| add(&mut information, self.offered.row(index)));
        let scale: Vec<f64> = information.diagonal().iter().map(|x| x.sqrt().recip()).collect();
        let scaled = information.map_with_location(|i, j, x| x * scale[i] * scale[j]);
        let inverse = scaled.cholesky()?.inverse();
        Some(inverse.map_with_location(|i, j, x| x * scale[i] * scale[j]))
    }

    /// What a candidate gains.
    fn gain(&self, covariance: &DMatrix<f64>, candidate: usize) -> f64 {
        let row = self.offered.row(candidate);
        let p = row.len();
        // The matrix is symmetric: its columns, which are contiguous, are its rows.
        let along =
            |k: usize| -> f64 { covariance.as_slice()[k * p..(k + 1) * p].iter().zip(row).map(|(v, j)| v * j).sum() };
        let form: f64 = (0..p).map(|k| row[k] * along(k)).sum();
        match self.parameter {
            None => form,
            Some(k) => along(k).powi(2) / (1.0 + form) / covariance[(k, k)],
        }
    }

    fn best(&self, covariance: &DMatrix<f64>, free: &[bool]) -> Option<(usize, f64)> {
        let gains = free.iter().enumerate().filter(|(_, free)| **free).map(|(k, _)| (k, self.gain(covariance, k)));
        gains.fold(None, |best: Option<(usize, f64)>, (k, gain)| match best {
            Some((_, most)) if gain <= most || gain.is_nan() => best,
            _ => Some((k, gain)),
        })
    }

    /// The best of several starts: each of the geometries that gain most alone comes first once, and for one parameter what
    /// is best for all of them is a start too.
    fn best_of_starts(&self, free: &[bool], count: usize) -> Vec<usize> {
        let mut starts = vec![self.greedy(&mut free.to_vec(), count)];
        if let (true, Some(covariance)) = (count > 1, self.covariance(std::iter::empty())) {
            let gain = |index: &usize| self.gain(&covariance, *index);
            let mut first: Vec<usize> = (0..free.len()).filter(|index| free[*index]).collect();
            first.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
            starts.extend(first.iter().take(STARTS).map(|index| self.greedy_after(*index, free, count)));
        }
        if self.parameter.is_some() {
            let all = Search { base: self.base.clone(), parameter: None, ..*self };
            starts.push(all.best_of_starts(free, count));
        }
        for chosen in &mut starts {
            let mut free = free.to_vec();
            chosen.iter().for_each(|index| free[*index] = false);
            self.exchange(chosen, &mut free);
        }
        starts.into_iter().min_by(|a, b| self.merit(a).total_cmp(&self.merit(b))).unwrap_or_default()
    }

    fn greedy_after(&self, first: usize, free: &[bool], count: usize) -> Vec<usize> {
        let mut base = self.base.clone();
        add(&mut base, self.offered.row(first));
        let mut free = free.to_vec();
        free[first] = false;
        let rest = Search { base, ..*self }.greedy(&mut free, count - 1);
        std::iter::once(first).chain(rest).collect()
    }

    /// What is made small; infinite where it cannot be said.
    fn merit(&self, chosen: &[usize]) -> f64 {
        let Some(covariance) = self.covariance(chosen.iter().copied()) else { return f64::INFINITY };
        match self.parameter {
            Some(k) => covariance[(k, k)],
            None => covariance.determinant(),
        }
    }

    fn greedy(&self, free: &mut [bool], count: usize) -> Vec<usize> {
        let mut chosen: Vec<usize> = Vec::new();
        while chosen.len() < count {
            let Some(covariance) = self.covariance(chosen.iter().copied()) else { break };
            let Some((best, _)) = self.best(&covariance, free) else { break };
            free[best] = false;
            chosen.push(best);
        }
        chosen
    }

    fn exchange(&self, chosen: &mut [usize], free: &mut [bool]) {
        for _ in 0..MOST_PASSES {
            let mut is_changed = false;
            for place in 0..chosen.len() {
                let others = chosen.iter().enumerate().filter(|(k, _)| *k != place).map(|(_, index)| *index);
                let Some(covariance) = self.covariance(others) else { continue };
                let Some((best, gain)) = self.best(&covariance, free) else { continue };
                if gain > self.gain(&covariance, chosen[place]) * (1.0 + GAIN) {
                    free[chosen[place]] = true;
                    free[best] = false;
                    chosen[place] = best;
                    is_changed = true;
                }
            }
            if !is_changed {
                return;
            }
        }
    }
}
