//! From an input file to its records, whatever its format.

use super::error::{ImportError, fault};
use super::receipt::{LISTED, Notes};
use super::record::Record;
use super::source::Source;
use super::{Format, Options, bfc, cgats, columns, icc_xml, matrix, pr650, pr650_line, spdx, spectrawin};
use crate::dataset::Place;
use crate::quantity::{QuantityKind, luminous_efficacy};

/// A header with `value` and one of these is that of a table CSV.
const TABLE_COLUMNS: &[&str] = &["theta_i_deg", "theta_i", "emission_nm", "excitation_nm"];

/// What format a text is in, by its content.
pub(super) fn sniff(source: &Source) -> Format {
    if super::universal_brdf::is_one(&source.text.content) {
        return Format::UniversalBrdf;
    }
    if icc_xml::is_one(source) {
        return Format::IccXml;
    }
    if spdx::is_one(source) {
        return Format::Spdx;
    }
    if cgats::is_one(source) {
        return Format::Cgats;
    }
    if bfc::is_one(source) {
        return Format::Bfc;
    }
    let header = super::rows::header_line(source).map_or("", |(_, text)| text).to_ascii_lowercase();
    let columns: Vec<&str> = header.split([',', ';']).map(|name| name.trim().trim_matches('"').trim()).collect();
    let toml = source.name.to_ascii_lowercase().ends_with(".toml") || header.trim() == "[[record]]";
    if toml {
        Format::ManifestToml
    } else if columns.contains(&"file") && columns.contains(&"role") || columns.first() == Some(&"file") {
        Format::Manifest
    } else if columns.contains(&"value") && TABLE_COLUMNS.iter().any(|column| columns.contains(column)) {
        Format::TableCsv
    } else if matrix::is_one(source) {
        Format::Matrix
    } else if spectrawin::is_full(source) {
        Format::SpectraWin
    } else if source.text.lines().take(20).any(|line| pr650_line::starts_capture(line.text)) {
        Format::Pr650
    } else if spectrawin::is_spectral_only(source) {
        Format::SpectraWin
    } else {
        Format::Columns
    }
}

/// Reads the records of a file of spectra, fills what the options state, and writes the receipt.
///
/// # Errors
/// [`ImportError`] of the parser.
pub(super) fn read(source: &Source, options: &Options, notes: &mut Notes) -> Result<Vec<Record>, ImportError> {
    let format = options.format.filter(|format| format.is_spectra()).unwrap_or_else(|| sniff(source));
    refuse_unread(source, format)?;
    let mut dialect = None;
    let mut records = match format {
        Format::Pr650 => pr650::parse(source, options)?,
        Format::Spdx => vec![spdx::parse(source)?],
        Format::Cgats => cgats::parse(source, notes)?,
        Format::SpectraWin => {
            let (record, unread) = spectrawin::parse(source, options)?;
            note_unread(source, &unread, notes);
            vec![record]
        }
        _ => {
            let columns = columns::parse(source, options)?;
            note_unread(source, &columns.unread, notes);
            dialect = Some(format!("columns, {}", columns.dialect));
            columns.records
        }
    };
    let mut input = source.input.clone();
    let first = records.first().map_or("", |record| record.dialect);
    input.dialect = format!("{}, {}", dialect.as_deref().unwrap_or(first), source.text.encoding.name());
    input.records = records.len() as u64;
    notes.input(input);
    for record in &mut records {
        fill(record, options);
    }
    for record in &records {
        note_state(record, notes);
    }
    Ok(records)
}

/// Formats that are known and hold no spectra, so that nobody looks for a fault in the file.
fn refuse_unread(source: &Source, format: Format) -> Result<(), ImportError> {
    let starts = |text: &str| source.text.lines().take(20).any(|line| line.text.trim_start().starts_with(text));
    let refused = |found: &str, expected: &str, advice: &str| {
        Err(ImportError::Malformed(fault(source.at_line(1), found, expected, advice)))
    };
    if matches!(format, Format::Bfc | Format::IccXml | Format::UniversalBrdf) {
        return refused(&format!("a file of the format {format}"), "spectra", "import it on its own");
    }
    if starts("[HEADER]") && !spectrawin::is_full(source) {
        return refused(
            "a SpectraWin export without the section [SPECTRAL]",
            "a section with the spectrum",
            "export it again with the spectral data",
        );
    }
    Ok(())
}

fn note_unread(source: &Source, unread: &[(u64, String)], notes: &mut Notes) {
    if unread.is_empty() {
        return;
    }
    let lines: Vec<String> = unread.iter().map(|(line, text)| format!("line {line} `{text}`")).collect();
    let text = format!("{} lines of text were not understood: {}", lines.len(), super::receipt::listed(&lines));
    notes.notice(Place::file(source.name.as_str()), text);
}

/// The quantity that the caller states holds for texts that do not state one.
fn fill(record: &mut Record, options: &Options) {
    if record.kind == QuantityKind::Unstated && record.quality.is_none() {
        record.kind = options.settings.quantity.unwrap_or(QuantityKind::Unstated);
    }
    if record.details.model.is_none() {
        record.details.model.clone_from(&options.settings.instrument);
    }
}

fn note_state(record: &Record, notes: &mut Notes) {
    if let Some((_, why)) = &record.rejection {
        let text = format!("rejected, {why}; its values are missing");
        notes.notice(record.place(), text);
    } else if let Some(code) = record.quality.filter(|code| *code != 0 && *code != 14) {
        let text = format!("quality code {code}; the values are kept with a flag");
        notes.notice(record.place(), text);
    }
    for doubt in &record.doubts {
        notes.notice(record.place(), doubt.clone());
    }
    note_precision(record, notes);
    note_luminance(record, notes);
}

/// Fixed decimals lose small values: says how many.
fn note_precision(record: &Record, notes: &mut Notes) {
    let (Some(decimals), true) = (record.fixed_decimals, record.is_pr650_like()) else { return };
    let step = record.steps.first().copied().unwrap_or(0.0);
    // Half a step is more than one per cent of a value below fifty steps.
    let coarse = record.values.iter().filter(|value| value.abs() < 50.0 * step).count();
    if coarse == 0 || decimals == 0 {
        return;
    }
    let zeros = record.values.iter().filter(|value| **value == 0.0).count();
    let text = format!(
        "{}fixed {decimals} decimals: precision {step:e}; {coarse} of {} values may be off by more than 1 % ({zeros} \
         printed as zero, flagged below-detection); if the instrument's own text exists, import that",
        record.prefix(),
        record.values.len()
    );
    notes.notice(record.place(), text);
}

/// A reported luminance that is far from that of the spectrum, in either unit system.
fn note_luminance(record: &Record, notes: &mut Notes) {
    let Some((reported, line)) = record.luminance.filter(|_| record.rejection.is_none()) else { return };
    if record.kind == QuantityKind::SpectralIrradiance || record.nm.len() < 10 {
        return;
    }
    let computed = luminance(record);
    if !(computed > 0.0 && reported > 0.0) {
        return;
    }
    let agrees = |unit: f64| (reported * unit / computed - 1.0).abs() <= LUMINANCE_TOLERANCE;
    if agrees(1.0) || agrees(CD_PER_FOOTLAMBERT) {
        return;
    }
    let ratio = computed / reported;
    let per_band = if (3.5..5.5).contains(&ratio) { "; the values may be per band and not per nm" } else { "" };
    let text = format!(
        "{}the reported luminance {reported} is not that of the spectrum ({computed:.4} cd m-2, or {:.4} fL): ratio \
         {ratio:.3}{per_band}",
        record.prefix(),
        computed / CD_PER_FOOTLAMBERT
    );
    notes.notice(Place::file(record.file.as_str()).at_line(line), text);
}

/// cd m-2 in one footlambert: 1/pi cd per square foot.
const CD_PER_FOOTLAMBERT: f64 = 3.426_259_1;

/// The instrument's own weighting departs by a few per cent in blue light; units are off by 4 or more.
const LUMINANCE_TOLERANCE: f64 = 0.05;

/// Luminance of a radiance spectrum, cd m-2.
fn luminance(record: &Record) -> f64 {
    let step = record.nm[1] - record.nm[0];
    step * record.nm.iter().zip(&record.values).map(|(nm, value)| luminous_efficacy(*nm) * value).sum::<f64>()
}

/// The same notice at several places, joined when there are many of them.
pub(super) fn note_each(notes: &mut Notes, places: Vec<Place>, text: &str) {
    if places.len() <= LISTED {
        for place in places {
            notes.notice(place, text);
        }
        return;
    }
    let names: Vec<String> = places.iter().map(ToString::to_string).collect();
    notes.notice(Place::default(), format!("{text} ({} records): {}", names.len(), super::receipt::listed(&names)));
}
