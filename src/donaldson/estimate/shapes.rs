//! The prior of excitation spectra: what absorption of known fluorescent colours looks like, in a few standard normal numbers.
//!
//! A main band with a slow rise and a steep fall, a second band, and a slow modulation of both by some tens of percent.
//! It is broad on purpose: what it excludes (lines, gaps) no broadband light would show.

/// Waves of the modulation.
const WAVES: usize = 6;
/// Numbers that make a shape.
pub(super) const NUMBERS: usize = 6 + WAVES;
/// Standard deviation of the logarithm of each wave.
const MODULATION: f64 = 0.25;
/// The peak lies in this range, nm.
const FROM_NM: f64 = 300.0;
const TO_NM: f64 = 660.0;

/// The family in words.
pub(super) const WORDS: &str = "one main band that peaks between 300 and 660 nm, rises slowly and falls steeply, a second band \
                                below it, and slow modulations";

/// The excitation spectrum of these numbers, 1 at its peak; each is standard normal in the prior.
pub(super) fn shape(numbers: &[f64; NUMBERS], excitation_nm: &[f64]) -> Vec<f64> {
    let peak = FROM_NM + (TO_NM - FROM_NM) * normal_share(numbers[0]);
    let (rise, fall) = (60.0 * (0.7 * numbers[1]).exp(), 22.0 * (0.6 * numbers[2]).exp());
    let second = 250.0 + (peak - 250.0) * normal_share(numbers[3]);
    let width = 30.0 * (0.5 * numbers[4]).exp();
    let strength = 0.5 * (0.8 * numbers[5]).exp();
    let to = peak + 2.0 * fall;
    let bell = |away: f64| (-away * away / 2.0).exp();
    let value = |nm: f64| {
        let main = bell((nm - peak) / if nm < peak { rise } else { fall });
        let cut = if nm > peak { bell((nm - peak) / fall) } else { 1.0 };
        let other = strength * bell((nm - second) / width) * cut;
        let along = ((nm - FROM_NM) / (to - FROM_NM)).clamp(0.0, 1.0) * std::f64::consts::PI;
        let slow: f64 = (0..WAVES).map(|k| numbers[6 + k] * ((k + 1) as f64 * along).cos()).sum();
        (main + other) * (MODULATION * slow).exp()
    };
    let mut values: Vec<f64> = excitation_nm.iter().map(|nm| value(*nm)).collect();
    let most = values.iter().copied().fold(0.0, f64::max);
    if most > 0.0 {
        values.iter_mut().for_each(|value| *value /= most);
    }
    values
}

/// What of a standard normal lies below: a logistic curve that differs by less than 0.01.
fn normal_share(x: f64) -> f64 {
    (1.0 + (-1.702 * x).exp()).recip()
}
