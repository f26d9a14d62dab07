//! The largest CIELAB distance that leaving something out can make, proven by intervals.
//!
//! A pixel is a sum of colours with factors that lie between a least and a largest value. Some of the colours are left out. The distance
//! between the whole and what is left is bounded on boxes of factors, and boxes are halved where the bound is largest, until it is close
//! to a distance that does occur. f of CIE 15 grows everywhere and ever less steeply, so that its differences are bounded by its
//! values at the ends and by its slope there.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A factor, with the colours that it multiplies: XYZ over that of white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Factor {
    /// Its least value.
    pub(super) least: f64,
    /// Its largest value.
    pub(super) most: f64,
    /// In the picture as planned.
    pub(super) kept: [f64; 3],
    /// What the full picture has more of.
    pub(super) left_out: [f64; 3],
}

/// The largest distance, and where one nearly as large occurs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Largest {
    /// No distance is larger.
    pub(super) bound: f64,
    /// XYZ over white of the full and of the planned pixel where the largest that was met occurs.
    pub(super) at: [[f64; 3]; 2],
}

/// A bound so close to what occurs is close enough.
const CLOSE: f64 = 1.1;
/// Most boxes looked at, and most factors of all of them.
const BOXES: usize = 3000;
const BOXES_TIMES_FACTORS: usize = 10_000;
/// (6/29)^3 and (29/6)^2 / 3.
const EDGE: f64 = 216.0 / 24_389.0;
const SLOPE: f64 = 841.0 / 108.0;

fn f(t: f64) -> f64 {
    if t > EDGE { t.cbrt() } else { SLOPE * t + 4.0 / 29.0 }
}

fn slope(t: f64) -> f64 {
    if t > EDGE { t.cbrt().powi(-2) / 3.0 } else { SLOPE }
}

/// CIELAB distance for differences of f in X, Y and Z.
fn distance([x, y, z]: [f64; 3]) -> f64 {
    (116.0 * y).hypot(500.0 * (x - y)).hypot(200.0 * (y - z))
}

/// CIELAB distance of two colours, XYZ over that of white.
pub(in crate::simulate) fn lab_distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    distance([0, 1, 2].map(|c| f(one[c]) - f(other[c])))
}

/// Factors from a least to a largest value each.
#[derive(Debug, Clone)]
struct Box_ {
    low: Vec<f64>,
    high: Vec<f64>,
    bound: f64,
}

/// The one with the largest bound is the greatest.
impl Ord for Box_ {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

impl PartialOrd for Box_ {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Box_ {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Box_ {}

/// How closely a distance is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interest {
    /// Where it is below this, any number below this will do.
    pub(super) floor: f64,
    /// Where it is above this, any number above this will do.
    pub(super) ceiling: f64,
}

impl Interest {
    /// In every distance.
    pub(super) const ALL: Self = Self { floor: 0.0, ceiling: f64::INFINITY };

    /// Where so large a distance is known already.
    pub(super) fn above(self, known: f64) -> Self {
        Self { floor: self.floor.max(known), ..self }
    }
}

/// Bounds the distance over all factors.
pub(super) fn largest(factors: &[Factor], Interest { floor, ceiling }: Interest) -> Largest {
    let black = Largest { bound: 0.0, at: [[0.0; 3]; 2] };
    let factors: Vec<Factor> = factors
        .iter()
        .copied()
        .filter(|one| one.most > 0.0 && (one.kept != [0.0; 3] || one.left_out != [0.0; 3]))
        .collect();
    if factors.iter().all(|one| one.left_out == [0.0; 3]) {
        return black;
    }
    if factors.iter().any(|one| !one.most.is_finite()) {
        return Largest { bound: f64::INFINITY, ..black };
    }
    let high: Vec<f64> = factors.iter().map(|one| one.most).collect();
    let mut best = (0.0, [[0.0; 3]; 2]);
    let low: Vec<f64> = factors.iter().map(|one| one.least).collect();
    let mut boxes = BinaryHeap::from([on(&factors, low, high, &mut best)]);
    for _ in 0..BOXES.min(BOXES_TIMES_FACTORS / factors.len()) {
        // The last is for values that it does not matter for.
        let close = if ceiling.is_finite() { 0.0 } else { CLOSE * best.0 };
        let enough = floor.max(close).max(1e-9);
        if best.0 > ceiling || boxes.peek().is_none_or(|one| one.bound <= enough) {
            break;
        }
        let Some(whole) = boxes.pop() else { break };
        let sums = [0, 1, 2].map(|c| 1e-3 + sum(&factors, &whole.low, c));
        let weight = |k: usize| {
            let width = whole.high[k] - whole.low[k];
            let colour = |c: usize| factors[k].kept[c].abs().max(factors[k].left_out[c].abs());
            // Relative to what else there is, for f turns most where there is little.
            (0..3).map(|c| width * colour(c) / sums[c]).fold(0.0, f64::max)
        };
        let side = (0..factors.len()).max_by(|a, b| weight(*a).total_cmp(&weight(*b))).unwrap_or(0);
        let middle = (whole.low[side] + whole.high[side]) / 2.0;
        let (mut below, mut above) = (whole.high.clone(), whole.low.clone());
        below[side] = middle;
        above[side] = middle;
        for (low, high) in [(whole.low, below), (above, whole.high)] {
            let half = on(&factors, low, high, &mut best);
            // What is proven below a distance that occurs needs no more looking at.
            if half.bound > best.0.max(floor) {
                boxes.push(half);
            }
        }
    }
    let bound = boxes.peek().map_or(0.0, |one| one.bound).max(best.0);
    // Roundings of sums of a few terms.
    Largest { bound: bound * (1.0 + 1e-12), at: best.1 }
}

/// The least of the sum in a channel, as a scale.
fn sum(factors: &[Factor], low: &[f64], c: usize) -> f64 {
    factors.iter().zip(low).map(|(one, g)| g * (one.kept[c] + one.left_out[c]).abs()).sum()
}

fn on(factors: &[Factor], low: Vec<f64>, high: Vec<f64>, best: &mut (f64, [[f64; 3]; 2])) -> Box_ {
    let colour = |g: &dyn Fn(usize) -> f64| {
        let sum = |of: &dyn Fn(&Factor) -> [f64; 3], c: usize| {
            factors.iter().enumerate().map(|(k, one)| g(k) * of(one)[c]).sum::<f64>()
        };
        let planned = [0, 1, 2].map(|c| sum(&|one| one.kept, c));
        [[0, 1, 2].map(|c| planned[c] + sum(&|one| one.left_out, c)), planned]
    };
    for at in [colour(&|k| low[k]), colour(&|k| high[k]), colour(&|k| (low[k] + high[k]) / 2.0)] {
        let found = distance([0, 1, 2].map(|c| f(at[0][c]) - f(at[1][c])));
        if found > best.0 {
            *best = (found, at);
        }
    }
    let between = |of: &dyn Fn(&Factor) -> f64| {
        factors.iter().enumerate().fold((0.0, 0.0), |(least, most), (k, one)| {
            let (a, b) = (low[k] * of(one), high[k] * of(one));
            (least + a.min(b), most + a.max(b))
        })
    };
    let difference = |c: usize| {
        let kept = between(&|one| one.kept[c]);
        let full = between(&|one| one.kept[c] + one.left_out[c]);
        let apart = between(&|one| one.left_out[c]);
        let (steep, flat) = (slope(kept.0.min(full.0)), slope(kept.1.max(full.1)));
        let least = (f(full.0) - f(kept.1)).max((apart.0 * steep).min(apart.0 * flat));
        let most = (f(full.1) - f(kept.0)).min((apart.1 * steep).max(apart.1 * flat));
        (least, most.max(least))
    };
    let ends = [difference(0), difference(1), difference(2)];
    // The distance is convex in the differences: on a box it is largest at a corner.
    let corner = |which: usize| [0, 1, 2].map(|c| if which >> c & 1 == 0 { ends[c].0 } else { ends[c].1 });
    let bound = (0..8).map(|which| distance(corner(which))).fold(0.0, f64::max);
    Box_ { low, high, bound }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_pixel_is_further_off_than_the_bound_and_one_is_nearly_so_far() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..200 {
            let count = 1 + (4.0 * random()) as usize;
            let factors: Vec<Factor> = (0..count)
                .map(|_| {
                    let (part, most) = (random(), 3.0 * random().powi(3));
                    Factor {
                        least: if part < 0.7 { 0.0 } else { (part - 0.7) * most },
                        most,
                        kept: [random(), random(), random()],
                        left_out: [0; 3].map(|_| if random() < 0.5 { 0.0 } else { 0.3 * (random() - 0.3) }),
                    }
                })
                .collect();
            let found = largest(&factors, Interest::ALL);
            let mut most = 0.0_f64;
            for _ in 0..2000 {
                let g: Vec<f64> = factors
                    .iter()
                    .map(|one| one.least + (one.most - one.least) * if random() < 0.3 { 0.0 } else { random() })
                    .collect();
                let of = |c: usize, full: f64| {
                    factors.iter().zip(&g).map(|(one, g)| g * (one.kept[c] + full * one.left_out[c])).sum::<f64>()
                };
                most = most.max(distance([0, 1, 2].map(|c| f(of(c, 1.0)) - f(of(c, 0.0)))));
            }
            assert!(most <= found.bound, "{most} beyond {} for {factors:?}", found.bound);
            assert!(found.bound <= 2.0 * most + 1e-6, "{most} of {} for {factors:?}", found.bound);
        }
    }
}
