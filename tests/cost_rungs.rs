//! Every rung of every ladder is run by its command, and gives the error that the ladder states.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod common {
    pub mod bispectral;
    pub mod ladders;
}

use std::path::{Path, PathBuf};

use bbrf::container::read_file;
use bbrf::cost::parameter_distance;
use common::ladders::{bbrf, cost, matrix, run, rung_of, scan, words};
use predicates::str::contains;
use serde_json::Value;

/// Every number of the terms of a fit beside its uncertainty.
fn parameters(fit: &Value) -> Vec<(f64, f64)> {
    let terms = fit["models"][0]["terms"].as_array().unwrap();
    let of =
        |parameter: &Value| (parameter["value"].as_f64().unwrap(), parameter["standard_uncertainty"].as_f64().unwrap());
    terms.iter().flat_map(|term| term["parameters"].as_object().unwrap().values().map(of)).collect()
}

#[test]
fn the_error_of_a_fit_is_the_distance_of_its_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let file = scan(folder.path());
    let ladder = cost("fit", &file, &[]);
    let reference =
        run(&["fit", file.to_str().unwrap(), "--nodes", "48x9x4", "--tolerance", "1e-14"].map(str::to_owned), "fit");
    for rung in ladder["rungs"].as_array().unwrap() {
        let name = rung["name"].as_str().unwrap();
        let fit = run(&words(&ladder, rung), "fit");
        let pairs = parameters(&fit).into_iter().zip(parameters(&reference));
        let distance = pairs.map(|((own, _), (other, sigma))| ((own - other) / sigma).abs()).fold(0.0, f64::max);
        let stated = rung["error"].as_f64().unwrap();
        // Numbers are printed with so many digits that a distance of 1e-9 shows.
        assert!((stated - distance).abs() < 1e-9 + 1e-6 * stated, "{name}: {stated} {distance}");
    }
    assert!(["2x1x1, 1e-2", "tolerance 1e0"].iter().all(|name| rung_of(&ladder, name)["error"].as_f64() > Some(1e-6)));
    assert_eq!(words(&ladder, rung_of(&ladder, "tolerance 1e-8")), ["fit", file.to_str().unwrap()]);
}

#[test]
fn bands_are_judged_by_roughness_and_index_of_the_fit_at_every_wavelength() {
    let folder = tempfile::tempdir().unwrap();
    let file = scan(folder.path());
    let ladder = cost("fit", &file, &["--reduce", "none"]);
    let fitted = |mut words: Vec<String>| {
        let out = folder.path().join("out.bbrf");
        words.extend(["-o".to_owned(), out.to_str().unwrap().to_owned()]);
        bbrf().args(&words).assert().success();
        read_file(&out).unwrap().document.models.remove(0)
    };
    let effort = ["fit", file.to_str().unwrap(), "--reduce", "none", "--nodes", "48x9x4", "--tolerance", "1e-14"];
    let reference = fitted(effort.map(str::to_owned).to_vec());
    for rung in ladder["rungs"].as_array().unwrap() {
        let distance = parameter_distance(&fitted(words(&ladder, rung)), &reference).unwrap();
        let stated = rung["error"].as_f64().unwrap();
        assert!((stated - distance).abs() <= 1e-9 * distance, "{}: {stated} {distance}", rung["name"]);
    }
    let luminance = rung_of(&ladder, "reduce luminance");
    assert!(luminance["error"].as_f64().unwrap() > 0.0 && luminance["second_error"].is_null());
    let line = words(&ladder, luminance).join(" ");
    assert!(line.ends_with("--reduce luminance") && !line.contains("--reduce none"), "{line}");
    assert!(words(&ladder, rung_of(&ladder, "2x1x1")).join(" ").ends_with("--reduce none --nodes 2x1x1"));
}

#[test]
fn the_error_of_a_prediction_is_its_largest_colour_difference() {
    let folder = tempfile::tempdir().unwrap();
    let file = matrix(folder.path());
    let lights = ["--light", "D65", "--light", "FL11"];
    let ladder = cost("eval", &file, &lights);
    let labs = |value: &Value| -> Vec<Vec<f64>> {
        let of = |one: &Value| if one["lab"].is_array() { one["lab"].clone() } else { one["colour"]["lab"].clone() };
        let predictions = value["predictions"].as_array().unwrap().iter();
        predictions.map(|one| serde_json::from_value(of(one)).unwrap()).collect()
    };
    let exact = run(&words(&ladder, rung_of(&ladder, "integrals")), "donaldson-predict");
    for rung in ladder["rungs"].as_array().unwrap() {
        let name = rung["name"].as_str().unwrap();
        let schema = if name == "integrals" { "donaldson-predict" } else { "donaldson-predict-sampled" };
        let found = run(&words(&ladder, rung), schema);
        let difference =
            |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let worst = labs(&found).iter().zip(&labs(&exact)).map(difference).fold(0.0, f64::max);
        let stated = rung["error"].as_f64().unwrap();
        assert!((worst - stated).abs() < 1e-9 + 1e-9 * worst, "{name}: {worst} {stated}");
    }
    let error = |name: &str| rung_of(&ladder, name)["error"].as_f64().unwrap();
    assert!(error("product 1 nm") < 0.05 && error("product 1 nm") < error("product 20 nm"));
    let same = (error("colour 5 nm") - error("product 5 nm")).abs();
    assert!(same < 1e-9, "a colour from three numbers is that of the spectrum: {same}");
}

#[test]
fn a_way_to_store_says_its_bytes_and_loses_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let file = scan(folder.path());
    let ladder = cost("storage", &file, &[]);
    let before = read_file(&file).unwrap();
    for rung in ladder["rungs"].as_array().unwrap() {
        let name = rung["name"].as_str().unwrap();
        let mut words = words(&ladder, rung);
        let output = folder.path().join("stored.bbrf");
        let place = words.iter().position(|word| word == "-o").unwrap();
        words[place + 1] = output.to_str().unwrap().to_owned();
        bbrf().args(&words).assert().success();
        let after = read_file(&output).unwrap();
        let is_single = name.ends_with("single");
        let pairs = before.document.measurements.iter().zip(&after.document.measurements);
        let changes = pairs.flat_map(|(a, b)| {
            let (values, sigma) = (a.values.iter().zip(b.values.iter()), &a.uncertainty.standard);
            let sigma = sigma.iter().flatten().zip(b.uncertainty.standard.iter().flatten());
            values.chain(sigma).filter(|(a, _)| a.is_finite() && **a != 0.0).map(|(a, b)| ((b - a) / a).abs())
        });
        assert_eq!(Some(changes.fold(0.0, f64::max)), rung["error"].as_f64(), "{name}");
        assert_eq!(is_single, rung["error"].as_f64() != Some(0.0));
        if !is_single {
            assert_eq!(Some(output.metadata().unwrap().len()), rung["bytes"].as_u64(), "{name}");
            assert_eq!(after.stored_digest, before.stored_digest, "{name}: the digests of a file do not depend on it");
        }
        bbrf().arg("validate").arg(&output).assert().success();
        assert_eq!(after.stored_digest.as_deref(), Some(after.computed_digest.as_str()));
    }
    let bytes = |name: &str| rung_of(&ladder, name)["bytes"].as_u64().unwrap();
    assert!(bytes("deflate 9, single") < bytes("deflate 9") && bytes("deflate 9") < bytes("deflate 0"));
}

/// Scan, matrix and terms in one file, and a list of geometries.
fn whole(folder: &Path) -> (PathBuf, PathBuf) {
    let (scan, matrix, out, list) = (scan(folder), matrix(folder), folder.join("whole.bbrf"), folder.join("g.csv"));
    bbrf().arg("fit").arg(scan).arg("--donaldson").arg(matrix).arg("-o").arg(&out).assert().success();
    let text = "# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n20,20\n-60,10\n45,40\n";
    std::fs::write(&list, text).unwrap();
    (out, list)
}

#[test]
fn the_error_of_a_complete_model_is_the_difference_of_its_radiance() {
    let folder = tempfile::tempdir().unwrap();
    let (file, list) = whole(folder.path());
    let id = read_file(&file).unwrap().document.models[0].id.to_string();
    let model = ["--model", &id, "--geometry", list.to_str().unwrap(), "--light", "FL11"];
    let ladder = cost("eval", &file, &model);
    let rows = |value: &Value| value["under"]["rows"].as_array().unwrap().clone();
    let total = |row: &Value| -> Vec<f64> {
        row["total"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
    };
    let totals = |value: &Value| -> Vec<Vec<f64>> { rows(value).iter().map(total).collect() };
    let relative = |(found, expected): (&Vec<f64>, &Vec<f64>)| {
        let (difference, whole) = found
            .iter()
            .zip(expected)
            .filter(|(_, expected)| expected.is_finite())
            .fold((0.0, 0.0), |(difference, whole), (a, b)| (difference + (a - b).powi(2), whole + b * b));
        (difference / whole).sqrt()
    };
    let reference = run(&words(&ladder, rung_of(&ladder, "one light, uncertainties")), "eval-complete");
    let rungs = ladder["rungs"].as_array().unwrap();
    assert_eq!(rungs.len(), 9);
    for rung in rungs {
        let name = rung["name"].as_str().unwrap();
        let found = run(&words(&ladder, rung), "eval-complete");
        let worst = totals(&found).iter().zip(&totals(&reference)).map(relative).fold(0.0, f64::max);
        let stated = rung["error"].as_f64().unwrap();
        assert!((worst - stated).abs() <= 1e-12 + 1e-9 * stated, "{name}: {worst} {stated}");
        let has_sigma = rows(&found)[0]["total_standard_uncertainty"].is_array();
        assert_eq!(has_sigma, name.ends_with("uncertainties"), "{name}");
    }
    let error = |name: &str| rung_of(&ladder, name)["error"].as_f64().unwrap();
    assert_eq!(error("one light, values"), 0.0, "values alone are those beside the uncertainties");
    assert!(error("own light, values, product 1 nm") < error("own light, values, product 20 nm"));
    let eval = |more: &[&str]| {
        let mut command = bbrf();
        command.args(["cost", "eval"]).arg(&file).args(model).args(["--patience", "0"]).args(more);
        command.assert()
    };
    eval(&["--light", "A"]).code(2).stderr(contains("found 2 lights; expected one"));
    bbrf().args(["cost", "eval", "--model", &id]).arg(&file).assert().code(2).stderr(contains("--geometry"));
    let values = |more: &[&str]| {
        let mut command = bbrf();
        let line = ["eval", "--geometry", list.to_str().unwrap(), "--light", "A", "--values", "--by"];
        command.args(line).args(more).arg("--model").arg(&file).assert()
    };
    values(&["product", "--step", "99"]).code(2).stderr(contains("0.5 to 50"));
    values(&["colour"]).code(2).stderr(contains("expected integrals or product"));
    let csv = values(&["product"]).success().get_output().stdout.clone();
    let header = "theta_i_deg,theta_v_deg,emission_nm,luminescent,diffuse,specular,total\n";
    assert!(String::from_utf8(csv).unwrap().starts_with(header));
}
