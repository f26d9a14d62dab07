//! `bbrf schema`: the JSON Schemas of the document and of every result.

use miette::miette;
use schemars::{Schema, schema_for};

use super::{info, rules};
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::print_text;
use crate::dataset::Document;
use crate::simulate::document::SceneDocument;
use crate::validate::form::ValidateResult;

/// Print a JSON Schema, or the names of all.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Name of the schema
    name: Option<String>,
}

/// Every schema by name; the files in `schema/` are these.
#[must_use]
pub(crate) fn all() -> Vec<(&'static str, Schema)> {
    let mut schemas = vec![
        ("convert", schema_for!(super::convert::ConvertResult)),
        ("convert-model", schema_for!(super::convert::ConvertModelResult)),
        ("cost", schema_for!(super::cost::CostResult)),
        ("design", schema_for!(super::design::DesignResult)),
        ("donaldson-estimate", schema_for!(super::donaldson::estimate::EstimateResult)),
        ("donaldson-separate", schema_for!(super::donaldson::separate::SeparateResult)),
        ("document", schema_for!(Document)),
        ("donaldson-predict", schema_for!(super::donaldson::predict::PredictResult)),
        ("donaldson-predict-sampled", schema_for!(super::donaldson::predict::SampledResult)),
        ("eval", schema_for!(super::eval::EvalResult)),
        ("eval-complete", schema_for!(super::eval::EvalCompleteResult)),
        ("eval-model", schema_for!(crate::cli::model_source::ModelJson)),
        ("fit", schema_for!(super::fit::FitResult)),
        ("fit-compare", schema_for!(super::fit::CompareResult)),
        ("import", schema_for!(super::import::ImportResult<'static>)),
        ("info", schema_for!(info::InfoResult)),
        ("migrate", schema_for!(super::migrate::MigrateResult)),
        ("plan", schema_for!(crate::simulate::Plan)),
        ("render", schema_for!(super::render::RenderResult)),
        ("report", schema_for!(super::report::ReportResult)),
        ("rules", schema_for!(rules::RulesResult)),
        ("scene", schema_for!(SceneDocument)),
        ("validate", schema_for!(ValidateResult<'static>)),
    ];
    for (name, schema) in &mut schemas {
        schema.insert("$id".to_owned(), format!("bbrf:{name}:1").into());
    }
    schemas
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let schemas = all();
    let names = || schemas.iter().map(|(name, _)| *name).collect::<Vec<_>>();
    let Some(wanted) = &arguments.name else {
        print_text(&names().join("\n"))?;
        return Ok(Outcome::Done);
    };
    let (_, schema) = schemas
        .iter()
        .find(|(name, _)| name == wanted)
        .ok_or_else(|| miette!("there is no schema `{wanted}`; expected one of: {}", names().join(", ")))?;
    let text = serde_json::to_string_pretty(schema).map_err(|error| miette!("{error}"))?;
    print_text(&text)?;
    Ok(Outcome::Done)
}
