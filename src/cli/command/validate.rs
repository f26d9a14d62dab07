//! `bbrf validate`: check files against the rules.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use miette::miette;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_text};
use crate::cli::progress::bar;
use crate::dataset::Place;
use crate::validate::{Finding, Report, Severity, Status, rule, validate_bytes};

/// So many places of one finding are named in the text output.
const MOST_PLACES: usize = 8;

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
    /// Treat findings of this rule as errors (`warnings`: all warnings)
    #[arg(long, value_name = "RULE")]
    deny: Vec<String>,
    /// Treat findings of this rule as warnings
    #[arg(long, value_name = "RULE")]
    warn: Vec<String>,
    /// Leave out findings of this rule
    #[arg(long, value_name = "RULE")]
    allow: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Form {
    /// For people
    Text,
    /// For programs
    Json,
}

/// What `--output json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ValidateResult {
    files: Vec<FileResult>,
}

/// One file.
#[derive(Debug, Serialize, JsonSchema)]
struct FileResult {
    file: String,
    status: Status,
    #[serde(flatten)]
    report: Report,
}

/// How the caller grades rules otherwise.
struct Grading {
    deny_warnings: bool,
    deny: Vec<&'static str>,
    warn: Vec<&'static str>,
    allow: Vec<&'static str>,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let grading = Grading::new(arguments)?;
    let bar = bar(arguments.files.len() as u64, "files");
    let checked = |path: &PathBuf| {
        let result = validate(path, &grading);
        bar.inc(1);
        result
    };
    // Results come in the order of the files, whichever is done first.
    let files: Vec<FileResult> = arguments.files.par_iter().map(checked).collect();
    bar.finish_and_clear();
    let worst = files.iter().map(|file| file.status).max().unwrap_or(Status::Valid);
    if arguments.json || arguments.output == Form::Json {
        print_json("bbrf:validate:1", &ValidateResult { files })?;
    } else {
        files.iter().try_for_each(|file| print_text(&file.text()))?;
    }
    match worst {
        Status::Valid => Ok(Outcome::Done),
        Status::Invalid => Ok(Outcome::Failed),
        Status::Unreadable => Err(miette!("not every file could be read; the findings say which and why")),
    }
}

fn validate(path: &Path, grading: &Grading) -> FileResult {
    let file = path.display().to_string();
    let mut report = match std::fs::read(path) {
        Ok(bytes) => validate_bytes(&bytes),
        Err(error) => not_read(&file, &error),
    };
    report.findings.retain_mut(|finding| grading.apply(finding));
    for finding in &mut report.findings {
        finding.place.file = Some(file.clone());
    }
    FileResult { file, status: report.status(), report }
}

/// The report on a file that the operating system does not give.
fn not_read(file: &str, error: &std::io::Error) -> Report {
    let finding = rule("structure.hdf5").map(|rule| Finding {
        rule: rule.id,
        alias: rule.alias,
        severity: Severity::Error,
        place: Place::file(file),
        found: format!("cannot be read: {error}"),
        expected: "a readable file".to_owned(),
        advice: "Check the name and the permissions.".to_owned(),
    });
    Report { digest: None, readable: false, findings: finding.into_iter().collect() }
}

impl Grading {
    fn new(arguments: &Arguments) -> Result<Self, miette::Report> {
        let ids = |names: &[String]| -> Result<Vec<&'static str>, miette::Report> {
            let known = names.iter().filter(|name| *name != "warnings");
            known.map(|name| rule(name).map(|rule| rule.id).ok_or_else(|| unknown_rule(name))).collect()
        };
        Ok(Self {
            deny_warnings: arguments.deny.iter().any(|name| name == "warnings"),
            deny: ids(&arguments.deny)?,
            warn: ids(&arguments.warn)?,
            allow: ids(&arguments.allow)?,
        })
    }

    /// Grades a finding; false where it is to be left out. What cannot be read stays an error.
    fn apply(&self, finding: &mut Finding) -> bool {
        let named = |rules: &[&str]| rules.contains(&finding.rule);
        if self.deny_warnings && finding.severity == Severity::Warning || named(&self.deny) {
            finding.severity = Severity::Error;
        } else if named(&self.warn) {
            finding.severity = Severity::Warning;
        }
        !named(&self.allow)
    }
}

pub(super) fn unknown_rule(name: &str) -> miette::Report {
    miette!(help = "bbrf rules lists them", "there is no rule `{name}`; expected an id or an alias such as BB0201")
}

impl FileResult {
    fn text(&self) -> String {
        let mut lines: Vec<String> = folded(&self.report.findings).into_iter().map(finding_text).collect();
        let count = |severity| self.report.findings.iter().filter(|finding| finding.severity == severity).count();
        let verdict = match self.status {
            Status::Valid => "valid",
            Status::Invalid => "NOT VALID",
            Status::Unreadable => "NOT READABLE",
        };
        lines.push(format!(
            "{}: {verdict} ({}, {}, {})",
            self.file,
            counted(count(Severity::Error), "error"),
            counted(count(Severity::Warning), "warning"),
            counted(count(Severity::Info), "note")
        ));
        lines.join("\n")
    }
}

/// A number with its noun.
pub(super) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Findings that say the same of several places, each once with its places, in the order of the first.
fn folded(findings: &[Finding]) -> Vec<(&Finding, Vec<String>)> {
    let mut known = HashMap::new();
    let mut folded: Vec<(&Finding, Vec<String>)> = Vec::new();
    for finding in findings {
        let says = (finding.rule, finding.found.as_str(), finding.expected.as_str());
        let index = *known.entry(says).or_insert(folded.len());
        match folded.get_mut(index) {
            // The name of the file stands with the first place and in the last line.
            Some((_, places)) => places.push(Place { file: None, ..finding.place.clone() }.to_string()),
            None => folded.push((finding, vec![finding.place.to_string()])),
        }
    }
    folded
}

/// Places on one line; the JSON output has all of them.
fn listed(places: &[String]) -> String {
    match places {
        [only] => only.clone(),
        _ if places.len() <= MOST_PLACES => format!("{} places: {}", places.len(), places.join(", ")),
        _ => format!("{} places: {}, ...", places.len(), places[..MOST_PLACES].join(", ")),
    }
}

fn finding_text((finding, places): (&Finding, Vec<String>)) -> String {
    format!(
        "{} [{} {}] {}\n    found {}; expected {}\n    {}",
        finding.severity.name(),
        finding.alias,
        finding.rule,
        listed(&places),
        finding.found,
        finding.expected,
        finding.advice
    )
}
