//! Fits of every kind of scan: at the global optimum, or said that the data cannot tell. The optimum and the profile are those
//! of another program. `BBRF_TRIALS=10000` runs as many scans of the whole box, and a tenth of each kind.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod families;
    pub mod optimum;
    pub mod scans;
}

use bbrf::fit::{Fit, Fitter, GeometrySet, Intervals, Terms};
use bbrf::quantity::Reference;
use bbrf::terms::{Denominator, Distribution};
use common::families::{Family, Scan};
use common::optimum::Known;
use common::scans::{Prepared, Random, Truth, prepare};
use ndarray::aview1;
use rayon::prelude::*;

const BOTH: Terms = Terms { diffuse: true, specular: true };

fn trials() -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(100)
}

/// A kind of scan with what its fits need.
struct Bench {
    family: Family,
    set: GeometrySet,
    prepared: Vec<Prepared>,
}

impl Bench {
    fn new(family: Family) -> Self {
        let (reference, distribution) = (Reference::None, Distribution::GaussianHalfHeight);
        let set = GeometrySet::new(&family.grid, &reference, distribution, Denominator::CosThetaI).unwrap();
        Self { set, prepared: prepare(&family.grid), family }
    }

    fn fit(&self, scan: &Scan) -> (Fit, Intervals) {
        let [values, sigma] =
            [&scan.values, &scan.sigma].map(|list| aview1(list).into_shape_with_order((1, list.len())).unwrap());
        Fitter::new(&self.set, BOTH).fit_with_intervals(values, Some(sigma), 0.95).unwrap()
    }
}

/// Roughness and index, where it is said that the data cannot tell them.
fn said(intervals: &Intervals) -> [bool; 2] {
    [intervals.roughness, intervals.index_minus_one]
        .map(|interval| interval.is_none_or(|interval| !interval.is_closed()))
}

#[test]
fn a_fit_anywhere_in_the_box_is_at_the_optimum_or_says_that_the_data_cannot_tell() {
    let bench = Bench::new(Family::whole_box());
    let count = trials();
    let outcomes: Vec<(bool, bool)> = (0..count)
        .into_par_iter()
        .map(|trial| {
            let mut random = Random::new(977 + 7919 * trial as u64);
            let scan = bench.family.scan(&mut random);
            let known = Known::new(&bench.prepared, &scan.values, &scan.sigma);
            let (fit, intervals) = bench.fit(&scan);
            let least = known.least(&scan.truth, 30, &mut random).min(fit.chi_square);
            let (gap, said) =
                ((fit.chi_square - least) / (least / (known.values.len() as f64 - 4.0)), said(&intervals));
            assert!(gap <= 1.0 || said.contains(&true), "trial {trial}: {gap} above the optimum: {:?}", scan.truth);
            let found = Truth {
                albedo: fit.bands[0].diffuse,
                intensity: fit.bands[0].intensity,
                roughness: fit.roughness,
                index_minus_one: fit.index_minus_one,
            };
            let near: Vec<Truth> =
                [scan.truth, found].into_iter().take(if fit.has_specular() { 2 } else { 1 }).collect();
            let mut closes = |parameter: usize| known.closes(parameter, least, &near, &mut random);
            let falsely = match fit.has_specular() {
                false => closes(0) && closes(1),
                true => said[0] && closes(0) || said[1] && closes(1),
            };
            (said.contains(&true), falsely)
        })
        .collect();
    let [told, falsely] =
        [outcomes.iter().filter(|outcome| outcome.0).count(), outcomes.iter().filter(|outcome| outcome.1).count()];
    println!("of {count} scans: \"cannot tell\" of {told}, falsely of {falsely}");
    assert!(falsely * 50 <= count, "\"cannot tell\" falsely of {falsely} of {count}");
}

#[test]
fn no_kind_of_scan_ends_above_the_global_optimum() {
    for (number, family) in Family::all().into_iter().enumerate() {
        let bench = Bench::new(family);
        let gaps = (0..trials().div_ceil(10)).into_par_iter().map(|trial| {
            let mut random = Random::new(1_000_003 * number as u64 + 613 * trial as u64);
            let scan = bench.family.scan(&mut random);
            let known = Known::new(&bench.prepared, &scan.values, &scan.sigma);
            let (fit, _) = bench.fit(&scan);
            let least = known.least(&scan.truth, 30, &mut random);
            let gap = (fit.chi_square - least) / (least / (known.values.len() as f64 - 4.0));
            assert!(gap <= 1e-3, "{}: trial {trial}: {gap} above the optimum: {:?}", bench.family.name, scan.truth);
            gap
        });
        let worst = gaps.reduce(|| f64::NEG_INFINITY, f64::max);
        println!("{}: largest gap {worst:.1e}", bench.family.name);
    }
}
