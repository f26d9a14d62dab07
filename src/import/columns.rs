//! Texts of columns: a wavelength and one or more values per line, divided by blanks, tabs, commas or semicolons.
//!
//! A header is optional; a header that comes again, or a wavelength that starts again, begins the next record. Each
//! value column is a record named by its header, except a column called `luminance`, which is a check on the spectrum
//! before it. Lines of other text (`Metadata,Value` blocks, `key: value`) give the instrument's particulars where the
//! key is known and are counted in the receipt where it is not. `#`, `%` and `//` begin comments.
//!
//! Such a text does not say what its numbers are: the quantity stays `unstated` unless the caller states it.

use super::Options;
use super::dialect::{Dialect, is_row};
use super::error::{ImportError, fault, quoted};
use super::number::{DecimalMark, Printed, printed};
use super::particulars::{self, Particular};
use super::record::{Details, Record, truncated};
use super::source::Source;
use super::text::Line;
use crate::quantity::Flag;

/// What a text of columns holds.
pub(super) struct Columns {
    /// The records in the order of the file.
    pub(super) records: Vec<Record>,
    /// Lines of text that were not understood, with their numbers.
    pub(super) unread: Vec<(u64, String)>,
    /// The dialect.
    pub(super) dialect: Dialect,
}

/// Reads every record of a text of columns.
///
/// # Errors
/// [`ImportError`] with line and wavelength for numbers that are none, wavelengths that do not ascend on the grid, and
/// rows that are missing.
pub(super) fn parse(source: &Source, options: &Options) -> Result<Columns, ImportError> {
    let dialect = match options.dialect {
        Some(dialect) => dialect,
        None => Dialect::find(source)?,
    };
    let mut reader = Reader {
        source,
        options,
        dialect,
        header: Vec::new(),
        rows: Vec::new(),
        details: Details::default(),
        luminance: None,
        records: Vec::new(),
        unread: Vec::new(),
    };
    for line in source.text.lines() {
        reader.line(line)?;
    }
    reader.flush()?;
    Ok(Columns { records: reader.records, unread: reader.unread, dialect })
}

struct Row {
    line: u64,
    nm: f64,
    values: Vec<Printed>,
}

struct Reader<'a> {
    source: &'a Source,
    options: &'a Options,
    dialect: Dialect,
    header: Vec<String>,
    rows: Vec<Row>,
    details: Details,
    luminance: Option<(f64, u64)>,
    records: Vec<Record>,
    unread: Vec<(u64, String)>,
}

impl Reader<'_> {
    fn line(&mut self, line: Line<'_>) -> Result<(), ImportError> {
        if is_row(line.text) {
            let row = self.row(line)?;
            let restarts = self.rows.len() > 1 && self.rows[0].nm == row.nm;
            if restarts {
                self.flush()?;
            }
            self.check_count(line, &row)?;
            self.rows.push(row);
            return Ok(());
        }
        self.flush()?;
        self.words(line);
        Ok(())
    }

    /// A line of words: a header, a particular, a comment.
    fn words(&mut self, line: Line<'_>) {
        let text = line.text.trim();
        let fields = self.dialect.fields(text);
        let header = particulars::is_wavelength(fields[0]);
        if header {
            self.header = fields.iter().map(|field| field.trim_matches('"').to_owned()).collect();
            return;
        }
        match particulars::read(text) {
            Some(Particular::Luminance(value)) => self.luminance = Some((value, line.number)),
            Some(particular) => particular.apply(&mut self.details),
            None if particulars::is_heading(text) => {}
            None => self.unread.push((line.number, text.chars().take(80).collect())),
        }
    }

    fn row(&self, line: Line<'_>) -> Result<Row, ImportError> {
        self.source.text.require_ascii(line, &self.source.name)?;
        let fields = self.dialect.fields(line.text);
        let Some(nm) = printed(fields[0], self.dialect.mark).map(|number| number.value) else {
            return Err(self.bad(line, "wavelength", fields[0]));
        };
        if nm <= 0.0 {
            return Err(ImportError::Malformed(fault(
                self.source.at_line(line.number),
                format!("the wavelength {nm} nm"),
                "a positive wavelength",
                "a status line was taken for data, or the columns are in another order",
            )));
        }
        let value = |field: &&str| {
            printed(field, self.dialect.mark).ok_or_else(|| self.bad(line, &format!("value at {nm} nm"), field))
        };
        let values: Vec<Printed> = fields[1..].iter().map(value).collect::<Result<_, _>>()?;
        let negative = values.iter().position(|number| number.value < 0.0);
        if let (Some(column), true) = (negative, self.declared_pr650()) {
            return Err(self.bad(line, &format!("negative value at {nm} nm"), fields[column + 1]));
        }
        Ok(Row { line: line.number, nm, values })
    }

    fn declared_pr650(&self) -> bool {
        let declared = self.options.settings.instrument.as_ref().or(self.details.model.as_ref());
        declared.is_some_and(|model| model.to_ascii_uppercase().contains("PR-650"))
    }

    fn bad(&self, line: Line<'_>, what: &str, found: &str) -> ImportError {
        let other = if self.dialect.mark == DecimalMark::Comma { "a decimal comma" } else { "a decimal point" };
        ImportError::Malformed(fault(
            self.source.at_line(line.number),
            format!("the bad {what}: {}", quoted(found)),
            format!("a finite number with {other} (dialect {}) that the instrument can print", self.dialect),
            "repair the line, leave the record out, or set `--dialect`",
        ))
    }

    fn check_count(&self, line: Line<'_>, row: &Row) -> Result<(), ImportError> {
        let expected = self.rows.first().map_or(row.values.len().max(1), |first| first.values.len());
        if row.values.len() == expected {
            return Ok(());
        }
        Err(ImportError::Malformed(fault(
            self.source.at_line(line.number),
            format!("{} values after the wavelength", row.values.len()),
            format!("{expected}, as in the lines before"),
            "the line is cut, or the delimiter is another one: set `--dialect`",
        )))
    }

    fn flush(&mut self) -> Result<(), ImportError> {
        let rows = std::mem::take(&mut self.rows);
        let Some(first) = rows.first() else { return Ok(()) };
        self.check_grid(&rows)?;
        let columns = first.values.len();
        let named = if self.header.len() == columns + 1 { self.header[1..].to_vec() } else { Vec::new() };
        let several = named.iter().filter(|name| !particulars::is_luminance(name)).count() > 1;
        for column in 0..columns {
            let name = named.get(column).map(String::as_str);
            if name.is_some_and(particulars::is_luminance) && column > 0 {
                let luminance = rows[0].values[column].value;
                if let Some(record) = self.records.last_mut() {
                    record.luminance = Some((luminance, rows[0].line));
                }
                continue;
            }
            let title = name.filter(|_| several).map(str::to_owned);
            self.push_record(&rows, column, title);
        }
        Ok(())
    }

    fn push_record(&mut self, rows: &[Row], column: usize, title: Option<String>) {
        let number = self.records.len() as u64 + 1;
        let mut record = Record::new(&self.source.name, number, rows[0].line, "columns");
        record.title = title;
        record.details = self.details.clone();
        record.luminance = self.luminance;
        for row in rows {
            record.push(row.nm, row.values[column]);
        }
        let decimals = rows[0].values[column].decimals;
        let fixed = |row: &Row| row.values[column].exponent_digits == 0 && row.values[column].decimals == decimals;
        record.fixed_decimals = rows.iter().all(fixed).then_some(decimals);
        if record.is_pr650_like() {
            flag_printed_zeros(&mut record);
            doubt_negatives(&mut record);
        }
        self.records.push(record);
    }

    /// Wavelengths ascend; where most of them have one step, all have.
    fn check_grid(&self, rows: &[Row]) -> Result<(), ImportError> {
        let step = usual_step(rows);
        if rows.len() > 1 && rows.windows(2).all(|pair| pair[1].nm < pair[0].nm) {
            return Err(ImportError::Malformed(fault(
                self.source.at_line(rows[1].line),
                format!("wavelengths that descend from {} nm", rows[0].nm),
                "ascending wavelengths",
                "turn the order of the rows round",
            )));
        }
        for pair in rows.windows(2) {
            let found = pair[1].nm - pair[0].nm;
            let is_measured = rows.len() >= FEWEST;
            let departs = step.is_some_and(|step| is_measured && (found - step).abs() > 0.2 * step);
            if found <= 0.0 || departs {
                let by = step.map_or_else(String::new, |step| format!(" by {step}"));
                return Err(ImportError::Malformed(fault(
                    self.source.at_line(pair[1].line),
                    format!("{} nm after {} nm", pair[1].nm, pair[0].nm),
                    format!("the next wavelength of the grid: it is not increasing{by} at this line"),
                    "look for a doubled or a lost row",
                )));
            }
        }
        self.check_complete(rows, step)
    }

    /// A 4 nm grid inside 380 to 780 nm is the PR-650's, which always prints all of it.
    fn check_complete(&self, rows: &[Row], step: Option<f64>) -> Result<(), ImportError> {
        let on_grid = |row: &Row| (380.0..=780.0).contains(&row.nm) && (row.nm - 380.0) % 4.0 == 0.0;
        let part = step == Some(4.0) && rows.len() < 101 && rows.iter().all(on_grid);
        match rows.last() {
            Some(last) if part && !self.options.allow_partial_grid => {
                let place = self.source.at_line(last.line);
                let grid = "the PR-650's grid of 380 to 780 nm by 4; `--allow-partial-grid` takes a part of it";
                Err(truncated(place, rows.len(), Some(last.nm), 101, grid))
            }
            Some(only) if rows.len() == 1 => Err(ImportError::Malformed(fault(
                self.source.at_line(only.line),
                "a spectrum of one row",
                "at least two wavelengths",
                "look for lost rows, or set `--dialect` or `--format`",
            ))),
            _ => Ok(()),
        }
    }
}

/// Fewer rows are no record of an instrument but knots that somebody chose, at whatever distance.
const FEWEST: usize = 10;

/// The step that more than half of the rows have, to 1e-6 of it.
fn usual_step(rows: &[Row]) -> Option<f64> {
    let mut steps: Vec<f64> = rows.windows(2).map(|pair| pair[1].nm - pair[0].nm).collect();
    steps.sort_by(f64::total_cmp);
    let middle = *steps.get(steps.len() / 2)?;
    let same = steps.iter().filter(|step| (**step - middle).abs() <= 1e-6 * middle.abs()).count();
    (middle > 0.0 && 2 * same > steps.len()).then_some(middle)
}

/// The PR-650 never prints zero: a zero is what is left of a small value after rounding to few decimals.
fn flag_printed_zeros(record: &mut Record) {
    for (flags, value) in record.flags.iter_mut().zip(&record.values) {
        if *value == 0.0 {
            *flags = flags.with(Flag::BelowDetection);
        }
    }
}

/// Nor does it print a negative value: something was taken off, or another instrument measured on this grid.
fn doubt_negatives(record: &mut Record) {
    let negative = || record.nm.iter().zip(&record.values).filter(|(_, value)| **value < 0.0);
    let Some((nm, value)) = negative().next() else { return };
    let text = format!(
        "{}{} of {} values are negative (the first {value:e} at {nm} nm), which a PR-650 cannot print: something was \
         taken off them, or another instrument measured; the values are kept",
        record.prefix(),
        negative().count(),
        record.values.len()
    );
    record.doubts.push(text);
}
