//! What the tests of ladders ask of the command.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::write_file;
use serde_json::Value;

use super::bispectral;

pub fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

pub fn scan(folder: &Path) -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let file = folder.join("scan.bbrf");
    bbrf().arg("import").arg(manifest).arg("-o").arg(&file).assert().success();
    file
}

pub fn matrix(folder: &Path) -> PathBuf {
    let file = folder.join("orange.bbrf");
    write_file(&bispectral::document(), &file).unwrap();
    file
}

/// A result with its schema held against it.
pub fn json(arguments: &[&str], schema: &str) -> Value {
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
pub fn cost(task: &str, file: &Path, more: &[&str]) -> Value {
    let file = file.to_str().unwrap();
    json(&[&["cost", task, file, "--patience", "0"], more].concat(), "cost")
}

pub fn rung_of<'a>(ladder: &'a Value, name: &str) -> &'a Value {
    let rungs = ladder["rungs"].as_array().unwrap();
    rungs.iter().find(|rung| rung["name"] == name).unwrap_or_else(|| panic!("{name} in {rungs:?}"))
}

/// The words of the command that runs a rung, without the program.
pub fn words(ladder: &Value, rung: &Value) -> Vec<String> {
    let list = |value: &Value| -> Vec<String> {
        value.as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
    };
    list(&ladder["command"])[1..].iter().cloned().chain(list(&rung["options"])).collect()
}

pub fn run(words: &[String], schema: &str) -> Value {
    json(&words.iter().map(String::as_str).collect::<Vec<_>>(), schema)
}
