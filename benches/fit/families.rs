//! Fourteen kinds of scans: is any fit above the global optimum? Outliers once more with Huber's loss.

use bbrf::fit::{Fitter, GeometrySet, Loss, Observations};
use rayon::prelude::*;

use crate::common::families::{Family, Scan};
use crate::common::optimum::Known;
use crate::common::scans::{Random, prepare};
use crate::precision::NAMES;
use crate::{BOTH, cannot_tell, row, tables, trials, with_intervals};

const STARTS: usize = 30;

pub fn run() {
    let count = trials(1000);
    println!("{count} scans each; gap to the best of the truth and {STARTS} random starts, in units of chi2/dof");
    // `BBRF_FAMILY` picks those with these letters in their name.
    let asked = std::env::var("BBRF_FAMILY").unwrap_or_default();
    for (number, family) in Family::all().into_iter().enumerate().filter(|(_, family)| family.name.contains(&asked)) {
        let (set, prepared) = (tables(&family.grid), prepare(&family.grid));
        let outcomes: Vec<([f64; 2], bool, f64)> = (0..count)
            .into_par_iter()
            .map(|trial| {
                let mut random = Random::new(1_000_003 * number as u64 + 613 * trial as u64);
                let scan = family.scan(&mut random);
                let known = Known::new(&prepared, &scan.values, &scan.sigma);
                let alone = Fitter::new(&set, BOTH).fit(&scan.values, Some(&scan.sigma)).unwrap();
                let (fit, intervals) = with_intervals(&set, &scan.values, &scan.sigma);
                let reference = known.least(&scan.truth, STARTS, &mut random);
                let least = reference.min(fit.chi_square);
                let unit = least / (known.values.len() as f64 - 4.0);
                let gaps = [alone.chi_square, fit.chi_square].map(|chi_square| (chi_square - least) / unit);
                let said = cannot_tell(&intervals).contains(&true);
                if gaps[0] > 1.0 {
                    eprintln!(
                        "   {}: trial {trial}: {:?}: gaps {gaps:.3?}, said {said}, gain {:.1}, found r {:.4} m {:.4}, {:?}",
                        family.name, scan.truth, fit.specular_gain, alone.roughness, alone.index_minus_one, alone.stop
                    );
                }
                (gaps, said, (reference - fit.chi_square) / unit)
            })
            .collect();
        let over = |k: usize, limit: f64| outcomes.iter().filter(|(gap, ..)| gap[k] > limit).count();
        let worst = |k: usize| outcomes.iter().map(|(gap, ..)| gap[k]).fold(0.0, f64::max);
        println!(
            "   {}: fit alone above by more than 1: {}, by more than 0.001: {}, worst {:.1e}; with its intervals {}, {}, {:.1e}; \
             \"cannot tell\" {}; the reference above ours {}",
            family.name,
            over(0, 1.0),
            over(0, 1e-3),
            worst(0),
            over(1, 1.0),
            over(1, 1e-3),
            worst(1),
            outcomes.iter().filter(|(_, said, _)| *said).count(),
            outcomes.iter().filter(|(.., above)| *above > 1.0).count()
        );
        if family.outliers > 0 {
            outliers(&family, &set, count);
        }
    }
}

/// Parameter errors over the Cramer-Rao bound of the data without outliers.
fn outliers(family: &Family, set: &GeometrySet, count: usize) {
    for (name, loss) in [("squares", Loss::Squares), ("Huber", Loss::Huber), ("Tukey", Loss::Tukey)] {
        let errors: Vec<Option<[f64; 4]>> = (0..count)
            .into_par_iter()
            .map(|trial| {
                let Scan { truth, values, sigma } = family.scan(&mut Random::new(77 + 613 * trial as u64));
                let data = Observations { values: row(&values), sigma: Some(row(&sigma)), bounds: &[], loss };
                let fit = Fitter::new(set, BOTH).fit_observed(&data, 0.95).unwrap().fit;
                let found = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one];
                let (truth, bound) = (truth.as_array(), truth.cramer_rao(&family.grid, 0.01));
                fit.has_specular().then(|| std::array::from_fn(|k| (found[k] - truth[k]).abs() / bound[k]))
            })
            .collect();
        let seen: Vec<[f64; 4]> = errors.into_iter().flatten().collect();
        for (k, parameter) in NAMES.into_iter().enumerate() {
            let mut sizes: Vec<f64> = seen.iter().map(|e| e[k]).collect();
            sizes.sort_by(f64::total_cmp);
            let rms = (sizes.iter().map(|e| e * e).sum::<f64>() / sizes.len() as f64).sqrt();
            println!(
                "      {name}: {parameter}: r.m.s. error / Cramer-Rao {rms:.3}, median {:.3} (of a normal error 0.674), 99 of 100 \
                 below {:.2}; {} with a specular term",
                sizes[sizes.len() / 2],
                sizes[sizes.len() * 99 / 100],
                sizes.len()
            );
        }
    }
}
