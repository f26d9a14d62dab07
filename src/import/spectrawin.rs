//! SpectraWin 2 exports, full and spectral-only.
//!
//! ```text
//! [HEADER]                 Title: ..  Description: ..  Model Num.: ..  Radiometric Mode: Radiance  ...
//! [END OF SECTION]
//! [SPECTRAL]               start, end, step, then the values, one per line
//! [END OF SECTION]
//! [CALCULATED]             Luminance(cd/m2): ..
//! ```
//!
//! The spectral-only form is a title line, then start, end, step and the values; columns after the first are passed
//! over. Wavelengths are implied, so a lost value would shift the rest: the count must be that of the stated range.

use super::Options;
use super::error::{ImportError, fault, quoted};
use super::number::{DecimalMark, Printed, printed, value};
use super::particulars::{self, Particular};
use super::record::Record;
use super::source::Source;
use super::text::Line;
use crate::quantity::QuantityKind;

/// Lines that were not understood, with their numbers.
pub(super) type Unread = Vec<(u64, String)>;

/// True where a text has the sections of a full export.
pub(super) fn is_full(source: &Source) -> bool {
    source.text.lines().take(200).any(|line| is_section(line.text, "SPECTRAL"))
}

/// True where a text is a title, then start, end and step, then single numbers.
pub(super) fn is_spectral_only(source: &Source) -> bool {
    let numbers: Vec<Option<f64>> = source.text.lines().skip(1).take(5).map(|line| first_number(line.text)).collect();
    let single = source.text.lines().skip(1).take(5).all(|line| line.text.split_whitespace().count() == 1);
    matches!(numbers.as_slice(), [Some(start), Some(end), Some(step), Some(_), ..]
        if *start >= 100.0 && end > start && *step > 0.0 && *step < end - start && single)
}

fn first_number(text: &str) -> Option<f64> {
    value(text.split(',').next().unwrap_or(text))
}

fn is_section(text: &str, name: &str) -> bool {
    text.trim().trim_matches(['[', ']']).eq_ignore_ascii_case(name) && text.trim().starts_with('[')
}

/// Reads the one spectrum of an export.
///
/// # Errors
/// [`ImportError`] with the line for values that are none and for a count that does not fit the stated range.
pub(super) fn parse(source: &Source, options: &Options) -> Result<(Record, Unread), ImportError> {
    let mut record = Record::new(&source.name, 1, 1, "spectrawin");
    let mut unread = Vec::new();
    let spectral: Vec<Line<'_>> =
        if is_full(source) { sections(source, &mut record, &mut unread) } else { plain(source, &mut record) };
    let [start, end, step] = range(source, &spectral)?;
    for line in &spectral[3..] {
        let field = line.text.split(',').next().unwrap_or(line.text).trim();
        let index = record.nm.len();
        let nm = start.value + step.value * index as f64;
        let model = options.settings.instrument.as_ref().or(record.details.model.as_ref());
        let negative_ok = !model.is_some_and(|model| model.contains("PR-6"));
        match printed(field, DecimalMark::Point) {
            Some(number) if number.value >= 0.0 || negative_ok => record.push(nm, number),
            _ => {
                return Err(ImportError::Malformed(fault(
                    source.at_line(line.number),
                    format!("the bad value at {nm} nm: {}", quoted(field)),
                    "a finite number that the instrument can print",
                    "export it again",
                )));
            }
        }
    }
    check_count(source, &record, [start.value, end.value, step.value])?;
    Ok((record, unread))
}

fn sections<'a>(source: &'a Source, record: &mut Record, unread: &mut Unread) -> Vec<Line<'a>> {
    let mut spectral = Vec::new();
    let mut section = String::new();
    for line in source.text.lines() {
        let text = line.text.trim();
        if text.starts_with('[') && text.ends_with(']') {
            section = text.trim_matches(['[', ']']).to_ascii_uppercase();
            if section == "SPECTRAL" {
                record.line = line.number;
            }
        } else if section == "SPECTRAL" {
            spectral.push(line);
        } else {
            particular(record, unread, text, line.number);
        }
    }
    spectral
}

fn particular(record: &mut Record, unread: &mut Unread, text: &str, line: u64) {
    if let Some(title) = text.strip_prefix("Title:") {
        record.title = Some(title.trim().to_owned()).filter(|title| !title.is_empty());
    } else if let Some(mode) = text.strip_prefix("Radiometric Mode:") {
        record.kind = match mode.trim().to_ascii_lowercase().as_str() {
            "radiance" => QuantityKind::SpectralRadiance,
            "irradiance" => QuantityKind::SpectralIrradiance,
            _ => QuantityKind::Unstated,
        };
    } else {
        match particulars::read(text) {
            Some(Particular::Luminance(luminance)) => record.luminance = Some((luminance, line)),
            Some(particular) => particular.apply(&mut record.details),
            None => unread.push((line, text.chars().take(80).collect())),
        }
    }
}

fn plain<'a>(source: &'a Source, record: &mut Record) -> Vec<Line<'a>> {
    let mut lines = source.text.lines();
    record.dialect = "spectrawin-spectral-only";
    record.title = lines.next().map(|line| line.text.trim().trim_end_matches(',').to_owned());
    lines.collect()
}

fn range(source: &Source, lines: &[Line<'_>]) -> Result<[Printed; 3], ImportError> {
    let number = |index: usize| {
        let text = lines.get(index).map_or("", |line| line.text);
        printed(text.split(',').next().unwrap_or(text), DecimalMark::Point).filter(|number| number.value > 0.0)
    };
    match (number(0), number(1), number(2)) {
        (Some(start), Some(end), Some(step)) if end.value > start.value => Ok([start, end, step]),
        _ => Err(ImportError::Malformed(fault(
            source.at_line(lines.first().map_or(1, |line| line.number)),
            "no range of wavelengths",
            "start, end and step in nm, one per line, before the values",
            "export it again from SpectraWin",
        ))),
    }
}

fn check_count(source: &Source, record: &Record, [start, end, step]: [f64; 3]) -> Result<(), ImportError> {
    let expected = ((end - start) / step).round() + 1.0;
    if record.nm.len() as f64 == expected {
        return Ok(());
    }
    let last = record.nm.last().map_or_else(|| "nowhere".to_owned(), |nm| format!("at {nm} nm"));
    Err(ImportError::Contradiction(fault(
        source.at_line(record.line),
        format!("{} values, which end {last}", record.nm.len()),
        format!("{expected} values: the header says {start} to {end} nm by {step}"),
        "a value or a wrong range: wavelengths are implied, so nothing can be placed; export it again",
    )))
}
