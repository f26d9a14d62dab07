//! `bbrf convert`: a measurement in another quantity, or a model in another form of the same function, beside the one it
//! was made of.

mod model;

use std::path::PathBuf;

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use super::export::chosen;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::open_to_rewrite;
use crate::cli::output::{print_json, print_text};
use crate::cli::overwrite::refuse_overwriting;
use crate::container::{self, Opened};
use crate::dataset::{Measurement, Step, Target, convert};
use crate::quantity::{Basis, QuantityKind, Reference};
use crate::terms::Distribution;
pub(crate) use model::ConvertModelResult;

/// Add a measurement in another quantity, reference or basis, or a model in another distribution, to a copy of the file;
/// refuses what is not exact.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("into").required(true).multiple(true).args(["to", "reference", "basis", "distribution"]))]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    /// Another quantity: brdf, brrdf, radiance-factor, donaldson-matrix, bispectral-luminescent-radiance-factor
    #[arg(long, value_name = "QUANTITY")]
    to: Option<QuantityKind>,
    /// Another reference of a factor, converted first: same-geometry, fixed-geometry(theta_i,theta_v)
    #[arg(long)]
    reference: Option<Reference>,
    /// Count energy or photons, converted last
    #[arg(long)]
    basis: Option<Basis>,
    /// The measurement, by id [default: the only one, or the only factor that is no part of a matrix]
    #[arg(long, value_name = "ID")]
    measurement: Option<String>,
    /// Another width or norm of a model's Gaussian: gaussian-half-height, gaussian, torrance-sparrow-1967,
    /// gaussian-normalised; with its covariance, exactly
    #[arg(long, conflicts_with_all = ["to", "reference", "basis", "measurement"])]
    distribution: Option<Distribution>,
    /// The model for --distribution, by id [default: the only one]
    #[arg(long, value_name = "ID", requires = "distribution")]
    model: Option<String>,
    /// Write the new file here; the old one is never changed
    #[arg(short, long)]
    output: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ConvertResult {
    /// The file written.
    file: String,
    /// Id of the measurement that was converted.
    from: String,
    /// Id of the new one.
    measurement: String,
    /// What its values are.
    quantity: QuantityKind,
    /// Their unit.
    unit: &'static str,
    /// How many values have no counterpart, because excitation and emission overlap there.
    without: usize,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let name = arguments.file.display();
    refuse_overwriting(&arguments.output, [arguments.file.clone()])?;
    let Opened { mut document, foreign, .. } = open_to_rewrite(&arguments.file)?;
    if let Some(path) = foreign.lost().first() {
        return Err(miette!(
            help = "take it out, or write it as numbers or texts",
            "{name}: {path} would be lost: values of a type that is not written here"
        ));
    }
    if let Some(into) = arguments.distribution {
        return model::run(arguments, &mut document, &foreign, into);
    }
    let source = chosen(&document, arguments.measurement.as_deref())?;
    let (from, before) = (source.id.to_string(), described(source));
    let targets = [
        arguments.reference.map(Target::Reference),
        arguments.to.map(Target::Kind),
        arguments.basis.map(Target::Basis),
    ];
    let (mut measurement, mut without) = (source.clone(), 0);
    for target in targets.into_iter().flatten() {
        let converted =
            convert(&measurement, target).map_err(|error| miette!("{name}: measurement `{from}`: {error}"))?;
        (measurement, without) = (converted.measurement, without.max(converted.without));
    }
    if document.measurement(measurement.id.as_str()).is_some() {
        return Err(miette!("{name}: there is a measurement `{}` already", measurement.id));
    }
    let result = ConvertResult {
        file: arguments.output.display().to_string(),
        from,
        measurement: measurement.id.to_string(),
        quantity: measurement.quantity.kind,
        unit: measurement.quantity.kind.unit(),
        without,
    };
    document.provenance.steps.push(Step::by_this_program(format!(
        "`{}` is `{}` converted: {before} to {}",
        measurement.id,
        result.from,
        described(&measurement)
    )));
    document.measurements.push(measurement);
    container::write_file_keeping(&document, &foreign, &arguments.output).map_err(|error| miette!("{error}"))?;
    print(arguments, &result)?;
    Ok(Outcome::Done)
}

/// What the values of a measurement are.
fn described(measurement: &Measurement) -> String {
    let quantity = &measurement.quantity;
    format!("{} ({}, reference {}, {})", quantity.kind, quantity.kind.unit(), quantity.reference, quantity.basis)
}

fn print(arguments: &Arguments, result: &ConvertResult) -> Result<(), miette::Report> {
    if arguments.json {
        return print_json("bbrf:convert:1", result);
    }
    let ConvertResult { file, from, measurement, quantity, unit, without } = result;
    let mut lines =
        vec![format!("wrote {file}"), format!("  {measurement}: {quantity} ({unit}), converted from {from}")];
    if *without > 0 {
        lines.push(format!(
            "  {without} values are `not-measured` in it: excitation and emission overlap there, and what the one holds \
             is nothing in the other"
        ));
    }
    print_text(&lines.join("\n"))
}
