//! Errors over the Cramer-Rao bound, standard box, known uncertainties.

use rayon::prelude::*;

use crate::common::families::Family;
use crate::common::scans::Random;
use crate::{BOTH, tables, trials};

pub const NAMES: [&str; 4] = ["albedo", "intensity", "roughness", "n - 1"];

pub fn run() {
    let family = Family::standard(0.01);
    let set = tables(&family.grid);
    let count = trials(10_000);
    let errors: Vec<[f64; 4]> = (0..count)
        .into_par_iter()
        .map(|trial| {
            let scan = family.scan(&mut Random::new(31 + 104_729 * trial as u64));
            let fit = bbrf::fit::Fitter::new(&set, BOTH).fit(&scan.values, Some(&scan.sigma)).unwrap();
            let found = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one];
            let (truth, bound) = (scan.truth.as_array(), scan.truth.cramer_rao(&family.grid, 0.01));
            std::array::from_fn(|k| (found[k] - truth[k]) / bound[k])
        })
        .collect();
    println!("{count} standard scans, 1 %; the ratio itself scatters by {:.4}", 1.0 / (2.0 * count as f64).sqrt());
    for (k, name) in NAMES.into_iter().enumerate() {
        let mean = errors.iter().map(|e| e[k]).sum::<f64>() / count as f64;
        let ratio = (errors.iter().map(|e| e[k] * e[k]).sum::<f64>() / count as f64).sqrt();
        println!("   {name}: r.m.s. error / Cramer-Rao {ratio:.4}, mean error {mean:+.4} sigma");
    }
}
