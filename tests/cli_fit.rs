//! The settings of `bbrf fit` as a user spells them.
#![cfg(feature = "write")]
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod documents;
    pub mod scans;
}

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::write_file;
use bbrf::quantity::{Flag, Reference};
use common::documents::measured_document;
use common::scans::{Random, Truth, paper_grid};
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
    assert!(text.contains("lies on the edge of the searched box (0.2000 to 0.5000)"), "{text}");
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

/// One wavelength without a value and one without a specular term: no command stumbles over either, and both are said.
#[test]
fn a_wavelength_without_a_model_and_one_without_a_lobe_go_through_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let (file, fitted) = (folder.path().join("scan.bbrf"), folder.path().join("fitted.bbrf"));
    let shiny = Truth { albedo: 0.5, intensity: 8.0, roughness: 0.2, index_minus_one: 0.5 };
    let fixed = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    let truths = [shiny, Truth { intensity: 0.0, ..shiny }, shiny, shiny];
    let mut document = measured_document(&paper_grid(), fixed, &truths, 0.01, &mut Random::new(3));
    document.measurements[0].values.column_mut(2).fill(f64::NAN);
    document.measurements[0].flags.column_mut(2).fill(Flag::NotMeasured.bit());
    write_file(&document, &file).unwrap();
    bbrf().args(["fit", "--reduce", "none", "--share", "nothing"]).arg(&file).arg("-o").arg(&fitted).assert().success();
    bbrf().arg("validate").arg(&fitted).assert().success();
    bbrf().arg("report").arg(&fitted).arg("-o").arg(folder.path().join("report.html")).assert().success();
    let twin = folder.path().join("twin.bbrf");
    bbrf()
        .args(["convert", "--distribution", "gaussian-normalised"])
        .arg(&fitted)
        .arg("-o")
        .arg(&twin)
        .assert()
        .success();
    bbrf().arg("validate").arg(&twin).assert().success();
    let geometry = folder.path().join("geometry.csv");
    std::fs::write(&geometry, "# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n30,30\n").unwrap();
    let mut eval = bbrf();
    eval.args(["eval", "--uncertainty", "--json", "--model"]).arg(&fitted).arg("--geometry").arg(&geometry);
    let output =
        eval.assert().success().stderr(contains("no row for 1 wavelengths of the measurement")).get_output().clone();
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["value"]["without_model_nm"], serde_json::json!([520.0]));
    let rows = result["rows"].as_array().unwrap();
    let nm: Vec<f64> = rows.iter().map(|row| row["emission_nm"].as_f64().unwrap()).collect();
    assert_eq!(nm, [500.0, 510.0, 530.0]);
    // Beside the lobe of the others it is its diffuse term alone.
    assert!((rows[1]["value"].as_f64().unwrap() / (0.5 * 30_f64.to_radians().cos()) - 1.0).abs() < 0.01, "{}", rows[1]);
    assert!(rows.iter().all(|row| row["standard_uncertainty"].as_f64().is_some_and(|sigma| sigma > 0.0)), "{rows:?}");
}
