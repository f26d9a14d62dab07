//! Light from all around at an interface.
//!
//! It is integrated over the half vector, as in the albedo of a term, but with pieces that follow it to the horizon: seen at a cosine u
//! the edges of G lie about u from the normal, and as much light comes from each power of the distance from them as from the next.
//!
//! For all distributions and denominators and half widths of a lobe from .002 to 1 rad the table is within 1e-6 of a separate quadrature
//! along the normal, 5e-5 to 45 degrees and 5e-4 to 89.99 degrees, of which the quadrature itself may be off by 1e-4; its largest value
//! is at most 1 % below that between its places (`cargo test --lib simulate::energy::interface`).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};
use std::sync::LazyLock;

use rayon::prelude::*;

use super::Interface;
use crate::simulate::vector::{dot, minus, scaled};

/// Cosines that it is tabulated at.
const VIEWS: usize = 81;
/// The least of them: 89.99994 degrees.
const LEAST: f64 = 1e-6;
/// How much denser they stand along the normal than their logarithms do.
const BY_COSINE: f64 = 8.0;
/// Points that a value is interpolated from.
const POINTS: usize = 6;
/// Pieces of an integral end at powers of these: beside the lobe, and beside the horizon.
const LOBE: f64 = 3.0;
const HORIZON: f64 = 4.0;
/// Gauss's rule of eight points from -1 to 1: the positive ones and their weights.
const RULE: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// What an interface sends of light from all around, over that which a perfect diffuser does, at cosines of viewing.
pub(super) fn table(interface: &Interface) -> Vec<f64> {
    COSINES.par_iter().map(|cosine| integral(interface, *cosine)).collect()
}

/// Where a cosine stands in the table: by its logarithm near the horizon, by itself near the normal.
fn place(cosine: f64) -> f64 {
    let height = |cosine: f64| cosine.ln() + BY_COSINE * cosine;
    let (first, last) = (height(LEAST), height(1.0));
    (height(cosine) - first) / (last - first) * (VIEWS - 1) as f64
}

/// The cosines of the table, by Newton's steps in the logarithm, where the function bends one way only.
static COSINES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let (first, last) = (LEAST.ln() + BY_COSINE * LEAST, BY_COSINE);
    let cosine = |k: usize| {
        let height = first + (last - first) * k as f64 / (VIEWS - 1) as f64;
        let step = |log: f64| log - (log + BY_COSINE * log.exp() - height) / (1.0 + BY_COSINE * log.exp());
        (0..60).fold(height.min(0.0), |log, _| step(log)).exp()
    };
    (0..VIEWS - 1).map(cosine).chain([1.0]).collect()
});

/// The table at a cosine. Over the cosine it is a polynomial in the logarithm, nearly, for every denominator; nearer to the horizon than
/// the table goes it is that of its end.
pub(in crate::simulate) fn at(table: &[f64], view: f64) -> f64 {
    let view = view.clamp(0.0, 1.0);
    if view <= LEAST {
        // A power of the cosine, between the first and none.
        let power = (table[1] / table[0]).ln() / (COSINES[1] / LEAST).ln();
        return table[0] * (view / LEAST).powf(if power.is_nan() { 0.0 } else { power.clamp(0.0, 1.0) });
    }
    let place = place(view);
    let first = (place as usize).saturating_sub(POINTS / 2 - 1).min(VIEWS - POINTS);
    let x = place - first as f64;
    let share = |k: usize| {
        let others = (0..POINTS).filter(|other| *other != k);
        others.map(|other| (x - other as f64) / (k as f64 - other as f64)).product::<f64>()
    };
    let over = |k: usize| table[first + k] / COSINES[first + k];
    view * (0..POINTS).map(|k| share(k) * over(k)).sum::<f64>().max(0.0)
}

/// The integral of D F G / den over pi over all directions of light, seen at a cosine above 0.
fn integral(interface: &Interface, cosine: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (normal, view, tangent) = ([0.0, 0.0, 1.0], [sine, 0.0, cosine], sine / cosine);
    let width = interface.half_width();
    let at_azimuth = |alpha: f64| {
        let (sin, cos) = alpha.sin_cos();
        let delta = (tangent * cos).atan();
        over(&polars(delta, (tangent * cos).abs().recip(), width), |phi| {
            let half = [phi.sin() * cos, phi.sin() * sin, phi.cos()];
            let cos_q = dot(half, view);
            let value = interface.value(normal, minus(scaled(half, 2.0 * cos_q), view), view);
            // d(omega_i) = 4 cos(theta_Q) d(omega_Q).
            if value.is_finite() { value * 4.0 * cos_q * phi.sin() } else { 0.0 }
        })
    };
    // One half of the azimuths stands for both.
    2.0 / PI * over(&azimuths(tangent), at_azimuth)
}

/// Azimuths of the half vector from 0 to pi, between which the edges of G do not cross and turn slowly.
fn azimuths(tangent: f64) -> Vec<f64> {
    let turns = powers(1.0, HORIZON, tangent).chain(Some(FRAC_PI_6.tan()).filter(|turn| *turn < tangent));
    let turns: Vec<f64> = turns.map(|turn| (turn / tangent).acos()).collect();
    let behind = turns.iter().map(|alpha| PI - alpha);
    ordered([0.0, FRAC_PI_2, PI].into_iter().chain(turns.iter().copied()).chain(behind), PI)
}

/// Polar angles of the half vector, between which all is smooth: edges of G and what is `near` them, and the lobe.
fn polars(delta: f64, near: f64, width: f64) -> Vec<f64> {
    // Beyond, light comes from below the horizon.
    let last = (FRAC_PI_2 + delta) / 2.0;
    let edges = [0.0, (FRAC_PI_2 + delta) / 3.0, FRAC_PI_2 - delta, last];
    let near = if delta > 0.0 { near } else { last };
    ordered(edges.into_iter().chain(powers(near, HORIZON, last)).chain(powers(width, LOBE, last)), last)
}

/// The powers of a ratio times a number, up to another.
fn powers(from: f64, ratio: f64, to: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(from), move |x| Some(ratio * x)).take_while(move |x| *x < to)
}

/// Each once, up to the last.
fn ordered(breaks: impl Iterator<Item = f64>, last: f64) -> Vec<f64> {
    let mut breaks: Vec<f64> = breaks.filter(|at| (0.0..=last).contains(at)).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

/// An integral in pieces.
fn over(breaks: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    let piece = |from: f64, to: f64| {
        let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
        half * RULE.iter().map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x))).sum::<f64>()
    };
    breaks.windows(2).map(|pair| piece(pair[0], pair[1])).sum()
}
