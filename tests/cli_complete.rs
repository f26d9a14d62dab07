//! `bbrf fit --donaldson` and `bbrf eval --light`: one step to a file that says what a surface radiates anywhere.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod common {
    pub mod bispectral;
}

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::{open, write_file};
use bbrf::dataset::Document;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn scan(folder: &Path) -> PathBuf {
    let scan = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let file = folder.join("scan.bbrf");
    bbrf().arg("import").arg(scan).arg("-o").arg(&file).assert().success();
    file
}

fn matrix(folder: &Path) -> PathBuf {
    let file = folder.join("matrix.bbrf");
    let document = Document { license: Some("CC-BY-4.0".to_owned()), ..common::bispectral::document() };
    write_file(&document, &file).unwrap();
    file
}

fn geometries(folder: &Path) -> PathBuf {
    let file = folder.join("g.csv");
    std::fs::write(&file, "# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n20,20\n-60,10\n").unwrap();
    file
}

/// Scan and matrix completed, and where.
fn whole(folder: &Path) -> PathBuf {
    let (scan, matrix, out) = (scan(folder), matrix(folder), folder.join("whole.bbrf"));
    bbrf().arg("fit").arg(scan).arg("--donaldson").arg(matrix).arg("-o").arg(&out).assert().success();
    out
}

fn json(command: &mut Command) -> Value {
    let output = command.assert().success().get_output().clone();
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn one_file_holds_scan_matrix_parts_and_model_and_says_how_it_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let out = whole(folder.path());
    // The file needs nothing of what it was made of.
    std::fs::remove_file(folder.path().join("matrix.bbrf")).unwrap();
    let document = open(&out).unwrap().document;
    for id in ["scan", "orange", "orange-elastic", "orange-luminescent"] {
        assert!(document.measurement(id).is_some(), "{id}");
    }
    assert!(document.factorisation("orange-factors").is_some());
    let attachment = document.models[0].donaldson.as_ref().unwrap();
    assert_eq!(attachment.factorisation.as_str(), "orange-factors");
    assert!(!attachment.consistency.is_empty());
    let steps: Vec<&str> = document.provenance.steps.iter().map(|step| step.action.as_str()).collect();
    assert!(
        steps.iter().any(|step| step.contains("taken over from matrix.bbrf") && step.contains("CC-BY-4.0")),
        "{steps:?}"
    );
    assert!(steps.iter().any(|step| step.contains("completed with the matrix `orange`")), "{steps:?}");
    let report = json(bbrf().args(["validate", "--output", "json"]).arg(&out));
    let rules = report.to_string();
    for rule in ["model.", "factorisation.", "reference.dangling", "digest."] {
        assert!(!rules.contains(&format!("bbrf:1.0:{rule}")), "{rule}");
    }
    bbrf().arg("info").arg(&out).assert().success().stdout(contains("complete with the matrix of orange-factors"));
    // Once more over itself: the parts are there, and stay.
    let again = || {
        bbrf()
            .arg("fit")
            .arg(&out)
            .args(["--measurement", "scan", "--donaldson"])
            .arg(format!("{}#orange", out.display()))
            .arg("-o")
            .arg(&out)
            .assert()
            .success();
    };
    again();
    let count = open(&out).unwrap().document.measurements.len();
    again();
    assert_eq!(open(&out).unwrap().document.measurements.len(), count);
    assert_eq!(open(&out).unwrap().document.models.len(), 1);
}

#[test]
fn a_complete_model_is_evaluated_under_any_light_with_its_parts() {
    let folder = tempfile::tempdir().unwrap();
    let (out, g) = (whole(folder.path()), geometries(folder.path()));
    let eval = || {
        let mut command = bbrf();
        command.arg("eval").arg("--model").arg(&out).arg("--geometry").arg(&g);
        command
    };
    let result = json(eval().args(["--light", "D65", "--json"]));
    assert_eq!(result["schema"], "bbrf:eval-complete:1");
    let schema: Value = json(bbrf().args(["schema", "eval-complete"]));
    let validator = jsonschema::validator_for(&schema).unwrap();
    assert!(validator.is_valid(&result), "{:?}", validator.iter_errors(&result).next());
    let rows = result["under"]["rows"].as_array().unwrap();
    assert_eq!((rows.len(), rows[0]["total"].as_array().unwrap().len()), (2, 41));
    let at = |row: usize, part: &str, j: usize| rows[row][part][j].as_f64().unwrap();
    for (row, j) in [(0, 10), (1, 22)] {
        let sum = at(row, "luminescent", j) + at(row, "diffuse", j) + at(row, "specular", j);
        assert!((sum - at(row, "total", j)).abs() < 1e-12);
    }
    // The prediction of the matrix alone, times the cosine.
    let alone = json(
        bbrf().args(["donaldson", "predict", "--light", "D65", "--json"]).arg(format!("{}#orange", out.display())),
    );
    for j in 0..41 {
        let expected = 0.5 * alone["predictions"][0]["luminescent"][j].as_f64().unwrap();
        assert!((at(1, "luminescent", j) - expected).abs() < 1e-12 * (1.0 + expected.abs()));
    }
    let output = eval().args(["--light", "D65"]).assert().success().get_output().clone();
    let csv = String::from_utf8(output.stdout).unwrap();
    assert!(
        csv.starts_with("theta_i_deg,theta_v_deg,emission_nm,luminescent,luminescent_standard_uncertainty,diffuse,")
    );
    assert_eq!(csv.lines().count(), 1 + 2 * 41);
    let csv = eval().args(["--excitation", "375", "--excitation", "450"]).assert().success().get_output().clone();
    let csv = String::from_utf8(csv.stdout).unwrap();
    // 41 densities for each, and a line where the excitation is an emission as well.
    assert_eq!(csv.lines().filter(|line| line.contains(",nm-1,")).count(), 2 * 2 * 41);
    assert_eq!(csv.lines().filter(|line| line.contains(",450,450,1,")).count(), 2);
    eval().args(["--light", "FL11"]).assert().success().stderr(contains("warning").and(contains("from 300 to 380 nm")));
    eval().args(["--excitation", "250"]).assert().code(2).stderr(contains("from 300 to 780 nm"));
    eval().args(["--excitation", "400", "--light", "D65"]).assert().code(2);
    // Without a light it is what it was: the terms in the band of the fit.
    eval().assert().success().stdout(contains("theta_i_deg,theta_v_deg,value"));
}

#[test]
fn a_model_without_a_matrix_says_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let (file, g, out) = (scan(folder.path()), geometries(folder.path()), folder.path().join("out.bbrf"));
    bbrf().arg("fit").arg(&file).arg("-o").arg(&out).assert().success();
    let eval = bbrf().arg("eval").arg("--model").arg(&out).arg("--geometry").arg(&g).args(["--light", "D65"]).assert();
    eval.code(2).stderr(contains("no matrix attached").and(contains("--donaldson")));
}

#[test]
fn a_call_that_cannot_work_is_refused_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (file, matrix, out) = (scan(folder.path()), matrix(folder.path()), folder.path().join("out.bbrf"));
    let fit = |donaldson: &str, out: &Path| {
        let mut command = bbrf();
        command.arg("fit").arg(&file).arg("--donaldson").arg(donaldson).arg("-o").arg(out);
        command.assert().code(2)
    };
    let name = matrix.display().to_string();
    fit(&format!("{name}#green"), &out).stderr(contains("no measurement `green`"));
    fit(&file.display().to_string(), &out).stderr(contains("donaldson-matrix"));
    fit(&format!("{}#scan", file.display()), &out).stderr(contains("expected `donaldson-matrix`"));
    fit("missing.bbrf", &out).stderr(contains("missing.bbrf"));
    fit(&name, &matrix).stderr(contains("would be overwritten"));
    assert!(!out.exists());
    assert_eq!(open(&matrix).unwrap().document.measurements.len(), 1);
}

/// Each real matrix at hand becomes part of a whole, and what it says under a light is what `donaldson predict` says.
#[test]
fn real_matrices_complete_a_model() {
    let Some(shared) = common::bispectral::shared() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (file, g) = (scan(folder.path()), geometries(folder.path()));
    for name in ["CIBA12", "HERPIORA", "IXCRLALE", "POLGREE"] {
        let (matrix, out) =
            (folder.path().join(format!("{name}.bbrf")), folder.path().join(format!("{name}-whole.bbrf")));
        bbrf()
            .arg("import")
            .arg(shared.join(format!("bispectral/{name}.BFC")))
            .arg("-o")
            .arg(&matrix)
            .assert()
            .success();
        let fitted =
            json(bbrf().arg("fit").arg(&file).arg("--json").arg("--donaldson").arg(&matrix).arg("-o").arg(&out));
        let completion = &fitted["models"][0]["donaldson"];
        assert_eq!((&completion["reflectance"], &completion["consistent"]), (&"matrix".into(), &true.into()));
        let result = json(
            bbrf().arg("eval").arg("--model").arg(&out).arg("--geometry").arg(&g).args(["--light", "A", "--json"]),
        );
        let alone = json(bbrf().args(["donaldson", "predict", "--light", "A", "--json"]).arg(&matrix));
        for j in 0..41 {
            let at = |part: &str| result["under"]["rows"][1][part][j].as_f64().unwrap();
            let expected = 0.5 * alone["predictions"][0]["total"][j].as_f64().unwrap();
            let found = at("luminescent") + at("diffuse");
            assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{name}: {found} {expected}");
        }
        bbrf().arg("validate").arg(&out).assert().success();
    }
}
