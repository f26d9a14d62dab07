//! A spectrum as a parser found it, and the checks that every parser makes.

use super::error::{ImportError, fault};
use super::number::Printed;
use crate::dataset::{Place, Role};
use crate::quantity::{BandpassCorrection, Flag, Flags, QuantityKind};

/// What the input says about the instrument's state when the record was taken.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Details {
    /// Make and model.
    pub(crate) model: Option<String>,
    /// Serial number.
    pub(crate) serial: Option<String>,
    /// Aperture.
    pub(crate) aperture: Option<String>,
    /// Lenses and filters.
    pub(crate) accessories: Option<String>,
    /// Time as printed, without a zone.
    pub(crate) local_time: Option<String>,
    /// Integration time, ms.
    pub(crate) exposure_ms: Option<f64>,
    /// Bandpass that the instrument reported, nm.
    pub(crate) bandpass_nm: Option<f64>,
    /// Whether the values are corrected for it.
    pub(crate) bandpass_correction: Option<BandpassCorrection>,
    /// Make and model of the light, where the record is of one.
    pub(crate) make: Option<String>,
}

/// One spectrum.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Record {
    /// The file's name as given.
    pub(crate) file: String,
    /// Its number in the file, from 1.
    pub(crate) number: u64,
    /// The line it starts at.
    pub(crate) line: u64,
    /// The dialect, as in `pr650-d5`.
    pub(crate) dialect: &'static str,
    /// Its name, if the input gives one.
    pub(crate) title: Option<String>,
    /// Wavelengths, nm; empty for a rejected record without data.
    pub(crate) nm: Vec<f64>,
    /// Values as printed; NaN where missing.
    pub(crate) values: Vec<f64>,
    /// One unit of the last printed digit of each value.
    pub(crate) steps: Vec<f64>,
    /// Flags of each value.
    pub(crate) flags: Vec<Flags>,
    /// Number of decimals when the values are printed without exponents.
    pub(crate) fixed_decimals: Option<u32>,
    /// The instrument's quality code.
    pub(crate) quality: Option<i32>,
    /// Why the record is no measurement: the reason as a flag, and in words.
    pub(crate) rejection: Option<(Flag, String)>,
    /// What it is of, where the input itself says it.
    pub(crate) role: Option<Role>,
    /// What the numbers are.
    pub(crate) kind: QuantityKind,
    /// About the instrument.
    pub(crate) details: Details,
    /// What is odd about it without making it useless.
    pub(crate) doubts: Vec<String>,
    /// Luminance (or illuminance) that the input reports beside the spectrum, and where.
    pub(crate) luminance: Option<(f64, u64)>,
}

impl Record {
    /// A record without data yet.
    pub(crate) fn new(file: &str, number: u64, line: u64, dialect: &'static str) -> Self {
        Self {
            file: file.to_owned(),
            number,
            line,
            dialect,
            title: None,
            nm: Vec::new(),
            values: Vec::new(),
            steps: Vec::new(),
            flags: Vec::new(),
            fixed_decimals: None,
            quality: None,
            rejection: None,
            role: None,
            kind: QuantityKind::Unstated,
            details: Details::default(),
            doubts: Vec::new(),
            luminance: None,
        }
    }

    /// Adds a sample.
    pub(crate) fn push(&mut self, nm: f64, value: Printed) {
        self.nm.push(nm);
        self.values.push(value.value);
        self.steps.push(value.step);
        self.flags.push(Flags::NONE);
    }

    /// Where the record starts.
    pub(crate) fn place(&self) -> Place {
        Place::file(self.file.as_str()).at_line(self.line)
    }

    /// Its name in messages.
    pub(crate) fn label(&self) -> String {
        if self.number == 1 { self.file.clone() } else { format!("{} record {}", self.file, self.number) }
    }

    /// What a notice at its place begins with: columns of one file share their lines.
    pub(crate) fn prefix(&self) -> String {
        if self.number == 1 { String::new() } else { format!("record {}: ", self.number) }
    }

    /// Gives a flag to every sample.
    pub(crate) fn flag_all(&mut self, flag: Flag) {
        for flags in &mut self.flags {
            *flags = flags.with(flag);
        }
    }

    /// Makes the record one that the instrument refused: its values become missing with the flag as the reason.
    pub(crate) fn reject(&mut self, flag: Flag, why: String) {
        self.values.fill(f64::NAN);
        self.flag_all(flag);
        self.rejection = Some((flag, why));
    }

    /// True where the samples lie on the grid of the PR-650 and PR-655: 380 to 780 nm by 4.
    pub(crate) fn is_on_pr650_grid(&self) -> bool {
        self.nm.len() == 101 && self.nm.iter().zip(0_u32..).all(|(nm, index)| *nm == 380.0 + 4.0 * f64::from(index))
    }

    /// True for spectra of the PR-6xx family, or on its grid.
    pub(crate) fn is_pr650_like(&self) -> bool {
        if self.is_foreign() {
            return false;
        }
        self.details.model.as_ref().is_some_and(|model| model.to_ascii_uppercase().contains("PR-6"))
            || self.is_on_pr650_grid()
    }

    /// True for formats of other instruments, or of none: floor, old buffers and noise of the PR-650 are not theirs.
    pub(crate) fn is_foreign(&self) -> bool {
        matches!(self.dialect, "spdx" | "cgats")
    }

    /// Integral over wavelength by the rectangle rule of the instrument, in the unit of the values times nm.
    pub(crate) fn integral(&self) -> f64 {
        let step = if self.nm.len() > 1 { self.nm[1] - self.nm[0] } else { 0.0 };
        step * self.values.iter().sum::<f64>()
    }

    /// Checks the integral that the instrument printed against the sum. Both are rounded to the printed digits, so
    /// the tolerance is 1e-3 of the integral plus half a step of every number in the comparison.
    pub(crate) fn check_integral(&self, printed: Printed, line: u64) -> Result<(), ImportError> {
        let sum = self.integral();
        let step = if self.nm.len() > 1 { self.nm[1] - self.nm[0] } else { 0.0 };
        let rounding = printed.step / 2.0 + step * self.steps.iter().sum::<f64>() / 2.0;
        if (sum - printed.value).abs() <= 1e-3 * printed.value.abs() + rounding {
            return Ok(());
        }
        Err(ImportError::Contradiction(fault(
            Place::file(self.file.as_str()).at_line(line),
            format!(
                "the integral {:e} in the header where the sum of the values times {step} nm is {sum:.4e}",
                printed.value
            ),
            "both within a thousandth",
            "the spectrum was changed or damaged after it was printed; read it from the instrument again",
        )))
    }
}

/// Checks that a wavelength follows the one before it on a uniform grid.
pub(crate) fn expect_wavelength(
    place: Place,
    found: f64,
    expected: f64,
    first: bool,
    step: f64,
) -> Result<(), ImportError> {
    if found == expected {
        return Ok(());
    }
    let (expected, advice) = if first {
        (
            format!("the first wavelength {expected} nm"),
            "look for lost rows, or for a status line that was taken for data".to_owned(),
        )
    } else {
        (
            format!("{expected} nm: the wavelength is not increasing by {step} nm at this line"),
            "look for a doubled or a lost row".to_owned(),
        )
    };
    Err(ImportError::Malformed(fault(place, format!("the wavelength {found} nm"), expected, advice)))
}

/// The error for a spectrum that ends too early.
pub(crate) fn truncated(place: Place, rows: usize, last: Option<f64>, expected: usize, grid: &str) -> ImportError {
    let last = last.map_or_else(|| "none".to_owned(), |nm| format!("{nm} nm"));
    ImportError::Malformed(fault(
        place,
        format!("{rows} rows, the last {last}"),
        format!("{expected} rows ({grid})"),
        "rows are missing: the transfer was cut; read the spectrum from the instrument again",
    ))
}
