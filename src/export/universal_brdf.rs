//! A measurement as Universal BRDF JSON, version 1.0: columns of points under `data`, what is known of sample, instrument
//! and surroundings under `metadata`. Importing the file gives the same numbers to the bit; what it cannot hold is listed.
//!
//! A radiance factor is converted: BRDF = factor / pi, times what its reference had of the beam over what the sample had.
//! A density per nanometre, a radiance and a ratio of sums are no BRDF and are refused.
//!
//! Where the format has no words (part, reference, coverage factor, flags), its own places for additions are used:
//! `metadata.adhoc_section.bbrf` and `data.adhoc_variables.flag`.

mod convert;
mod lost;
mod metadata;
mod points;

use std::io::Write;

use serde_json::json;

use crate::dataset::{Document, Measurement};
use convert::Conversion;
use points::Points;

/// The schema that a file names.
const SCHEMA: &str =
    "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/BRDF_JSON_schema/brdf_json_schema_v1.0.json";

/// The extension that keeps what an import of the format had no place for.
const DOMAIN: &str = "io.github.bird-project";

/// Why a measurement is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UniversalBrdfError {
    /// It is no BRDF, and cannot be made one.
    #[error("measurement `{measurement}` cannot be a Universal BRDF: {why}")]
    Refused {
        /// Which.
        measurement: String,
        /// Why.
        why: String,
    },
    /// The target took nothing.
    #[error("the file could not be written: {0}")]
    Write(#[from] std::io::Error),
    /// A text is no JSON.
    #[error("the file could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Writes a measurement of a document, and returns what the file does not hold, and what the schema of the format will
/// object to, one line each.
///
/// # Errors
/// [`UniversalBrdfError`] for a quantity that is no BRDF, and what the target reports.
pub fn write(
    document: &Document,
    measurement: &Measurement,
    target: &mut impl Write,
) -> Result<Vec<String>, UniversalBrdfError> {
    let refused = |why: String| UniversalBrdfError::Refused { measurement: measurement.id.to_string(), why };
    let conversion = Conversion::of(measurement).map_err(refused)?;
    let points = Points::of(measurement, &conversion);
    if points.value.is_empty() {
        return Err(refused("it has no value in a known geometry".to_owned()));
    }
    let (metadata, missing) = metadata::metadata(document, measurement, &conversion);
    writeln!(target, "{{\n\"metadata\": {},", serde_json::to_string_pretty(&metadata)?)?;
    let columns = points.columns(measurement, metadata::kept(document, "data"));
    let lines = columns.iter().map(|(name, column)| Ok(format!("{}: {column}", json!(name))));
    let lines: Vec<String> = lines.collect::<Result<_, serde_json::Error>>()?;
    writeln!(target, "\"data\": {{\n{}\n}}\n}}", lines.join(",\n"))?;
    Ok(lost::lost(document, measurement, &conversion, &points, &missing))
}
