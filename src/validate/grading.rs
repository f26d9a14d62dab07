//! How grave each rule is to whoever asks: profiles, the caller's own grades, and what is known already.

use super::baseline::{Accepted, Baseline, is_known};
use super::finding::{Finding, Severity};
use super::registry::{Rule, rule};

/// A use of files that asks for other grades than the rules' own.
#[derive(Debug)]
pub struct Profile {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Rules or groups of rules with the severity they have in it.
    pub grades: &'static [(&'static str, Severity)],
}

use Severity::{Error, Info, Warning};

/// Every profile; the first is the default.
pub const PROFILES: &[Profile] = &[
    Profile {
        name: "exchange",
        purpose: "a file from one laboratory to another: every rule has its own severity",
        grades: &[],
    },
    Profile {
        name: "archive",
        purpose: "a file that must be understood in twenty years, without its makers: what is unstated is an error",
        grades: &[
            ("quantity.unstated", Error),
            ("wavelength.bandpass-unstated", Error),
            ("wavelength.bandpass-particulars", Warning),
            ("wavelength.excitation-bandpass", Error),
            ("geometry.unknown", Error),
            ("geometry.self-test-missing", Error),
            ("uncertainty.missing", Error),
            ("uncertainty.of-value", Error),
            ("calibration.missing", Warning),
            ("calibration.expired", Error),
            ("model.data-changed", Error),
            ("model.residuals", Error),
            ("model.not-converged", Error),
            ("provenance.license", Error),
            ("provenance.origin", Error),
            ("provenance.unfilled", Warning),
            ("portability", Error),
        ],
    },
    Profile {
        name: "raw",
        purpose: "what an instrument gave, before anybody worked on it: what is not known yet is a note",
        grades: &[
            ("quantity.unstated", Info),
            ("wavelength.bandpass-unstated", Info),
            ("wavelength.excitation-bandpass", Info),
            ("geometry.unknown", Info),
            ("geometry.retro", Info),
            ("geometry.self-test-missing", Info),
            ("uncertainty", Info),
            ("calibration", Info),
            ("provenance.origin", Info),
            ("physics", Info),
        ],
    },
];

impl Profile {
    /// The severity of a rule in this profile. An error is never made less.
    #[must_use]
    pub fn grade(&self, rule: &Rule) -> Severity {
        let grade = self.grades.iter().rev().find(|(name, _)| covers(name, rule)).map(|(_, grade)| *grade);
        grade.filter(|_| rule.severity != Error).unwrap_or(rule.severity)
    }
}

/// The profile of a name.
#[must_use]
pub fn profile(name: &str) -> Option<&'static Profile> {
    PROFILES.iter().find(|profile| profile.name == name)
}

/// A name that no rule has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no rule `{0}`; expected an id, a group or an alias such as BB0201")]
pub struct UnknownRule(pub String);

/// The grades of a run.
#[derive(Debug, Default)]
pub struct Grading {
    profile: Option<&'static Profile>,
    deny_warnings: bool,
    named: Vec<(String, Option<Severity>)>,
    known: Accepted,
}

impl Grading {
    /// The grades of a profile.
    #[must_use]
    pub fn of(profile: &'static Profile) -> Self {
        Self { profile: Some(profile), ..Self::default() }
    }

    /// Makes findings of a rule or a group errors; `warnings` stands for all warnings.
    ///
    /// # Errors
    /// [`UnknownRule`].
    pub fn deny(&mut self, name: &str) -> Result<(), UnknownRule> {
        if name == "warnings" {
            self.deny_warnings = true;
            return Ok(());
        }
        self.grade(name, Some(Error))
    }

    /// Makes findings of a rule or a group warnings.
    ///
    /// # Errors
    /// [`UnknownRule`].
    pub fn warn(&mut self, name: &str) -> Result<(), UnknownRule> {
        self.grade(name, Some(Warning))
    }

    /// Leaves findings of a rule or a group out.
    ///
    /// # Errors
    /// [`UnknownRule`].
    pub fn allow(&mut self, name: &str) -> Result<(), UnknownRule> {
        self.grade(name, None)
    }

    fn grade(&mut self, name: &str, severity: Option<Severity>) -> Result<(), UnknownRule> {
        let is_group = super::CLAUSES.iter().any(|clause| clause.1 == name);
        let name = match rule(name) {
            Some(rule) => rule.name(),
            None if is_group => name,
            None => return Err(UnknownRule(name.to_owned())),
        };
        self.named.push((name.to_owned(), severity));
        Ok(())
    }

    /// Leaves out findings that a baseline knows, unless they are graver now than they were then.
    pub fn know(&mut self, baseline: &Baseline) {
        self.known = baseline.accepted();
    }

    /// True where a graded finding is to be left out as known. That a file cannot be read is never left out.
    pub(super) fn knows(&self, finding: &Finding) -> bool {
        is_known(&self.known, finding)
    }

    /// Grades a finding; false where it is to be left out. That a file cannot be read is never left out.
    pub(super) fn apply(&self, finding: &mut Finding) -> bool {
        let Some(rule) = rule(finding.rule) else { return true };
        if rule.name() == "structure.hdf5" {
            return true;
        }
        finding.severity = self.profile.map_or(rule.severity, |profile| profile.grade(rule));
        if self.deny_warnings && finding.severity == Warning {
            finding.severity = Error;
        }
        match self.named.iter().rev().find(|(name, _)| covers(name, rule)) {
            Some((_, None)) => return false,
            Some((_, Some(severity))) => finding.severity = *severity,
            None => {}
        }
        true
    }
}

fn covers(name: &str, rule: &Rule) -> bool {
    name == rule.name() || name == rule.group()
}
