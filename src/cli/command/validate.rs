//! `bbrf validate`: check files against the rules.

use std::path::{Path, PathBuf};

use miette::miette;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_message, print_text, write_output};
use crate::cli::progress::bar;
use crate::container::{FileBytes, Limits};
use crate::validate::{
    Baseline, Checked, Grading, PROFILES, Status, UnknownRule, form, profile, repair, validate_files,
};

/// Check files; exit status 0 valid, 1 not valid, 2 not readable, the worst of all.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The files
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Form of the output
    #[arg(long, value_enum, default_value_t = Form::Text)]
    output: Form,
    /// The same as --output json
    #[arg(long)]
    json: bool,
    /// What the file is for: exchange, archive (what is unstated is an error) or raw (it is a note)
    #[arg(long, value_name = "NAME", default_value = PROFILES[0].name)]
    profile: String,
    /// Treat findings of this rule or group as errors (`warnings`: all warnings)
    #[arg(long, value_name = "RULE")]
    deny: Vec<String>,
    /// Treat findings of this rule or group as warnings
    #[arg(long, value_name = "RULE")]
    warn: Vec<String>,
    /// Leave out findings of this rule or group
    #[arg(long, value_name = "RULE")]
    allow: Vec<String>,
    /// Leave out findings that this file lists as known, unless they are graded higher now
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Write what is found to FILE, as known from now on
    #[arg(long, value_name = "FILE", conflicts_with = "baseline")]
    write_baseline: Option<PathBuf>,
    /// Write files again where that alone mends a finding; content is never changed
    #[arg(long)]
    fix: bool,
    /// With --fix: say what would be mended, and write nothing
    #[arg(long, requires = "fix")]
    dry_run: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Form {
    /// For people
    Text,
    /// For programs
    Json,
    /// For code hosts: SARIF 2.1.0
    Sarif,
    /// For build servers: JUnit XML
    Junit,
    /// For comments and notebooks
    Markdown,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let grading = grading(arguments)?;
    if arguments.fix {
        for file in &arguments.files {
            print_message(&fix(file, arguments.dry_run)?);
        }
    }
    let bar = bar(arguments.files.len() as u64, "files");
    let files = validate_files(&arguments.files, &grading, || bar.inc(1));
    bar.finish_and_clear();
    if let Some(path) = &arguments.write_baseline {
        write_baseline(path, &files)?;
    }
    let worst = files.iter().map(|file| file.status).max().unwrap_or(Status::Valid);
    print(&files, if arguments.json { Form::Json } else { arguments.output })?;
    match worst {
        Status::Valid => Ok(Outcome::Done),
        Status::Invalid => Ok(Outcome::Failed),
        Status::Unreadable => Err(miette!("not every file could be read; the findings say which and why")),
    }
}

fn print(files: &[Checked], form: Form) -> Result<(), miette::Report> {
    let failed = |error: form::FormError| miette!("{error}");
    match form {
        Form::Text => files.iter().try_for_each(|file| print_text(&form::text(file))),
        Form::Json => print_text(&form::json(files).map_err(failed)?),
        Form::Sarif => print_text(&form::sarif(files).map_err(failed)?),
        Form::Junit => print_text(&form::junit(files).map_err(failed)?),
        Form::Markdown => print_text(&form::markdown(files)),
    }
}

fn grading(arguments: &Arguments) -> Result<Grading, miette::Report> {
    let names = || PROFILES.iter().map(|profile| profile.name).collect::<Vec<_>>().join(", ");
    let profile = profile(&arguments.profile)
        .ok_or_else(|| miette!("there is no profile `{}`; expected {}", arguments.profile, names()))?;
    let mut grading = Grading::of(profile);
    let unknown = |error: UnknownRule| miette!(help = "bbrf rules lists them", "{error}");
    arguments.warn.iter().try_for_each(|name| grading.warn(name)).map_err(unknown)?;
    arguments.deny.iter().try_for_each(|name| grading.deny(name)).map_err(unknown)?;
    arguments.allow.iter().try_for_each(|name| grading.allow(name)).map_err(unknown)?;
    if let Some(path) = &arguments.baseline {
        let place = path.display();
        let text = std::fs::read_to_string(path).map_err(|error| miette!("{place}: cannot be read: {error}"))?;
        let baseline =
            Baseline::parse(&text).map_err(|error| miette!(help = "--write-baseline makes one", "{place}: {error}"))?;
        grading.know(&baseline);
    }
    Ok(grading)
}

fn write_baseline(path: &Path, files: &[Checked]) -> Result<(), miette::Report> {
    let baseline = Baseline::of(files);
    let text = serde_json::to_string_pretty(&baseline).map_err(|error| miette!("the baseline: {error}"))?;
    write_output(path, format!("{text}\n").as_bytes())
}

/// Repairs a file in place, and says what was done.
fn fix(path: &Path, dry_run: bool) -> Result<String, miette::Report> {
    let name = path.display();
    // What cannot be read is reported by the validation that follows.
    let Ok(bytes) = FileBytes::read(path, Limits::default().file_bytes) else {
        return Ok(format!("{name}: cannot be read, not repaired"));
    };
    match repair(&bytes) {
        Ok(None) => Ok(format!("{name}: nothing that writing it again would mend")),
        Ok(Some(mended)) if dry_run => Ok(format!("{name}: would mend {}", mended.repaired.join(", "))),
        Ok(Some(mended)) => {
            write_output(path, &mended.bytes)?;
            Ok(format!("{name}: mended {}", mended.repaired.join(", ")))
        }
        Err(error) => Ok(format!("{name}: {error}")),
    }
}
