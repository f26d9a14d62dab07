//! The uncertainty of a prediction is what predictions scatter by, and what cannot be formed is said.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod documents;
    pub mod scans;
}

use std::path::Path;

use assert_cmd::Command;
use bbrf::container::write_file;
use bbrf::dataset::{Document, Model, predict};
use bbrf::fit::{FitOptions, Share, fit_measurement};
use bbrf::quantity::{Component, CorrelatedOver, Geometry, Reference, SignHabit};
use common::documents::measured_document;
use common::scans::{Random, Truth, paper_grid};
use ndarray::Axis;

const TRUTH: Truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.15, index_minus_one: 0.5 };

fn in_plane(theta_i: f64, theta_v: f64) -> Geometry {
    Geometry::from_signed(theta_i, theta_v, SignHabit::MirrorAtEqual).unwrap()
}

fn document(grid: &[Geometry], bands: usize, random: &mut Random) -> Document {
    let fixed = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    let mut document = measured_document(grid, fixed, &vec![TRUTH; bands], 0.01, random);
    document.measurements[0].uncertainty.components =
        vec![Component::new("certified factor", vec![0.005], CorrelatedOver::All)];
    document
}

fn fitted(document: &Document, options: &FitOptions) -> Model {
    fit_measurement(document, &document.measurements[0], options).unwrap()
}

/// Of one value, and at the middle one of three wavelengths with roughness and index in common, or with nothing.
#[test]
fn the_uncertainty_of_a_prediction_is_the_scatter_of_predictions_over_refits() {
    let grid = paper_grid();
    let mut random = Random::new(51);
    let at =
        [in_plane(0.0, 45.0), in_plane(30.0, 30.0), in_plane(75.0, 75.0), in_plane(20.0, 35.0), in_plane(85.0, 60.0)];
    let trials = 400;
    for (bands, share) in [(1, Some(Share::Shape)), (3, Some(Share::Shape)), (3, None)] {
        let reduction = if bands > 1 { "none" } else { "auto" }.parse().unwrap();
        let options = FitOptions { reduction, share, ..FitOptions::default() };
        let (mut found, mut claims): ([Vec<f64>; 5], [f64; 5]) = Default::default();
        for _ in 0..trials {
            let model = fitted(&document(&grid, bands, &mut random), &options);
            let terms = model.terms_at(bands / 2).unwrap();
            for (k, geometry) in at.iter().enumerate() {
                found[k].push(predict(&terms, geometry, &Reference::None).unwrap().total());
                let uncertainty = model.prediction_uncertainty(bands / 2, geometry, &Reference::None).unwrap();
                claims[k] += uncertainty.standard.unwrap().powi(2);
                assert!((uncertainty.shared_relative.unwrap() - 0.005).abs() < 1e-12, "{uncertainty:?}");
            }
        }
        for (k, list) in found.iter().enumerate() {
            let mean = list.iter().sum::<f64>() / f64::from(trials);
            let scatter = (list.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(trials - 1)).sqrt();
            let ratio = (claims[k] / f64::from(trials)).sqrt() / scatter;
            println!("{bands} {share:?}, {:?}: scatter {scatter:.3e}, claimed over it {ratio:.3}", at[k].signed_deg());
            // The scatter of 400 is itself known to 3.5 %.
            assert!((ratio - 1.0).abs() < 4.0 * 0.0354, "{bands} {share:?}, {k}: {ratio}");
        }
    }
}

#[test]
fn a_prediction_is_least_certain_where_nothing_was_measured() {
    let is_near = |g: &Geometry| g.incidence.theta_deg() <= 50.0 && g.viewing.theta_deg() <= 50.0;
    let grid: Vec<Geometry> = paper_grid().into_iter().filter(is_near).collect();
    let model = fitted(&document(&grid, 1, &mut Random::new(52)), &FitOptions::default());
    let terms = model.terms_at(0).unwrap();
    let relative = |theta: f64| {
        let geometry = in_plane(theta, theta);
        let value = predict(&terms, &geometry, &Reference::None).unwrap().total();
        model.prediction_uncertainty(0, &geometry, &Reference::None).unwrap().standard.unwrap() / value
    };
    let list = [30.0, 60.0, 70.0, 80.0].map(relative);
    assert!(list.is_sorted() && list[3] > 3.0 * list[0], "{list:?}");
}

fn eval(model: &str, geometry: &Path, more: &[&str]) -> (String, String) {
    let mut command = Command::cargo_bin("bbrf").unwrap();
    let output = command.args(["eval", "--model", model, "--geometry"]).arg(geometry).args(more).output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success(), "{err}");
    (out, err)
}

/// A folder with a fitted file of that many wavelengths, and a list of two geometries.
fn folder(bands: usize) -> (tempfile::TempDir, String, std::path::PathBuf, Model) {
    let folder = tempfile::tempdir().unwrap();
    let mut document = document(&paper_grid(), bands, &mut Random::new(53));
    let reduction = if bands > 1 { "none" } else { "auto" };
    let model = fitted(&document, &FitOptions { reduction: reduction.parse().unwrap(), ..FitOptions::default() });
    document.models.push(model.clone());
    let file = folder.path().join("fitted.bbrf");
    write_file(&document, &file).unwrap();
    let geometry = folder.path().join("angles.csv");
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n0,0,45,180\n30,0,30,180\n").unwrap();
    (folder, file.display().to_string(), geometry, model)
}

#[test]
fn eval_prints_the_uncertainty_beside_the_value() {
    let (_folder, file, geometry, model) = folder(1);
    let (out, err) = eval(&file, &geometry, &["--uncertainty"]);
    assert_eq!(err, "");
    let lines: Vec<&str> = out.lines().collect();
    let header = "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value,standard_uncertainty,shared_relative_uncertainty";
    assert_eq!(lines[0], header);
    for (line, geometry) in lines[1..].iter().zip([in_plane(0.0, 45.0), in_plane(30.0, 30.0)]) {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let expected = model.prediction_uncertainty(0, &geometry, &Reference::None).unwrap().standard.unwrap();
        assert!((fields[5] / expected - 1.0).abs() < 1e-9, "{line}: {expected}");
        assert_eq!(fields[6], 0.005);
    }
    let (plain, _) = eval(&file, &geometry, &[]);
    assert!(!plain.contains("uncertainty"));
    let (json, _) = eval(&file, &geometry, &["--uncertainty", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["rows"][0]["standard_uncertainty"].as_f64().unwrap() > 0.0);
    let (json, _) = eval(&file, &geometry, &["--json"]);
    assert!(!json.contains("uncertainty"));
}

#[test]
fn every_wavelength_of_a_spectral_model_has_its_band_and_what_is_missing_is_named() {
    let (_folder, file, geometry, model) = folder(3);
    let (out, err) = eval(&file, &geometry, &["--uncertainty"]);
    assert!(out.lines().skip(1).all(|line| line.split(',').nth(6).unwrap().parse::<f64>().unwrap() > 0.0), "{out}");
    assert_eq!(err, "");
    let folder = tempfile::tempdir().unwrap();
    let lacking = folder.path().join("lacking.bbrf");
    let mut document = document(&paper_grid(), 3, &mut Random::new(53));
    // As another program may write it: of the amplitudes the variance alone.
    let common: Vec<usize> = [2, 3].to_vec();
    let covariance = model.covariance.select(Axis(1), &common).select(Axis(2), &common).into_shared();
    let covariance_parameters = model.covariance_parameters[2..].to_vec();
    document.models.push(Model { covariance, covariance_parameters, ..model });
    write_file(&document, &lacking).unwrap();
    let (out, err) = eval(&lacking.display().to_string(), &geometry, &["--uncertainty"]);
    assert!(out.lines().skip(1).all(|line| line.split(',').nth(6) == Some("")), "{out}");
    assert!(err.contains("6 values have no standard uncertainty"), "{err}");
    assert!(err.contains("`lambertian.albedo` with `torrance-sparrow.roughness`"), "{err}");
}

#[test]
fn a_model_in_json_may_bring_its_covariance() {
    let folder = tempfile::tempdir().unwrap();
    let (model, geometry) = (folder.path().join("model.json"), folder.path().join("angles.csv"));
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n60,0,0,0\n").unwrap();
    let write = |covariance: &str| {
        let text = format!("{{\"terms\": [{{\"kind\": \"lambertian\", \"albedo\": 0.8}}]{covariance}}}");
        std::fs::write(&model, text).unwrap();
    };
    let name = model.display().to_string();
    write(", \"covariance_parameters\": [\"lambertian.albedo\"], \"covariance\": [[0.0004]]");
    let (out, _) = eval(&name, &geometry, &["--uncertainty"]);
    let uncertainty: f64 = out.lines().nth(1).unwrap().split(',').nth(5).unwrap().parse().unwrap();
    assert!((uncertainty - 0.01).abs() < 1e-15, "{out}");
    write("");
    let (out, err) = eval(&name, &geometry, &["--uncertainty"]);
    assert!(out.ends_with(",\n") && err.contains("`lambertian.albedo`"), "{out}{err}");
    for (bad, why) in [
        (", \"covariance\": [[0.0004]]", "belong together"),
        (", \"covariance_parameters\": [\"lambertian.albido\"], \"covariance\": [[1]]", "lambertian.albido"),
        (", \"covariance_parameters\": [\"lambertian.albedo\"], \"covariance\": [[-1]]", "expected 0 or more"),
        (", \"covariance_parameters\": [\"lambertian.albedo\"], \"covariance\": [[1, 2]]", "expected 1 rows of 1"),
    ] {
        write(bad);
        let mut command = Command::cargo_bin("bbrf").unwrap();
        let output = command.args(["eval", "--model", &name, "--geometry"]).arg(&geometry).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains(why), "{said}");
    }
}
