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
/// Most boxes looked at.
const BOXES: usize = 3000;
/// What roundings, and ends that are nearly one, may take from a slope.
const SURE: f64 = 1e-4;
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
    let [lightness, a, b] = [116.0 * y, 500.0 * (x - y), 200.0 * (y - z)];
    (lightness * lightness + a * a + b * b).sqrt()
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
}

/// How it is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    pub(super) interest: Interest,
    /// Factors times boxes at most.
    pub(super) boxes: usize,
    /// Whether there may be any amount of other light, of any colour, in both pictures.
    pub(super) has_more: bool,
}

impl Look {
    /// In every distance, closely.
    #[cfg(test)]
    const ALL: Self = Self { interest: Interest::ALL, boxes: 10_000, has_more: false };

    /// Where so large a distance is known already.
    pub(super) fn above(self, known: f64) -> Self {
        let interest = Interest { floor: self.interest.floor.max(known), ..self.interest };
        Self { interest, ..self }
    }
}

/// Bounds the distance over all factors.
pub(super) fn largest(factors: &[Factor], look: Look) -> Largest {
    let Interest { floor, ceiling } = look.interest;
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
    let mut boxes = BinaryHeap::from([on(&factors, low, high, look.has_more, &mut best)]);
    for _ in 0..BOXES.min(look.boxes / factors.len()) {
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
            let half = on(&factors, low, high, look.has_more, &mut best);
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

fn on(factors: &[Factor], low: Vec<f64>, high: Vec<f64>, has_more: bool, best: &mut (f64, [[f64; 3]; 2])) -> Box_ {
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
    let mut ranges = [[Range::ZERO; 3]; 3];
    for (k, one) in factors.iter().enumerate() {
        for (c, [kept, full, apart]) in ranges.iter_mut().enumerate() {
            kept.add(low[k], high[k], one.kept[c]);
            full.add(low[k], high[k], one.kept[c] + one.left_out[c]);
            apart.add(low[k], high[k], one.left_out[c]);
        }
    }
    let bound = by_channels(&ranges, has_more).min(by_slopes(factors, &low, &high, &ranges, has_more));
    Box_ { low, high, bound }
}

/// Between which values a sum lies.
#[derive(Debug, Clone, Copy)]
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    const ZERO: Self = Self { low: 0.0, high: 0.0 };

    /// A value times a factor between these.
    fn add(&mut self, low: f64, high: f64, value: f64) {
        let (a, b) = (low * value, high * value);
        self.low += a.min(b);
        self.high += a.max(b);
    }

    fn most(self) -> f64 {
        self.high.max(-self.low)
    }
}

/// A bound by the differences of f in X, Y and Z, each by itself; the ranges are those of what is kept, of the whole and of what is
/// left out.
fn by_channels(ranges: &[[Range; 3]; 3], has_more: bool) -> f64 {
    let ends = ranges.map(|[kept, full, apart]| {
        let (steep, flat) = (slope(kept.low.min(full.low)), slope(kept.high.max(full.high)));
        let least = (f(full.low) - f(kept.high)).max((apart.low * steep).min(apart.low * flat));
        let most = (f(full.high) - f(kept.low)).min((apart.high * steep).max(apart.high * flat));
        // The more there is beside it, the less is seen of it.
        if has_more { (least.min(0.0), most.max(0.0)) } else { (least, most.max(least)) }
    });
    // The distance is convex in the differences: on a box it is largest at a corner.
    let corner = |which: usize| [0, 1, 2].map(|c| if which >> c & 1 == 0 { ends[c].0 } else { ends[c].1 });
    (0..8).map(|which| distance(corner(which))).fold(0.0, f64::max)
}

/// A bound by what is left out times the slopes of f between what is kept and the whole. It is convex in the slopes, and for given slopes
/// each of L*, a* and b* is a sum over the factors: so a colour that is left out stays the colour that it is.
fn by_slopes(factors: &[Factor], low: &[f64], high: &[f64], ranges: &[[Range; 3]; 3], has_more: bool) -> f64 {
    let slopes = ranges.map(|[kept, full, _]| {
        let flat = if has_more { 0.0 } else { secant(kept.high, full.high) * (1.0 - SURE) };
        [flat, secant(kept.low, full.low) * (1.0 + SURE)]
    });
    let most = |of: &dyn Fn(&[f64; 3]) -> f64| {
        let mut range = Range::ZERO;
        factors
            .iter()
            .zip(low.iter().zip(high))
            .for_each(|(one, (low, high))| range.add(*low, *high, of(&one.left_out)));
        range.most()
    };
    let at = |y: f64| {
        let lightness = 116.0 * most(&|left| y * left[1]);
        let a = slopes[0].map(|x| 500.0 * most(&|left| x * left[0] - y * left[1]));
        let b = slopes[2].map(|z| 200.0 * most(&|left| y * left[1] - z * left[2]));
        let (a, b) = (a[0].max(a[1]), b[0].max(b[1]));
        (lightness * lightness + a * a + b * b).sqrt()
    };
    at(slopes[1][0]).max(at(slopes[1][1]))
}

/// The slope of f from one value to another; f turns away from its tangents, so that it falls with both.
fn secant(from: f64, to: f64) -> f64 {
    let apart = to - from;
    if from.max(to) <= EDGE {
        return SLOPE;
    }
    // Too near for a difference, the slope of either end is as good.
    if apart.abs() <= 1e-5 * from.abs().max(to.abs()) { slope(from.min(to)) } else { (f(to) - f(from)) / apart }
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
            let found = largest(&factors, Look::ALL);
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
