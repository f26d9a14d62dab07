//! The certified factor of the white reference: one number, or a two-column file.

use std::path::Path;

use super::error::{ImportError, fault, quoted};
use super::manifest::beside;
use super::number::value;
use super::plan::Plan;
use super::receipt::Notes;
use super::record::Record;
use super::source::Source;
use super::{Options, columns};
use crate::dataset::{Id, Measurement, Place, WhiteReference};
use crate::quantity::Finite;

/// The reference with its factor on the emission axis.
#[derive(Debug)]
pub(super) struct Certificate {
    /// The white reference of the document.
    pub(super) reference: WhiteReference,
    /// None, one number, or one per emission wavelength.
    pub(super) factor: Vec<f64>,
}

impl Certificate {
    /// The factor at an emission index; 1 where there is no certificate.
    pub(super) fn at(&self, column: usize) -> f64 {
        self.factor.get(column).or(self.factor.last()).copied().unwrap_or(1.0)
    }
}

/// Largest certified factor that is taken.
const HIGHEST_FACTOR: f64 = 1.1;

/// Reads the certificate that the settings state.
///
/// # Errors
/// [`ImportError`] where the text is neither a positive number nor a readable file, or the file's range is too short.
pub(super) fn read(plan: &Plan, sample: &Measurement, notes: &mut Notes) -> Result<Certificate, ImportError> {
    let settings = &plan.settings;
    let mut reference = WhiteReference {
        id: Id::from_title("white-reference"),
        certificate: settings.certificate.clone(),
        certified_relative_uncertainty: settings.certified_relative_uncertainty.and_then(|u| Finite::try_from(u).ok()),
        ..WhiteReference::default()
    };
    let Some(text) = &settings.certified_factor else {
        let text = "no certified factor is stated: the factor is relative to the real white reference as if it were \
                    the perfect diffuser";
        notes.assume(plan.place.clone(), text);
        notes.unfilled("white_references/white-reference/certified_factor");
        return Ok(Certificate { reference, factor: Vec::new() });
    };
    if settings.certified_relative_uncertainty.is_none() {
        notes.unfilled("white_references/white-reference/certified_relative_uncertainty");
    }
    if let Some(number) = value(text) {
        // No diffuser reflects more than all; the best reach 1.02 in some geometries. 99 is a percentage.
        if !(number > 0.0 && number <= HIGHEST_FACTOR) {
            return Err(refused(&stated_at(plan), text));
        }
        reference.certified_factor = vec![number];
        return Ok(Certificate { reference, factor: vec![number] });
    }
    let record = read_file(plan, text, notes)?;
    let axis = sample.emission.wavelengths().unwrap_or(&[]);
    let factor = axis.iter().map(|nm| interpolate(&record, *nm)).collect::<Option<Vec<f64>>>().ok_or_else(|| {
        ImportError::Contradiction(fault(
            Place::file(record.file.as_str()),
            "a certificate that does not cover the emission axis",
            format!(
                "wavelengths from {} to {} nm",
                axis.first().copied().unwrap_or(f64::NAN),
                axis.last().copied().unwrap_or(f64::NAN)
            ),
            "state a certificate over the whole range",
        ))
    })?;
    if record.nm != axis {
        let text = "the certified factor is interpolated linearly onto the emission axis";
        notes.assume(record.place(), text);
    }
    reference.certified_nm = record.nm;
    reference.certified_factor = record.values;
    Ok(Certificate { reference, factor })
}

fn refused(place: &Place, text: &str) -> ImportError {
    ImportError::Call(fault(
        place.clone(),
        format!("{} as the certified factor", quoted(text)),
        "a factor of about 1 (more than 0, at most 1.1), or the name of a file of two columns (nm, factor)",
        "correct it; divide a percentage by 100",
    ))
}

/// Where the factor is stated.
fn stated_at(plan: &Plan) -> Place {
    plan.settings.place_of("certified-factor", plan.place.clone())
}

/// A file's name is relative to the manifest, or to where the command runs.
fn read_file(plan: &Plan, name: &str, notes: &mut Notes) -> Result<Record, ImportError> {
    let folder = plan.place.file.as_deref().map(Path::new).and_then(Path::parent);
    let path = folder
        .map(|folder| beside(folder, name))
        .filter(|path| path.is_file())
        .unwrap_or_else(|| Path::new(name).to_path_buf());
    if !path.is_file() {
        return Err(refused(&stated_at(plan), name));
    }
    let source = Source::read(&path, &path.display().to_string())?;
    let options = Options { allow_partial_grid: true, ..Options::default() };
    let record = columns::parse(&source, &options)?.records.into_iter().next();
    let record = record.filter(|record| record.values.iter().all(|value| *value > 0.0 && *value <= HIGHEST_FACTOR));
    let mut input = source.input.clone();
    input.dialect = "certificate, columns".to_owned();
    input.records = 1;
    notes.input(input);
    record.ok_or_else(|| {
        ImportError::Malformed(fault(
            source.at_line(1),
            "no certified factor",
            "two columns: nm and a factor greater than zero",
            "correct the certificate",
        ))
    })
}

fn interpolate(record: &Record, nm: f64) -> Option<f64> {
    let above = record.nm.partition_point(|known| *known < nm);
    let (upper_nm, upper) = (*record.nm.get(above)?, *record.values.get(above)?);
    if upper_nm == nm {
        return Some(upper);
    }
    let below = above.checked_sub(1)?;
    let (lower_nm, lower) = (record.nm[below], record.values[below]);
    Some(lower + (upper - lower) * (nm - lower_nm) / (upper_nm - lower_nm))
}
