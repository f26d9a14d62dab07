//! Text for people.

use std::collections::HashMap;

use crate::dataset::Place;
use crate::validate::{Checked, Finding};

/// So many places of one finding are named.
const MOST_PLACES: usize = 8;

/// The report on a file as text: every finding with what to do, the verdict in the last line.
#[must_use]
pub fn text(file: &Checked) -> String {
    let mut lines: Vec<String> = folded(&file.report.findings).into_iter().map(finding_text).collect();
    lines.push(file.verdict());
    lines.join("\n")
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
