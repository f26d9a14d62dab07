//! `validate` of several files, and its text.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use assert_cmd::Command;
use bbrf::container::write_file;
use bbrf::quantity::{Bandpass, EmissionAxis};

fn text(command: &mut Command) -> String {
    String::from_utf8(command.output().unwrap().stdout).unwrap()
}

#[test]
fn many_files_are_reported_in_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let names: Vec<String> = (0..24).map(|number| format!("{:02}.bbrf", (number * 7) % 24)).collect();
    for name in &names {
        write_file(&documents::small(), &folder.path().join(name)).unwrap();
    }
    let mut command = Command::cargo_bin("bbrf").unwrap();
    let json = text(command.current_dir(folder.path()).args(["validate", "--json"]).args(&names));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let listed: Vec<&str> =
        json["files"].as_array().unwrap().iter().map(|file| file["file"].as_str().unwrap()).collect();
    assert_eq!(listed, names);
}

#[test]
fn equal_findings_are_one_line_of_text_and_all_of_json() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = documents::small();
    let mut twin = document.measurement("scan").unwrap().clone();
    twin.id = documents::id("twin");
    document.measurements.push(twin);
    for measurement in &mut document.measurements {
        if let EmissionAxis::Wavelengths(axis) = &mut measurement.emission {
            axis.bandpass = Bandpass::Unstated;
        }
    }
    let file = folder.path().join("a.bbrf");
    write_file(&document, &file).unwrap();
    let shown = text(Command::cargo_bin("bbrf").unwrap().arg("validate").arg(&file));
    assert_eq!(shown.matches("BB0304").count(), 1, "{shown}");
    assert!(shown.contains(" places: "), "{shown}");
    assert!(shown.contains("(0 errors, ") && shown.contains(" warnings, "), "{shown}");
    let json = text(Command::cargo_bin("bbrf").unwrap().args(["validate", "--json"]).arg(&file));
    assert!(json.matches("BB0304").count() >= 2);
    let info = text(Command::cargo_bin("bbrf").unwrap().arg("info").arg(&file));
    assert!(info.contains("  1 import receipt\n") && !info.contains("receipt(s)"), "{info}");
}
