//! Universal BRDF JSON, version 1.0: the format of the projects BxDiff and BiRD for measured and simulated BRDFs.
//!
//! # What is read
//!
//! `data` holds columns of one length: `theta_i`, `phi_i`, `theta_r`, `phi_r` (deg or rad), `BRDF` (1/sr), and where the
//! file has them `uBRDF` (1/sr or %), `wavelength_i`, `wavelength_r` (nm or μm), `polarization_i`, `polarization_r`.
//!
//! - Points of one geometry, wavelength of illumination and polarisation of it are an acquisition; wavelengths of
//!   detection are its columns; the k-th repeat of a point goes into the k-th such acquisition. A cell that the file does
//!   not have is `not-measured`.
//! - Where both wavelengths are equal at every point, the quantity is `elastic` and the columns alone hold the wavelength.
//! - Each polarisation of the detection is a measurement of its own.
//! - `null` in `BRDF` or `uBRDF` is a missing number; anywhere else it is an error. Values below 0 are kept.
//!
//! What the format does not say is assumed in the receipt: the sense of azimuths, that incidence points to the source,
//! and that uncertainties are standard uncertainties.
//!
//! What our document has no place for is kept as JSON, as it stood, in the extension [`DOMAIN`].

mod columns;
mod file;
mod json;
mod metadata;
mod ours;
mod quantities;
mod table;

use std::collections::BTreeMap;

use super::error::{ImportError, fault};
use super::keys::Settings;
use super::manifest::note_overridden;
use super::receipt::Notes;
use super::source::Source;
use super::{Options, parts, scan};
use crate::dataset::tree::{Array, Dataset, Group};
use crate::dataset::{Document, Excitation, Extension, Id, Measurement, Place};
use crate::quantity::{Basis, EmissionAxis, NormalisedAt, Part, Quantity, QuantityKind, Reference, ReferenceLight};
use columns::Columns;
use file::File;
use json::Json;
use metadata::Particulars;
use ours::Ours;
use table::Common;

/// The extension that keeps what has no place in the document: datasets `metadata` and `data` with JSON.
pub const DOMAIN: &str = "io.github.bird-project";

/// True for a text that looks like one: an object that speaks of a BRDF, or has its two members.
pub(super) fn is_one(text: &str) -> bool {
    let has = |name: &str| text.contains(name);
    text.trim_start().starts_with('{') && (has("\"BRDF\"") || has("\"metadata\"") && has("\"data\""))
}

/// Reads a file as a document.
///
/// # Errors
/// [`ImportError`] with the path in the file, what was found, what was expected and what to do.
pub(super) fn document(source: &Source, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    refuse_settings(&options.settings)?;
    let mut file = File::parse(source)?;
    let columns = Columns::take(&mut file, notes)?;
    let mut input = source.input.clone();
    input.dialect = metadata::identity(&mut file, notes)?;
    input.records = columns.len() as u64;
    notes.input(input);
    let ours = Ours::take(&mut file, notes);
    let stated = metadata::settings(&mut file);
    note_overridden(source, &options.settings, &stated, notes);
    let settings = options.settings.clone().or(&stated);
    let particulars = Particulars::take(&mut file);
    let mut document = parts::document(&settings);
    document.measurements = measurements(&file, &columns, &settings, &ours)?;
    ours.apply(&mut document);
    note_parts(&mut document, &settings, notes);
    if let Some(measurement) = document.measurements.first() {
        metadata::assume(&file, measurement, notes);
        parts::list_unfilled(measurement, notes);
        let geometries: Vec<_> = measurement.acquisitions.iter().filter_map(|row| row.geometry).collect();
        scan::note_coverage(&geometries, file.at("data"), notes);
    }
    particulars.attach(&mut document);
    document.extensions.extend(extension(&file, notes));
    Ok(document)
}

/// What the format itself says cannot be stated otherwise.
fn refuse_settings(settings: &Settings) -> Result<(), ImportError> {
    let stated = [
        ("quantity", settings.quantity.is_some_and(|kind| kind != QuantityKind::Brdf)),
        ("certified-factor", settings.certified_factor.is_some()),
        ("certified-relative-uncertainty", settings.certified_relative_uncertainty.is_some()),
        ("certificate", settings.certificate.is_some()),
        ("angles", settings.angles.is_some()),
        ("time-zone", settings.time_zone.is_some()),
    ];
    let Some((key, _)) = stated.into_iter().find(|(_, stated)| *stated) else { return Ok(()) };
    Err(ImportError::Call(fault(
        Place::file("the call"),
        format!("`{key}` with a Universal BRDF file"),
        "what the format does not say itself",
        "leave it out",
    )))
}

fn measurements(
    file: &File,
    columns: &Columns,
    settings: &Settings,
    ours: &Ours,
) -> Result<Vec<Measurement>, ImportError> {
    let id = settings.id.as_deref().map(Id::from_title).or_else(|| ours.id()).unwrap_or_else(|| Id::from_title("scan"));
    let common = |id: Id| Common {
        id,
        quantity: quantity(columns, settings, ours.quantity()),
        bandpass: parts::bandpass(settings, None),
        band: EmissionAxis::Band { band: settings.band.or(ours.band()) },
        excitation: Excitation {
            light: settings.light.as_deref().map(Id::from_title),
            wavelength_nm: settings.excitation_nm.filter(|_| columns.excitation_nm.is_none()),
            fwhm_nm: settings.excitation_fwhm_nm,
            filter: settings.filter.clone(),
            ..Excitation::default()
        },
    };
    let Some(states) = &columns.polarisation_r else {
        let all: Vec<usize> = (0..columns.len()).collect();
        return Ok(vec![table::measurement(file, columns, &all, &common(id))?]);
    };
    let mut points: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    states.iter().enumerate().for_each(|(point, state)| points.entry(state).or_default().push(point));
    let several = points.len() > 1;
    let measurement = |(number, (state, points)): (usize, (&str, Vec<usize>))| {
        let own = if several { Id::from_title(&format!("{id}-{}", number + 1)) } else { id.clone() };
        let mut measurement = table::measurement(file, columns, &points, &common(own))?;
        measurement.conditions.viewing_polarisation = Some(state.to_owned());
        Ok(measurement)
    };
    points.into_iter().enumerate().map(measurement).collect()
}

/// What the caller states, then what our own export states, then what follows from the columns. A BRDF is a ratio of
/// radiance to irradiance: it has no reference diffuser.
fn quantity(columns: &Columns, settings: &Settings, ours: Option<Quantity>) -> Quantity {
    let reflected = Quantity { part: Part::Elastic, normalised_at: NormalisedAt::Emission, ..brdf() };
    let base = ours.unwrap_or_else(|| if columns.is_elastic { reflected } else { brdf() });
    Quantity {
        part: settings.part.unwrap_or(base.part),
        normalised_at: settings.normalised_at.unwrap_or(base.normalised_at),
        basis: settings.basis.unwrap_or(base.basis),
        reference: settings.reference.unwrap_or(base.reference),
        reference_light: settings.reference_light.clone().unwrap_or(base.reference_light),
        ..brdf()
    }
}

fn brdf() -> Quantity {
    Quantity {
        basis: Basis::Energy,
        reference: Reference::None,
        reference_light: ReferenceLight::Same,
        ..Quantity::unstated(QuantityKind::Brdf)
    }
}

/// Sample, instrument and lights, for every measurement.
fn note_parts(document: &mut Document, settings: &Settings, notes: &mut Notes) {
    let mut measurements = std::mem::take(&mut document.measurements);
    for measurement in &mut measurements {
        parts::attach_sample(document, measurement, settings, notes);
        parts::attach_instrument(document, measurement, None, settings, notes);
        parts::attach_lights(document, measurement, settings);
    }
    document.measurements = measurements;
}

/// What is left of the file, as JSON.
fn extension(file: &File, notes: &mut Notes) -> Option<Extension> {
    let Json::Object(members) = &file.tree else { return None };
    let known = ["metadata", "data"];
    let left = |name: &str| members.get(name).filter(|left| !left.is_empty()).map(serde_json::to_string);
    let mut texts: Vec<_> = known.iter().filter_map(|name| Some((*name, left(name)?))).collect();
    let other: BTreeMap<_, _> = members.iter().filter(|(name, _)| !known.contains(&name.as_str())).collect();
    if !other.is_empty() {
        texts.push(("other", serde_json::to_string(&other)));
    }
    let dataset = |text: String| Dataset::new(Array::text(text)).with_text("media_type", "application/json");
    let kept = texts.into_iter().filter_map(|(name, text)| Some((name.to_owned(), dataset(text.ok()?))));
    let datasets: Vec<_> = kept.collect();
    for (name, _) in &datasets {
        notes.notice(file.at(name), format!("what the document has no place for is kept in the extension {DOMAIN}"));
    }
    let domain = Id::new(DOMAIN).ok()?;
    (!datasets.is_empty()).then(|| Extension { domain, content: Group { datasets, ..Group::default() } })
}
