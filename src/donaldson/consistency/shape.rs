//! What a comparison of two spectra says.

use super::ScanOf;
use super::comparison::{Compared, Deviation, FALSE_ALARMS};

/// The spectrum of a scan beside that of the matrix under the same light.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// What the scan is compared as.
    pub of: ScanOf,
    /// The light, in words; `None` for a ratio that needs none.
    pub light: Option<String>,
    /// How many wavelengths are compared.
    pub count: usize,
    /// The first of them, nm.
    pub from_nm: f64,
    /// The last, nm.
    pub to_nm: f64,
    /// Weighted sum of squares over degrees of freedom of what differs once the scale is fitted.
    pub reduced_chi_square: f64,
    /// What one pair of spectra of one shape in a hundred exceeds.
    pub limit: f64,
    /// Where they differ most.
    pub largest: Deviation,
    /// Measured over predicted level; `None` where what fell in is not known.
    pub level: Option<Level>,
}

/// Measured over predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// The ratio, 1 where scan and matrix agree.
    pub ratio: f64,
    /// Its standard uncertainty, what the values share included; the light is taken as exact.
    pub sigma: f64,
}

impl Shape {
    pub(super) fn of(of: ScanOf, light: Option<String>, compared: Compared, level: Option<Level>) -> Self {
        Self {
            of,
            light,
            count: compared.count,
            from_nm: compared.from_nm,
            to_nm: compared.to_nm,
            reduced_chi_square: compared.reduced_chi_square,
            limit: compared.limit,
            largest: compared.largest,
            level,
        }
    }

    /// In words.
    pub(super) fn sentence(&self) -> String {
        let verdict = if self.agrees() { "agree" } else { "DISAGREE" };
        let light = self.light.as_ref().map_or(String::new(), |light| format!(" under {light}"));
        format!(
            "the {} spectra of scan and matrix {verdict} in shape{light}: reduced chi-square {:.2} (one pair of one shape in {:.0} \
             exceeds {:.2}), {} wavelengths from {} to {} nm, largest deviation {:+.1} % of the peak at {} nm ({:+.1} standard \
             uncertainties)",
            self.of,
            self.reduced_chi_square,
            FALSE_ALARMS.recip(),
            self.limit,
            self.count,
            self.from_nm,
            self.to_nm,
            100.0 * self.largest.relative,
            self.largest.nm,
            self.largest.sigmas
        )
    }

    /// True where what differs is no more than what is not known.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.reduced_chi_square <= self.limit
    }
}

impl Level {
    /// True within what chance alone exceeds in one of a hundred cases.
    #[must_use]
    pub fn agrees(&self) -> bool {
        // The 99.5 % quantile of the normal distribution.
        (self.ratio - 1.0).abs() <= 2.575_829 * self.sigma
    }
}
