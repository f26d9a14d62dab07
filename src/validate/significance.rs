//! When is a departure more than chance? One threshold for a family of comparisons: whatever the number of values, one
//! clean file in a hundred raises a false alarm.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Share of clean files in which any rule of physics raises a false alarm.
const FALSE_ALARMS: f64 = 0.01;
/// How many rules share it.
const RULES: f64 = 7.0;

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

/// The worst of all z-scores, if it is beyond the threshold for their number.
pub(super) fn worst<P>(
    scores: impl IntoIterator<Item = (P, f64)>,
    degrees_of_freedom: Option<f64>,
) -> Option<Worst<P>> {
    let scores: Vec<(P, f64)> = scores.into_iter().filter(|(_, z)| z.is_finite()).collect();
    let threshold = threshold(scores.len(), degrees_of_freedom);
    let beyond = scores.iter().filter(|(_, z)| *z > threshold).count();
    let (place, z) = scores.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (z > threshold).then_some(Worst { place, z, beyond, threshold })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::*;

    /// Quantiles at the Sidak level, from mpmath with 40 digits.
    #[test]
    fn the_threshold_grows_slowly_with_the_number_of_values() {
        for (count, expected) in [(1, 2.982_703_875_49), (27_472, 5.319_458_844_83), (100_000_000, 6.653_646_692_31)] {
            let z = threshold(count, None);
            assert!((z / expected - 1.0).abs() < 1e-7, "{count}: {z}");
        }
        // A standard deviation of three repeats says little.
        let student = threshold(1000, Some(2.0));
        assert!((student / 591.395_544_821 - 1.0).abs() < 1e-6, "{student}");
    }

    #[test]
    fn nothing_compared_is_no_alarm() {
        assert_eq!(worst(Vec::<((), f64)>::new(), None), None);
        assert_eq!(worst([((), f64::NAN)], None), None);
        assert!(worst([((), 9.0), ((), 0.1)], None).unwrap().beyond == 1);
    }
}
