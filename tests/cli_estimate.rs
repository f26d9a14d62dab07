//! `bbrf donaldson estimate`: from texts of two columns to a file that others can use.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod matrices;
    pub mod scans;
}

use assert_cmd::Command;
use bbrf::donaldson::Light;
use bbrf::donaldson::estimate::{Axes, Lit};
use common::matrices::Bispectral;
use common::scans::Random;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

/// What was seen under two lights of the CIE, as texts, and what it was made of.
struct Seen {
    folder: tempfile::TempDir,
    reflectance: Vec<f64>,
    emission_nm: Vec<f64>,
}

fn seen() -> Seen {
    let folder = tempfile::tempdir().unwrap();
    let nm = |from: u32| (from..=700).step_by(10).map(f64::from).collect::<Vec<f64>>();
    let axes = Axes { excitation_nm: nm(300), emission_nm: nm(400), width_nm: 10.0 };
    let bell = |nm: f64, peak: f64, width: f64| (-((nm - peak) / width).powi(2) / 2.0).exp();
    let excitation: Vec<f64> = axes.excitation_nm.iter().map(|nm| bell(*nm, 420.0, 40.0)).collect();
    let emission: Vec<f64> = axes.emission_nm.iter().map(|nm| 0.05 * bell(*nm, 520.0, 25.0)).collect();
    let made = Bispectral::usual(1);
    let reflectance: Vec<f64> = axes.emission_nm.iter().map(|nm| made.reflectance(*nm)).collect();
    let mut random = Random::new(8);
    for name in ["A", "D65"] {
        let light = Lit::of(&Light::named(name).unwrap(), &axes);
        let mut text = String::new();
        for (j, nm) in axes.emission_nm.iter().enumerate() {
            let below = (0..excitation.len()).filter(|i| axes.excitation_nm[*i] <= *nm);
            let excited: f64 = below.map(|i| light.excitation[i] * excitation[i]).sum();
            let value = reflectance[j] + emission[j] * excited / light.emission[j];
            text.push_str(&format!("{nm},{}\n", value * (1.0 + 0.005 * random.normal())));
        }
        std::fs::write(folder.path().join(format!("{name}.csv")), text).unwrap();
    }
    let shape: Vec<String> = axes.excitation_nm.iter().zip(&excitation).map(|(nm, x)| format!("{nm},{x}\n")).collect();
    std::fs::write(folder.path().join("excitation.csv"), shape.concat()).unwrap();
    Seen { folder, reflectance, emission_nm: axes.emission_nm }
}

const UNDER: [&str; 8] = ["donaldson", "estimate", "--under", "A=A.csv", "--under", "D65=D65.csv", "--noise", "0.005"];

#[test]
fn two_spectra_and_the_excitation_give_a_file_that_is_valid_and_can_be_used() {
    let seen = seen();
    let mut command = bbrf();
    command.current_dir(seen.folder.path()).args(UNDER);
    command.args(["--quantity", "radiance-factor", "--excitation", "excitation.csv", "-o", "made.bbrf", "--json"]);
    let output = command.assert().success().get_output().clone();
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let reflectance = result["reflectance"].as_array().unwrap();
    let held = reflectance
        .iter()
        .zip(&seen.reflectance)
        .filter(|(one, truth)| one["low"].as_f64().unwrap() <= **truth && **truth <= one["high"].as_f64().unwrap());
    assert!(held.count() >= 27, "{reflectance:?} {:?}", seen.reflectance);
    let range = |nm: f64| {
        let at = seen.emission_nm.iter().position(|one| *one == nm).unwrap();
        result["ranges"][at].as_str().unwrap().to_owned()
    };
    assert_eq!(range(520.0), "mixed");
    assert_ne!(range(690.0), "mixed");
    assert!(result["further_lights"].as_array().unwrap().len() > 20);
    let mut check = bbrf();
    check.current_dir(seen.folder.path()).args(["validate", "made.bbrf"]).assert().success();
    let mut predict = bbrf();
    predict.current_dir(seen.folder.path());
    predict.args(["donaldson", "predict", "made.bbrf#estimate", "--light", "D65"]).assert().success();
}

#[test]
fn without_the_excitation_the_answer_says_so_and_names_its_prior() {
    let seen = seen();
    let mut command = bbrf();
    let output = command.current_dir(seen.folder.path()).args(UNDER).args(["--quantity", "radiance-factor"]);
    let output = output.assert().success().get_output().clone();
    let text = String::from_utf8(output.stdout).unwrap();
    for said in ["excitation spectrum unknown", "that fit", "one more light that would help most", "prior: "] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn what_cannot_be_estimated_is_refused_with_what_to_do() {
    let seen = seen();
    for (arguments, said) in [
        (vec!["--under", "A=A.csv", "--noise", "0.01", "--quantity", "radiance-factor"], "1 light"),
        (vec!["--under", "A=A.csv", "--under", "D65=D65.csv", "--quantity", "radiance-factor"], "--noise"),
        (vec!["--under", "A=A.csv", "--under", "D65=D65.csv", "--noise", "0.01"], "--quantity"),
        (
            vec!["--under", "A=A.csv", "--under", "D65=D65.csv", "--noise", "0.01", "--quantity", "spectral-radiance"],
            "radiance factor",
        ),
        (vec!["--under", "A"], "LIGHT=SPECTRUM"),
        (
            vec!["--under", "A=A.csv", "--under", "A=D65.csv", "--noise", "0.01", "--quantity", "radiance-factor"],
            "one spectrum",
        ),
        (
            vec![
                "--under",
                "A=A.csv",
                "--under",
                "D65=D65.csv",
                "--noise",
                "0.01",
                "--quantity",
                "radiance-factor",
                "--emission",
                "710:800",
            ],
            "0 values",
        ),
        (vec!["--under", "A=A.csv", "--under", "D65=D65.csv", "--noise", "1e-300"], "as 0.01"),
        (vec!["--under", "A=A.csv", "--under", "D65=D65.csv", "--excitation-from", "500"], "begin at 400 nm"),
        (
            vec!["--under", "A=A.csv", "--under", "D65=none.csv", "--noise", "0.01", "--quantity", "radiance-factor"],
            "none.csv",
        ),
    ] {
        let mut command = bbrf();
        command.current_dir(seen.folder.path()).args(["donaldson", "estimate"]).args(arguments);
        let output = command.assert().code(2).get_output().clone();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(said), "{said}: {text}");
    }
}

/// What was estimated, applied to a light, is what was seen under it: steep edges included.
#[test]
fn the_estimated_matrix_gives_back_the_spectra_it_was_estimated_from() {
    let seen = seen();
    let mut command = bbrf();
    command.current_dir(seen.folder.path()).args(UNDER);
    command.args(["--quantity", "radiance-factor", "--excitation", "excitation.csv", "-o", "made.bbrf"]);
    command.assert().success();
    for light in ["A", "D65"] {
        let mut predict = bbrf();
        predict.current_dir(seen.folder.path());
        predict.args([
            "donaldson",
            "predict",
            "made.bbrf#estimate",
            "--light",
            light,
            "--luminescence",
            "factors",
            "--json",
        ]);
        let output = predict.assert().success().get_output().clone();
        let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let factors = result["predictions"][0]["radiance_factor"].as_array().unwrap();
        let text = std::fs::read_to_string(seen.folder.path().join(format!("{light}.csv"))).unwrap();
        for (line, factor) in text.lines().zip(factors) {
            let (nm, value) = line.split_once(',').unwrap();
            let (nm, value): (f64, f64) = (nm.parse().unwrap(), value.parse().unwrap());
            let found = factor.as_f64().unwrap();
            // Four standard deviations of the noise.
            assert!((found / value - 1.0).abs() < 0.02, "{light} {nm}: {found} {value}");
        }
    }
}
