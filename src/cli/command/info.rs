//! `bbrf info`: what is inside a file.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::open_whatever;
use crate::cli::output::{print_json, print_text};
use crate::container::Opened;
use crate::dataset::{Factorisation, Measurement, Model};
use crate::validate::counted;

/// Say what is inside a file.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print the digest of the content and nothing else, to sign it or to compare files
    #[arg(long, conflicts_with = "json")]
    digest: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct InfoResult {
    file: String,
    title: Option<String>,
    license: Option<String>,
    /// Digest of the content as it was read.
    digest: String,
    /// True where every stored digest agrees with the content.
    verified: bool,
    samples: Vec<String>,
    instruments: Vec<String>,
    lights: Vec<String>,
    white_references: Vec<String>,
    measurements: Vec<MeasurementInfo>,
    models: Vec<ModelInfo>,
    factorisations: Vec<FactorisationInfo>,
    /// Number of imports with a receipt.
    receipts: usize,
    /// Paths of content that the standard does not know.
    unknown: Vec<String>,
}

/// One measurement in short.
#[derive(Debug, Serialize, JsonSchema)]
struct MeasurementInfo {
    id: String,
    title: Option<String>,
    role: String,
    quantity: String,
    unit: String,
    part: String,
    reference: String,
    /// Fields that the source did not state.
    unstated: Vec<String>,
    acquisitions: usize,
    /// Values on the emission axis.
    emission_values: usize,
    /// First and last wavelength, nm.
    emission_nm: Option<[f64; 2]>,
    /// Values that are NaN.
    missing: usize,
    has_uncertainty: bool,
}

/// One model in short.
#[derive(Debug, Serialize, JsonSchema)]
struct ModelInfo {
    id: String,
    measurement: String,
    reduction: String,
    terms: Vec<String>,
    converged: bool,
    residual_rms: f64,
    /// The factors of the matrix that makes it complete.
    #[serde(skip_serializing_if = "Option::is_none")]
    complete_with: Option<String>,
}

/// One factorisation in short.
#[derive(Debug, Serialize, JsonSchema)]
struct FactorisationInfo {
    id: String,
    /// The matrix.
    measurement: String,
    rank: usize,
    residual_rms: f64,
}

impl FactorisationInfo {
    fn new(part: &Factorisation) -> Self {
        Self {
            id: part.id.to_string(),
            measurement: part.measurement.to_string(),
            rank: part.rank(),
            residual_rms: part.residual_rms,
        }
    }

    fn text(&self) -> String {
        let factors = counted(self.rank, "factor");
        format!(
            "  factorisation {} of {}: {factors}, leaving {:.2e} r.m.s.",
            self.id, self.measurement, self.residual_rms
        )
    }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let opened = open_whatever(&arguments.file)?;
    if arguments.digest {
        print_text(&opened.computed_digest.to_string())?;
        return Ok(Outcome::Done);
    }
    let result = InfoResult::new(arguments.file.display().to_string(), &opened);
    if arguments.json {
        print_json("bbrf:info:1", &result)?;
    } else {
        print_text(result.text().trim_end())?;
    }
    Ok(Outcome::Done)
}

impl InfoResult {
    fn new(file: String, opened: &Opened) -> Self {
        let document = &opened.document;
        Self {
            file,
            title: document.title.clone(),
            license: document.license.clone(),
            digest: opened.computed_digest.to_string(),
            verified: opened.mismatched.is_empty(),
            samples: document.samples.iter().map(|part| part.id.to_string()).collect(),
            instruments: document.instruments.iter().map(|part| part.id.to_string()).collect(),
            lights: document.lights.iter().map(|part| part.id.to_string()).collect(),
            white_references: document.white_references.iter().map(|part| part.id.to_string()).collect(),
            measurements: document.measurements.iter().map(MeasurementInfo::new).collect(),
            models: document.models.iter().map(ModelInfo::new).collect(),
            factorisations: document.factorisations.iter().map(FactorisationInfo::new).collect(),
            receipts: document.provenance.receipts.len(),
            unknown: opened.unknown.clone(),
        }
    }

    fn text(&self) -> String {
        let mut lines = vec![format!("{}: {}", self.file, self.title.as_deref().unwrap_or("(no title)"))];
        let digest = if self.verified { "agrees with the content" } else { "DOES NOT AGREE: run bbrf validate" };
        lines.push(format!("  digest {} ({digest})", self.digest));
        for (name, ids) in [
            ("samples", &self.samples),
            ("instruments", &self.instruments),
            ("lights", &self.lights),
            ("white references", &self.white_references),
        ] {
            if !ids.is_empty() {
                lines.push(format!("  {name}: {}", ids.join(", ")));
            }
        }
        lines.extend(self.measurements.iter().map(MeasurementInfo::text));
        lines.extend(self.models.iter().map(ModelInfo::text));
        lines.extend(self.factorisations.iter().map(FactorisationInfo::text));
        lines.push(format!("  {}", counted(self.receipts, "import receipt")));
        lines.extend(self.unknown.iter().map(|path| format!("  not of the standard: {path}")));
        lines.join("\n")
    }
}

impl MeasurementInfo {
    fn new(measurement: &Measurement) -> Self {
        let quantity = &measurement.quantity;
        let ends = |nm: &[f64]| Some([*nm.first()?, *nm.last()?]);
        Self {
            id: measurement.id.to_string(),
            title: measurement.title.clone(),
            role: measurement.role.to_string(),
            quantity: quantity.kind.to_string(),
            unit: quantity.kind.unit().to_owned(),
            part: quantity.part.to_string(),
            reference: quantity.reference.to_string(),
            unstated: quantity.unstated_fields().into_iter().map(str::to_owned).collect(),
            acquisitions: measurement.acquisitions.len(),
            emission_values: measurement.emission.len(),
            emission_nm: measurement.emission.wavelengths().and_then(ends),
            missing: measurement.values.iter().filter(|value| value.is_nan()).count(),
            has_uncertainty: measurement.uncertainty.standard.is_some(),
        }
    }

    fn text(&self) -> String {
        let axis = self.emission_nm.map_or("one band".to_owned(), |[first, last]| {
            format!("{} {first} to {last} nm", counted(self.emission_values, "wavelength"))
        });
        let mut text = format!(
            "  measurement {} ({}): {} [{}], {}, reference {}; {} x {axis}, {} missing, {} uncertainty",
            self.id,
            self.role,
            self.quantity,
            self.unit,
            self.part,
            self.reference,
            counted(self.acquisitions, "acquisition"),
            self.missing,
            if self.has_uncertainty { "with" } else { "no" }
        );
        if !self.unstated.is_empty() {
            text.push_str(&format!("; unstated: {}", self.unstated.join(", ")));
        }
        text
    }
}

impl ModelInfo {
    fn new(model: &Model) -> Self {
        Self {
            id: model.id.to_string(),
            measurement: model.measurement.to_string(),
            reduction: model.reduction.clone(),
            terms: model.terms.iter().map(|term| term.kind.to_string()).collect(),
            converged: model.converged,
            residual_rms: model.residuals.rms,
            complete_with: model.donaldson.as_ref().map(|attachment| attachment.factorisation.to_string()),
        }
    }

    fn text(&self) -> String {
        let state = if self.converged { "converged" } else { "NOT CONVERGED" };
        let complete = self.complete_with.as_ref();
        let complete = complete.map_or(String::new(), |factors| format!(", complete with the matrix of {factors}"));
        format!(
            "  model {}: {} of {} ({}), {state}, residual r.m.s. {}{complete}",
            self.id,
            self.terms.join(" + "),
            self.measurement,
            self.reduction,
            self.residual_rms
        )
    }
}
