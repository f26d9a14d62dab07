//! Every fault of the kit is found by the rule that it is made for, and the clean file is left alone.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use bbrf::validate::{CLAUSES, RULES, Severity, Status, rule, validate_bytes};
use conformance::score::{Answer, Kind, section, table};
use conformance::{FAULTS, Fault, clean, clean_bytes, found, hemisphere};

#[test]
fn the_clean_file_is_left_alone() {
    let report = validate_bytes(clean_bytes());
    assert_eq!(report.findings, [], "{:#?}", report.findings);
    assert_eq!(report.status(), Status::Valid);
}

#[test]
fn every_fault_is_found_by_its_rule() {
    let missed: Vec<String> = FAULTS
        .iter()
        .filter_map(|fault| {
            let found = found(&fault.bytes());
            (!found.contains(&fault.rule)).then(|| format!("{}: found {found:?}", fault.file_name()))
        })
        .collect();
    assert!(missed.is_empty(), "{missed:#?}");
}

/// The page says what the code does; `make conformance` writes it.
#[test]
fn the_published_table_is_in_step() {
    let answer = |fault: &Fault| {
        let report = validate_bytes(fault.bytes());
        let named = found(&fault.bytes()).into_iter().map(str::to_owned).collect();
        (fault.file_name(), Answer::Ended { accepted: report.status() == Status::Valid, named })
    };
    let table = table(Kind::Validator, &FAULTS.iter().map(answer).collect());
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/conformance.md")).unwrap();
    let published = section(&page, "validator").unwrap();
    assert!(published.contains(&table), "docs/conformance.md is not what the code gives; run make conformance");
    section(&page, "reader").unwrap();
}

#[test]
fn what_is_no_hdf5_is_unreadable() {
    for fault in FAULTS.iter().filter(|fault| fault.rule == "structure.hdf5") {
        assert_eq!(validate_bytes(fault.bytes()).status(), Status::Unreadable, "{}", fault.file_name());
    }
}

#[test]
fn each_rule_has_a_fault_a_clause_and_one_name() {
    for (position, rule) in RULES.iter().enumerate() {
        let name = rule.id.strip_prefix("bbrf:1.0:").unwrap();
        // Encodings are made by another library: see `encodings.rs`.
        let tested = FAULTS.iter().any(|fault| fault.rule == name) || rule.group() == "portability";
        assert!(tested, "{name} has no fault");
        let others = RULES.iter().skip(position + 1);
        assert!(others.into_iter().all(|other| other.id != rule.id && other.alias != rule.alias), "{name} twice");
        assert!(!rule.rationale.is_empty() && !rule.example.is_empty() && !rule.repair.is_empty());
        assert!(CLAUSES.iter().any(|clause| clause.0 == rule.clause()), "{name} has no clause");
    }
    for fault in FAULTS {
        assert!(rule(fault.rule).is_some(), "no rule {}", fault.rule);
        assert_eq!(
            FAULTS.iter().filter(|other| other.file_name() == fault.file_name()).count(),
            1,
            "{}",
            fault.file_name()
        );
    }
    assert!(FAULTS.len() >= 150, "{} faults", FAULTS.len());
    assert!(RULES.iter().any(|rule| rule.severity == Severity::Info));
}

#[test]
fn a_finding_of_physics_has_its_z_score() {
    let fault = FAULTS.iter().find(|fault| fault.rule == "physics.negative").unwrap();
    let report = validate_bytes(fault.bytes());
    let finding = report.findings.iter().find(|finding| finding.rule.ends_with("physics.negative")).unwrap();
    assert!(finding.z.unwrap() > 10.0 && finding.severity == Severity::Warning, "{finding:#?}");
    assert_eq!(finding.place.index, [0, 20]);
}

/// A surface that reflects nearly all light, and one that is known too badly to say that it reflects more.
#[test]
fn an_albedo_within_its_uncertainty_is_left_alone() {
    let of = |value: f64, factor: f64| {
        let mut document = clean();
        document.models.clear();
        let mut measurement = hemisphere(&document.measurements[1], value);
        measurement.uncertainty.standard.as_mut().unwrap().mapv_inplace(|sigma| sigma * factor);
        document.measurements[1] = measurement;
        found(&bbrf::container::document_bytes(&document).unwrap().0).contains(&"physics.albedo")
    };
    assert!(!of(0.99, 1.0));
    assert!(!of(1.05, 20.0), "a value of 1.05 with an uncertainty of 0.21");
    assert!(of(1.05, 1.0));
}

/// A total may exceed 1: what is emitted here was absorbed elsewhere.
#[test]
fn fluorescence_is_no_albedo() {
    let mut document = clean();
    document.models[0].terms[0].parameters[0].value = vec![1.4];
    document.measurements[1].quantity.part = bbrf::quantity::Part::Total;
    assert!(!found(&bbrf::container::document_bytes(&document).unwrap().0).contains(&"model.albedo"));
}

/// Who is to mend a file reads in the finding what belongs there.
#[test]
fn a_finding_says_what_stands_there_and_what_belongs_there() {
    for (rule, what, found, expected) in [
        ("structure.attributes", "flag-meanings-in-another-order", "`one two`", "not-measured-by-design"),
        ("structure.attributes", "coordinates-left-out", "`theta_i phi_i`", "`theta_i phi_i theta_v phi_v`"),
        ("structure.attributes", "flag-masks-shifted", "2, 4, 8", "1, 2, 4, 8"),
        ("quantity.other-units", "angles-in-radians", "`radian`", "`degree`"),
        ("structure.complete", "no-stated-mask", "nothing", "uint8"),
    ] {
        let fault = FAULTS.iter().find(|fault| fault.rule == rule && fault.what == what).unwrap();
        let report = validate_bytes(fault.bytes());
        let finding = report.findings.iter().find(|finding| finding.rule.ends_with(rule)).unwrap();
        assert_eq!(finding.found, found, "{rule} {what}");
        assert!(finding.expected.contains(expected), "{rule} {what}: {}", finding.expected);
    }
}

/// What cannot be read as a direction is placed where it stands.
#[test]
fn an_angle_below_its_range_is_found_in_its_own_column() {
    for (column, angle) in [("theta_v", -10.0), ("phi_i", -10.0)] {
        let mut tree = bbrf::container::document_tree(&clean()).unwrap();
        conformance::numbers(tree.at_mut("measurement/scan").unwrap(), column)[3] = angle;
        bbrf::container::sign_tree(&mut tree);
        let report = bbrf::validate::validate_bytes(bbrf::container::tree_bytes(&tree).unwrap());
        let places: Vec<_> = report.findings.iter().map(|finding| finding.place.to_string()).collect();
        assert!(!places.is_empty());
        let right = format!("/measurement/scan/{column}[3]");
        assert!(places.iter().all(|place| *place == right), "{places:?}");
    }
}
