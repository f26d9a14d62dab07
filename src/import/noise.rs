//! The noise of a PR-650 record where repeats do not show it.
//!
//! sigma^2 = s0(lambda)^2 + (b L)^2 + q^2 for each sample, and a scale error c L that a record's samples share; from
//! the repeats of a real unit: b = 0.003, c = 0.003, q the step of the last printed digit over sqrt(12), s0 the noise of
//! the dark. A short exposure lifts the floor of the instrument and the noise with it: s0 is the floor of the record
//! itself. Where no floor is seen in the set, s0 is 5e-6 W m-2 sr-1 nm-1 (that of a real unit at short exposures), and
//! no larger than the smallest value of the set at the wavelength.

use super::plan::Entry;
use crate::quantity::{Flag, Flags};

/// Relative noise of a sample, independent between samples.
const RELATIVE: f64 = 0.003;

/// Relative error of scale that the samples of a record share.
pub(super) const RECORD_SCALE: f64 = 0.003;

/// Noise of the dark where the set shows neither a floor nor a smaller value, W m-2 sr-1 nm-1.
const DARK_NOISE: f64 = 5e-6;

/// Significant bits of a computed uncertainty: five decimal digits, more than any is worth. The other bits would be
/// noise that no compression can shorten; without them a file is a third smaller.
const KEPT_BITS: u32 = 16;

/// A computed uncertainty, rounded to the digits that are kept.
pub(super) fn kept(sigma: f64) -> f64 {
    let dropped = 52 - KEPT_BITS;
    if !sigma.is_normal() {
        return sigma;
    }
    f64::from_bits((sigma.to_bits() + (1_u64 << (dropped - 1))) & !((1_u64 << dropped) - 1))
}

/// The noise model of a set of records.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Noise {
    dark: Vec<f64>,
}

impl Noise {
    /// The model for records that share an axis.
    pub(super) fn of(entries: &[Entry]) -> Self {
        let width = entries.iter().map(|entry| entry.record.values.len()).max().unwrap_or(0);
        let smallest = |index: usize| {
            let values = entries.iter().filter_map(|entry| entry.record.values.get(index));
            values.copied().filter(|value| *value > 0.0).fold(DARK_NOISE, f64::min)
        };
        let zeros = entries.iter().any(|entry| entry.record.fixed_decimals.is_some());
        let dark = (0..width).map(|index| if zeros { DARK_NOISE } else { smallest(index) }).collect();
        Self { dark }
    }

    /// Standard uncertainty of one sample without the shared scale, in the unit of the value; NaN where it is missing.
    pub(super) fn sigma(&self, entry: &Entry, index: usize) -> f64 {
        let record = &entry.record;
        let value = record.values.get(index).copied().unwrap_or(f64::NAN);
        let step = record.steps.get(index).copied().unwrap_or(0.0);
        let flags = record.flags.get(index).copied().unwrap_or(Flags::NONE);
        let floor = entry.floor.as_ref().and_then(|floor| floor.get(index));
        let dark = floor.or(self.dark.get(index)).copied().unwrap_or(DARK_NOISE);
        let rounding = step / 12.0_f64.sqrt();
        let sigma = (dark * dark + (RELATIVE * value).powi(2) + rounding * rounding).sqrt();
        let doubtful = flags.contains(Flag::LowLight) || flags.contains(Flag::Noisy);
        if doubtful { 2.0 * sigma } else { sigma }
    }

    /// The model in words, for the receipt.
    pub(super) fn describe() -> String {
        format!(
            "uncertainty by the noise model sigma^2 = s0^2 + (b L)^2 + q^2 with b = {RELATIVE}, q = the last printed \
             digit / sqrt(12), s0 = the floor of the record (where the record lies above it, the highest that it can be; \
             between wavelengths with a known floor drawn geometrically), or without a floor the smallest value of the \
             set at the wavelength, at most {DARK_NOISE:e} (that for texts with fixed decimals); doubled for the \
             quality codes 18 and 30; and a scale error of {RECORD_SCALE} that the samples of a record share; kept to \
             {KEPT_BITS} significant bits"
        )
    }
}
