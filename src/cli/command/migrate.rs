//! `bbrf migrate`: a file in the version of the standard that this program writes, without the names of people, or laid down in
//! another way.

use std::path::PathBuf;

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::say_later;
use crate::cli::output::{not_written, print_json, print_message, print_text};
use crate::cli::overwrite::refuse_overwriting;
use crate::cli::references::keeping_references;
use crate::container::layout::{self, MINOR, VERSION};
use crate::container::{self, FileBytes, Limits, Opened, ReadError, Storing, inspect};
use crate::dataset::{Anonymised, Document, Step};

/// Bring a file to the current version of the standard, take the names of people out of it, or store it in another way
///
/// `bbrf cost storage` measures what each way of storing costs.
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
    /// Level of deflate, 0 (none) to 9 [default: 4]; what the file says and its digests stay
    #[arg(long, requires = "output", value_name = "LEVEL", value_parser = clap::value_parser!(u32).range(0..=9))]
    compression: Option<u32>,
    /// Bytes of a chunk before compression, about; at least a row [default: 1048576]
    #[arg(long, requires = "output", value_name = "BYTES", value_parser = clap::value_parser!(u32).range(1..=1 << 30))]
    chunk: Option<u32>,
    /// Round values and their uncertainties to single precision (4 bytes, seven digits): the measurements then have other digests
    #[arg(long, requires = "output")]
    single: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// How the file is asked to be stored; `None` where nothing is asked.
    fn storing(&self) -> Option<Storing> {
        let usual = Storing::default();
        let is_asked = self.compression.is_some() || self.chunk.is_some() || self.single;
        is_asked.then(|| Storing {
            compression: self.compression.unwrap_or(usual.compression),
            chunk_bytes: self.chunk.map_or(usual.chunk_bytes, |bytes| bytes as usize),
            single: self.single,
        })
    }
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
    let storing = arguments.storing();
    if let (Some(output), true) = (&arguments.output, arguments.anonymise || is_later || storing.is_some()) {
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
        if arguments.single {
            in_single(&mut document).map_err(|error| miette!("{name}: {error}"))?;
        }
        container::write_file_storing(&document, &foreign, storing.unwrap_or_default(), output)
            .map_err(|error| not_written(&error))?;
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

/// Takes the names out.
fn anonymised(document: &mut Document) -> Result<Anonymised, miette::Report> {
    let found = keeping_references(document, |document| Ok(document.anonymise()))?;
    if !found.removed.is_empty() {
        document
            .provenance
            .steps
            .push(Step::by_this_program(format!("names of people taken out: {}", found.removed.join(", "))));
    }
    Ok(found)
}

/// Rounds the values.
fn in_single(document: &mut Document) -> Result<(), miette::Report> {
    keeping_references(document, |document| document.round_to_single().map_err(|error| miette!("{error}")))?;
    document.provenance.steps.push(Step::by_this_program("values rounded to single precision".to_owned()));
    Ok(())
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
