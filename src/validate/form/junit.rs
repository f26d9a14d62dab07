//! JUnit XML, as build servers show it: a suite for each file, a case for each rule.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::FormError;
use crate::validate::{Checked, RULES, Severity};

/// The report as JUnit XML. An error is a failure; warnings and notes stand in the output of a passed case.
///
/// # Errors
/// [`FormError`] when a text holds what XML cannot.
pub fn junit(files: &[Checked]) -> Result<String, FormError> {
    let mut report = Report::new("bbrf validate");
    for file in files {
        let mut suite = TestSuite::new(file.file.as_str());
        for rule in RULES {
            let of_rule = || file.report.findings.iter().filter(|finding| finding.rule == rule.id);
            let lines = |errors: bool| -> Vec<String> {
                let wanted = of_rule().filter(|finding| (finding.severity == Severity::Error) == errors);
                wanted.map(|f| format!("{}: found {}; expected {}", f.place, f.found, f.expected)).collect()
            };
            let (failed, said) = (lines(true), lines(false));
            let mut status = TestCaseStatus::success();
            if let Some(first) = failed.first() {
                status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_type(rule.id).set_message(first.as_str()).set_description(failed.join("\n"));
            }
            let mut case = TestCase::new(rule.name(), status);
            case.set_classname(rule.id);
            if !said.is_empty() {
                case.set_system_out(said.join("\n"));
            }
            suite.add_test_case(case);
        }
        if let Some(known) = file.known_text() {
            suite.set_system_out(known);
        }
        report.add_test_suite(suite);
    }
    report.to_string().map_err(|error| FormError { form: "JUnit", why: error.to_string() })
}
