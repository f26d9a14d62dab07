//! What accuracy costs: the best rungs are marked, a wish takes a rung, and an answer can be run as it stands.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod common {
    pub mod bispectral;
    pub mod ladders;
}

use bbrf::container::read_file;
use bbrf::cost::{Ladder, Meaning, Rung, Task, Timing, Wish, mark_best};
use common::ladders::{bbrf, cost, matrix, scan, words};
use predicates::str::contains;

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
        axis: "error".to_owned(),
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
