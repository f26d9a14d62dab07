//! The cells of a text of a matrix, and how they are divided.

use super::super::Options;
use super::super::dialect::{Delimiter, Dialect};
use super::super::error::{ImportError, fault, quoted};
use super::super::number::{DecimalMark, printed};
use super::super::receipt::Notes;
use super::super::rows::header_line;
use super::super::source::Source;
use super::super::text::Line;

/// The numbers as they stand.
pub(super) struct Table {
    /// The line of the first row.
    pub(super) header: u64,
    /// Its first cell.
    pub(super) corner: String,
    /// Wavelengths along it, nm.
    pub(super) columns_nm: Vec<f64>,
    /// Wavelengths down the first column, nm.
    pub(super) rows_nm: Vec<f64>,
    /// The cells, row by row; NaN where one is empty.
    pub(super) values: Vec<f64>,
    /// How the fields are written.
    pub(super) dialect: Dialect,
}

impl Table {
    /// Reads the table under the keys.
    ///
    /// # Errors
    /// [`ImportError::Malformed`] with the line.
    pub(super) fn read(source: &Source, options: &Options, notes: &mut Notes) -> Result<Self, ImportError> {
        let malformed = |line: u64, found: String, expected: &str, advice: &str| {
            ImportError::Malformed(fault(source.at_line(line), found, expected, advice))
        };
        let Some((header, names)) = header_line(source) else {
            let expected = "a corner and the wavelengths of one axis";
            return Err(malformed(1, "no header".to_owned(), expected, "add the first row"));
        };
        let dialect = options.dialect.unwrap_or_else(|| dialect(source, header, names));
        let number = |field: &str| printed(field, dialect.mark).map(|printed| printed.value);
        let below = source.text.lines().filter(|line| line.number > header);
        let mut fields = split(names, dialect.delimiter);
        let width = below.clone().next().map_or(0, |line| split(line.text, dialect.delimiter).len());
        // Blanks leave no empty corner.
        let corner = if fields.len() + 1 == width && number(fields[0]).is_some() { "" } else { fields.remove(0) };
        let wavelength = |line: u64, field: &str| {
            number(field).filter(|nm| *nm > 0.0).ok_or_else(|| {
                let advice = "correct the cell, or set `--dialect` where the delimiter is another one";
                malformed(
                    line,
                    format!("{} where a wavelength should be", quoted(field)),
                    "a positive number, nm",
                    advice,
                )
            })
        };
        let columns_nm: Vec<f64> = fields.iter().map(|field| wavelength(header, field)).collect::<Result<_, _>>()?;
        let mut table =
            Self { header, corner: corner.to_owned(), columns_nm, rows_nm: Vec::new(), values: Vec::new(), dialect };
        let mut missing = 0_usize;
        for line in below {
            let mut fields = row_fields(line, dialect.delimiter, table.columns_nm.len() + 1).into_iter();
            let nm = wavelength(line.number, fields.next().unwrap_or(""))?;
            let found = fields.len();
            if found != table.columns_nm.len() {
                let found = format!("{found} values in the row of {nm} nm");
                let expected = format!("{}, one for each wavelength of line {header}", table.columns_nm.len());
                return Err(malformed(
                    line.number,
                    found,
                    &expected,
                    "the line is cut, or the delimiter is another one: set `--dialect`",
                ));
            }
            for (field, column) in fields.zip(&table.columns_nm) {
                let absent = field.is_empty() || field.eq_ignore_ascii_case("nan");
                missing += usize::from(absent);
                let value = if absent { Some(f64::NAN) } else { number(field) };
                table.values.push(value.ok_or_else(|| {
                    let found = format!("{} in the row of {nm} nm, under {column} nm", quoted(field));
                    let expected = format!("a finite number, or nothing (dialect {dialect})");
                    malformed(line.number, found, &expected, "correct the cell, or set `--dialect`")
                })?);
            }
            table.rows_nm.push(nm);
        }
        if table.rows_nm.is_empty() || table.columns_nm.is_empty() {
            let found = format!("{} rows and {} columns of values", table.rows_nm.len(), table.columns_nm.len());
            return Err(malformed(
                header,
                found,
                "at least one of each",
                "export the matrix again, or force another `--format`",
            ));
        }
        if missing > 0 {
            notes.notice(source.at_line(header), format!("{missing} empty cells are `not-measured`"));
        }
        Ok(table)
    }
}

/// A line may end with its delimiter; where that makes one field too many, the last is none.
fn row_fields(line: Line<'_>, delimiter: Delimiter, expected: usize) -> Vec<&str> {
    let mut fields: Vec<&str> = raw_fields(line.text, delimiter);
    if fields.len() == expected + 1 && fields.last().is_some_and(|last| last.is_empty()) {
        fields.pop();
    }
    fields
}

/// The fields of the first row: what is empty at its end is none.
pub(super) fn split(text: &str, delimiter: Delimiter) -> Vec<&str> {
    let mut fields = raw_fields(text, delimiter);
    while fields.len() > 1 && fields.last().is_some_and(|last| last.is_empty()) {
        fields.pop();
    }
    if fields.is_empty() { vec![""] } else { fields }
}

fn raw_fields(text: &str, delimiter: Delimiter) -> Vec<&str> {
    let clean = |field| str::trim(field).trim_matches('"').trim();
    match delimiter {
        Delimiter::Space => text.split_whitespace().map(clean).collect(),
        Delimiter::Tab => text.split('\t').map(clean).collect(),
        Delimiter::Comma => text.split(',').map(clean).collect(),
        Delimiter::Semicolon => text.split(';').map(clean).collect(),
    }
}

/// What divides the fields of a first row.
pub(super) fn delimiter_of(header: &str) -> Delimiter {
    [('\t', Delimiter::Tab), (';', Delimiter::Semicolon), (',', Delimiter::Comma)]
        .into_iter()
        .find(|(c, _)| header.contains(*c))
        .map_or(Delimiter::Space, |(_, delimiter)| delimiter)
}

/// The delimiter of the header; commas are decimal marks where they are no delimiters and there is no point.
fn dialect(source: &Source, header: u64, names: &str) -> Dialect {
    let delimiter = delimiter_of(names);
    let any = |c: char| source.text.lines().filter(|line| line.number > header).any(|line| line.text.contains(c));
    let comma = delimiter != Delimiter::Comma && any(',') && !any('.');
    Dialect { delimiter, mark: if comma { DecimalMark::Comma } else { DecimalMark::Point } }
}

/// A number with either decimal mark.
pub(super) fn either(text: &str) -> Option<f64> {
    let number = printed(text, DecimalMark::Point).or_else(|| printed(text, DecimalMark::Comma));
    number.map(|number| number.value)
}
