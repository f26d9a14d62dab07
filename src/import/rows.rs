//! A table of named columns under `# key: value` lines: what manifests and table CSV have in common.

use super::angles::Written;
use super::error::{ImportError, fault, quoted};
use super::keys::{Settings, key_line};
use super::number::value;
use super::source::Source;
use super::times;
use crate::dataset::Place;

/// The rows of a table, by the names of its columns.
#[derive(Debug)]
pub(crate) struct Rows {
    file: String,
    /// True for fields divided by semicolons, whose numbers may have decimal commas.
    pub(crate) semicolons: bool,
    /// The line of the column names.
    pub(crate) header: u64,
    columns: Vec<String>,
    rows: Vec<(u64, Vec<String>)>,
}

/// One row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    table: &'a Rows,
    /// The line it stands in.
    pub(crate) line: u64,
    fields: &'a [String],
}

/// Column names of other programs and their names here.
const ALIASES: &[(&str, &str)] = &[
    ("lambda_i_nm", "excitation_nm"),
    ("theta_i", "theta_i_deg"),
    ("theta_v", "theta_v_deg"),
    ("phi_i", "phi_i_deg"),
    ("phi_v", "phi_v_deg"),
];

/// The header line of a table: the first line that is neither blank nor a comment.
pub(crate) fn header_line(source: &Source) -> Option<(u64, &str)> {
    source.text.lines().find(|line| !line.text.trim_start().starts_with('#')).map(|line| (line.number, line.text))
}

/// Reads the `# key: value` lines above the header into `settings`.
///
/// # Errors
/// [`ImportError`] with the line for other comments, unknown keys, and one key with two values.
pub(crate) fn keys_above(source: &Source, settings: &mut Settings) -> Result<(), ImportError> {
    let mut taken = Vec::new();
    for line in source.text.lines().take_while(|line| line.text.trim_start().starts_with('#')) {
        match key_line(line.text) {
            Some((key, text)) => settings.take_once(key, text, source.at_line(line.number), &mut taken)?,
            None => {
                return Err(ImportError::Call(fault(
                    source.at_line(line.number),
                    format!("the comment {}", quoted(line.text.trim())),
                    "`# key: value`",
                    "say it as `# title: ...`, or take the line out: nothing is passed over",
                )));
            }
        }
    }
    Ok(())
}

impl Rows {
    /// Reads the keys into `settings` and the rows of a CSV text. `known` are the columns that it may have.
    ///
    /// # Errors
    /// [`ImportError`] with the line for unknown keys and columns, doubled columns, and rows of another length.
    pub(crate) fn from_csv(source: &Source, settings: &mut Settings, known: &[&str]) -> Result<Self, ImportError> {
        keys_above(source, settings)?;
        let Some((first, names)) = header_line(source) else {
            return Err(ImportError::Malformed(fault(
                source.at_line(1),
                "no line of column names",
                format!("a header with columns of: {}", known.join(", ")),
                "add the header",
            )));
        };
        let semicolons = names.contains(';') && !names.contains(',');
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(if semicolons { b';' } else { b',' })
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(source.text.rest_from(first).as_bytes());
        let mut rows = Vec::new();
        let mut record = csv::StringRecord::new();
        loop {
            match reader.read_record(&mut record) {
                Ok(false) => break,
                Ok(true) => {
                    let line = first - 1 + record.position().map_or(1, csv::Position::line);
                    refuse_comment(
                        &record,
                        rows.first().map(|(_, names): &(u64, Vec<String>)| names.len()),
                        source.at_line(line),
                    )?;
                    rows.push((line, record.iter().map(|field| decimal_point(field, semicolons)).collect::<Vec<_>>()));
                }
                Err(error) => {
                    let line = error.position().map_or(first, |position| first - 1 + position.line());
                    return Err(malformed(source.at_line(line), error.to_string(), "a row of the table"));
                }
            }
        }
        let (line, header) = rows.remove(0);
        let mut table = Self::new(source, line, header, rows, known)?;
        table.semicolons = semicolons;
        table.check_lengths()?;
        Ok(table)
    }

    /// A table from column names and rows.
    pub(crate) fn new(
        source: &Source,
        header_line: u64,
        header: Vec<String>,
        rows: Vec<(u64, Vec<String>)>,
        known: &[&str],
    ) -> Result<Self, ImportError> {
        let canonical = |name: &String| {
            let name = name.trim().to_ascii_lowercase();
            ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, canonical)| (*canonical).to_owned())
        };
        let columns: Vec<String> = header.iter().map(canonical).collect();
        for (index, column) in columns.iter().enumerate() {
            let unknown = !known.contains(&column.as_str());
            if unknown || columns[..index].contains(column) {
                let what = if unknown { "unknown" } else { "doubled" };
                return Err(ImportError::Call(fault(
                    source.at_line(header_line),
                    format!("the {what} column {}", quoted(column)),
                    format!("columns of: {}", known.join(", ")),
                    "rename the column or take it out: nothing is passed over",
                )));
            }
        }
        let rows: Vec<_> =
            rows.into_iter().filter(|(_, fields)| fields.iter().any(|field| !field.is_empty())).collect();
        if rows.is_empty() {
            return Err(malformed(source.at_line(header_line), "no rows", "at least one row under the header"));
        }
        Ok(Self { file: source.name.clone(), semicolons: false, header: header_line, columns, rows })
    }

    /// Rewrites the fields of a column where `new` gives another text.
    pub(crate) fn rewrite(&mut self, column: &str, new: impl Fn(&str) -> Option<String>) {
        let Some(index) = self.columns.iter().position(|name| name == column) else { return };
        for field in self.rows.iter_mut().filter_map(|(_, fields)| fields.get_mut(index)) {
            if let Some(text) = new(field) {
                *field = text;
            }
        }
    }

    fn check_lengths(&self) -> Result<(), ImportError> {
        let wrong = self.rows.iter().find(|(_, fields)| fields.len() != self.columns.len());
        wrong.map_or(Ok(()), |(line, fields)| {
            let expected = format!("{}, one per column of the header", self.columns.len());
            Err(malformed(Place::file(self.file.as_str()).at_line(*line), format!("{} fields", fields.len()), expected))
        })
    }

    /// The rows.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|(line, fields)| Row { table: self, line: *line, fields })
    }

    /// True where the table has the column.
    pub(crate) fn has(&self, column: &str) -> bool {
        self.columns.iter().any(|name| name == column)
    }
}

impl<'a> Row<'a> {
    /// Where the row stands.
    pub(crate) fn place(&self) -> Place {
        Place::file(self.table.file.as_str()).at_line(self.line)
    }

    /// The text of a column; `None` where the table has no such column or the field is empty.
    pub(crate) fn text(&self, column: &str) -> Option<&'a str> {
        let index = self.table.columns.iter().position(|name| name == column)?;
        self.fields.get(index).map(String::as_str).filter(|text| !text.is_empty())
    }

    /// The number in a column.
    pub(crate) fn number(&self, column: &str) -> Result<Option<f64>, ImportError> {
        let Some(text) = self.text(column) else { return Ok(None) };
        value(text).map(Some).ok_or_else(|| self.bad(column, text, "a finite number with a decimal point"))
    }

    /// The number in a column, which must be greater than zero.
    pub(crate) fn positive(&self, column: &str) -> Result<Option<f64>, ImportError> {
        match self.number(column)? {
            Some(number) if number <= 0.0 => Err(self.bad(column, &number.to_string(), "a number greater than zero")),
            other => Ok(other),
        }
    }

    /// The whole number in a column.
    pub(crate) fn whole(&self, column: &str) -> Result<Option<u32>, ImportError> {
        let Some(text) = self.text(column) else { return Ok(None) };
        text.parse().map(Some).map_err(|_| self.bad(column, text, "a whole number"))
    }

    /// The time of the row as RFC 3339; the zone is that of all rows, where one is stated.
    pub(crate) fn time(&self, zone: Option<&str>) -> Result<Option<String>, ImportError> {
        let Some(text) = self.text("time") else { return Ok(None) };
        times::rfc3339(text, zone).map(Some).ok_or_else(|| {
            self.bad("time", text, "a time with its offset, as 2024-05-01T10:00:00+09:00, or the key `time-zone`")
        })
    }

    /// The angles of the row; `None` where all fields are empty.
    pub(crate) fn angles(&self) -> Result<Option<Written>, ImportError> {
        let names = if self.table.has("phi_i_deg") || self.table.has("phi_v_deg") {
            &["theta_i_deg", "phi_i_deg", "theta_v_deg", "phi_v_deg"][..]
        } else {
            &["theta_i_deg", "theta_v_deg"][..]
        };
        let numbers: Vec<Option<f64>> = names.iter().map(|name| self.number(name)).collect::<Result<_, _>>()?;
        match numbers.as_slice() {
            [Some(theta_i), Some(theta_v)] => Ok(Some(Written::Signed(*theta_i, *theta_v))),
            [Some(theta_i), Some(phi_i), Some(theta_v), Some(phi_v)] => {
                Ok(Some(Written::Full([*theta_i, *phi_i, *theta_v, *phi_v])))
            }
            numbers if numbers.iter().all(Option::is_none) => Ok(None),
            _ => Err(self.bad("angles", "a part of them", &format!("all of {} or none", names.join(", ")))),
        }
    }

    /// The error for a field that cannot be read.
    pub(crate) fn bad(&self, column: &str, found: &str, expected: &str) -> ImportError {
        malformed(self.place(), format!("{} in the column `{column}`", quoted(found)), expected)
    }
}

/// Keys and comments stand above the header: below it, a key would hold for some rows and not for others. A file may
/// have a name that begins with `#`, in a row of as many fields as the header's `columns`.
fn refuse_comment(record: &csv::StringRecord, columns: Option<usize>, place: Place) -> Result<(), ImportError> {
    let first = record.get(0).unwrap_or("");
    let is_row = columns == Some(record.len()) && !first.starts_with("# ");
    if !first.starts_with('#') || is_row {
        return Ok(());
    }
    let text: Vec<&str> = record.iter().collect();
    Err(ImportError::Call(fault(
        place,
        format!("the comment {} below the header", quoted(&text.join(","))),
        "a row of the table",
        "take the line out, or say it as `# key: value` above the header",
    )))
}

/// A field of a table divided by semicolons: a number with a decimal comma gets a point.
fn decimal_point(field: &str, semicolons: bool) -> String {
    let is_number = field.chars().all(|c| c.is_ascii_digit() || matches!(c, ',' | '+' | '-' | 'e' | 'E'));
    if semicolons && is_number && field.matches(',').count() == 1 { field.replace(',', ".") } else { field.to_owned() }
}

fn malformed(place: Place, found: impl Into<String>, expected: impl Into<String>) -> ImportError {
    ImportError::Malformed(fault(place, found, expected, "correct the line"))
}
