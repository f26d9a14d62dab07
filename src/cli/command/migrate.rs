//! `bbrf migrate`: a file in the version of the standard that this program writes, or without the names of people.

use std::path::PathBuf;

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::say_later;
use crate::cli::output::{not_written, print_json, print_message, print_text};
use crate::cli::overwrite::refuse_overwriting;
use crate::container::layout::{self, MINOR, VERSION};
use crate::container::{self, FileBytes, Limits, Opened, ReadError, inspect};
use crate::dataset::{Anonymised, Document, Step};

/// Bring a file to the current version of the standard, or take the names of people out of it.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    /// Write the new file here; the old one is never changed
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Take out the contact and the operators, and list texts that may still name a person
    #[arg(long, requires = "output")]
    anonymise: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct MigrateResult {
    file: String,
    /// The version of the standard that the file states.
    version: String,
    /// The version that this program writes.
    current: &'static str,
    /// The file written, if there was anything to do.
    output: Option<String>,
    /// Paths of what was taken out.
    removed: Vec<String>,
    /// Texts that stand and may name a person.
    suspects: Vec<SuspectText>,
}

/// A text that may name a person.
#[derive(Debug, Serialize, JsonSchema)]
struct SuspectText {
    /// Where in the document.
    path: String,
    text: String,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let name = arguments.file.display().to_string();
    if let Some(output) = &arguments.output {
        refuse_overwriting(output, [arguments.file.clone()])?;
    }
    let version = stated_version(arguments)?;
    let is_later = layout::parse_version(&version).is_some_and(|(_, minor)| minor > MINOR);
    if is_later {
        say_later(&arguments.file, &version);
    }
    let mut result = MigrateResult {
        file: name.clone(),
        version,
        current: VERSION,
        output: None,
        removed: Vec::new(),
        suspects: Vec::new(),
    };
    if let (Some(output), true) = (&arguments.output, arguments.anonymise || is_later) {
        let Opened { mut document, foreign, .. } = match container::open_to_rewrite(&arguments.file) {
            Err(error @ ReadError::Later { .. }) => {
                print_message(&format!("bbrf: {error}"));
                return Ok(Outcome::Failed);
            }
            other => other.map_err(|error| miette!("{error}"))?,
        };
        if let Some(path) = foreign.lost().first() {
            let help = "take it out, or write it as numbers or texts";
            return Err(miette!(
                help = help,
                "{name}: {path} would be lost: values of a type that is not written here"
            ));
        }
        if arguments.anonymise {
            let found = anonymised(&mut document)?;
            result.removed = found.removed;
            let texts =
                found.suspects.into_iter().map(|suspect| SuspectText { path: suspect.path, text: suspect.text });
            result.suspects = texts.collect();
            // What the standard does not know is kept, and nobody here can read it.
            result.suspects.extend(foreign.paths().into_iter().map(|path| SuspectText {
                path: path.to_owned(),
                text: "(content that the standard does not know)".to_owned(),
            }));
        }
        container::write_file_keeping(&document, &foreign, output).map_err(|error| not_written(&error))?;
        result.output = Some(output.display().to_string());
    }
    print(arguments, &result)?;
    Ok(Outcome::Done)
}

fn stated_version(arguments: &Arguments) -> Result<String, miette::Report> {
    let name = arguments.file.display();
    let limits = Limits::default();
    let bytes = FileBytes::read(&arguments.file, limits.file_bytes)
        .map_err(|error| miette!("{name}: cannot be read: {error}"))?;
    let inspection = inspect(bytes, &limits).map_err(|error| miette!("{name}: {error}"))?;
    // A version that is not stated or not known is an error of the document.
    inspection.document.as_ref().map_err(|error| miette!("{name}: {error}"))?;
    let stated = inspection.tree.attributes.get(layout::name::BBRF_VERSION).and_then(|array| array.as_text());
    Ok(stated.unwrap_or_default().to_owned())
}

/// Takes the names out. Models keep the measurement they were fitted to: what they refer to by its digest is that
/// measurement without the operator.
fn anonymised(document: &mut Document) -> Result<Anonymised, miette::Report> {
    let digest = |document: &Document, id: &str| -> Result<Option<String>, miette::Report> {
        let measurement = document.measurement(id);
        let digest = measurement.map(container::measurement_digest).transpose();
        digest.map_err(|error| miette!("{error}"))
    };
    let mut current = Vec::new();
    for (position, model) in document.models.iter().enumerate() {
        if digest(document, model.measurement.as_str())?.as_deref() == Some(model.data_digest.as_str()) {
            current.push(position);
        }
    }
    let found = document.anonymise();
    for position in current {
        let id = document.models[position].measurement.to_string();
        if let Some(digest) = digest(document, &id)? {
            document.models[position].data_digest = digest;
        }
    }
    if !found.removed.is_empty() {
        document
            .provenance
            .steps
            .push(Step::by_this_program(format!("names of people taken out: {}", found.removed.join(", "))));
    }
    Ok(found)
}

fn print(arguments: &Arguments, result: &MigrateResult) -> Result<(), miette::Report> {
    if arguments.json {
        return print_json("bbrf:migrate:1", result);
    }
    let MigrateResult { file, version, current, .. } = result;
    let mut lines = match &result.output {
        Some(output) => vec![format!("{file}: version {version}; written to {output} as version {current}")],
        None if version == current => {
            vec![format!("{file}: version {version} of the standard is current: nothing to do")]
        }
        None => {
            vec![format!("{file}: version {version} of the standard; this program writes {current}: left as it is")]
        }
    };
    if arguments.anonymise && result.removed.is_empty() {
        lines.push("  neither a contact nor an operator was in it".to_owned());
    }
    lines.extend(result.removed.iter().map(|path| format!("  taken out: {path}")));
    lines.extend(result.suspects.iter().map(|suspect| format!("  look at: {}: {}", suspect.path, suspect.text)));
    print_text(&lines.join("\n"))
}
