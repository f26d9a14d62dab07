//! V(lambda): how the eye weighs a radiance.

use colorimetry::observer::Observer;

/// Luminous efficacy of radiation at 555 nm, lm/W (SI: 683 lm/W at 540 THz).
const LARGEST_EFFICACY: f64 = 683.002;

/// Spectral luminous efficacy for photopic vision, lm/W: 683 V(lambda), V being the CIE 1931 y-bar, by linear
/// interpolation between whole nanometres; 0 outside 380 to 780 nm.
#[must_use]
pub fn luminous_efficacy(nm: f64) -> f64 {
    let at = |whole: f64| Observer::Cie1931.xyz_at_wavelength(whole as usize).map_or(0.0, |xyz| xyz.y());
    let lower = nm.floor();
    let fraction = nm - lower;
    // The crate scales its table; V is 1 at 555 nm.
    LARGEST_EFFICACY * (at(lower) * (1.0 - fraction) + at(lower + 1.0) * fraction) / at(555.0)
}
