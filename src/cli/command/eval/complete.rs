//! `bbrf eval --light` and `--excitation`: what a complete model says.

mod result;

use miette::miette;

use super::Arguments;
use crate::cli::command::donaldson::light_source;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::model_source::load_complete;
use crate::cli::output::{print_json, print_message, print_text};
use crate::donaldson::{By, Complete, CompleteTable, Extend, STEPS_NM};
use crate::import::{GeometryRow, read_geometries};
pub(crate) use result::EvalCompleteResult;

pub(super) fn run(arguments: &Arguments) -> CommandResult {
    let complete = load_complete(&arguments.model)?;
    let geometries = read_geometries(&arguments.geometry).map_err(|error| miette!("{error}"))?;
    let result = match &arguments.light {
        Some(light) => under(arguments, &complete, light, &geometries)?,
        None => excited(arguments, &complete, &geometries)?,
    };
    for finding in complete.findings() {
        print_message(&format!("bbrf: {}: {finding}", arguments.model));
    }
    let undefined = result.undefined();
    for (row, problem) in &undefined {
        let line = geometries[*row].line;
        print_message(&format!("bbrf: {}, line {line}: {problem}", arguments.geometry.display()));
    }
    if arguments.json {
        print_json("bbrf:eval-complete:1", &result)?;
    } else {
        print_text(&result.csv(&geometries))?;
    }
    Ok(if undefined.is_empty() { Outcome::Done } else { Outcome::Failed })
}

fn under(
    arguments: &Arguments,
    complete: &Complete,
    light: &str,
    geometries: &[GeometryRow],
) -> Result<EvalCompleteResult, miette::Report> {
    let loaded = light_source::load(light)?;
    loaded.remarks.iter().for_each(|remark| print_message(&format!("bbrf: {remark}")));
    let lit = complete.under(&loaded.light, arguments.extend);
    for unlit in &lit.prediction().unlit {
        let level = if arguments.extend == Extend::Flat { "the light goes on flat" } else { "warning" };
        print_message(&format!("bbrf: {level}: {}: {}", arguments.model, unlit.sentence(light)));
    }
    if !arguments.values {
        return Ok(EvalCompleteResult::under(complete, &lit, light, geometries));
    }
    let incident = match arguments.by {
        By::Integrals => complete.incident(&loaded.light, arguments.extend),
        By::Product => {
            let table = CompleteTable::new(complete, arguments.step).ok_or_else(|| {
                miette!("--step: found {} nm; expected {} to {}", arguments.step, STEPS_NM.0, STEPS_NM.1)
            })?;
            table.incident(&table.sampled(&loaded.light, arguments.extend))
        }
        other => return Err(miette!("--by: found {other}; expected integrals or product for a model")),
    };
    Ok(EvalCompleteResult::values(complete, &lit, &incident, light, geometries))
}

fn excited(
    arguments: &Arguments,
    complete: &Complete,
    geometries: &[GeometryRow],
) -> Result<EvalCompleteResult, miette::Report> {
    EvalCompleteResult::excited(complete, &arguments.excitation, geometries)
        .map_err(|error| miette!("{}: {error}", arguments.model))
}
