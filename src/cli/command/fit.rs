//! `bbrf fit`: fits the terms to a measurement of each file.

mod compare;
mod complete;
mod diagnose;
mod outputs;
pub(super) mod question;
mod settings;
mod text;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use miette::miette;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::open_to_rewrite;
use crate::cli::output::{not_written, print_json, print_text, report_error};
use crate::cli::progress;
use crate::container::{self, Opened};
use crate::dataset::{Document, FittedParameter, Model, Step};
use crate::fit::fit_measurement;
use crate::terms::{Denominator, Distribution, TermKind};

/// Fit Lambertian and Torrance-Sparrow terms, without a starting point.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf files
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Write the document with its model here: a file; with several FILEs a folder, where each keeps its name
    ///
    /// This may be the FILE itself: the fit only adds its model (or replaces an older one of the same id), and the new
    /// file takes the place of the old one in one step, whole or not at all.
    #[arg(short, long)]
    output: Option<PathBuf>,
    #[command(flatten)]
    question: Question,
    /// Complete the model with a bispectral matrix, FILE.bbrf#ID (FILE.bbrf where it holds one): Y = Y_l + Y_d + Y_s
    ///
    /// The matrix is separated as `bbrf donaldson separate` does, scan and matrix are held against each other (a disagreement is a
    /// warning), and with `-o` the matrix, its parts and what it refers to stand in OUT beside scan and model, so that
    /// `bbrf eval --model OUT#MODEL --light LIGHT` needs nothing else.
    #[arg(long, value_name = "FILE#ID", conflicts_with = "compare")]
    donaldson: Option<String>,
    /// Fit every form of the terms instead, and compare them by cross-validation, AICc and BIC; writes nothing
    #[arg(long, conflicts_with_all = ["output", "terms", "distribution", "denominator", "diagnose"])]
    compare: bool,
    /// Write an HTML page on what the fit rests on: residuals, leverage, influential values, profiles; for one FILE
    #[arg(long, conflicts_with_all = ["share", "loss", "nuisance"], value_name = "PAGE")]
    diagnose: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) use compare::CompareResult;
use question::Question;

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct FitResult {
    /// One per file.
    models: Vec<FittedModel>,
}

/// One fitted model.
#[derive(Debug, Serialize, JsonSchema)]
struct FittedModel {
    /// The file as given.
    file: String,
    /// The model's id.
    id: String,
    /// The measurement's id.
    measurement: String,
    /// True when the fit ended at a minimum inside its box.
    converged: bool,
    /// How a spectrum became the fitted number.
    reduction: String,
    /// Wavelengths of the amplitudes, nm, in the order of their lists; none where one band was fitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    emission_nm: Option<Vec<f64>>,
    /// Reference convention of the fitted numbers.
    reference: String,
    /// The terms.
    terms: Vec<TermResult>,
    /// Covariance of the parameters named, at each emission value.
    covariance: CovarianceResult,
    /// Residuals.
    residual: ResidualResult,
    /// What the data cannot tell, and other findings.
    identifiability: Vec<String>,
    /// The paper's separability check, for in-plane scans.
    separability: Option<SeparabilityResult>,
    /// How the fit was done and why it stopped.
    method: String,
    /// With `--donaldson`: the matrix that completes the model, and whether it goes with the scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    donaldson: Option<complete::CompletionResult>,
    /// Time of the fit alone, seconds.
    seconds: f64,
}

/// One term.
#[derive(Debug, Serialize, JsonSchema)]
struct TermResult {
    kind: TermKind,
    distribution: Option<Distribution>,
    denominator: Option<Denominator>,
    parameters: BTreeMap<String, ParameterResult>,
}

/// A parameter: numbers, or arrays where it has one value per wavelength; `null` where the data cannot tell.
#[derive(Debug, Serialize, JsonSchema)]
struct ParameterResult {
    value: NumberOrList,
    standard_uncertainty: NumberOrList,
    /// Ends of the 95 % interval by profile likelihood; `null` at an end that the data leave open.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval_low: Option<NumberOrList>,
    #[serde(skip_serializing_if = "Option::is_none")]
    interval_high: Option<NumberOrList>,
    shared_relative_uncertainty: Option<NumberOrList>,
    unit: String,
}

/// One number or a list.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(untagged)]
enum NumberOrList {
    Number(Option<f64>),
    List(Vec<Option<f64>>),
}

#[derive(Debug, Serialize, JsonSchema)]
struct CovarianceResult {
    parameters: Vec<String>,
    matrices: Vec<Vec<Vec<Option<f64>>>>,
}

fn table(covariance: ndarray::ArrayView2<'_, f64>) -> Vec<Vec<Option<f64>>> {
    covariance.rows().into_iter().map(|row| row.iter().copied().map(finite).collect()).collect()
}

#[derive(Debug, Serialize, JsonSchema)]
struct ResidualResult {
    rms: Option<f64>,
    reduced_chi_square: Option<f64>,
    count: u64,
    left_out: u64,
}

/// The numbers of the separability check without its curves: is the value a function of incidence times one of viewing?
#[derive(Debug, Serialize, JsonSchema)]
struct SeparabilityResult {
    /// Amplitude of the cosine fitted to the average over viewing.
    cosine_amplitude: f64,
    /// R.m.s. departure of that average from the cosine, relative to its amplitude.
    cosine_relative_rms: f64,
    /// R.m.s. departure of the average over incidence from its mean, relative to that mean.
    constancy_relative_rms: f64,
    /// R.m.s. of what the best product of the two leaves, relative to the r.m.s. of all values.
    rank_one_relative_rms: f64,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if arguments.compare {
        return compare::run(arguments);
    }
    if let Some(page) = &arguments.diagnose {
        diagnose::check(page, &arguments.files, arguments.output.as_deref())?;
    }
    let outputs = outputs::outputs(&arguments.files, arguments.output.as_deref())?;
    let matrix = arguments.donaldson.as_deref().map(|name| complete::Source::open(name, &arguments.files, &outputs));
    let matrix = matrix.transpose()?;
    let progress = progress::bar(arguments.files.len() as u64, "fitting");
    let results: Vec<Result<FittedModel, miette::Report>> = arguments
        .files
        .par_iter()
        .zip(&outputs)
        .map(|(file, output)| {
            let result = fit_file(arguments, file, output.as_deref(), matrix.as_ref());
            progress.inc(1);
            result
        })
        .collect();
    progress.finish_and_clear();
    let (mut models, mut errors) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(model) => models.push(model),
            Err(error) => errors.push(error),
        }
    }
    let converged = models.iter().all(|model| model.converged);
    if models.is_empty() && errors.len() == 1 {
        return Err(errors.remove(0));
    }
    if arguments.json {
        print_json("bbrf:fit:1", &FitResult { models })?;
    } else {
        models.iter().try_for_each(|model| print_text(&text::text(model)))?;
    }
    errors.iter().for_each(report_error);
    match errors.len() {
        0 if converged => Ok(Outcome::Done),
        0 => Ok(Outcome::Failed),
        count => Err(miette!("{count} of {} files could not be fitted", arguments.files.len())),
    }
}

fn fit_file(
    arguments: &Arguments,
    file: &Path,
    output: Option<&Path>,
    matrix: Option<&complete::Source>,
) -> Result<FittedModel, miette::Report> {
    let Opened { mut document, foreign, .. } = open_to_rewrite(file)?;
    let measurement = arguments.question.choose(&document, file)?;
    let digest = container::measurement_digest(measurement).map_err(|error| miette!("{}: {error}", file.display()))?;
    let options = arguments.question.options(digest);
    let start = Instant::now();
    let mut model = fit_measurement(&document, measurement, &options)
        .map_err(|error| miette!("{}: {error}{}", file.display(), question::hint(&error)))?;
    let seconds = start.elapsed().as_secs_f64();
    let mut result = fitted_model(file, &model, seconds);
    if let Some(page) = &arguments.diagnose {
        diagnose::write(page, &document, &model, &options)?;
    }
    if let Some(matrix) = matrix {
        result.donaldson = Some(matrix.complete(file, &mut document, &mut model)?);
    }
    if let Some(output) = output {
        store(&mut document, model);
        if let Some(path) = foreign.lost().first() {
            let help = "take it out, or write it as numbers or texts";
            return Err(miette!(
                help = help,
                "{}: {path} would be lost: values of a type that is not written here",
                file.display()
            ));
        }
        container::write_file_keeping(&document, &foreign, output).map_err(|error| not_written(&error))?;
    }
    Ok(result)
}

/// Puts the model into the document, in place of an older one of the same id.
fn store(document: &mut Document, model: Model) {
    document
        .provenance
        .steps
        .push(Step::by_this_program(format!("fitted model `{}` to measurement `{}`", model.id, model.measurement)));
    match document.models.iter_mut().find(|old| old.id == model.id) {
        Some(old) => *old = model,
        None => document.models.push(model),
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn number_or_list(values: &[f64]) -> NumberOrList {
    match values {
        [one] => NumberOrList::Number(finite(*one)),
        many => NumberOrList::List(many.iter().copied().map(finite).collect()),
    }
}

fn parameter_result(parameter: &FittedParameter) -> ParameterResult {
    let shared = &parameter.shared_relative_uncertainty;
    ParameterResult {
        value: number_or_list(&parameter.value),
        standard_uncertainty: number_or_list(&parameter.standard_uncertainty),
        interval_low: (!parameter.interval_low.is_empty()).then(|| number_or_list(&parameter.interval_low)),
        interval_high: (!parameter.interval_high.is_empty()).then(|| number_or_list(&parameter.interval_high)),
        shared_relative_uncertainty: (!shared.is_empty()).then(|| number_or_list(shared)),
        unit: parameter.unit.clone(),
    }
}

fn fitted_model(file: &Path, model: &Model, seconds: f64) -> FittedModel {
    let terms = model
        .terms
        .iter()
        .map(|term| TermResult {
            kind: term.kind,
            distribution: term.distribution,
            denominator: term.denominator,
            parameters: term.parameters.iter().map(|p| (p.name.clone(), parameter_result(p))).collect(),
        })
        .collect();
    FittedModel {
        file: file.display().to_string(),
        id: model.id.to_string(),
        measurement: model.measurement.to_string(),
        converged: model.converged,
        reduction: model.reduction.clone(),
        emission_nm: model.emission.wavelengths().map(<[f64]>::to_vec),
        reference: model.reference.to_string(),
        terms,
        covariance: CovarianceResult {
            parameters: model.covariance_parameters.clone(),
            matrices: model.covariance.outer_iter().map(table).collect(),
        },
        residual: ResidualResult {
            rms: finite(model.residuals.rms),
            reduced_chi_square: finite(model.residuals.reduced_chi_square),
            count: model.residuals.count,
            left_out: model.residuals.left_out,
        },
        identifiability: model.identifiability.clone(),
        separability: model.separability.as_ref().map(|s| SeparabilityResult {
            cosine_amplitude: s.cosine_amplitude,
            cosine_relative_rms: s.cosine_relative_rms,
            constancy_relative_rms: s.constancy_relative_rms,
            rank_one_relative_rms: s.rank_one_relative_rms,
        }),
        method: model.method.clone(),
        donaldson: None,
        seconds,
    }
}
