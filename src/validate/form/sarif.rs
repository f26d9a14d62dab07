//! SARIF 2.1.0, as code hosts show it beside a change.
//!
//! An HDF5 file has no lines: the HDF5 path is a logical location, and a physical one with the file goes with it, because
//! consumers drop results that have none. Fingerprints let a host follow a finding from run to run.

use serde_sarif::sarif::{
    ArtifactLocation, Location, LogicalLocation, Message, MultiformatMessageString, PhysicalLocation, PropertyBag,
    ReportingConfiguration, ReportingDescriptor, ResultLevel, Run, Sarif, Tool, ToolComponent,
};

use super::FormError;
use crate::dataset::Place;
use crate::validate::{Checked, Finding, RULES, Rule, Severity};

/// The report as SARIF.
///
/// # Errors
/// [`FormError`], should the report not be JSON.
pub fn sarif(files: &[Checked]) -> Result<String, FormError> {
    let failed = |why: serde_json::Error| FormError { form: "SARIF", why: why.to_string() };
    let driver = ToolComponent::builder()
        .name("bbrf")
        .version(env!("CARGO_PKG_VERSION"))
        .rules(RULES.iter().map(descriptor).collect::<Vec<_>>())
        .build();
    let findings = files.iter().flat_map(|file| &file.report.findings);
    let results = findings.map(|finding| result(finding).map_err(failed)).collect::<Result<Vec<_>, _>>()?;
    let known: usize = files.iter().map(|file| file.known).sum();
    let properties = serde_json::from_value::<PropertyBag>(serde_json::json!({ "knownFindingsLeftOut": known }));
    let run = Run::builder()
        .tool(Tool::builder().driver(driver).build())
        .results(results)
        .properties(properties.map_err(failed)?)
        .build();
    let sarif = Sarif::builder()
        .version(serde_json::json!("2.1.0"))
        .schema("https://json.schemastore.org/sarif-2.1.0.json")
        .runs(vec![run])
        .build();
    serde_json::to_string_pretty(&sarif).map_err(failed)
}

fn level(severity: Severity) -> ResultLevel {
    match severity {
        Severity::Error => ResultLevel::Error,
        Severity::Warning => ResultLevel::Warning,
        Severity::Info => ResultLevel::Note,
    }
}

fn descriptor(rule: &Rule) -> ReportingDescriptor {
    let text = |text: &str| MultiformatMessageString::builder().text(text).build();
    let level = serde_json::to_value(level(rule.severity)).unwrap_or_default();
    ReportingDescriptor::builder()
        .id(rule.id)
        .name(rule.name())
        .short_description(text(rule.rationale))
        .full_description(text(&rule.demands().join(" ")))
        .help(text(&format!("For example: {}. {}", rule.example, rule.repair)))
        .default_configuration(ReportingConfiguration::builder().level(level).build())
        .build()
}

/// The name of a file as a reference of RFC 3986: its unreserved characters and `/`, all others in per cent.
fn uri(name: &str) -> String {
    let mut uri = String::new();
    for byte in name.replace('\\', "/").bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}

fn result(finding: &Finding) -> Result<serde_sarif::sarif::Result, serde_json::Error> {
    let uri = uri(finding.place.file.as_deref().unwrap_or_default());
    let artifact = ArtifactLocation::builder().uri(uri).build();
    let inside = Place { file: None, ..finding.place.clone() };
    let location = Location::builder()
        .physical_location(PhysicalLocation::builder().artifact_location(artifact).build())
        .logical_locations(vec![LogicalLocation::builder().fully_qualified_name(inside.to_string()).build()])
        .build();
    let text = format!("found {}; expected {}. {}", finding.found, finding.expected, finding.advice);
    let index = RULES.iter().position(|rule| rule.id == finding.rule).unwrap_or_default();
    let properties =
        serde_json::from_value::<PropertyBag>(serde_json::json!({ "z": finding.z, "alias": finding.alias }))?;
    Ok(serde_sarif::sarif::Result::builder()
        .rule_id(finding.rule)
        .rule_index(i64::try_from(index).unwrap_or_default())
        .level(level(finding.severity))
        .message(Message::builder().text(text).build())
        .locations(vec![location])
        .partial_fingerprints(
            [("bbrf/v1".to_owned(), finding.fingerprint())].into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        )
        .properties(properties)
        .build())
}
