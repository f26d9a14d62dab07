//! Raw texts of the PR-650 (report D5 or M5) and of the PR-655 and PR-670 (M5), as they come over the serial line.
//!
//! ```text
//! PR-650   qq,U <eol> i.iiiEsee <eol>   then 101 rows   wwww.,r.rrrEsee
//! PR-655   qqqqq,U,peak,integral,photon then 101 rows   www,r.rrresee(e)
//! PR-670   the same                     with 201 rows of 2 nm
//! ```
//!
//! A capture may hold prompts (`>`), echoed commands, acknowledgements (`000`), other reports and several spectra. Any
//! of CR, LF and CRLF ends a line. Reports D1 to D6 give a luminance to check the spectrum against; D120 gives the
//! bandpass. Every number is read by its comma and not by its offset, because the sources differ in their digits.

use super::Options;
use super::error::{ImportError, fault, quoted};
use super::number::{DecimalMark, Printed, printed, value};
use super::pr650_line::{Kind, is_later_header, is_range_report, is_status_code, kind, strip};
use super::quality::{self, Action};
use super::record::{Record, expect_wavelength, truncated};
use super::source::Source;
use super::text::Line;
use crate::quantity::{Flag, Flags, QuantityKind};

/// Values at or below this are what the PR-655 and PR-670 print for zero (`1.000e-27`), W m-2 sr-1 nm-1.
const LATER_MODEL_ZERO: f64 = 1e-20;

/// A wavelength grid that the instrument prints.
#[derive(Debug, Clone, Copy)]
struct Grid {
    first: f64,
    step: f64,
    count: usize,
}

impl Grid {
    const PR650: Self = Self { first: 380.0, step: 4.0, count: 101 };
    const PR670: Self = Self { first: 380.0, step: 2.0, count: 201 };

    fn at(self, index: usize) -> f64 {
        self.first + self.step * index as f64
    }

    fn describe(self) -> String {
        format!("{} to {} nm by {}", self.first, self.at(self.count - 1), self.step)
    }
}

/// Reads every spectrum of a capture.
///
/// # Errors
/// [`ImportError`] with the line for everything that the format does not allow.
pub(super) fn parse(source: &Source, options: &Options) -> Result<Vec<Record>, ImportError> {
    let lines: Vec<Line<'_>> = source.text.lines().collect();
    let mut capture = Capture {
        source,
        options,
        lines,
        next: 0,
        records: Vec::new(),
        luminance: None,
        bandpass_nm: None,
        grid: Grid::PR650,
        command: String::new(),
    };
    while capture.next < capture.lines.len() {
        capture.step()?;
    }
    capture.finish()
}

struct Capture<'a> {
    source: &'a Source,
    options: &'a Options,
    lines: Vec<Line<'a>>,
    next: usize,
    records: Vec<Record>,
    /// A luminance that came before its spectrum.
    luminance: Option<(f64, u64)>,
    bandpass_nm: Option<f64>,
    grid: Grid,
    command: String,
}

impl<'a> Capture<'a> {
    fn step(&mut self) -> Result<(), ImportError> {
        let line = self.lines[self.next];
        self.source.text.require_ascii(line, &self.source.name)?;
        let text = strip(line.text);
        self.next += 1;
        match kind(text) {
            Kind::Prompt | Kind::Acknowledgement => Ok(()),
            Kind::Command => {
                self.command = text.to_ascii_uppercase();
                Ok(())
            }
            Kind::Status => self.spectrum_of_pr650(line, text),
            Kind::Report => self.report(line, text),
            Kind::Row => Err(self.unexpected(line, "a row of data without a status line `qq,U` before it")),
            Kind::Number => Err(self.unexpected(line, "a number on a line of its own")),
            Kind::Unknown => Err(self.unexpected(line, &format!("the line {}", quoted(text)))),
        }
    }

    fn unexpected(&self, line: Line<'_>, found: &str) -> ImportError {
        ImportError::Malformed(fault(
            self.source.at_line(line.number),
            found,
            "a status line, a command, a prompt or a report of a PR-650, PR-655 or PR-670",
            "look for lost lines before it; for a plain table of two columns say `--format columns`",
        ))
    }

    fn peek(&self) -> Option<(Line<'a>, Kind, &'a str)> {
        let line = *self.lines.get(self.next)?;
        let text = strip(line.text);
        Some((line, kind(text), text))
    }

    /// `qq,U`, then the integral, then the rows.
    fn spectrum_of_pr650(&mut self, line: Line<'_>, text: &str) -> Result<(), ImportError> {
        let fields: Vec<&str> = text.split(',').map(str::trim).collect();
        let mut record = self.open(line, "pr650-d5", "PR-650");
        self.status(&mut record, line, fields[0], fields[1])?;
        let integral = self.integral_line(&record)?;
        let grid = self.grid;
        self.rows(record, grid, integral)
    }

    fn integral_line(&mut self, record: &Record) -> Result<Option<(Printed, u64)>, ImportError> {
        let Some((line, Kind::Number, text)) = self.peek() else {
            if record.rejection.is_some() {
                return Ok(None);
            }
            let line = self.peek().map_or(record.line, |(line, ..)| line.number);
            return Err(ImportError::Malformed(fault(
                self.source.at_line(line),
                "no integral after the status line",
                "the integral `i.iiiE+ee` and 101 rows",
                "the transfer was cut; read the spectrum from the instrument again",
            )));
        };
        self.next += 1;
        Ok(printed(text, DecimalMark::Point).map(|integral| (integral, line.number)))
    }

    /// A status with further numbers: the header of a later model's spectrum, or a colorimetric report.
    fn report(&mut self, line: Line<'_>, text: &str) -> Result<(), ImportError> {
        let fields: Vec<&str> = text.split(',').map(str::trim).collect();
        if self.command == "D120" || is_range_report(&fields) {
            return self.range_report(&fields);
        }
        if !is_status_code(fields[0]) {
            return Err(self.unexpected(line, &format!("the line {}", quoted(text))));
        }
        let later_model = fields[0].len() > 2;
        let rows_follow = matches!(self.peek(), Some((_, Kind::Row, _)));
        let spectrum = self.command.ends_with('5') || rows_follow || is_later_header(&fields);
        if later_model && spectrum && fields.len() == 5 {
            return self.spectrum_of_later_model(line, &fields);
        }
        self.luminance_report(line, &fields);
        Ok(())
    }

    /// `qqqqq,UUUU,peak,integral,photon`, then the rows: 4 nm for the PR-655, 2 nm for the PR-670.
    fn spectrum_of_later_model(&mut self, line: Line<'_>, fields: &[&str]) -> Result<(), ImportError> {
        let second = self.lines.get(self.next + 1).and_then(|line| strip(line.text).split(',').next()).and_then(value);
        let (grid, dialect, model) = if second == Some(Grid::PR670.at(1)) {
            (Grid::PR670, "pr670-m5", "PR-670")
        } else {
            (Grid::PR650, "pr655-m5", "PR-655")
        };
        let mut record = self.open(line, dialect, model);
        self.status(&mut record, line, fields[0], fields[1])?;
        let integral = printed(fields[3], DecimalMark::Point).map(|integral| (integral, line.number));
        self.rows(record, grid, integral)
    }

    fn open(&mut self, line: Line<'_>, dialect: &'static str, model: &str) -> Record {
        let mut record = Record::new(&self.source.name, self.records.len() as u64 + 1, line.number, dialect);
        record.details.model = Some(model.to_owned());
        record.details.bandpass_nm = self.bandpass_nm;
        record.luminance = self.luminance.take();
        record
    }

    fn status(&self, record: &mut Record, line: Line<'_>, code: &str, unit: &str) -> Result<(), ImportError> {
        let place = || self.source.at_line(line.number);
        let code: i32 =
            code.parse().map_err(|_| self.unexpected(line, &format!("the quality code {}", quoted(code))))?;
        record.quality = Some(code);
        let quality = quality::look_up(code, place())?;
        record.kind = match unit.parse::<u16>() {
            Ok(0) => QuantityKind::SpectralRadiance,
            Ok(1) => QuantityKind::SpectralIrradiance,
            Ok(2) if self.options.allow_uncalibrated => QuantityKind::Unstated,
            Ok(2) => {
                return Err(ImportError::Refused(fault(
                    place(),
                    "unit code 2: uncalibrated",
                    "unit 0 (radiance) or 1 (irradiance)",
                    "calibrate the instrument, or force it with `--allow-uncalibrated`",
                )));
            }
            _ => return Err(self.unexpected(line, &format!("the unit code {}", quoted(unit)))),
        };
        if let Action::Reject(flag) = quality.action {
            record.rejection = Some((flag, format!("quality code {code}: {}", quality.text)));
        }
        Ok(())
    }

    /// The rows of a spectrum. Those of a rejected record are passed over: they are no measurement.
    fn rows(&mut self, mut record: Record, grid: Grid, integral: Option<(Printed, u64)>) -> Result<(), ImportError> {
        let rejected = record.rejection.is_some();
        while let Some((line, Kind::Row, text)) = self.peek() {
            let (nm_text, value_text) = text.split_once(',').unwrap_or((text, ""));
            self.source.text.require_ascii(line, &self.source.name)?;
            self.next += 1;
            if !rejected {
                self.row(&mut record, grid, line, (nm_text.trim(), value_text.trim()))?;
            }
        }
        if let Some((line, ..)) = self.peek() {
            self.source.text.require_ascii(line, &self.source.name)?;
        }
        if rejected {
            let (flag, why) = record.rejection.take().unwrap_or((Flag::Invalid, String::new()));
            record.reject(flag, why);
        } else {
            self.complete(&mut record, grid, integral)?;
        }
        self.records.push(record);
        Ok(())
    }

    fn row(&self, record: &mut Record, grid: Grid, line: Line<'_>, text: (&str, &str)) -> Result<(), ImportError> {
        let place = || self.source.at_line(line.number);
        let index = record.nm.len();
        if index == grid.count {
            return Err(ImportError::Malformed(fault(
                place(),
                format!("row {} of a spectrum", index + 1),
                format!("{} rows ({})", grid.count, grid.describe()),
                "look for doubled rows, or for a lost status line between two spectra",
            )));
        }
        let Some(nm) = value(text.0) else {
            return Err(self.bad_value(line, "wavelength", text.0, "`wwww.`"));
        };
        expect_wavelength(place(), nm, grid.at(index), index == 0, grid.step)?;
        let what = format!("value at {nm} nm");
        let Some(number) = printed(text.1, DecimalMark::Point).filter(|number| matches!(number.exponent_digits, 2 | 3))
        else {
            return Err(self.bad_value(line, &what, text.1, "`r.rrrE+ee`"));
        };
        if number.value < 0.0 {
            return Err(self.bad_value(
                line,
                &what,
                text.1,
                "a number that is not negative: the instrument prints none",
            ));
        }
        record.push(nm, number);
        Ok(())
    }

    fn bad_value(&self, line: Line<'_>, what: &str, found: &str, expected: &str) -> ImportError {
        ImportError::Malformed(fault(
            self.source.at_line(line.number),
            format!("the bad {what}: {}", quoted(found)),
            expected,
            "the line is cut or was changed; read the spectrum from the instrument again",
        ))
    }

    fn complete(&self, record: &mut Record, grid: Grid, integral: Option<(Printed, u64)>) -> Result<(), ImportError> {
        if record.nm.len() < grid.count {
            let last_line = self.lines.get(self.next.saturating_sub(1)).map_or(record.line, |line| line.number);
            let place = self.source.at_line(last_line);
            let last = record.nm.last().copied();
            return Err(truncated(place, record.nm.len(), last, grid.count, &grid.describe()));
        }
        let action = quality::look_up(record.quality.unwrap_or(0), record.place())?.action;
        if let Some((integral, line)) = integral {
            match (record.check_integral(integral, line), action) {
                // The instrument itself doubts this record and its flag says so; the sum is one doubt more.
                (Err(error), Action::KeepWithFlag(Flag::LowLight | Flag::Noisy)) => {
                    record.doubts.push(error.to_string())
                }
                (result, _) => result?,
            }
        }
        for (flags, value) in record.flags.iter_mut().zip(&record.values) {
            if *value <= LATER_MODEL_ZERO {
                *flags = Flags::with(*flags, Flag::BelowDetection);
            }
        }
        if let Action::KeepWithFlag(flag) = action {
            record.flag_all(flag);
        }
        Ok(())
    }

    /// D120: points, bandwidth, first, last, step. Nothing is lost when the report has another form.
    fn range_report(&mut self, fields: &[&str]) -> Result<(), ImportError> {
        let numbers: Vec<f64> = fields.iter().filter_map(|field| value(field)).collect();
        let shift = usize::from(fields.len() > 6);
        let Some(&[points, bandwidth, first, last, step]) = numbers.get(shift..shift + 5) else { return Ok(()) };
        self.bandpass_nm = (bandwidth > 0.0).then_some(bandwidth);
        let count = ((last - first) / step).round() + 1.0;
        if count == points && (2.0..=10_000.0).contains(&points) && step > 0.0 && first > 0.0 {
            self.grid = Grid { first, step, count: points as usize };
        }
        Ok(())
    }

    /// D1, D3, D4, D6 print the luminance third; D2 prints X, Y, Z.
    fn luminance_report(&mut self, line: Line<'_>, fields: &[&str]) {
        let tristimulus = self.command.ends_with('2')
            || fields.len() == 5 && fields[2..].iter().all(|field| field.contains(['E', 'e']));
        let Some(luminance) = fields.get(if tristimulus { 3 } else { 2 }).and_then(|field| value(field)) else {
            return;
        };
        match self.records.last_mut() {
            Some(record) if record.luminance.is_none() => record.luminance = Some((luminance, line.number)),
            _ => self.luminance = Some((luminance, line.number)),
        }
    }

    fn finish(self) -> Result<Vec<Record>, ImportError> {
        if self.records.is_empty() {
            return Err(ImportError::Malformed(fault(
                self.source.at_line(self.lines.first().map_or(1, |line| line.number)),
                "no spectrum, only commands or colorimetric reports",
                "a report D5 or M5",
                "read the spectrum from the instrument with D5 or M5",
            )));
        }
        Ok(self.records)
    }
}
