//! What a rule says about a file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::registry::Rule;
use crate::dataset::Place;

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Worth knowing.
    Info,
    /// Doubtful, or not stated; the file is valid.
    Warning,
    /// The file is not valid.
    Error,
}

impl Severity {
    /// The name in text output.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Finding {
    /// Id of the rule.
    pub rule: &'static str,
    /// Its short alias.
    pub alias: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// Where.
    pub place: Place,
    /// What is there.
    pub found: String,
    /// What should be there.
    pub expected: String,
    /// What to do.
    pub advice: String,
    /// For a departure from physics: how many standard uncertainties it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<f64>,
}

/// The result of validating one file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Report {
    /// Digest of the document as it was read, if it could be.
    pub digest: Option<String>,
    /// False where the bytes are no file of this standard, or damaged: nothing else can be said of them.
    pub readable: bool,
    /// All findings.
    pub findings: Vec<Finding>,
}

/// What a report means for whoever waits for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// No finding of severity error.
    Valid,
    /// Read, and not valid.
    Invalid,
    /// Not read.
    Unreadable,
}

impl Report {
    /// What the findings amount to.
    #[must_use]
    pub fn status(&self) -> Status {
        if !self.readable {
            Status::Unreadable
        } else if self.findings.iter().any(|finding| finding.severity == Severity::Error) {
            Status::Invalid
        } else {
            Status::Valid
        }
    }
}

/// Collects the findings of one rule.
#[derive(Debug)]
pub struct Finder {
    rule: &'static Rule,
    pub(super) findings: Vec<Finding>,
}

impl Finder {
    pub(super) fn new(rule: &'static Rule) -> Self {
        Self { rule, findings: Vec::new() }
    }

    /// Adds a finding.
    pub fn add(&mut self, place: Place, found: impl Into<String>, expected: impl Into<String>) {
        self.push(place, found.into(), expected.into(), None);
    }

    /// Adds a finding with its z-score.
    pub(super) fn add_scored(&mut self, place: Place, found: String, expected: &str, z: f64) {
        self.push(place, found, expected.to_owned(), Some(z));
    }

    fn push(&mut self, place: Place, found: String, expected: String, z: Option<f64>) {
        self.findings.push(Finding {
            rule: self.rule.id,
            alias: self.rule.alias,
            severity: self.rule.severity,
            place,
            found,
            expected,
            advice: self.rule.repair.to_owned(),
            z,
        });
    }
}
