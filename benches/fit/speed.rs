//! Time of one fit, and of two thousand.

use std::hint::black_box;
use std::time::Instant;

use bbrf::fit::Fitter;
use rayon::prelude::*;

use crate::common::families::Family;
use crate::common::scans::Random;
use crate::timing::time;
use crate::{BOTH, row, tables};

const SCANS: usize = 2000;

/// 2,000 standard scans, 1 % noise.
pub fn scans() -> Vec<crate::common::families::Scan> {
    let (family, mut random) = (Family::standard(0.01), Random::new(20_131_111));
    (0..SCANS).map(|_| family.scan(&mut random)).collect()
}

pub fn run() {
    let (scans, grid) = (scans(), Family::standard(0.01).grid);
    let set = tables(&grid);
    let vector = Fitter::new(&set, BOTH);
    let plain = vector.plain();
    println!("one scan of 272 points, no start, covariance and singular values included ({SCANS} scans, twice)");
    for (name, fitter) in [("plain", plain), ("vectors where the processor has them", vector)] {
        let timed = time(2 * SCANS, |k| {
            let scan = &scans[k % SCANS];
            black_box(fitter.fit(black_box(&scan.values), Some(black_box(&scan.sigma))).unwrap());
        });
        println!("   {name}: {timed}");
    }
    let timed = time(SCANS, |_| {
        black_box(tables(black_box(&grid)));
    });
    println!("   building the tables of its geometries: {timed}");
    let timed = time(SCANS, |k| {
        let scan = &scans[k];
        black_box(vector.fit_with_intervals(row(&scan.values), Some(row(&scan.sigma)), 0.95).unwrap());
    });
    println!("   fit with the 95 % intervals of all four parameters: {timed}");
    println!("{SCANS} scans in memory, 30 passes");
    let mut one = f64::NAN;
    for (name, fitter) in [("plain", plain), ("vectors", vector)] {
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let pass = || {
                let begin = Instant::now();
                let sum: f64 = pool.install(|| {
                    let fits = scans.par_iter().map(|scan| fitter.fit(&scan.values, Some(&scan.sigma)).unwrap());
                    fits.map(|fit| fit.chi_square).sum()
                });
                black_box(sum);
                SCANS as f64 / begin.elapsed().as_secs_f64()
            };
            let mut rates: Vec<f64> = (0..30).map(|_| pass()).collect();
            rates.sort_by(f64::total_cmp);
            let median = rates[15];
            if threads == 1 {
                one = median;
            }
            println!(
                "   {name}, {threads} threads: {median:.0} fits/s [{:.0} .. {:.0}], {:.2} times one thread",
                rates[3],
                rates[27],
                median / one
            );
        }
    }
}
