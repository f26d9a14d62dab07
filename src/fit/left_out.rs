//! What took no part in a fit, by reason: a reader of a fit must be able to tell why his values are not in it.

use std::fmt;

/// How many values took no part, each counted under the first reason that applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LeftOut {
    /// There is no number that may be used: missing, flagged, or of unknown geometry.
    pub no_value: usize,
    /// A fitted term has no value at the geometry (grazing).
    pub undefined_geometry: usize,
    /// The standard uncertainty is 0, which would be an infinite weight.
    pub zero_sigma: usize,
    /// The standard uncertainty is empty, negative or infinite.
    pub unknown_sigma: usize,
}

/// Why one value takes no part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reason {
    NoValue,
    ZeroSigma,
    UnknownSigma,
}

/// Why a value at a geometry where every term is defined takes no part; `None` where it does.
pub(super) fn reason(value: f64, sigma: Option<f64>) -> Option<Reason> {
    match sigma {
        _ if !value.is_finite() => Some(Reason::NoValue),
        Some(0.0) => Some(Reason::ZeroSigma),
        Some(sigma) if !(sigma > 0.0 && sigma.is_finite()) => Some(Reason::UnknownSigma),
        _ => None,
    }
}

impl LeftOut {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> usize {
        self.no_value + self.undefined_geometry + self.zero_sigma + self.unknown_sigma
    }

    pub(super) fn add(&mut self, reason: Reason) {
        *match reason {
            Reason::NoValue => &mut self.no_value,
            Reason::ZeroSigma => &mut self.zero_sigma,
            Reason::UnknownSigma => &mut self.unknown_sigma,
        } += 1;
    }

    pub(super) fn add_all(&mut self, other: &Self) {
        let Self { no_value, undefined_geometry, zero_sigma, unknown_sigma } = other;
        self.no_value += no_value;
        self.undefined_geometry += undefined_geometry;
        self.zero_sigma += zero_sigma;
        self.unknown_sigma += unknown_sigma;
    }

    /// One phrase per reason that applies.
    pub(super) fn reasons(&self) -> Vec<String> {
        [
            (
                self.no_value,
                "without a number that may be used (missing, flagged, masked, below the surface or of unknown geometry)",
            ),
            (self.undefined_geometry, "at a grazing geometry, where a term has no value"),
            (
                self.zero_sigma,
                "whose standard uncertainty (sigma) is 0; state it above 0, or leave it out for all values",
            ),
            (self.unknown_sigma, "whose standard uncertainty (sigma) is empty or not a positive number"),
        ]
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, why)| format!("{count} {why}"))
        .collect()
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.reasons() {
            reasons if reasons.is_empty() => f.write_str("none left out"),
            reasons => write!(f, "left out: {}", reasons.join("; ")),
        }
    }
}
