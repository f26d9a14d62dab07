//! `bbrf export`: a file in another format.

use std::io::Write;
use std::path::PathBuf;

use miette::{IntoDiagnostic, WrapErr, miette};

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::open;
use crate::cli::output::{print_bytes, print_message};
use crate::cli::overwrite::refuse_overwriting;
use crate::container::{self, Opened};
use crate::dataset::{Document, Measurement};
use crate::export::{json, table_csv, universal_brdf};
use crate::quantity::QuantityKind;

/// Write a file in another format.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    /// The format
    #[arg(long, value_enum)]
    to: Format,
    /// The measurement, by id [default: the only one, or the only one that is a factor]
    #[arg(long, value_name = "ID")]
    measurement: Option<String>,
    /// Write here instead of to stdout
    #[arg(short, long)]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// One measurement as a table
    Csv,
    /// The whole document
    Json,
    /// One measurement as Universal BRDF JSON
    UniversalBrdf,
}

impl Format {
    /// What is written, in a message.
    fn noun(self) -> &'static str {
        if self == Self::Csv { "table" } else { "file" }
    }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if let Some(output) = &arguments.output {
        refuse_overwriting(output, [arguments.file.clone()])?;
    }
    let Opened { document, unknown, .. } = open(&arguments.file)?;
    let mut bytes = Vec::new();
    let lost = match arguments.to {
        Format::Csv => {
            let measurement = chosen(&document, arguments.measurement.as_deref())?;
            table_csv::write(&document, measurement, &mut bytes).into_diagnostic()?
        }
        Format::UniversalBrdf => {
            let measurement = chosen(&document, arguments.measurement.as_deref())?;
            universal_brdf::write(&document, measurement, &mut bytes).map_err(|error| miette!("{error}"))?
        }
        Format::Json => {
            let digest = container::digest(&document).map_err(|error| miette!("{error}"))?;
            json::write(&document, digest.as_str(), &mut bytes).into_diagnostic()?;
            unknown.into_iter().map(|path| format!("{path}, which the standard does not know")).collect()
        }
    };
    for what in lost {
        print_message(&format!("bbrf: not in the {}: {what}", arguments.to.noun()));
    }
    match &arguments.output {
        Some(path) => container::replace::write_whole(path, |file| file.write_all(&bytes))
            .into_diagnostic()
            .wrap_err_with(|| format!("{} cannot be written", path.display()))?,
        None => print_bytes(&bytes)?,
    }
    Ok(Outcome::Done)
}

pub(super) fn chosen<'a>(document: &'a Document, id: Option<&str>) -> Result<&'a Measurement, miette::Report> {
    let ids: Vec<&str> = document.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    let listed = ids.join(", ");
    if let Some(id) = id {
        return document
            .measurement(id)
            .ok_or_else(|| miette!("there is no measurement `{id}`; expected one of: {listed}"));
    }
    let is_factor = |kind: QuantityKind| kind.is_factor();
    let factors: Vec<&Measurement> = document.measurements.iter().filter(|m| is_factor(m.quantity.kind)).collect();
    match (document.measurements.as_slice(), factors.as_slice()) {
        ([only], _) => Ok(only),
        (_, [only]) => Ok(only),
        ([], _) => Err(miette!("the file holds no measurement")),
        _ => Err(miette!(help = "name one with --measurement", "the file holds several measurements: {listed}")),
    }
}
