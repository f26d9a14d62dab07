//! When is a departure more than chance? One threshold for a family of comparisons: whatever the number of values, one
//! clean file in a hundred raises a false alarm.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Share of clean files in which any rule of physics raises a false alarm.
const FALSE_ALARMS: f64 = 0.01;
/// How many rules share it.
const RULES: f64 = 9.0;

/// The z-score that the largest of so many independent comparisons reaches by chance in one file of a hundred (Sidak),
/// all rules of physics together. `degrees_of_freedom` are those of the standard uncertainties; `None` where they are
/// taken as known.
#[must_use]
pub(super) fn threshold(comparisons: usize, degrees_of_freedom: Option<f64>) -> f64 {
    // 1 - (1 - a)^(1/n) without cancellation.
    let tail = -((-FALSE_ALARMS / RULES).ln_1p() / comparisons.max(1) as f64).exp_m1();
    let student = degrees_of_freedom.filter(|f| *f > 0.0).and_then(|freedom| StudentsT::new(0.0, 1.0, freedom).ok());
    match (student, Normal::new(0.0, 1.0)) {
        (Some(student), _) => -student.inverse_cdf(tail),
        (None, Ok(normal)) => -normal.inverse_cdf(tail),
        (None, Err(_)) => f64::INFINITY,
    }
}

/// The departure that is furthest beyond chance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Worst<P> {
    /// Where.
    pub(super) place: P,
    /// Its z-score.
    pub(super) z: f64,
    /// How many are beyond the threshold.
    pub(super) beyond: usize,
    /// The threshold.
    pub(super) threshold: f64,
}

/// The worst of the z-scores, if it is beyond the threshold for so many comparisons. Scores that cannot be beyond it may
/// be left out of the iterator, as long as they are counted.
pub(super) fn worst<P>(
    comparisons: usize,
    scores: impl Iterator<Item = (P, f64)> + Clone,
    degrees_of_freedom: Option<f64>,
) -> Option<Worst<P>> {
    let threshold = threshold(comparisons, degrees_of_freedom);
    let beyond = || scores.clone().filter(|(_, z)| z.is_finite() && *z > threshold);
    let (place, z) = beyond().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Worst { place, z, beyond: beyond().count(), threshold })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::*;

    /// Quantiles at the Sidak level, from SciPy.
    #[test]
    fn the_threshold_grows_slowly_with_the_number_of_values() {
        for (count, expected) in [(1, 3.058_804_356_46), (27_472, 5.365_030_787_66), (100_000_000, 6.690_541_842_53)] {
            let z = threshold(count, None);
            assert!((z / expected - 1.0).abs() < 1e-7, "{count}: {z}");
        }
        // A standard deviation of three repeats says little.
        let student = threshold(1000, Some(2.0));
        assert!((student / 670.633_062_874 - 1.0).abs() < 1e-6, "{student}");
    }

    #[test]
    fn nothing_compared_is_no_alarm() {
        assert_eq!(worst(0, std::iter::empty::<((), f64)>(), None), None);
        assert_eq!(worst(1, [((), f64::NAN)].into_iter(), None), None);
        assert!(worst(2, [((), 9.0), ((), 0.1)].into_iter(), None).unwrap().beyond == 1);
    }
}
