//! Findings that are known and accepted, so that a pipeline hears of what is new.

use std::collections::BTreeMap;
use std::path::{Component, Path};

use serde::{Deserialize, Serialize};

use super::checked::Checked;
use super::finding::{Finding, Severity};
use crate::dataset::Place;

/// The form of the file; another one is refused.
const FORM: &str = "bbrf:baseline:1";

/// A list of known findings, for people to read and to prune.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    schema: String,
    known: Vec<Known>,
}

/// A known finding. The fingerprint finds it again; the rest says to people what it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Known {
    rule: String,
    severity: Severity,
    place: Place,
    found: String,
    fingerprint: String,
}

/// Why a text is no baseline.
#[derive(Debug, thiserror::Error)]
pub enum BaselineError {
    /// Not the JSON of a baseline.
    #[error("no baseline: {0}")]
    Json(#[from] serde_json::Error),
    /// Another form.
    #[error("no baseline: found the schema `{0}`; expected `{FORM}`")]
    Form(String),
}

impl Baseline {
    /// What is found now, as known from now on. Findings that another baseline left out are not in it.
    #[must_use]
    pub fn of(files: &[Checked]) -> Self {
        let findings = files.iter().flat_map(|file| &file.report.findings);
        let known = findings.map(|finding| Known {
            rule: finding.rule.to_owned(),
            severity: finding.severity,
            place: finding.place.clone(),
            found: finding.found.clone(),
            fingerprint: finding.fingerprint(),
        });
        Self { schema: FORM.to_owned(), known: known.collect() }
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn parse(text: &str) -> Result<Self, BaselineError> {
        let baseline: Self = serde_json::from_str(text)?;
        if baseline.schema == FORM { Ok(baseline) } else { Err(BaselineError::Form(baseline.schema)) }
    }

    /// What is accepted, by fingerprint.
    pub(super) fn accepted(&self) -> Accepted {
        let mut accepted = Accepted::new();
        for Known { place, severity, fingerprint, .. } in &self.known {
            let file = place.file.clone().unwrap_or_default();
            accepted.entry(fingerprint.clone()).or_default().push((file, *severity));
        }
        accepted
    }
}

/// The files, as they were named, in which a finding of a fingerprint is accepted, and how grave.
pub(super) type Accepted = BTreeMap<String, Vec<(String, Severity)>>;

/// True where the finding is accepted in this file, as grave as it is now.
pub(super) fn is_known(accepted: &Accepted, finding: &Finding) -> bool {
    let file = finding.place.file.as_deref().unwrap_or_default();
    let covers = |(then, severity): &(String, Severity)| *severity >= finding.severity && may_be_one_file(then, file);
    !accepted.is_empty() && accepted.get(&finding.fingerprint()).is_some_and(|known| known.iter().any(covers))
}

/// True where one name is the end of the other: a pipeline may run in another folder, but `a/scan.bbrf` is not
/// `b/scan.bbrf`.
fn may_be_one_file(then: &str, now: &str) -> bool {
    let names = |path| {
        let parts = Path::new(path).components().rev();
        parts.filter(|part| matches!(part, Component::Normal(_)))
    };
    names(then).zip(names(now)).all(|(then, now)| then == now)
}
