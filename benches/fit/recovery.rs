//! Random scans of the whole parameter box: each fit is at the global optimum, or says that the data cannot tell; and how often
//! that is said falsely. The optimum and the profile are those of another program.

use rayon::prelude::*;

use crate::common::families::Family;
use crate::common::optimum::Known;
use crate::common::scans::{Random, Truth, prepare};
use crate::{cannot_tell, tables, trials, with_intervals};

/// Independent starts of the reference.
const STARTS: usize = 30;

/// What became of one scan.
#[derive(Clone, Copy)]
struct Outcome {
    /// Chi-square above the optimum in units of chi-square per degree of freedom: of the fit alone, and with its intervals.
    gap: [f64; 2],
    said: bool,
    falsely: bool,
    /// Chi-square of the reference above ours, in the same units.
    reference_above: f64,
}

pub fn run() {
    let family = Family::whole_box();
    let (set, prepared) = (tables(&family.grid), prepare(&family.grid));
    let count = trials(10_000);
    let outcomes: Vec<Outcome> = (0..count)
        .into_par_iter()
        .map(|trial| {
            let mut random = Random::new(977 + 7919 * trial as u64);
            let scan = family.scan(&mut random);
            let known = Known::new(&prepared, &scan.values, &scan.sigma);
            let alone = bbrf::fit::Fitter::new(&set, crate::BOTH).fit(&scan.values, Some(&scan.sigma)).unwrap();
            let (fit, intervals) = with_intervals(&set, &scan.values, &scan.sigma);
            let reference = known.least(&scan.truth, STARTS, &mut random);
            let least = reference.min(fit.chi_square);
            let freedom = known.values.len() as f64 - 4.0;
            let unit = least / freedom;
            // A specular term that is not seen is left out on purpose: its gap is what the reference gains by it.
            let gap = [alone.chi_square, fit.chi_square].map(|chi_square| (chi_square - least) / unit);
            let said = cannot_tell(&intervals);
            let found = Truth {
                albedo: fit.bands[0].diffuse,
                intensity: fit.bands[0].intensity,
                roughness: fit.roughness,
                index_minus_one: fit.index_minus_one,
            };
            let near: Vec<Truth> = if fit.has_specular() { vec![scan.truth, found] } else { vec![scan.truth] };
            // What was said of a parameter is false where the other program closes its interval; of the whole term, where it
            // closes both.
            let closes = |k: usize, random: &mut Random| known.closes(k, least, &near, random);
            let falsely = match (fit.has_specular(), said) {
                (false, _) => closes(0, &mut random) && closes(1, &mut random),
                (true, [roughness, index]) => {
                    (roughness && closes(0, &mut random)) || (index && closes(1, &mut random))
                }
            };
            let outcome = Outcome {
                gap,
                said: said.contains(&true),
                falsely,
                reference_above: (reference - fit.chi_square) / unit,
            };
            if gap[1] > 1.0 || falsely {
                eprintln!(
                    "   trial {trial}: {:?}: gaps {gap:.3?}, said {said:?}, falsely {falsely}, gain {:.2}, {:?}",
                    scan.truth, fit.specular_gain, intervals
                );
            }
            outcome
        })
        .collect();
    let share = |is: &dyn Fn(&Outcome) -> bool| outcomes.iter().filter(|outcome| is(outcome)).count();
    println!("{}: {count} scans, reference: best of {STARTS} random starts and the truth", family.name);
    for (k, name) in ["fit alone", "fit with its intervals"].into_iter().enumerate() {
        let right = share(&|o| o.gap[k] <= 1.0);
        let told = share(&|o| o.gap[k] > 1.0 && o.said);
        let worst = outcomes.iter().filter(|o| !o.said).map(|o| o.gap[k]).fold(0.0, f64::max);
        println!(
            "   {name}: {right} within 1 of the optimum, {told} further and \"cannot tell\" said, {} further and not said; \
             largest gap where it is not said {worst:.2e}",
            share(&|o| o.gap[k] > 1.0 && !o.said)
        );
    }
    println!("   \"cannot tell\" said of {}, falsely of {}", share(&|o| o.said), share(&|o| o.falsely));
    println!("   the reference misses the optimum by more than 1 in {}", share(&|o| o.reference_above > 1.0));
}
