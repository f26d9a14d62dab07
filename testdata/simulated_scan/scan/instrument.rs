//! What a PR-650 makes of a radiance: exposure, noise, floor, four digits, quality code, and the D5 text.
//!
//! The numbers are those that repeats on real instruments gave: every wavelength 0.3 % of the value and the floor at that
//! exposure, one scale error of 0.3 % per record; nothing is ever reported below the floor.

use super::optics::{WAVELENGTHS, wavelength_nm};
use super::random::Random;

/// Standard deviation of a value, relative, independent between wavelengths.
pub(crate) const NOISE: f64 = 0.003;
/// Standard deviation of the scale of a record, relative, common to its wavelengths.
pub(crate) const SCALE: f64 = 0.003;
/// The longest integration time, ms, and the one to which [`floor_at`] belongs.
const LONGEST_MS: f64 = 6000.0;
/// Peak radiance below which the instrument says "low light level" (code 18).
const LOW_LIGHT: f64 = 9.0e-4;

/// One reading.
#[derive(Debug)]
pub(crate) struct Reading {
    /// Integration time, ms.
    pub(crate) exposure_ms: u32,
    /// Quality code: 0 okay, 18 low light level, 30 noisy.
    pub(crate) quality: u8,
    /// Spectral radiance as printed, W m-2 sr-1 nm-1.
    printed: Vec<String>,
}

impl Reading {
    /// Reads a radiance. `noisy` makes it a reading that the instrument itself calls noisy.
    pub(crate) fn take(radiance: &[f64], noisy: bool, random: &mut Random) -> Self {
        let peak = radiance.iter().copied().fold(0.0, f64::max);
        let exposure = (0.9 / peak).clamp(10.0, LONGEST_MS).round();
        let quality = if noisy { 30 } else { 18 * u8::from(peak < LOW_LIGHT) };
        let relative = if quality == 0 { NOISE } else { 2.0 * NOISE };
        let scale = 1.0 + SCALE * random.normal();
        let value = |(index, radiance): (usize, &f64)| {
            let floor = floor_at(index, exposure);
            let sigma = (relative * radiance).hypot(floor);
            four_digits((radiance * scale + sigma * random.normal()).max(floor))
        };
        let printed = radiance.iter().enumerate().map(value).collect();
        Self { exposure_ms: exposure as u32, quality, printed }
    }

    /// The reply to `D5`, with CRLF line ends: quality and unit, integral, 101 values.
    pub(crate) fn d5_text(&self) -> String {
        // The header is made of the digits below it, as a reader will check.
        let sum: f64 = self.printed.iter().map(|text| text.parse::<f64>().unwrap_or(f64::NAN)).sum();
        let mut text = format!("{:02},0\r\n{}\r\n", self.quality, four_digits(4.0 * sum));
        for (index, value) in self.printed.iter().enumerate() {
            text.push_str(&format!("{:04.0}.,{value}\r\n", wavelength_nm(index)));
        }
        text
    }
}

/// The floor of the instrument: 3.4e-7 at 380 nm, 7.0e-8 at 560, 5.3e-7 at 780 for the longest exposure; it grows as the
/// exposure gets shorter, up to 8.6 times.
fn floor_at(index: usize, exposure_ms: f64) -> f64 {
    const SHAPE: [(f64, f64); 5] =
        [(380.0, 3.400e-7), (460.0, 1.050e-7), (560.0, 7.0e-8), (680.0, 1.350e-7), (780.0, 5.318e-7)];
    let nm = wavelength_nm(index.min(WAVELENGTHS - 1));
    let scale = (LONGEST_MS / exposure_ms).min(8.6);
    let after = SHAPE.iter().position(|point| point.0 >= nm).unwrap_or(SHAPE.len() - 1).max(1);
    let ((from, low), (to, high)) = (SHAPE[after - 1], SHAPE[after]);
    scale * low * (high / low).powf((nm - from) / (to - from))
}

/// Four significant digits and a signed exponent of two, as in `1.509E-07`.
fn four_digits(value: f64) -> String {
    let text = format!("{value:.3e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    format!("{mantissa}E{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
}
