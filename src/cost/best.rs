//! Which rungs nobody need pass over.

use super::ladder::Rung;

/// Marks the Pareto-best rungs: those than which no other is as good in both errors, time, reading time and bytes, and better in one. Of two
/// that are equal in all, both are marked; one without an error is not.
pub fn mark_best(rungs: &mut [Rung]) {
    let respects = |rung: &Rung| {
        let bytes = rung.bytes.map_or(0.0, |bytes| bytes as f64);
        let read = rung.read_time.map_or(0.0, |time| time.median);
        let size = |error: Option<f64>| error.map(f64::abs).filter(|error| !error.is_nan()).unwrap_or(f64::INFINITY);
        [size(rung.error), size(rung.second_error), rung.time.median, read, bytes]
    };
    let all: Vec<[f64; 5]> = rungs.iter().map(respects).collect();
    let beats = |other: &[f64; 5], one: &[f64; 5]| {
        let pairs = || other.iter().zip(one);
        pairs().all(|(other, one)| other <= one) && pairs().any(|(other, one)| other < one)
    };
    for (rung, own) in rungs.iter_mut().zip(&all) {
        rung.is_best = own[0].is_finite() && !all.iter().any(|other| beats(other, own));
    }
}
