//! The command line as scripts and pipelines use it: exit status, shapes of `--json`, numbers that read back.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn stdout(command: &mut Command) -> String {
    String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap()
}

/// JSON of a command, held against its schema in `schema/`.
fn json(command: &mut Command, schema: &str) -> Value {
    let value: Value = serde_json::from_str(&stdout(command)).unwrap();
    assert_eq!(value["schema"], format!("bbrf:{schema}:1"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("schema/{schema}.json"));
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let faults: Vec<String> =
        jsonschema::validator_for(&schema).unwrap().iter_errors(&value).map(|error| error.to_string()).collect();
    assert!(faults.is_empty(), "{faults:?}");
    value
}

/// The simulated scan, imported and fitted.
fn fitted(folder: &Path) -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let (scan, fitted) = (folder.join("scan.bbrf"), folder.join("fitted.bbrf"));
    bbrf().arg("import").arg(manifest).arg("-o").arg(&scan).assert().success();
    bbrf().arg("fit").arg(&scan).arg("-o").arg(&fitted).assert().success();
    fitted
}

#[test]
fn the_main_job_from_raw_records_to_a_valid_fitted_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let result = json(bbrf().args(["fit", "--json", "--reduce", "band:500-620"]).arg(&file), "fit");
    let model = &result["models"][0];
    assert_eq!(model["measurement"], "scan");
    assert_eq!(model["converged"], true);
    assert!(model["seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(model["residual"]["count"], 272);
    let reduced = model["residual"]["reduced_chi_square"].as_f64().unwrap();
    assert!((0.6..1.5).contains(&reduced), "reduced chi-square {reduced}");
    // The truth of the simulation (testdata/simulated_scan/truth.json), band 500 to 620 nm.
    let truth = [(0, "albedo", 1.01511), (1, "intensity", 2.0), (1, "roughness", 0.1), (1, "refractive_index", 1.45)];
    for (term, name, expected) in truth {
        let parameter = &model["terms"][term]["parameters"][name];
        let number = |key: &str| parameter[key].as_f64().unwrap_or(0.0);
        let value = number("value");
        let sigma = number("standard_uncertainty").hypot(value * number("shared_relative_uncertainty"));
        assert!((value - expected).abs() < 3.0 * sigma, "{name}: {value}, expected {expected} +- {sigma}");
        assert!(parameter["unit"].is_string());
    }
    assert_eq!(model["covariance"]["matrices"][0].as_array().unwrap().len(), 4);
    let report = json(bbrf().args(["validate", "--output", "json"]).arg(&file), "validate");
    assert!(report.to_string().contains("wavelength.bandpass-unstated"), "what is unstated is a warning: {report}");
    json(bbrf().args(["info", "--json"]).arg(&file), "info");
    let figures = folder.path().join("figures");
    let drawn = json(bbrf().args(["report", "--json", "--figures"]).arg(&figures).arg(&file), "report");
    assert!(drawn["figures"].as_array().unwrap().len() > 10);
}

#[test]
fn every_wavelength_is_fitted_with_one_roughness_and_index() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let result = json(bbrf().args(["fit", "--json", "--reduce", "none"]).arg(&file), "fit");
    let model = &result["models"][0];
    let parameters = &model["terms"][1]["parameters"];
    let nm = model["emission_nm"].as_array().unwrap();
    assert_eq!(parameters["intensity"]["value"].as_array().unwrap().len(), nm.len());
    assert_eq!(nm.len(), 101);
    assert!(model["identifiability"].to_string().contains("below detection as upper bounds"), "{model}");
    let roughness = parameters["roughness"]["value"].as_f64().unwrap();
    assert!((roughness - 0.1).abs() < 0.001, "{roughness}");
    let luminance = json(bbrf().args(["fit", "--json", "--reduce", "luminance"]).arg(&file), "fit");
    assert_eq!(luminance["models"][0]["reduction"], "luminance");
}

#[test]
fn the_same_input_gives_the_same_bytes_in_another_process() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let bytes = folders.each_ref().map(|folder| std::fs::read(fitted(folder.path())).unwrap());
    assert!(bytes[0] == bytes[1]);
}

#[test]
fn a_table_goes_out_and_comes_back_with_every_digit() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let table = stdout(bbrf().args(["export", "--to", "csv", "--measurement", "scan"]).arg(&file));
    let (csv, back) = (folder.path().join("scan.csv"), folder.path().join("back.bbrf"));
    std::fs::write(&csv, &table).unwrap();
    bbrf().arg("import").arg(&csv).arg("-o").arg(&back).assert().success();
    let id = json(bbrf().args(["info", "--json"]).arg(&back), "info");
    let id = id["measurements"][0]["id"].as_str().unwrap().to_owned();
    let again = stdout(bbrf().args(["export", "--to", "csv", "--measurement", &id]).arg(&back));
    let rows = |text: &str| text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>();
    assert!(rows(&table).len() > 272);
    assert_eq!(rows(&table), rows(&again));
}

#[test]
fn eval_prints_the_angles_back_and_the_factors() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("model.json");
    std::fs::write(
        &model,
        r#"{"terms":[{"kind":"lambertian","albedo":0.8},{"kind":"torrance-sparrow","intensity":30,"roughness":0.05,
           "refractive_index":1.45,"distribution":"gaussian-half-height","denominator":"cos-theta-i"}]}"#,
    )
    .unwrap();
    let geometry = folder.path().join("g.csv");
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n0,180,0,0\n60,180,60,0\n100,180,60,0\n")
        .unwrap();
    let text = stdout(bbrf().args(["eval", "--factors", "--model"]).arg(&model).arg("--geometry").arg(&geometry));
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value,phi_rad,D,G,F");
    let value = |line: &str| line.split(',').nth(4).unwrap().parse::<f64>().unwrap();
    // 0.8 + 30 F(0) with F(0) = (0.45 / 2.45)^2.
    assert!((value(lines[1]) - (0.8 + 30.0 * (0.45_f64 / 2.45).powi(2))).abs() < 1e-14, "{}", lines[1]);
    assert!(lines[2].starts_with("60,180,60,0,"));
    assert_eq!(value(lines[3]), 0.0, "below the horizon: exactly zero");
    std::fs::write(&geometry, "# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n20,20\n").unwrap();
    let signed = stdout(bbrf().args(["eval", "--model"]).arg(&model).arg("--geometry").arg(&geometry));
    assert!(signed.starts_with("theta_i_deg,theta_v_deg,value\n20,20,"), "{signed}");
    json(bbrf().args(["eval", "--json", "--model"]).arg(&model).arg("--geometry").arg(&geometry), "eval");
}

#[test]
fn eval_says_what_its_value_is() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let geometry = folder.path().join("g.csv");
    std::fs::write(&geometry, "# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n90,20\n-90,0\n0,10\n")
        .unwrap();
    let eval = |model: &Path| {
        let mut command = bbrf();
        command.arg("eval").arg("--json").arg("--model").arg(model).arg("--geometry").arg(&geometry);
        command
    };
    let band = json(&mut eval(&file), "eval");
    assert_eq!((&band["value"]["reference"], &band["value"]["unit"]), (&"none".into(), &"1".into()));
    assert!(band["value"]["reduction"].as_str().unwrap().starts_with("band:"));
    assert!(band["value"]["meaning"].as_str().unwrap().contains("Y/E"));
    let every = folder.path().join("every.bbrf");
    bbrf()
        .args(["fit", "--reduce", "none", "--terms", "lambertian"])
        .arg(folder.path().join("scan.bbrf"))
        .arg("-o")
        .arg(&every)
        .assert()
        .success()
        .stdout(contains("every wavelength (101 with a model)"));
    let result = json(&mut eval(&every), "eval");
    let rows = result["rows"].as_array().unwrap();
    assert!(rows[..2 * 101].iter().all(|row| row["value"] == 0.0), "at 90 degrees a Lambertian term is exactly 0");
    assert!(rows[2 * 101]["value"].as_f64().unwrap() > 0.0);
    bbrf().args(["eval", "--help"]).assert().success().stdout(contains("The column `value` is the sum"));
}

#[test]
fn a_fit_prints_value_and_uncertainty_alike_and_says_that_a_radiance_has_no_albedo() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let text = stdout(bbrf().arg("fit").arg(&file));
    assert!(text.contains("0.96827 ± 0.00018, and 0.51 % shared"), "{text}");
    assert!(text.contains("of its amplitude") && text.contains("of their r.m.s."), "{text}");
    let radiance = stdout(bbrf().args(["fit", "--measurement", "radiance"]).arg(&file));
    assert!(radiance.contains("are amplitudes in that unit, no albedo"), "{radiance}");
    assert!(!text.contains("no albedo"), "{text}");
}

#[test]
fn a_geometry_without_a_value_fails_with_its_line_and_is_never_nan() {
    let folder = tempfile::tempdir().unwrap();
    let (model, geometry) = (folder.path().join("m.json"), folder.path().join("g.csv"));
    let term = r#"{"terms":[{"kind":"torrance-sparrow","intensity":1,"roughness":0.1,"refractive_index":1.5}]}"#;
    std::fs::write(&model, term).unwrap();
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n90,180,90,0\n").unwrap();
    let run = bbrf().args(["eval", "--model"]).arg(&model).arg("--geometry").arg(&geometry).assert().code(1);
    let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
    assert!(text.ends_with("90,180,90,0,\n"), "{text}");
    run.stderr(contains("line 2"));
}

#[test]
fn a_parameter_beyond_the_range_of_numbers_is_undefined_and_never_nan_or_infinite() {
    let folder = tempfile::tempdir().unwrap();
    let (model, geometry) = (folder.path().join("m.json"), folder.path().join("g.csv"));
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n30,180,30,0\n").unwrap();
    for (roughness, index) in [("0.1", "1e200"), ("1e-160", "1.5")] {
        let term = format!(
            r#"{{"terms":[{{"kind":"torrance-sparrow","intensity":1,"roughness":{roughness},"refractive_index":{index},
               "distribution":"beckmann"}}]}}"#
        );
        std::fs::write(&model, term).unwrap();
        let run = bbrf().args(["eval", "--factors", "--model"]).arg(&model).arg("--geometry").arg(&geometry).assert();
        let run = run.code(1).stderr(contains("line 2").and(contains("no finite value")));
        let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}

#[test]
fn a_wrong_call_is_status_2_with_what_is_expected() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let fails = |arguments: &[&str], message: &'static str| {
        bbrf().args(arguments).arg(&file).assert().code(2).stdout("").stderr(contains(message));
    };
    fails(&["fit", "--measurement", "nothing"], "radiance, white, dark, scan");
    fails(&["fit", "--terms", "phong"], "torrance-sparrow");
    fails(&["fit", "--terms", "lambertian,luminescent"], "cannot be told apart");
    fails(&["fit", "--terms", "lambertian,lambertian"], "asked for twice");
    fails(&["fit", "--reference", "same-geometry"], "states its reference as `fixed-geometry(0,45)`");
    fails(&["fit", "--reduce", "band:620-500"], "FROM below TO");
    fails(&["fit", "--reduce", "band:900-1000"], "780");
    fails(&["export", "--to", "csv", "--measurement", "nothing"], "nothing");
    bbrf().args(["fit", "absent.bbrf"]).assert().code(2).stderr(contains("absent.bbrf"));
    bbrf().args(["frobnicate"]).assert().code(2);
}

#[test]
fn a_damaged_file_is_named_and_never_fitted() {
    let folder = tempfile::tempdir().unwrap();
    let file = fitted(folder.path());
    let bytes = std::fs::read(&file).unwrap();
    let undamaged = bbrf().arg("fit").arg(&file).output().unwrap().stdout;
    let mut refused = 0;
    for eighth in 0..8 {
        let mut damaged = bytes.clone();
        let place = bytes.len() * (2 * eighth + 1) / 16;
        damaged[place..place + 64].fill(0x5a);
        std::fs::write(&file, &damaged).unwrap();
        let code = bbrf().arg("validate").arg(&file).assert().get_output().status.code();
        assert!(matches!(code, Some(1 | 2)), "byte {place}: {code:?}");
        // Damage in what this reader does not need is a finding; a number is never taken from it.
        let fit = bbrf().arg("fit").arg(&file).output().unwrap();
        if fit.status.code() == Some(0) {
            assert_eq!(fit.stdout, undamaged, "byte {place}");
        } else {
            assert_eq!(fit.status.code(), Some(2), "byte {place}");
            assert!(String::from_utf8_lossy(&fit.stderr).contains("fitted.bbrf"), "byte {place}");
            refused += 1;
        }
    }
    assert!(refused >= 4, "{refused} of 8 refused");
    std::fs::write(&file, &bytes[..1000]).unwrap();
    bbrf().arg("fit").arg(&file).assert().code(2).stderr(contains("fitted.bbrf"));
    let code = bbrf().arg("validate").arg(&file).assert().get_output().status.code();
    assert!(matches!(code, Some(1 | 2)), "{code:?}");
}

#[test]
fn one_bad_file_of_several_does_not_stop_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let good = fitted(folder.path());
    let bad = folder.path().join("bad.bbrf");
    std::fs::write(&bad, b"not HDF5").unwrap();
    let out = folder.path().join("out");
    let run = bbrf().arg("fit").arg(&bad).arg(&good).arg("-o").arg(&out).assert().code(2);
    run.stdout(contains("roughness")).stderr(contains("bad.bbrf"));
    assert!(out.join("fitted.bbrf").exists());
}

#[test]
fn rules_are_listed_and_explained() {
    let rules = json(bbrf().args(["rules", "--json"]), "rules");
    let list = rules["rules"].as_array().unwrap();
    assert!(list.len() >= 20);
    for rule in list {
        let id = rule["id"].as_str().unwrap();
        assert!(id.starts_with("bbrf:1.0:"), "{id}");
        bbrf().args(["explain", id]).assert().success();
    }
    let explained = stdout(bbrf().args(["explain", "BB0403"]));
    for part in ["geometry.unknown", "Rows of a sample SHOULD have a geometry.", "error under --profile archive"] {
        assert!(explained.contains(part), "{part}: {explained}");
    }
    bbrf().args(["explain", "no.such-rule"]).assert().code(2);
}
