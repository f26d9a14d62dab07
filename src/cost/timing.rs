//! How long works take: in turns, until the median is known.

use std::time::Instant;

use schemars::JsonSchema;
use serde::Serialize;

/// When enough has been measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patience {
    /// The 95 % interval of the median is to reach no further from it than this share of it.
    pub precision: f64,
    /// Seconds that a work may take in all its repeats, known well or not.
    pub seconds: f64,
}

impl Default for Patience {
    fn default() -> Self {
        Self { precision: 0.03, seconds: 1.0 }
    }
}

/// Fewest repeats that say anything of a spread.
const LEAST: usize = 7;
/// More than these say nothing new.
const MOST: usize = 10_000;
/// A sample shorter than this is mostly clock, seconds.
const SHORTEST: f64 = 20e-6;

/// What repeats of a work took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Timing {
    /// Median, seconds.
    pub median: f64,
    /// First quartile, seconds.
    pub first_quartile: f64,
    /// Third quartile, seconds.
    pub third_quartile: f64,
    /// How often it was measured, the warm-up left out.
    pub repeats: usize,
    /// False where time ran out before the median was known as well as asked.
    pub settled: bool,
}

impl Timing {
    /// The timing of a work so many times as large.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            median: self.median * factor,
            first_quartile: self.first_quartile * factor,
            third_quartile: self.third_quartile * factor,
            ..self
        }
    }

    /// Of these samples, in seconds.
    fn of(samples: &[f64], precision: f64) -> Self {
        let mut sorted = samples.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * sorted.len().saturating_sub(1) as f64;
            let (below, above) = (sorted.get(place.floor() as usize), sorted.get(place.ceil() as usize));
            let (below, above) = (below.copied().unwrap_or(f64::NAN), above.copied().unwrap_or(f64::NAN));
            below + (above - below) * place.fract()
        };
        let [first_quartile, median, third_quartile] = [0.25, 0.5, 0.75].map(at);
        // McGill, Tukey and Larsen, 1978: the notch of a box plot, about the 95 % interval of a median.
        let notch = 1.57 * (third_quartile - first_quartile) / (samples.len() as f64).sqrt();
        let settled = samples.len() >= LEAST && notch <= precision * median;
        Self { median, first_quartile, third_quartile, repeats: samples.len(), settled }
    }
}

/// Something that takes time.
pub type Work<'a> = Box<dyn FnMut() + 'a>;

/// Times works that take turns, so that what slows the machine for a while slows all alike. Each runs once without being timed.
#[must_use]
pub fn take_turns(works: &mut [Work<'_>], patience: Patience) -> Vec<Timing> {
    let begin = Instant::now();
    in_turns(works, patience, &mut || begin.elapsed().as_secs_f64())
}

/// One work's samples so far.
struct Running {
    /// Calls that make one sample long enough for the clock.
    calls: usize,
    samples: Vec<f64>,
    spent: f64,
    is_done: bool,
}

fn in_turns(works: &mut [Work<'_>], patience: Patience, clock: &mut dyn FnMut() -> f64) -> Vec<Timing> {
    let mut running: Vec<Running> = works.iter_mut().map(|work| warmed_up(work, patience, clock)).collect();
    while running.iter().any(|one| !one.is_done) {
        for (one, work) in running.iter_mut().zip(works.iter_mut()).filter(|(one, _)| !one.is_done) {
            let begin = clock();
            (0..one.calls).for_each(|_| work());
            let took = clock() - begin;
            one.samples.push(took / one.calls as f64);
            one.spent += took;
            // Sorting all samples at every turn would take longer than short works do.
            let is_look = one.samples.len() <= LEAST || one.samples.len().is_multiple_of(8);
            let is_known = is_look && Timing::of(&one.samples, patience.precision).settled;
            one.is_done = is_known || one.spent >= patience.seconds || one.samples.len() >= MOST;
        }
    }
    running.iter().map(|one| Timing::of(&one.samples, patience.precision)).collect()
}

/// The first run finds caches cold and pages missing, and tells how many calls make a sample.
fn warmed_up(work: &mut Work<'_>, patience: Patience, clock: &mut dyn FnMut() -> f64) -> Running {
    work();
    let begin = clock();
    work();
    let took = (clock() - begin).max(1e-9);
    let calls = if took < SHORTEST { (SHORTEST / took).ceil() as usize } else { 1 };
    // Of what takes longer than all repeats may, the second run is warm enough to be the one that counts.
    let is_done = took >= patience.seconds;
    let samples = if is_done { vec![took] } else { Vec::new() };
    Running { calls, samples, spent: 0.0, is_done }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Works that take the times given, one after the other, by a clock that only they move.
    fn timed(lists: &[&[f64]], patience: Patience) -> Vec<Timing> {
        let now = Cell::new(0.0);
        let mut works: Vec<Work<'_>> = Vec::new();
        for list in lists {
            let (mut call, now) = (0, &now);
            works.push(Box::new(move || {
                now.set(now.get() + list[call % list.len()]);
                call += 1;
            }));
        }
        in_turns(&mut works, patience, &mut || now.get())
    }

    #[test]
    fn a_steady_work_is_known_after_few_repeats_and_its_warm_up_does_not_count() {
        // Eighths, whose sums and differences are exact.
        let cold = [[9.0, 9.0].as_slice(), &[0.125; 60]].concat();
        let found = timed(&[&cold], Patience { precision: 0.02, seconds: 10.0 });
        assert_eq!((found[0].median, found[0].repeats, found[0].settled), (0.125, LEAST, true));
    }

    #[test]
    fn a_noisy_work_is_repeated_more_and_given_up_when_time_runs_out() {
        let noisy = [0.1, 0.2, 0.3, 0.15, 0.25];
        let patient = timed(&[&noisy], Patience { precision: 0.1, seconds: 1e6 });
        assert!(patient[0].settled && patient[0].repeats > LEAST, "{patient:?}");
        assert!(patient[0].first_quartile < patient[0].median && patient[0].median < patient[0].third_quartile);
        let hasty = timed(&[&noisy, &[5.0]], Patience { precision: 0.001, seconds: 2.0 });
        assert!(!hasty[0].settled && hasty[0].repeats < 12, "{hasty:?}");
        assert_eq!(hasty[1].repeats, 1);
    }

    #[test]
    fn short_works_are_called_often_enough_for_the_clock() {
        let found = timed(&[&[1e-6]], Patience { precision: 0.02, seconds: 1.0 });
        assert!((found[0].median - 1e-6).abs() < 1e-12, "{found:?}");
    }
}
