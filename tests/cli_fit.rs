//! The settings of `bbrf fit` as a user spells them.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::str::contains;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn imported(folder: &Path) -> PathBuf {
    let scan = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let file = folder.join("scan.bbrf");
    bbrf().arg("import").arg(scan).arg("-o").arg(&file).assert().success();
    file
}

fn model(arguments: &[&str], file: &Path) -> serde_json::Value {
    let output = bbrf().arg("fit").arg("--json").args(arguments).arg(file).assert().success().get_output().clone();
    let mut result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    result["models"][0].take()
}

fn specular<'a>(model: &'a serde_json::Value, name: &str) -> &'a serde_json::Value {
    let term = model["terms"].as_array().unwrap().iter().find(|term| term["kind"] == "torrance-sparrow").unwrap();
    &term["parameters"][name]
}

#[test]
fn what_wavelengths_share_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let file = imported(folder.path());
    let lists = |share: &str| {
        let model = model(&["--reduce", "none", "--share", share], &file);
        ["intensity", "roughness"].map(|name| specular(&model, name)["value"].is_array())
    };
    assert_eq!(lists("shape"), [true, false]);
    assert_eq!(lists("shape-and-intensity"), [false, false]);
    assert_eq!(lists("nothing"), [true, true]);
    bbrf().args(["fit", "--share", "all"]).arg(&file).assert().code(2).stderr(contains("shape-and-intensity"));
}

#[test]
fn a_parameter_has_an_interval_and_a_box_says_where_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let file = imported(folder.path());
    let free = model(&[], &file);
    let roughness = specular(&free, "roughness");
    let ends = ["interval_low", "value", "interval_high"].map(|name| roughness[name].as_f64().unwrap());
    assert!(ends[0] < ends[1] && ends[1] < ends[2] && ends[2] - ends[0] < 0.01, "{ends:?}");
    let output = bbrf().args(["fit", "--json", "--bounds", "roughness=0.2..0.5"]).arg(&file).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "a fit on a bound has not converged");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("lies on the edge of the searched box"), "{text}");
    for wrong in ["roughness=0.5..0.2", "albedo=0..1", "refractive_index=0.9..2", "roughness"] {
        bbrf().args(["fit", "--bounds", wrong]).arg(&file).assert().code(2).stderr(contains("expected"));
    }
}

#[test]
fn a_mask_and_effects_are_stored_so_that_the_residuals_can_be_formed_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = imported(folder.path());
    let fitted = folder.path().join("fitted.bbrf");
    bbrf()
        .args(["fit", "--mask", "theta-i>70", "--nuisance", "viewing-offset=0,0.5", "--nuisance", "aperture=0.3"])
        .arg(&file)
        .arg("-o")
        .arg(&fitted)
        .assert()
        .success()
        .stdout(contains("masked out on request (theta-i>70)"))
        .stdout(contains("viewing-offset"))
        .stdout(contains("aperture taken as 0.3 degrees"));
    let report = bbrf().args(["validate", "--output", "json"]).arg(&fitted).assert().success().get_output().clone();
    let report = String::from_utf8(report.stdout).unwrap();
    assert!(!report.contains("model.residuals"), "{report}");
    for (wrong, said) in [
        (["--mask", "theta>3"], "half-angle>DEGREES"),
        (["--nuisance", "offset=1"], "viewing-offset"),
        (["--nuisance", "aperture=-1"], "expected 0 or more"),
        (["--nuisance", "wavelength-shift=1,1"], "actual wavelengths"),
    ] {
        bbrf().arg("fit").args(wrong).arg(&file).assert().code(2).stderr(contains(said));
    }
}

#[test]
fn robust_losses_and_a_shift_of_the_wavelength_say_what_they_did() {
    let folder = tempfile::tempdir().unwrap();
    let file = imported(folder.path());
    for loss in ["huber", "tukey"] {
        let model = model(&["--loss", loss], &file);
        let roughness = specular(&model, "roughness")["value"].as_f64().unwrap();
        assert!((roughness - 0.1).abs() < 0.001, "{loss}: {roughness}");
        assert!(model["method"].as_str().unwrap().contains(loss));
        assert!(model["identifiability"].to_string().contains("robust loss"), "{model}");
    }
    let plain = model(&["--reduce", "none"], &file);
    let shifted = model(&["--reduce", "none", "--nuisance", "wavelength-shift=0,1"], &file);
    let shared = |model: &serde_json::Value| -> f64 {
        let list = model["terms"][0]["parameters"]["albedo"]["shared_relative_uncertainty"].as_array().unwrap().clone();
        list.iter().map(|value| value.as_f64().unwrap()).fold(0.0, f64::max)
    };
    assert!(shared(&shifted) > 2.0 * shared(&plain), "{} {}", shared(&shifted), shared(&plain));
    assert!(shifted["identifiability"].to_string().contains("slope of their spectrum"));
}
