//! `bbrf design`, `fit --compare` and `convert --distribution` as they are called.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::path::Path;

use assert_cmd::Command;
use bbrf::container::{open_verified, write_file};
use bbrf::validate::{Severity, validate_bytes};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

const GUESS: &str = r#"{"terms": [{"kind": "lambertian", "albedo": 0.8},
    {"kind": "torrance-sparrow", "intensity": 30.0, "roughness": 0.05, "refractive_index": 1.45}]}"#;

fn bbrf(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("bbrf").unwrap().current_dir(folder).args(arguments).assert()
}

fn json(folder: &Path, schema: &str, arguments: &[&str]) -> Value {
    let output = bbrf(folder, arguments).success();
    let value: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert_eq!(value["schema"], format!("bbrf:{schema}:1"));
    let schemas = bbrf::cli::schemas();
    let (_, form) = schemas.iter().find(|(name, _)| *name == schema).unwrap();
    let form = serde_json::to_value(form).unwrap();
    assert!(jsonschema::is_valid(&form, &value), "{value}");
    value
}

#[test]
fn a_design_is_a_table_a_picture_and_a_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("guess.json"), GUESS).unwrap();
    let call = ["design", "--model", "guess.json", "--grid", "step=10,max=80", "--add", "6"];
    let files = ["--figure", "design.svg", "--manifest", "scan.csv"];
    bbrf(path, &[&call[..], &files[..]].concat())
        .success()
        .stdout(contains("272 geometries planned").and(contains("next geometries for all parameters (D-optimal)")));
    let svg = std::fs::read_to_string(path.join("design.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("<path"));
    let manifest = std::fs::read_to_string(path.join("scan.csv")).unwrap();
    assert_eq!(manifest.lines().filter(|line| line.contains(",sample,")).count(), 278);
    assert_eq!(manifest.lines().filter(|line| line.contains(",white,")).count(), 278);
    let found = json(path, "design", &[&call[..], &["--json", "--optimise", "refractive-index"]].concat());
    assert_eq!(found["added"].as_array().unwrap().len(), 6);
    for parameter in found["parameters"].as_array().unwrap() {
        let sigma = |key: &str| parameter[key].as_f64().unwrap();
        assert!(sigma("standard_uncertainty_after") < sigma("standard_uncertainty"), "{parameter}");
    }
}

#[test]
fn a_design_says_what_is_wrong_with_the_call() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("guess.json"), GUESS).unwrap();
    let call = |more: &[&str]| bbrf(path, &[&["design", "--model", "guess.json"], more].concat()).code(2);
    call(&[]).stderr(contains("no geometries"));
    call(&["--add", "3", "--optimise", "colour"]).stderr(contains("`colour` is nothing to optimise"));
    call(&["--grid", "step=0,max=3"]).stderr(contains("is no grid"));
    call(&["--add", "3", "--noise", "0"]).stderr(contains("one of them above 0"));
    call(&["--add", "3", "--figure", "a.pdf"]).stderr(contains("expected .svg or .png"));
    call(&["--add", "3", "--manifest", "guess.json"]).stderr(contains("would be overwritten"));
}

#[test]
fn a_fitted_model_is_designed_for_compared_and_converted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_file(&conformance::clean(), &path.join("in.bbrf")).unwrap();
    let before = open_verified(&path.join("in.bbrf")).unwrap();
    let model = before.models.iter().find(|model| model.terms.iter().any(|term| term.distribution.is_some())).unwrap();
    let given = format!("in.bbrf#{}", model.id);
    json(path, "design", &["design", "--model", &given, "--grid", "step=10,max=80", "--json"]);
    let call = ["convert", "in.bbrf", "--model", model.id.as_str(), "-o", "out.bbrf"];
    bbrf(path, &[&call[..], &["--distribution", "beckmann"]].concat())
        .code(2)
        .stderr(contains("another function").and(contains("bbrf fit --distribution beckmann")));
    json(path, "convert-model", &[&call[..], &["--distribution", "gaussian-normalised", "--json"]].concat());
    let after = open_verified(&path.join("out.bbrf")).unwrap();
    assert_eq!(after.models.len(), before.models.len() + 1);
    let report = validate_bytes(std::fs::read(path.join("out.bbrf")).unwrap());
    let grave: Vec<_> = report.findings.iter().filter(|finding| finding.severity > Severity::Info).collect();
    assert!(grave.is_empty(), "{grave:#?}");
    let compared = json(
        path,
        "fit-compare",
        &["fit", "in.bbrf", "--compare", "--measurement", model.measurement.as_str(), "--json"],
    );
    assert_eq!(compared["comparisons"][0]["models"].as_array().unwrap().len(), 19);
    bbrf(path, &["fit", "in.bbrf", "--compare", "-o", "x.bbrf"]).code(2).stderr(contains("cannot be used with"));
}
