//! Which excitation spectra fit: walkers over the numbers that make a shape, which step along differences of each other
//! (ter Braak, Stat. Comput. 16 (2006) 239).
//!
//! Each shape is as probable as its best reflectance and emission make it. The volume of those that are nearly as good is left
//! out on purpose: it is largest where luminescence looks like reflection, and would draw the walkers to where the data tell least.

use rayon::prelude::*;

use super::problem::Problem;
use super::random::Random;
use super::shapes::{NUMBERS, shape};
use crate::donaldson::overlap::median;

/// Walkers in each of the two halves; one half steps along differences of the other, so that it can step at once.
const HALF: usize = 24;
/// Shapes of the prior that are tried for each walker to start from.
const TRIED: usize = 12;
/// Steps of each walker that count, after those that lead there: at least so many, at most so many.
const STEPS: usize = 80;
const WAY: (usize, usize) = (60, 600);
/// One in a thousand costs is this much above the least: chi-square of twelve numbers.
const RARE: f64 = 33.0;
/// Every so many steps the walkers are taken into the set.
const EVERY: usize = 16;

type Numbers = [f64; NUMBERS];

#[derive(Clone)]
struct Walker {
    numbers: Numbers,
    cost: f64,
}

/// Shapes as probable as they are frequent here; empty where none could be solved. Deterministic. With them the mean square of the
/// numbers that make them: 1 for shapes as the prior has them.
pub(super) fn shapes_that_fit(problem: &Problem<'_>) -> (Vec<Vec<f64>>, f64) {
    let cost = |numbers: &Numbers| {
        let best = problem.given(&shape(numbers, &problem.axes.excitation_nm)).best();
        best.map_or(f64::INFINITY, |best| best.cost + numbers.iter().map(|x| x * x).sum::<f64>())
    };
    let mut random = Random::new(0x6262_7266);
    let mut halves = start(&mut random, &cost);
    let mut kept = Vec::new();
    let values = problem.given(&shape(&[0.0; NUMBERS], &problem.axes.excitation_nm)).count.max(1) as f64;
    let (mut way, mut taken) = (0, 0);
    while taken < STEPS {
        let (least, spread) = least_and_spread(&halves);
        // Where not even the best fits, what fits as badly counts.
        let floor = (least / values).max(1.0);
        let is_there = way >= WAY.1 || way >= WAY.0 && spread <= floor;
        let heat = if is_there { floor } else { spread.max(floor) };
        for half in 0..2 {
            let proposals: Vec<(Numbers, f64)> = (0..HALF)
                .map(|k| (propose(&halves[half][k].numbers, &halves[1 - half], &mut random), random.uniform().ln()))
                .collect();
            let costs: Vec<f64> = proposals.par_iter().map(|(numbers, _)| cost(numbers)).collect();
            for (walker, ((numbers, level), cost)) in halves[half].iter_mut().zip(proposals.into_iter().zip(costs)) {
                if level < (walker.cost - cost) / (2.0 * heat) {
                    *walker = Walker { numbers, cost };
                }
            }
        }
        if is_there {
            taken += 1;
        } else {
            way += 1;
            rescue(&mut halves, heat, &mut random);
        }
        if is_there && taken % EVERY == 0 {
            kept.extend(halves.iter().flatten().filter(|walker| walker.cost.is_finite()).map(|walker| walker.numbers));
        }
    }
    let squares: f64 = kept.iter().flatten().map(|x| x * x).sum();
    let strain = squares / (kept.len().max(1) * NUMBERS) as f64;
    (kept.iter().map(|numbers| shape(numbers, &problem.axes.excitation_nm)).collect(), strain)
}

/// The least cost, and by how much costs are divided on the way: walkers that are spread over more than the noise would all stay
/// where they are. Where they belong their costs are as many above the least as they have numbers.
fn least_and_spread(halves: &[Vec<Walker>; 2]) -> (f64, f64) {
    let costs: Vec<f64> = halves.iter().flatten().map(|walker| walker.cost).filter(|cost| cost.is_finite()).collect();
    let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = (median(costs) - least) / (1.5 * NUMBERS as f64);
    (least, if spread.is_finite() { spread } else { 0.0 })
}

/// A walker that stands where next to none would be is stuck, and goes on from where another one is.
fn rescue(halves: &mut [Vec<Walker>; 2], heat: f64, random: &mut Random) {
    let mut sorted: Vec<Walker> = halves.iter().flatten().cloned().collect();
    sorted.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let least = sorted[0].cost;
    for walker in halves.iter_mut().flatten().filter(|walker| walker.cost > least + RARE * heat) {
        *walker = sorted[random.below(HALF)].clone();
    }
}

fn start(random: &mut Random, cost: &(impl Fn(&Numbers) -> f64 + Sync)) -> [Vec<Walker>; 2] {
    let drawn: Vec<Numbers> = (0..2 * HALF * TRIED).map(|_| std::array::from_fn(|_| random.normal())).collect();
    let mut walkers: Vec<Walker> =
        drawn.into_par_iter().map(|numbers| Walker { cost: cost(&numbers), numbers }).collect();
    walkers.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    walkers.truncate(2 * HALF);
    let second = walkers.iter().skip(1).step_by(2).cloned().collect();
    [walkers.into_iter().step_by(2).collect(), second]
}

/// Along the difference of two of the other half, now and then all of it or little of it, and a little to any side.
fn propose(from: &Numbers, others: &[Walker], random: &mut Random) -> Numbers {
    let a = random.below(others.len());
    let b = (a + 1 + random.below(others.len() - 1)) % others.len();
    let usual = 2.38 / (2.0 * NUMBERS as f64).sqrt();
    let length = match random.below(10) {
        0 => 1.0,
        1 | 2 => 0.4 * usual,
        _ => usual,
    };
    std::array::from_fn(|k| from[k] + length * (others[a].numbers[k] - others[b].numbers[k]) + 0.02 * random.normal())
}
