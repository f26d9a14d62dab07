//! `bbrf convert`: the named conversions of the standard, from the command line.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::{open_verified, write_file};
use bbrf::dataset::{Document, Measurement};
use bbrf::quantity::{Bandpass, EmissionAxis, Flag, QuantityKind};
use bbrf::validate::{Severity, validate_bytes};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

fn convert(file: &Path, arguments: &[&str], output: &Path) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("bbrf").unwrap();
    command.arg("convert").arg(file).args(arguments).arg("-o").arg(output).assert()
}

fn written(folder: &Path, change: impl FnOnce(&mut Document)) -> PathBuf {
    let path = folder.join("in.bbrf");
    let mut document = conformance::clean();
    change(&mut document);
    write_file(&document, &path).unwrap();
    path
}

fn measurement<'a>(document: &'a Document, id: &str) -> &'a Measurement {
    document.measurement(id).unwrap()
}

#[test]
fn a_brdf_is_the_factor_over_pi_beside_the_factor() {
    let folder = tempfile::tempdir().unwrap();
    let (file, output) = (written(folder.path(), |_| {}), folder.path().join("out.bbrf"));
    convert(&file, &["--to", "brdf"], &output).success().stdout(contains("scan-brdf: brdf (sr-1)"));
    let (before, after) = (open_verified(&file).unwrap(), open_verified(&output).unwrap());
    let (factor, brdf) = (measurement(&after, "scan"), measurement(&after, "scan-brdf"));
    assert_eq!(factor, measurement(&before, "scan"), "the original stays");
    assert_eq!(after.models, before.models);
    for (one, other) in brdf.values.iter().zip(&factor.values) {
        assert!((one * std::f64::consts::PI / other - 1.0).abs() < 1e-15);
    }
    let sigma = |m: &Measurement| m.uncertainty.standard.as_ref().unwrap()[[3, 2]];
    assert!((sigma(brdf) * std::f64::consts::PI / sigma(factor) - 1.0).abs() < 1e-15);
    assert_eq!(brdf.quantity.kind, QuantityKind::Brdf);
    let step = after.provenance.steps.last().unwrap();
    assert!(step.action.contains("`scan-brdf` is `scan` converted: radiance-factor (1"), "{}", step.action);
    let report = validate_bytes(std::fs::read(&output).unwrap());
    let grave: Vec<_> = report.findings.iter().filter(|finding| finding.severity > Severity::Info).collect();
    assert!(grave.is_empty(), "{grave:#?}");
}

/// There and back again gives the numbers that were there, and says where there are none.
#[test]
fn a_matrix_of_the_density_has_the_bandpass_in_it_and_no_diagonal() {
    let folder = tempfile::tempdir().unwrap();
    let (file, there, back) =
        (written(folder.path(), |_| {}), folder.path().join("there.bbrf"), folder.path().join("back.bbrf"));
    convert(&file, &["--measurement", "density", "--to", "donaldson-matrix"], &there)
        .success()
        .stdout(contains("`not-measured`"));
    let matrix_id = "density-donaldson-matrix";
    let density_kind = "bispectral-luminescent-radiance-factor";
    convert(&there, &["--measurement", matrix_id, "--to", density_kind], &back).success();
    let document = open_verified(&back).unwrap();
    let (density, matrix) = (measurement(&document, "density"), measurement(&document, matrix_id));
    let again = measurement(&document, &format!("{matrix_id}-{density_kind}"));
    let (mut compared, mut diagonal) = (0, 0);
    for ((at, value), through) in density.values.indexed_iter().zip(&again.values) {
        let (excited, emitted) = (380.0 + 20.0 * at.0 as f64, 360.0 + 10.0 * at.1 as f64);
        if (excited - emitted).abs() < 20.0 {
            diagonal += 1;
            assert!(matrix.values[at].is_nan() && matrix.flags[at] & Flag::NotMeasured.bit() != 0, "{at:?}");
        } else {
            compared += 1;
            assert!((matrix.values[at] - 10.0 * value).abs() <= 1e-15 * value.abs() * 10.0);
            assert!((through - value).abs() <= 1e-15 * value.abs(), "{at:?}");
        }
    }
    assert_eq!((compared + diagonal, diagonal), (180, 18));
}

#[test]
fn without_the_bandpass_a_density_is_no_matrix() {
    let folder = tempfile::tempdir().unwrap();
    let file = written(folder.path(), |document| {
        if let EmissionAxis::Wavelengths(axis) = &mut document.measurements[2].emission {
            axis.bandpass = Bandpass::Unstated;
        }
    });
    let output = folder.path().join("out.bbrf");
    convert(&file, &["--measurement", "density", "--to", "donaldson-matrix"], &output)
        .code(2)
        .stderr(contains("bandpass").and(contains("unstated")).and(contains("density")));
    assert!(!output.exists());
}

#[test]
fn what_has_no_conversion_is_refused_with_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let (file, output) = (written(folder.path(), |_| {}), folder.path().join("out.bbrf"));
    let refused = |arguments: &[&str]| convert(&file, arguments, &output).code(2);
    refused(&["--to", "luminance"]).stderr(contains("radiance-factor and brdf"));
    refused(&["--measurement", "matrix", "--to", "brdf"]).stderr(contains("no conversion leads"));
    refused(&["--measurement", "nothing", "--to", "brdf"]).stderr(contains("one of: white, scan"));
    refused(&[]).stderr(contains("--to"));
    assert!(!output.exists());
    convert(&file, &["--to", "brdf"], &file).code(2);
}

#[test]
fn reference_quantity_and_basis_are_converted_in_one_call() {
    let folder = tempfile::tempdir().unwrap();
    let (file, output) = (written(folder.path(), |_| {}), folder.path().join("out.bbrf"));
    convert(&file, &["--reference", "fixed-geometry(0,45)"], &output).success();
    let document = open_verified(&output).unwrap();
    let (same, fixed) = (measurement(&document, "scan"), measurement(&document, "scan-fixed-0-45"));
    for (row, acquisition) in same.acquisitions.iter().enumerate() {
        let cosine = acquisition.geometry.unwrap().incidence.cos_theta();
        assert!((fixed.values[[row, 0]] / (same.values[[row, 0]] * cosine) - 1.0).abs() < 1e-14);
    }
    let second = folder.path().join("second.bbrf");
    let all = ["--measurement", "scan-fixed-0-45", "--reference", "same-geometry", "--to", "brdf", "--basis", "photon"];
    convert(&output, &all, &second).success();
    let document = open_verified(&second).unwrap();
    let brdf = document.measurements.last().unwrap();
    let expected = document.measurement("scan").unwrap().values[[7, 1]] / std::f64::consts::PI;
    assert!((brdf.values[[7, 1]] / expected - 1.0).abs() < 1e-14);
}
