//! `bbrf import` on the command line: exit status, messages, whole files or none. Writing depends on the container.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use spectra::{Folder, good};

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

#[test]
fn an_error_leaves_no_file() {
    let folder = Folder::new();
    let input = folder.write("overload.txt", "19,0\r\n");
    let output = folder.path().join("out.bbrf");
    let run = bbrf().arg("import").arg(input).arg("-o").arg(&output).assert();
    run.code(2).stderr(contains("overload.txt").and(contains("overload, no data"))).stdout("");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_wrong_key_is_a_wrong_call() {
    let folder = Folder::new();
    let input = folder.write("a.txt", good(1.0));
    let output = folder.path().join("out.bbrf");
    let run = bbrf().arg("import").arg(input).args(["--set", "quantty=1", "-o"]).arg(output).assert();
    run.code(2).stderr(contains("`quantty`"));
}

#[test]
fn the_receipt_is_printed_as_json() {
    let folder = Folder::new();
    let input = folder.write("a.txt", good(1.0));
    let output = folder.path().join("out.bbrf");
    let run = bbrf().arg("import").arg(input).args(["--json", "-o"]).arg(&output).assert().success();
    let json: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    assert_eq!(json["schema"], "bbrf:import:1");
    assert_eq!(json["receipts"][0]["inputs"][0]["sha256"].as_str().unwrap().len(), 64);
    assert!(output.is_file());
}

#[test]
fn an_input_is_never_written_over() {
    let folder = Folder::new();
    let input = folder.write("ok.txt", good(1.0));
    let run = bbrf().arg("import").arg(&input).arg("-o").arg(&input).assert();
    run.code(2).stderr(contains("an input file")).stdout("");
    let rows = "file,role\nok.txt,sample\n";
    let manifest = folder.write("m.csv", rows);
    for output in ["ok.txt", "m.csv", "../x/ok.txt"] {
        let inside = folder.path().join("x");
        std::fs::create_dir_all(&inside).unwrap();
        let output = if output.starts_with("..") { inside.join("../ok.txt") } else { folder.path().join(output) };
        bbrf().arg("import").arg(&manifest).arg("-o").arg(&output).assert().code(2).stderr(contains("an input file"));
    }
    assert_eq!(std::fs::read_to_string(&input).unwrap(), good(1.0));
    assert_eq!(std::fs::read_to_string(&manifest).unwrap(), rows);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_read_once() {
    let folder = Folder::new();
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let writer = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::write(pipe, good(1.0)).unwrap()
    });
    let output = folder.path().join("out.bbrf");
    let mut call = bbrf();
    let run = call.arg("import").arg(&pipe).arg("-o").arg(&output).timeout(std::time::Duration::from_secs(20));
    run.assert().success().stdout(contains("read 1 file, 1 record"));
    writer.join().unwrap();
}
