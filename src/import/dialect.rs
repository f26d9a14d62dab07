//! How a table of numbers is written: what stands between its columns, and its decimal mark.

use std::fmt;
use std::str::FromStr;

use super::error::{ImportError, fault, quoted};
use super::number::DecimalMark;
use super::source::Source;
use super::text::Line;
use crate::quantity::UnknownName;

/// What stands between two columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Delimiter {
    /// Any run of blanks.
    Space,
    /// One tab.
    Tab,
    /// `,`
    Comma,
    /// `;`
    Semicolon,
}

/// The dialect of a table of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    pub(crate) delimiter: Delimiter,
    pub(crate) mark: DecimalMark,
}

const NAMES: &[(&str, Dialect)] = &[
    ("space", Dialect { delimiter: Delimiter::Space, mark: DecimalMark::Point }),
    ("tab", Dialect { delimiter: Delimiter::Tab, mark: DecimalMark::Point }),
    ("comma", Dialect { delimiter: Delimiter::Comma, mark: DecimalMark::Point }),
    ("semicolon", Dialect { delimiter: Delimiter::Semicolon, mark: DecimalMark::Point }),
    ("space-decimal-comma", Dialect { delimiter: Delimiter::Space, mark: DecimalMark::Comma }),
    ("tab-decimal-comma", Dialect { delimiter: Delimiter::Tab, mark: DecimalMark::Comma }),
    ("semicolon-decimal-comma", Dialect { delimiter: Delimiter::Semicolon, mark: DecimalMark::Comma }),
];

impl Dialect {
    /// The name in options and receipts.
    #[must_use]
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(_, dialect)| *dialect == self).map_or("comma", |(name, _)| name)
    }

    /// The fields of a line, without blanks around them.
    pub(crate) fn fields(self, text: &str) -> Vec<&str> {
        let text = text.trim();
        match self.delimiter {
            Delimiter::Space => text.split_whitespace().collect(),
            Delimiter::Tab => text.split('\t').map(str::trim).collect(),
            Delimiter::Comma => trailing_off(text, ',').split(',').map(str::trim).collect(),
            Delimiter::Semicolon => trailing_off(text, ';').split(';').map(str::trim).collect(),
        }
    }

    /// Finds the dialect of the lines of numbers of a text.
    ///
    /// # Errors
    /// [`ImportError::Ambiguous`] where the text can be read in two ways, [`ImportError::Malformed`] where it mixes
    /// decimal marks or holds no numbers.
    pub(crate) fn find(source: &Source) -> Result<Self, ImportError> {
        let rows = || source.text.lines().filter(|line| is_row(line.text));
        let Some(first) = rows().next() else {
            return Err(ImportError::Malformed(fault(
                source.at_line(1),
                "no line that starts with a number",
                "rows of a wavelength and values",
                "say `--format` if it is another format",
            )));
        };
        let any = |c: char| rows().any(|line| line.text.contains(c));
        let named = |name: &str| name.parse::<Self>().map_err(|_| ambiguous(source, first, "the dialect is unknown"));
        if any(';') {
            refuse_mixed_marks(source, rows())?;
            return named(if any(',') { "semicolon-decimal-comma" } else { "semicolon" });
        }
        if any('\t') {
            return if any(',') { Err(ambiguous(source, first, "a tab and a comma")) } else { named("tab") };
        }
        if !any(',') {
            return named("space");
        }
        let inner_blank = |line: Line<'_>| line.text.split(',').any(|field| field.split_whitespace().count() > 1);
        if let Some(line) = rows().find(|line| inner_blank(*line)) {
            return Err(ambiguous(source, line, "a blank and a comma between digits"));
        }
        // Without a single point, `380,0,000028` is 380 and 0.000028, or three whole numbers.
        if !any('.') && rows().any(|line| line.text.split(',').count() > 2) {
            return Err(ambiguous(source, first, "commas that may be decimal marks or delimiters"));
        }
        named("comma")
    }
}

fn trailing_off(text: &str, delimiter: char) -> &str {
    text.strip_suffix(delimiter).unwrap_or(text)
}

/// True where a line starts like a number.
pub(crate) fn is_row(text: &str) -> bool {
    text.trim_start().starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'))
}

fn ambiguous(source: &Source, line: Line<'_>, found: &str) -> ImportError {
    ImportError::Ambiguous(fault(
        source.at_line(line.number),
        format!("an ambiguous delimiter ({found}) in {}", quoted(line.text.trim())),
        "columns divided by blanks, tabs or commas with decimal points, or by semicolons",
        format!("set `--dialect` to one of {}", names()),
    ))
}

fn refuse_mixed_marks<'a>(source: &Source, rows: impl Iterator<Item = Line<'a>>) -> Result<(), ImportError> {
    let mut seen: Option<char> = None;
    for line in rows {
        for mark in line.text.chars().filter(|c| matches!(c, '.' | ',')) {
            let before = *seen.get_or_insert(mark);
            if before != mark {
                return Err(ImportError::Malformed(fault(
                    source.at_line(line.number),
                    format!("mixed decimal marks: this line uses '{mark}' after '{before}'"),
                    "one decimal mark in the whole file",
                    "export it again with one decimal mark",
                )));
            }
        }
    }
    Ok(())
}

fn names() -> String {
    NAMES.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Dialect {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        NAMES.iter().find(|(name, _)| *name == text).map(|(_, dialect)| *dialect).ok_or_else(|| UnknownName {
            what: "dialect",
            found: text.to_owned(),
            expected: names(),
        })
    }
}
