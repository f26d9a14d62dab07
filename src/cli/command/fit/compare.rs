//! `bbrf fit --compare`: every form of the terms, and which of them the data ask for.

use std::path::Path;

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use super::question::hint;
use super::{Arguments, finite};
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::open;
use crate::cli::output::{print_json, print_text};
use crate::fit::{Compared, Comparison, FitOptions, Indistinguishable, compare_measurement};

/// What `--compare --json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct CompareResult {
    /// One per file.
    comparisons: Vec<FileComparison>,
}

/// The comparison of one file.
#[derive(Debug, Serialize, JsonSchema)]
struct FileComparison {
    file: String,
    measurement: String,
    /// How a spectrum became the fitted number.
    reduction: String,
    /// Reference convention of the fitted numbers.
    reference: String,
    /// Values that take part in every fit.
    values: usize,
    /// Different geometries, repeats and mirror images counted once.
    geometries: usize,
    /// Sets of geometries that were left out in turn.
    folds: usize,
    /// False where chi-square is a sum of squares, for want of uncertainties.
    has_uncertainties: bool,
    /// What decides, and why.
    criterion: &'static str,
    /// The preferred model, by its name in `models`.
    preferred: String,
    /// By cross-validation, the best first.
    models: Vec<ModelResult>,
    /// What the data cannot tell from the preferred model.
    indistinguishable: Vec<OtherResult>,
}

/// One model.
#[derive(Debug, Serialize, JsonSchema)]
struct ModelResult {
    /// Terms, distribution and denominator.
    name: String,
    /// Distributions that are the same function with another width or norm.
    exact_twins: Vec<&'static str>,
    /// False where no specular term was seen: the fit is that of the diffuse term alone.
    specular_seen: bool,
    converged: bool,
    /// Number of fitted parameters.
    parameters: usize,
    /// Amplitudes of the diffuse and the specular term, where one number was fitted.
    diffuse: Option<f64>,
    intensity: Option<f64>,
    roughness: Option<f64>,
    refractive_index: Option<f64>,
    chi_square: Option<f64>,
    aicc: Option<f64>,
    bic: Option<f64>,
    /// Mean squared error of values that were left out, over their variance.
    cross_validation: Option<f64>,
    /// How much that is above the best.
    behind: Option<f64>,
    /// Standard error of that difference over the geometries.
    behind_standard_error: Option<f64>,
}

/// A model that cannot be told from the preferred one.
#[derive(Debug, Serialize, JsonSchema)]
struct OtherResult {
    name: String,
    delta_aicc: Option<f64>,
    delta_cross_validation: Option<f64>,
    delta_standard_error: Option<f64>,
    /// Geometries at which the two differ most, the best first.
    measure_at: Vec<DifferenceResult>,
}

/// A geometry that tells two models apart.
#[derive(Debug, Serialize, JsonSchema)]
struct DifferenceResult {
    theta_i_deg: f64,
    phi_i_deg: f64,
    theta_v_deg: f64,
    phi_v_deg: f64,
    /// Difference of the predictions over the standard deviation of one value.
    in_sigma: f64,
}

const CRITERION: &str = "cross-validation by geometry decides, because it needs neither the uncertainties nor the model to be \
    right; of the models within one standard error of the best, that of fewest parameters is preferred";

pub(super) fn run(arguments: &Arguments) -> CommandResult {
    let results = arguments.files.iter().map(|file| compare(arguments, file));
    let comparisons = results.collect::<Result<Vec<_>, miette::Report>>()?;
    if arguments.json {
        print_json("bbrf:fit-compare:1", &CompareResult { comparisons })?;
    } else {
        comparisons.iter().try_for_each(|comparison| print_text(&text(comparison)))?;
    }
    Ok(Outcome::Done)
}

fn compare(arguments: &Arguments, file: &Path) -> Result<FileComparison, miette::Report> {
    let document = open(file)?.document;
    let measurement = arguments.question.choose(&document, file)?;
    let options = FitOptions {
        reduction: arguments.question.reduce,
        assume_reference: arguments.question.reference,
        ..FitOptions::default()
    };
    let comparison = compare_measurement(&document, measurement, &options)
        .map_err(|error| miette!("{}: {error}{}", file.display(), hint(&error)))?;
    Ok(result(file, measurement.id.as_str(), &comparison))
}

fn result(file: &Path, measurement: &str, comparison: &Comparison) -> FileComparison {
    FileComparison {
        file: file.display().to_string(),
        measurement: measurement.to_owned(),
        reduction: comparison.reduction.clone(),
        reference: comparison.reference.to_string(),
        values: comparison.values,
        geometries: comparison.geometries,
        folds: comparison.folds,
        has_uncertainties: comparison.has_sigma,
        criterion: CRITERION,
        preferred: comparison.models.get(comparison.preferred).map_or(String::new(), |model| model.shape.to_string()),
        models: comparison.models.iter().map(model_result).collect(),
        indistinguishable: comparison.indistinguishable.iter().map(other_result).collect(),
    }
}

fn model_result(model: &Compared) -> ModelResult {
    let single = match model.fit.bands.as_slice() {
        [band] => Some(band),
        _ => None,
    };
    ModelResult {
        name: model.shape.to_string(),
        exact_twins: model.shape.twins().iter().map(|twin| twin.name()).collect(),
        specular_seen: model.fit.has_specular(),
        converged: model.fit.stop.is_converged(),
        parameters: model.parameters,
        diffuse: single.filter(|_| model.shape.diffuse).map(|band| band.diffuse),
        intensity: single.filter(|_| model.fit.has_specular()).map(|band| band.intensity),
        roughness: finite(model.fit.roughness),
        refractive_index: finite(model.fit.refractive_index()),
        chi_square: finite(model.chi_square),
        aicc: finite(model.aicc),
        bic: finite(model.bic),
        cross_validation: finite(model.cross_validation),
        behind: finite(model.behind.0),
        behind_standard_error: finite(model.behind.1),
    }
}

fn other_result(other: &Indistinguishable) -> OtherResult {
    let difference = |one: &crate::fit::Difference| DifferenceResult {
        theta_i_deg: one.geometry.incidence.theta_deg(),
        phi_i_deg: one.geometry.incidence.phi_deg(),
        theta_v_deg: one.geometry.viewing.theta_deg(),
        phi_v_deg: one.geometry.viewing.phi_deg(),
        in_sigma: one.in_sigma,
    };
    OtherResult {
        name: other.shape.to_string(),
        delta_aicc: finite(other.delta_aicc),
        delta_cross_validation: finite(other.delta_cross_validation.0),
        delta_standard_error: finite(other.delta_cross_validation.1),
        measure_at: other.apart.iter().map(difference).collect(),
    }
}

fn number(value: Option<f64>, width: usize) -> String {
    let text = match value {
        None => "-".to_owned(),
        Some(value) if (0.01..1e5).contains(&value.abs()) || value == 0.0 => format!("{value:.3}"),
        Some(value) => format!("{value:.2e}"),
    };
    format!("{text:>width$}")
}

fn text(comparison: &FileComparison) -> String {
    let chi = if comparison.has_uncertainties { "chi-square" } else { "RSS" };
    let mut lines = vec![
        format!(
            "{}: measurement `{}`, {}, reference {}; {} values, {} geometries, {} sets left out in turn",
            comparison.file,
            comparison.measurement,
            comparison.reduction,
            comparison.reference,
            comparison.values,
            comparison.geometries,
            comparison.folds
        ),
        format!(
            "  {:<48}{:>3}{chi:>12}{:>12}{:>12}{:>11}{:>11}{:>10}  {}",
            "model", "k", "AICc", "BIC", "CV", "behind", "+-", "diffuse, c_s, r, n"
        ),
    ];
    for model in &comparison.models {
        let parameters = [model.diffuse, model.intensity, model.roughness, model.refractive_index];
        let parameters: Vec<String> = parameters.iter().map(|value| number(*value, 0)).collect();
        let unseen = if model.specular_seen || !model.name.contains('/') { "" } else { "  (no specular term seen)" };
        lines.push(format!(
            "{} {:<48}{:>3}{}{}{}{}{}{}  {}{unseen}",
            if model.name == comparison.preferred { ">" } else { " " },
            model.name,
            model.parameters,
            number(model.chi_square, 12),
            number(model.aicc, 12),
            number(model.bic, 12),
            number(model.cross_validation, 11),
            number(model.behind, 11),
            number(model.behind_standard_error, 10),
            parameters.join(", ")
        ));
    }
    lines.push(format!("  preferred: {} ({})", comparison.preferred, comparison.criterion));
    let twins =
        comparison.models.iter().find(|model| model.name == comparison.preferred).map(|model| &model.exact_twins);
    if let Some(twins) = twins.filter(|twins| !twins.is_empty()) {
        lines.push(format!("  the same function under other widths or norms: {}", twins.join(", ")));
    }
    for other in &comparison.indistinguishable {
        lines.push(format!(
            "  CANNOT BE TOLD APART from it: {} (difference of AICc {}, of CV {} +- {})",
            other.name,
            number(other.delta_aicc, 0),
            number(other.delta_cross_validation, 0),
            number(other.delta_standard_error, 0)
        ));
        let place = |one: &DifferenceResult| {
            format!(
                "({:.0}, {:.0}; {:.0}, {:.0}) {:.1} sigma",
                one.theta_i_deg, one.phi_i_deg, one.theta_v_deg, one.phi_v_deg, one.in_sigma
            )
        };
        let places: Vec<String> = other.measure_at.iter().map(place).collect();
        lines.push(format!("    they differ most at (theta_i, phi_i; theta_v, phi_v): {}", places.join(", ")));
    }
    lines.join("\n")
}
