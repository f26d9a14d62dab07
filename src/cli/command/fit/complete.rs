//! `bbrf fit --donaldson`: the matrix that makes the model complete.

use std::path::{Path, PathBuf};

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::command::donaldson::material::{pick, split};
use crate::cli::opened::open;
use crate::cli::output::print_message;
use crate::cli::overwrite::{is_same_file, refuse_overwriting};
use crate::container::measurement_digest;
use crate::dataset::{Document, Id, Model, ReflectanceSource, Step};
use crate::donaldson::{Consistency, Level, ScanOf, Shape, attach};

/// A matrix and the document that it is in.
pub(super) struct Source {
    name: String,
    path: PathBuf,
    id: Id,
    document: Document,
}

/// What completes the model.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct CompletionResult {
    /// The matrix, by its id in the document of the model.
    matrix: String,
    /// Where the diffuse reflectance comes from: the matrix or the terms.
    reflectance: ReflectanceSource,
    /// True where nothing that could be checked speaks against scan and matrix being of one surface.
    consistent: bool,
    /// The spectra that were compared, one for each excitation of the scan.
    shapes: Vec<ShapeResult>,
    /// Reduced chi-square of the fit over the geometries; `null` without uncertainties.
    angular_reduced_chi_square: Option<f64>,
    /// All of it in words, and what was taken for granted.
    findings: Vec<String>,
}

/// The spectrum of a scan beside that of the matrix under the same light, the scale between them fitted away.
#[derive(Debug, Serialize, JsonSchema)]
struct ShapeResult {
    /// What the scan was compared as.
    of: ScanOf,
    /// The light, in words; `null` for a ratio that needs none.
    light: Option<String>,
    /// True where they agree: `reduced_chi_square` is at most `limit`.
    agrees: bool,
    /// Wavelengths compared.
    count: usize,
    from_nm: f64,
    to_nm: f64,
    /// Weighted sum of squares over degrees of freedom.
    reduced_chi_square: f64,
    /// What one pair of spectra of one shape in a hundred exceeds.
    limit: f64,
    /// Where they differ most, nm.
    largest_deviation_nm: f64,
    /// Measured minus predicted there, relative to the largest predicted value.
    largest_deviation_relative: f64,
    /// The same in standard uncertainties.
    largest_deviation_sigmas: f64,
    /// Measured over predicted level; `null` where what fell in is not known.
    level: Option<LevelResult>,
}

/// Measured over predicted level.
#[derive(Debug, Serialize, JsonSchema)]
struct LevelResult {
    ratio: f64,
    /// With what all values share; the light is taken as exact.
    standard_uncertainty: f64,
    agrees: bool,
}

impl From<&Level> for LevelResult {
    fn from(level: &Level) -> Self {
        Self { ratio: level.ratio, standard_uncertainty: level.sigma, agrees: level.agrees() }
    }
}

impl From<&Shape> for ShapeResult {
    fn from(shape: &Shape) -> Self {
        Self {
            of: shape.of,
            light: shape.light.clone(),
            agrees: shape.agrees(),
            count: shape.count,
            from_nm: shape.from_nm,
            to_nm: shape.to_nm,
            reduced_chi_square: shape.reduced_chi_square,
            limit: shape.limit,
            largest_deviation_nm: shape.largest.nm,
            largest_deviation_relative: shape.largest.relative,
            largest_deviation_sigmas: shape.largest.sigmas,
            level: shape.level.as_ref().map(LevelResult::from),
        }
    }
}

impl CompletionResult {
    fn new(matrix: &Id, model: &Model, consistency: &Consistency) -> Self {
        let chi_square = consistency.angular_reduced_chi_square;
        let attachment = model.donaldson.as_ref();
        Self {
            matrix: matrix.to_string(),
            reflectance: attachment.map_or(ReflectanceSource::Matrix, |attachment| attachment.reflectance),
            consistent: consistency.agrees(),
            shapes: consistency.shapes.iter().map(ShapeResult::from).collect(),
            angular_reduced_chi_square: chi_square.is_finite().then_some(chi_square),
            findings: attachment.map(|attachment| attachment.consistency.clone()).unwrap_or_default(),
        }
    }

    /// For people.
    pub(super) fn lines(&self) -> Vec<String> {
        let first = format!("  completed with the matrix `{}`, reflectance from the {}", self.matrix, self.reflectance);
        std::iter::once(first).chain(self.findings.iter().map(|finding| format!("  note: {finding}"))).collect()
    }
}

impl Source {
    /// Opens the document of a matrix. It is not written over, unless it is that of the scan and its output.
    pub(super) fn open(name: &str, files: &[PathBuf], outputs: &[Option<PathBuf>]) -> Result<Self, miette::Report> {
        let (path, id) = split(name);
        let path = PathBuf::from(path);
        for (file, output) in files.iter().zip(outputs).filter_map(|(file, output)| Some((file, output.as_ref()?))) {
            if !is_same_file(file, &path) {
                refuse_overwriting(output, [path.clone()])?;
            }
        }
        let document = open(&path)?.document;
        let id = pick(&document, &path.display().to_string(), id)?.id.clone();
        Ok(Self { name: name.to_owned(), path, id, document })
    }

    /// Brings the matrix into the document of a scan, unless it is there, and attaches it to the model. A disagreement is a warning.
    pub(super) fn complete(
        &self,
        file: &Path,
        document: &mut Document,
        model: &mut Model,
    ) -> Result<CompletionResult, miette::Report> {
        let id = if is_same_file(file, &self.path) { self.id.clone() } else { self.bring(document)? };
        let digest = |part: &crate::dataset::Measurement| measurement_digest(part).map_err(|error| error.to_string());
        let consistency = attach(document, model, id.as_str(), digest)
            .map_err(|error| miette!("{}, --donaldson {}: {error}", file.display(), self.name))?;
        for warning in &consistency.warnings {
            print_message(&format!("bbrf: warning: {}, --donaldson {}: {warning}", file.display(), self.name));
        }
        Ok(CompletionResult::new(&id, model, &consistency))
    }

    fn bring(&self, document: &mut Document) -> Result<Id, miette::Report> {
        let adopted = document
            .adopt(&self.document, self.id.as_str())
            .ok_or_else(|| miette!("{}: no measurement `{}`", self.path.display(), self.id))?;
        let mut action = format!("`{}` taken over from {} with what it refers to", adopted.id, base_name(&self.path));
        for (what, text) in [
            ("title", &self.document.title),
            ("licence", &self.document.license),
            ("citation", &self.document.citation),
        ] {
            if let Some(text) = text {
                action.push_str(&format!("; {what} there: {text}"));
            }
        }
        for renamed in &adopted.renamed {
            print_message(&format!("bbrf: {}: {renamed}", self.name));
            action.push_str(&format!("; {renamed}"));
        }
        document.provenance.steps.push(Step::by_this_program(action));
        Ok(adopted.id)
    }
}

/// Where a file lies on one machine is nobody else's concern.
fn base_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
