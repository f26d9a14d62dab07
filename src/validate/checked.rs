//! A validated file: its report under a grading.

use std::path::Path;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use schemars::JsonSchema;
use serde::Serialize;
use sha2::{Digest as _, Sha256};

use super::finding::{Finding, Report, Severity, Status};
use super::grading::Grading;
use super::{rule, validate_bytes};
use crate::container::{FileBytes, Limits};
use crate::dataset::Place;

/// One file with what was found in it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Checked {
    /// The file as the caller named it.
    pub file: String,
    /// What the findings amount to.
    pub status: Status,
    /// How many findings a baseline left out.
    pub known: usize,
    /// The findings.
    #[serde(flatten)]
    pub report: Report,
}

/// Validates files over all cores; the results come in the order of the files. One that is broken does not stop the
/// rest. `done` is called after each.
pub fn validate_files<P: AsRef<Path> + Sync>(files: &[P], grading: &Grading, done: impl Fn() + Sync) -> Vec<Checked> {
    let checked = |path: &P| {
        let result = validate_file(path.as_ref(), grading);
        done();
        result
    };
    files.par_iter().map(checked).collect()
}

/// Validates one file.
#[must_use]
pub fn validate_file(path: &Path, grading: &Grading) -> Checked {
    let report = match FileBytes::read(path, Limits::default().file_bytes) {
        Ok(bytes) => validate_bytes(bytes),
        Err(error) => not_read(&error),
    };
    Checked::new(path.display().to_string(), report, grading)
}

/// A number with its noun.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The report on a file that the operating system does not give.
fn not_read(error: &std::io::Error) -> Report {
    let mut found = rule("structure.hdf5").map(super::Rule::finder);
    if let Some(found) = &mut found {
        found.add(Place::default(), format!("cannot be read: {error}"), "a readable file");
    }
    Report { digest: None, readable: false, findings: found.map_or_else(Vec::new, |found| found.findings) }
}

impl Checked {
    /// A report under a grading, with the name of what it is about in every place.
    #[must_use]
    pub fn new(file: String, mut report: Report, grading: &Grading) -> Self {
        for finding in &mut report.findings {
            finding.place.file = Some(file.clone());
        }
        report.findings.retain_mut(|finding| grading.apply(finding));
        let graded = report.findings.len();
        // Who accepted what is wrong with a file that cannot be read in full accepted what was in it then, and without a
        // digest of the document nobody can say that it is the same.
        let readable = report.digest.is_some();
        report.findings.retain(|finding| !(readable && grading.knows(finding)));
        let known = graded - report.findings.len();
        Self { file, status: report.status(), known, report }
    }

    /// How many findings are of that severity.
    #[must_use]
    pub fn count(&self, severity: Severity) -> usize {
        self.report.findings.iter().filter(|finding| finding.severity == severity).count()
    }

    /// The verdict in one line.
    #[must_use]
    pub fn verdict(&self) -> String {
        let verdict = match self.status {
            Status::Valid => "valid",
            Status::Invalid => "NOT VALID",
            Status::Unreadable => "NOT READABLE",
        };
        let [errors, warnings, notes] =
            [(Severity::Error, "error"), (Severity::Warning, "warning"), (Severity::Info, "note")]
                .map(|(severity, noun)| counted(self.count(severity), noun));
        let known = self.known_text().map_or_else(String::new, |known| format!("; {known}"));
        format!("{}: {verdict} ({errors}, {warnings}, {notes}){known}", self.file)
    }

    /// That findings are not shown because a baseline knows them, where it is so.
    #[must_use]
    pub(super) fn known_text(&self) -> Option<String> {
        (self.known > 0).then(|| format!("{} left out", counted(self.known, "known finding")))
    }
}

impl Finding {
    /// What stays the same between two runs over two versions of a file: the rule and the place, without the folder.
    /// Of damage also what was found, because who accepts one change of the content does not accept the next.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        let file = self.place.file.as_deref().map(Path::new).and_then(Path::file_name).unwrap_or_default();
        let place = Place { file: None, ..self.place.clone() };
        let mut text = format!("{}|{}|{place}", self.rule, file.to_string_lossy());
        if rule(self.rule).is_some_and(|rule| rule.group() == "digest" || rule.name() == "structure.bytes") {
            text = format!("{text}|{}", self.found);
        }
        Sha256::digest(text).iter().take(16).map(|byte| format!("{byte:02x}")).collect()
    }
}
