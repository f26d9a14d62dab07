//! CGATS.17 texts (`.txt`, `.ti3`, `.sp`) with spectra: named fields, then a row for each sample.
//!
//! ```text
//! CGATS.17
//! INSTRUMENTATION "i1Pro"
//! NUMBER_OF_FIELDS 4
//! BEGIN_DATA_FORMAT
//! SAMPLE_ID SAMPLE_NAME SPECTRAL_NM380 SPECTRAL_NM390
//! END_DATA_FORMAT
//! NUMBER_OF_SETS 1
//! BEGIN_DATA
//! 1 A1 0.11 0.12
//! END_DATA
//! ```
//!
//! Spectral fields are `SPECTRAL_NM380`, `SPECTRAL_380`, `SPEC_380`, `nm380` and `380_NM`. Each sample is a record of its
//! own, named by `SAMPLE_NAME` or `SAMPLE_ID`. Counts are checked. A file may hold several tables; its numbers may have
//! decimal commas. Whether they are per cent or parts of one the format does not say: nothing is scaled, and the
//! quantity is `unstated`.

mod words;

use std::collections::{BTreeMap, BTreeSet};

use super::error::{ImportError, fault, quoted};
use super::number::{DecimalMark, printed};
use super::receipt::{Notes, listed};
use super::record::{Details, Record};
use super::source::Source;
use super::text::Line;
use words::{spectral_text, tokens, wavelength};

/// Fields that name a sample, the most telling first.
const NAMES: [&str; 4] = ["SAMPLE_NAME", "SAMPLE_ID", "SAMPLEID", "SAMPLE_LOC"];

/// True for a text that begins as the standard says, or has its section of field names near its beginning.
pub(super) fn is_one(source: &Source) -> bool {
    let mut lines = source.text.lines();
    lines.clone().next().is_some_and(|line| line.text.trim_start().starts_with("CGATS"))
        || lines.by_ref().take(2000).any(|line| line.text.trim() == "BEGIN_DATA_FORMAT")
}

/// Reads every sample that has a spectrum.
///
/// # Errors
/// [`ImportError`] with the line for counts that do not fit, sections that do not end, and values that are none.
pub(super) fn parse(source: &Source, notes: &mut Notes) -> Result<Vec<Record>, ImportError> {
    let mut reader = Reader {
        source,
        table: Table::default(),
        details: Details::default(),
        records: Vec::new(),
        left: BTreeSet::new(),
    };
    let mut lines = source.text.lines();
    while let Some(line) = lines.next() {
        let text = line.text.trim();
        match text {
            "BEGIN_DATA_FORMAT" => reader.format(line, &mut lines)?,
            "BEGIN_DATA" => reader.data(line, &mut lines)?,
            _ => reader.keyword(line)?,
        }
    }
    if reader.records.is_empty() {
        return Err(ImportError::Malformed(fault(
            source.at_line(1),
            "no spectra",
            "fields such as SPECTRAL_NM380, SPECTRAL_380, SPEC_380 or nm380, and samples that have them",
            "export the file with spectral data; colour coordinates alone are not read",
        )));
    }
    if !reader.left.is_empty() {
        let left: Vec<String> = reader.left.into_iter().collect();
        notes.notice(source.at_line(1), format!("without a place in the document: {}", listed(&left)));
    }
    name(&mut reader.records);
    Ok(reader.records)
}

/// Names that come again get their number in the file, so that each sample is a measurement of its own.
fn name(records: &mut [Record]) {
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    for title in records.iter().filter_map(|record| record.title.clone()) {
        *counts.entry(title).or_insert(0) += 1;
    }
    for record in records {
        let title = record.title.take().unwrap_or_else(|| "sample".to_owned());
        let alone = counts.get(&title) == Some(&1);
        record.title = Some(if alone { title } else { format!("{title} (set {})", record.number) });
    }
}

/// What is known of the table that is being read.
#[derive(Default)]
struct Table {
    fields: Vec<String>,
    /// Positions of the spectral fields with their wavelengths, ascending.
    spectral: Vec<(usize, f64)>,
    name: Option<usize>,
    stated_fields: Option<(usize, u64)>,
    stated_sets: Option<(usize, u64)>,
}

struct Reader<'a> {
    source: &'a Source,
    table: Table,
    details: Details,
    records: Vec<Record>,
    /// What has no place: keywords with values, and fields.
    left: BTreeSet<String>,
}

impl<'a> Reader<'a> {
    fn malformed(&self, line: u64, found: String, expected: &str, advice: &str) -> ImportError {
        ImportError::Malformed(fault(self.source.at_line(line), found, expected, advice))
    }

    fn keyword(&mut self, line: Line<'_>) -> Result<(), ImportError> {
        let text = line.text.split('#').next().unwrap_or("").trim();
        let (key, rest) = text.split_once([' ', '\t']).unwrap_or((text, ""));
        let rest = rest.trim().trim_matches('"').trim();
        let count = |reader: &Self| {
            let bad = || reader.malformed(line.number, quoted(text), "a whole number", "correct the count");
            rest.parse().map(|count: usize| Some((count, line.number))).map_err(|_| bad())
        };
        match key {
            "" | "KEYWORD" | "END_DATA" | "END_DATA_FORMAT" => {}
            "NUMBER_OF_FIELDS" => self.table.stated_fields = count(self)?,
            "NUMBER_OF_SETS" => self.table.stated_sets = count(self)?,
            "INSTRUMENTATION" | "TARGET_INSTRUMENT" if !rest.is_empty() => self.details.model = Some(rest.to_owned()),
            _ if rest.is_empty() => {}
            _ => {
                // A row outside its section is a lost `BEGIN_DATA`, and no keyword.
                if printed(key, DecimalMark::Point).is_some() {
                    let advice = "put BEGIN_DATA before the rows, and END_DATA behind them";
                    return Err(self.malformed(line.number, quoted(text), "a keyword outside the sections", advice));
                }
                self.left.insert(format!("{key} {}", quoted(rest)));
            }
        }
        Ok(())
    }

    fn format(&mut self, begin: Line<'_>, lines: &mut impl Iterator<Item = Line<'a>>) -> Result<(), ImportError> {
        let mut fields: Vec<String> = Vec::new();
        loop {
            let Some(line) = lines.next() else {
                let found = "the end of the file".to_owned();
                return Err(self.malformed(begin.number, found, "END_DATA_FORMAT", "the file is cut; export it again"));
            };
            if line.text.trim() == "END_DATA_FORMAT" {
                break;
            }
            fields.extend(tokens(line.text).map(str::to_owned));
        }
        let mut spectral: Vec<(usize, f64)> =
            fields.iter().enumerate().filter_map(|(at, field)| Some((at, wavelength(field)?))).collect();
        spectral.sort_by(|a, b| a.1.total_cmp(&b.1));
        if let Some(pair) = spectral.windows(2).find(|pair| pair[0].1 == pair[1].1) {
            let found = format!("{} and {}", quoted(&fields[pair[0].0]), quoted(&fields[pair[1].0]));
            return Err(self.malformed(begin.number, found, "one field for a wavelength", "take one of them out"));
        }
        if spectral.is_empty() && fields.iter().any(|field| field.eq_ignore_ascii_case("SPECTRAL_NM")) {
            let found = "pairs of SPECTRAL_NM and a value".to_owned();
            return Err(self.malformed(begin.number, found, "a field for each wavelength", "export it in that form"));
        }
        let upper: Vec<String> = fields.iter().map(|field| field.to_ascii_uppercase()).collect();
        let name = NAMES.iter().find_map(|name| upper.iter().position(|field| field == name));
        let known: BTreeSet<usize> = spectral.iter().map(|(at, _)| *at).collect();
        let other = |at: &usize| !known.is_empty() && !known.contains(at) && !NAMES.contains(&upper[*at].as_str());
        let others: Vec<String> =
            (0..fields.len()).filter(other).map(|at| format!("the field {}", quoted(&fields[at]))).collect();
        self.left.extend(others);
        self.table.fields = fields;
        self.table.spectral = spectral;
        self.table.name = name;
        Ok(())
    }

    fn data(&mut self, begin: Line<'_>, lines: &mut impl Iterator<Item = Line<'a>>) -> Result<(), ImportError> {
        if self.table.fields.is_empty() {
            let advice = "put the names of the fields between BEGIN_DATA_FORMAT and END_DATA_FORMAT";
            return Err(self.malformed(
                begin.number,
                "BEGIN_DATA without fields".to_owned(),
                "the names of the fields",
                advice,
            ));
        }
        let stated = self.table.stated_fields.take();
        self.check_count(stated, self.table.fields.len(), "NUMBER_OF_FIELDS", "fields")?;
        let mut rows = Vec::new();
        loop {
            let Some(line) = lines.next() else {
                let found = format!("the end of the file after {} sets", rows.len());
                return Err(self.malformed(begin.number, found, "END_DATA", "the file is cut; export it again"));
            };
            match line.text.trim() {
                "END_DATA" => break,
                text if text.starts_with('#') => {}
                _ => rows.push(line),
            }
        }
        let stated = self.table.stated_sets.take();
        self.check_count(stated, rows.len(), "NUMBER_OF_SETS", "sets")?;
        if self.table.spectral.is_empty() {
            self.left.insert(format!("a table of {} sets without spectral fields", rows.len()));
            return Ok(());
        }
        let numbers = |c: char| rows.iter().any(|line| spectral_text(line.text).any(|token| token.contains(c)));
        let mark = if numbers(',') && !numbers('.') { DecimalMark::Comma } else { DecimalMark::Point };
        for line in rows {
            self.row(line, mark)?;
        }
        Ok(())
    }

    fn check_count(
        &self,
        stated: Option<(usize, u64)>,
        found: usize,
        key: &str,
        what: &str,
    ) -> Result<(), ImportError> {
        let Some((stated, line)) = stated.filter(|(stated, _)| *stated != found) else { return Ok(()) };
        Err(ImportError::Contradiction(fault(
            self.source.at_line(line),
            format!("{key} {stated} over {found} {what}"),
            "as many as there are",
            "rows or fields were lost or added; export the file again",
        )))
    }

    fn row(&mut self, line: Line<'_>, mark: DecimalMark) -> Result<(), ImportError> {
        let expected = self.table.fields.len();
        let mut fields: Vec<&str> = tokens(line.text).collect();
        // Names with blanks in them stand between tabs.
        if fields.len() != expected && line.text.contains('\t') {
            fields = line.text.trim_end().split('\t').map(|field| field.trim().trim_matches('"')).collect();
        }
        if fields.len() != expected {
            let found = format!("{} values in a set", fields.len());
            let advice = "the line is cut, or a name with blanks is not quoted";
            return Err(self.malformed(line.number, found, &format!("{expected}, one for each field"), advice));
        }
        let number = self.records.len() as u64 + 1;
        let mut record = Record::new(&self.source.name, number, line.number, "cgats");
        record.details = self.details.clone();
        record.title = self.table.name.and_then(|at| fields.get(at)).map(|name| (*name).to_owned());
        record.title = record.title.filter(|title| !title.is_empty());
        for (at, nm) in &self.table.spectral {
            let value = printed(fields[*at], mark).ok_or_else(|| {
                let form = if mark == DecimalMark::Comma { "a decimal comma" } else { "a decimal point" };
                let found = format!("{} at {nm} nm", quoted(fields[*at]));
                self.malformed(line.number, found, &format!("a finite number with {form}"), "correct the value")
            })?;
            record.push(*nm, value);
        }
        let highest = record.values.iter().copied().fold(0.0, f64::max);
        if highest > 2.0 && number == 1 {
            let text = format!("the highest value of the first set is {highest}: is it per cent? Nothing is scaled");
            record.doubts.push(text);
        }
        self.records.push(record);
        Ok(())
    }
}
