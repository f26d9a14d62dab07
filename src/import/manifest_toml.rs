//! A scan manifest in TOML: the keys at the top, one `[[record]]` per row.

use toml::de::{DeTable, DeValue};

use super::error::{ImportError, fault, quoted};
use super::keys::Settings;
use super::rows::Rows;
use super::source::Source;

/// Reads the keys into `settings` and the rows.
///
/// # Errors
/// [`ImportError`] with the line for what is no TOML, and for unknown keys.
pub(super) fn rows(source: &Source, settings: &mut Settings, known: &[&str]) -> Result<Rows, ImportError> {
    let text = &source.text.content;
    let lines = LineEnds::of(text);
    let table = DeTable::parse(text).map_err(|error| {
        let line = error.span().map_or(1, |span| lines.line(span.start));
        ImportError::Malformed(fault(source.at_line(line), error.message(), "a manifest in TOML", "correct the line"))
    })?;
    let mut records = Vec::new();
    for (key, value) in table.get_ref() {
        let line = lines.line(key.span().start);
        match value.get_ref() {
            DeValue::Array(items) if key.get_ref() == "record" => {
                for item in items {
                    let line = lines.line(item.span().start);
                    let DeValue::Table(fields) = item.get_ref() else {
                        return Err(not_a_value(source, line, "record"));
                    };
                    records.push((line, fields_of(source, &lines, fields)?));
                }
            }
            other => {
                let text = plain(other).ok_or_else(|| not_a_value(source, line, key.get_ref()))?;
                settings.take(key.get_ref(), &text, source.at_line(line))?;
            }
        }
    }
    let mut header: Vec<String> = Vec::new();
    for (name, _) in records.iter().flat_map(|(_, fields)| fields) {
        if !header.contains(name) {
            header.push(name.clone());
        }
    }
    let field = |fields: &[(String, String)], name: &String| {
        fields.iter().find(|(key, _)| key == name).map_or_else(String::new, |(_, text)| text.clone())
    };
    // Rows of thousands of unknown columns are refused before they are laid out.
    let laid_out = if header.len() > 2 * known.len() { &[][..] } else { &records[..] };
    let rows = laid_out
        .iter()
        .map(|(line, fields)| (*line, header.iter().map(|name| field(fields, name)).collect()))
        .collect();
    let first = records.first().map_or(1, |(line, _)| *line);
    Rows::new(source, first, header, rows, known)
}

fn fields_of(source: &Source, lines: &LineEnds, table: &DeTable<'_>) -> Result<Vec<(String, String)>, ImportError> {
    table
        .iter()
        .map(|(key, value)| {
            let line = lines.line(key.span().start);
            let field = plain(value.get_ref()).ok_or_else(|| not_a_value(source, line, key.get_ref()))?;
            Ok((key.get_ref().to_string(), field))
        })
        .collect()
}

/// The text of a plain value.
fn plain(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Integer(number) => Some(number.as_str().to_owned()),
        DeValue::Float(number) => Some(number.as_str().to_owned()),
        DeValue::Boolean(truth) => Some(truth.to_string()),
        DeValue::Datetime(time) => Some(time.to_string()),
        DeValue::Array(_) | DeValue::Table(_) => None,
    }
}

fn not_a_value(source: &Source, line: u64, key: &str) -> ImportError {
    ImportError::Call(fault(
        source.at_line(line),
        format!("a list or table under {}", quoted(key)),
        "a text, a number, true or false, or `[[record]]` tables",
        "correct the key",
    ))
}

/// Where the lines of a text end.
struct LineEnds(Vec<usize>);

impl LineEnds {
    fn of(text: &str) -> Self {
        Self(text.match_indices('\n').map(|(at, _)| at).collect())
    }

    /// The number of the line that holds a byte.
    fn line(&self, offset: usize) -> u64 {
        self.0.partition_point(|end| *end < offset) as u64 + 1
    }
}
