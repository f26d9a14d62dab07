//! What accuracy costs: errors are what they say, the best rungs are marked, and an answer can be run as it stands.
#![cfg(feature = "write")]
#![allow(unreachable_pub, clippy::unwrap_used, clippy::panic, reason = "a test")]

#[path = "common/bispectral.rs"]
mod bispectral;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::{read_file, write_file};
use bbrf::cost::{Ladder, Meaning, Rung, Task, Timing, Wish, mark_best};
use predicates::str::contains;
use serde_json::Value;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn timing(median: f64) -> Timing {
    Timing { median, first_quartile: median, third_quartile: median, repeats: 9, settled: true }
}

fn rung(name: &str, error: Option<f64>, seconds: f64) -> Rung {
    Rung {
        name: name.to_owned(),
        knob: "knob".to_owned(),
        options: vec!["--nodes".to_owned(), name.to_owned()],
        error,
        second_error: None,
        time: timing(seconds),
        read_time: None,
        bytes: None,
        is_best: false,
        note: None,
    }
}

fn ladder(task: Task, mut rungs: Vec<Rung>) -> Ladder {
    mark_best(&mut rungs);
    let meaning = Meaning {
        reference: "reference".to_owned(),
        error: "error".to_owned(),
        second_error: None,
        time: "time".to_owned(),
        read_time: None,
    };
    let command = ["bbrf", "fit", "my scan.bbrf"].map(str::to_owned).to_vec();
    Ladder { task, subject: "scan".to_owned(), machine: "machine".to_owned(), command, meaning, rungs }
}

#[test]
fn a_rung_is_marked_where_no_other_is_as_good_and_better_in_one() {
    let rungs = vec![
        rung("quick", Some(1.0), 1.0),
        rung("slower and worse", Some(1.5), 2.0),
        rung("middle", Some(0.1), 3.0),
        rung("as good, slower", Some(0.1), 4.0),
        rung("exact", Some(0.0), 9.0),
        rung("twin of exact", Some(0.0), 9.0),
        rung("quickest, lost", None, 0.1),
    ];
    let marks: Vec<bool> = ladder(Task::Fit, rungs).rungs.iter().map(|rung| rung.is_best).collect();
    assert_eq!(marks, [true, false, true, false, true, true, false]);
    let stored = |name, seconds, bytes| Rung { bytes: Some(bytes), ..rung(name, Some(0.0), seconds) };
    let files = vec![stored("large", 1.0, 900), stored("small", 2.0, 300), stored("neither", 3.0, 300)];
    let marks: Vec<bool> = ladder(Task::Storage, files).rungs.iter().map(|rung| rung.is_best).collect();
    assert_eq!(marks, [true, true, false]);
    let spectra = Rung { second_error: Some(0.5), ..rung("with spectra", Some(0.1), 3.0) };
    let marks = ladder(Task::Eval, vec![rung("colour only", Some(0.1), 1.0), spectra]).rungs;
    assert!(marks.iter().all(|rung| rung.is_best), "what another lacks altogether is a respect, too");
}

#[test]
fn an_error_takes_the_cheapest_rung_and_a_budget_the_most_accurate() {
    let fits = ladder(
        Task::Fit,
        vec![rung("1x1x1", Some(1.0), 1.0), rung("4x1x1", Some(0.1), 3.0), rung("9x9x9", Some(0.01), 9.0)],
    );
    let take = |max_error: Option<f64>, budget: Option<f64>| fits.answer(Wish { max_error, budget });
    let name = |max_error, budget| take(max_error, budget).unwrap().rung.map(|place| fits.rungs[place].name.clone());
    assert_eq!(name(Some(0.5), None).unwrap(), "4x1x1");
    assert_eq!(name(None, Some(3.0)).unwrap(), "4x1x1");
    assert_eq!(name(Some(1.0), Some(5.0)).unwrap(), "1x1x1");
    assert_eq!(take(None, None), None);
    assert_eq!(take(Some(0.1), None).unwrap().command.unwrap(), "bbrf fit 'my scan.bbrf' --nodes 4x1x1");
    for (error, budget) in [(Some(0.001), None), (None, Some(0.5)), (Some(0.05), Some(5.0))] {
        let none = take(error, budget).unwrap();
        assert_eq!((none.rung, none.command), (None, None));
        assert!(none.sentence.contains("9x9x9") && none.sentence.contains("1x1x1"), "{}", none.sentence);
    }
    let stored = |name, seconds, bytes| Rung { bytes: Some(bytes), ..rung(name, Some(0.0), seconds) };
    let files = ladder(Task::Storage, vec![stored("large", 1.0, 900), stored("small", 2.0, 300)]);
    let smallest = files.answer(Wish { max_error: Some(0.0), budget: None }).unwrap();
    assert_eq!(smallest.rung, Some(1), "of files the smallest");
    assert_eq!(files.answer(Wish { max_error: None, budget: Some(1.5) }).unwrap().rung, Some(0));
}

fn scan(folder: &Path) -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let file = folder.join("scan.bbrf");
    bbrf().arg("import").arg(manifest).arg("-o").arg(&file).assert().success();
    file
}

fn matrix(folder: &Path) -> PathBuf {
    let file = folder.join("orange.bbrf");
    write_file(&bispectral::document(), &file).unwrap();
    file
}

/// A result with its schema held against it.
fn json(arguments: &[&str], schema: &str) -> Value {
    let output = bbrf().args(arguments).arg("--json").assert().success().get_output().stdout.clone();
    let value: Value = serde_json::from_slice(&output).unwrap();
    let (_, form) = bbrf::cli::schemas().into_iter().find(|(name, _)| *name == schema).unwrap();
    let form = serde_json::to_value(form).unwrap();
    let faults: Vec<String> =
        jsonschema::validator_for(&form).unwrap().iter_errors(&value).map(|error| error.to_string()).collect();
    assert!(faults.is_empty(), "{faults:?}");
    value
}

/// The ladder of a file, hardly timed: the tests are about its errors.
fn cost(task: &str, file: &Path, more: &[&str]) -> Value {
    let file = file.to_str().unwrap();
    json(&[&["cost", task, file, "--patience", "0"], more].concat(), "cost")
}

fn rung_of<'a>(ladder: &'a Value, name: &str) -> &'a Value {
    let rungs = ladder["rungs"].as_array().unwrap();
    rungs.iter().find(|rung| rung["name"] == name).unwrap_or_else(|| panic!("{name} in {rungs:?}"))
}

/// The words of the command that runs a rung, without the program.
fn words(ladder: &Value, rung: &Value) -> Vec<String> {
    let list = |value: &Value| -> Vec<String> {
        value.as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
    };
    list(&ladder["command"])[1..].iter().cloned().chain(list(&rung["options"])).collect()
}

fn run(words: &[String], schema: &str) -> Value {
    json(&words.iter().map(String::as_str).collect::<Vec<_>>(), schema)
}

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
    for name in ["2x1x1, 1e-2", "tolerance 1e0", "tolerance 1e6"] {
        let rung = rung_of(&ladder, name);
        let fit = run(&words(&ladder, rung), "fit");
        let pairs = parameters(&fit).into_iter().zip(parameters(&reference));
        let distance = pairs.map(|((own, _), (other, sigma))| ((own - other) / sigma).abs()).fold(0.0, f64::max);
        let stated = rung["error"].as_f64().unwrap();
        assert!(distance > 0.0 && (stated / distance - 1.0).abs() < 1e-6, "{name}: {stated} {distance}");
    }
    assert_eq!(words(&ladder, rung_of(&ladder, "tolerance 1e-8")), ["fit", file.to_str().unwrap()]);
}

#[test]
fn bands_are_judged_by_roughness_and_index_of_the_fit_at_every_wavelength() {
    let folder = tempfile::tempdir().unwrap();
    let file = scan(folder.path());
    let ladder = cost("fit", &file, &["--reduce", "none"]);
    let luminance = rung_of(&ladder, "reduce luminance");
    assert!(luminance["error"].as_f64().unwrap() > 0.0 && luminance["second_error"].is_null());
    let line = words(&ladder, luminance).join(" ");
    assert!(line.ends_with("--reduce luminance") && !line.contains("--reduce none"), "{line}");
    bbrf().args(line.split(' ')).assert().success();
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
    for name in ["product 1 nm", "product 10 nm, single", "colour 5 nm", "factors 2 10 nm"] {
        let rung = rung_of(&ladder, name);
        let found = run(&words(&ladder, rung), "donaldson-predict-sampled");
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
    for name in ["deflate 0", "deflate 9", "chunk 16 KiB", "deflate 4, single"] {
        let rung = rung_of(&ladder, name);
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

#[test]
fn a_model_stays_up_to_date_where_its_scan_is_rounded_to_single_precision() {
    let folder = tempfile::tempdir().unwrap();
    let (file, fitted, single) =
        (scan(folder.path()), folder.path().join("fitted.bbrf"), folder.path().join("single.bbrf"));
    bbrf().arg("fit").arg(&file).arg("-o").arg(&fitted).assert().success();
    bbrf().arg("migrate").arg(&fitted).arg("-o").arg(&single).arg("--single").assert().success();
    let document = read_file(&single).unwrap().document;
    let model = &document.models[0];
    let digest = bbrf::container::measurement_digest(document.measurement(model.measurement.as_str()).unwrap());
    assert_eq!(model.data_digest, digest.unwrap());
    assert!(document.provenance.steps.iter().any(|step| step.action.contains("single precision")));
}

#[test]
fn an_answer_is_a_command_and_no_answer_is_status_1() {
    let folder = tempfile::tempdir().unwrap();
    let file = matrix(folder.path());
    let figure = folder.path().join("ladder.svg");
    let ladder = cost("eval", &file, &["--max-error", "1", "-o", figure.to_str().unwrap()]);
    let place = ladder["answer"]["rung"].as_u64().unwrap() as usize;
    let rung = &ladder["rungs"][place];
    assert!(rung["error"].as_f64().unwrap() <= 1.0);
    let line = format!("bbrf {}", words(&ladder, rung).join(" "));
    assert_eq!(ladder["answer"]["command"].as_str().unwrap(), line);
    assert!(std::fs::read_to_string(&figure).unwrap().contains("<svg"));
    let eval = |more: &[&str]| {
        let mut command = bbrf();
        command.args(["cost", "eval"]).arg(&file).args(["--patience", "0"]).args(more);
        command.assert()
    };
    eval(&["--budget", "0"]).code(1).stdout(contains("no rung has 0 s or less"));
    eval(&["--max-error", "-1"]).code(2);
    eval(&["-o", "ladder.pdf"]).code(2).stderr(contains(".svg or .png"));
    eval(&["--light", "nowhere.csv"]).code(2);
    let predict = |more: &[&str]| {
        let mut command = bbrf();
        command.args(["donaldson", "predict"]).arg(&file).args(more);
        command.assert()
    };
    predict(&["--by", "product", "--step", "0.1"]).code(2).stderr(contains("0.5 to 50"));
    bbrf().args(["fit", "--nodes", "0x1x1"]).arg(&file).assert().code(2).stderr(contains("12x3x2"));
    bbrf().args(["fit", "--tolerance", "0"]).arg(&file).assert().code(2).stderr(contains("above 0"));
}
