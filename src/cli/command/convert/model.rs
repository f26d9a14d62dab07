//! A model in another width or norm of its Gaussian.

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use super::Arguments;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_text};
use crate::container::{self, Foreign};
use crate::dataset::{Document, Model, Step, with_distribution};
use crate::quantity::rounded_with_uncertainty;
use crate::terms::Distribution;

/// What `--json` prints of a converted model.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ConvertModelResult {
    /// The file written.
    file: String,
    /// Id of the model that was converted.
    from: String,
    /// Id of the new one.
    model: String,
    /// Its distribution.
    distribution: Distribution,
}

pub(super) fn run(
    arguments: &Arguments,
    document: &mut Document,
    foreign: &Foreign,
    into: Distribution,
) -> CommandResult {
    let name = arguments.file.display();
    let source = chosen(document, arguments.model.as_deref()).map_err(|error| miette!("{name}: {error}"))?;
    let twin = with_distribution(source, into).map_err(|error| miette!("{name}: model `{}`: {error}", source.id))?;
    if document.model(twin.id.as_str()).is_some() {
        return Err(miette!("{name}: there is a model `{}` already", twin.id));
    }
    let result = ConvertModelResult {
        file: arguments.output.display().to_string(),
        from: source.id.to_string(),
        model: twin.id.to_string(),
        distribution: into,
    };
    let text = text(&result, &twin);
    let step = format!("model `{}` is `{}` converted exactly to the distribution `{into}`", twin.id, result.from);
    document.provenance.steps.push(Step::by_this_program(step));
    document.models.push(twin);
    container::write_file_keeping(document, foreign, &arguments.output).map_err(|error| miette!("{error}"))?;
    if arguments.json {
        print_json("bbrf:convert-model:1", &result)?;
    } else {
        print_text(&text)?;
    }
    Ok(Outcome::Done)
}

fn chosen<'a>(document: &'a Document, asked: Option<&str>) -> Result<&'a Model, miette::Report> {
    let ids = || document.models.iter().map(|model| model.id.to_string()).collect::<Vec<_>>().join(", ");
    match (asked, document.models.as_slice()) {
        (Some(id), _) => document.model(id).ok_or_else(|| miette!("no model `{id}`; the file holds: {}", ids())),
        (None, [one]) => Ok(one),
        (None, []) => Err(miette!("holds no model; make one with `bbrf fit`")),
        (None, _) => Err(miette!("holds several models ({}); name one with --model", ids())),
    }
}

fn text(result: &ConvertModelResult, twin: &Model) -> String {
    let mut lines =
        vec![format!("wrote {}", result.file), format!("  {}: converted exactly from {}", result.model, result.from)];
    for term in twin.terms.iter().filter(|term| term.distribution.is_some()) {
        for parameter in &term.parameters {
            if let ([value], [sigma]) = (parameter.value.as_slice(), parameter.standard_uncertainty.as_slice()) {
                let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
                let known = rounded_with_uncertainty(*value, *sigma);
                let known = known.unwrap_or_else(|| format!("{value:.6} ± unknown"));
                lines.push(format!("  {:<18}{:<18}{known}{unit}", term.kind, parameter.name));
            }
        }
    }
    lines.join("\n")
}
