//! Results arrive or the command says so, and no output takes the place of another file that still matters.
#![allow(clippy::unwrap_used)]

mod documents;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::{open_verified, write_file};
use predicates::str::contains;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

/// The simulated scan under a name.
fn scan(path: PathBuf) -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    bbrf().arg("import").arg(manifest).arg("-o").arg(&path).assert().success();
    path
}

/// Linux has a device that is always full.
#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_written_is_status_2_and_never_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.bbrf");
    write_file(&documents::small(), &file).unwrap();
    let file = file.to_str().unwrap();
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let geometry = folder.path().join("g.csv");
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n0,0,45,0\n").unwrap();
    let imported = scan(folder.path().join("b/b.bbrf"));
    let imported = imported.to_str().unwrap();
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/simulated_scan/scan.csv");
    let out = folder.path().join("out.bbrf");
    let (page, out) = (folder.path().join("page.html"), out.to_str().unwrap());
    let calls: &[&[&str]] = &[
        &["--help"],
        &["--version"],
        &["validate", "--help"],
        &["import", manifest, "-o", out],
        &["fit", imported],
        &["fit", "--json", imported],
        &["eval", "--model", file, "--geometry", geometry.to_str().unwrap()],
        &["report", file, "-o", page.to_str().unwrap()],
        &["migrate", file],
        &["validate", "--json", file],
        &["validate", "--output", "sarif", file],
        &["validate", "--output", "junit", file],
        &["validate", "--output", "markdown", file],
        &["rules", "--json"],
        &["export", "--to", "csv", "--measurement", "scan", file],
        &["info", file],
        &["info", "--json", file],
        &["validate", file],
        &["rules"],
        &["schema"],
        &["export", "--to", "json", file],
        &["explain", "BB0201"],
    ];
    let command = |arguments: &[&str]| {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("bbrf"));
        command.args(arguments).stdout(full());
        command
    };
    for arguments in calls {
        let run = command(arguments).output().unwrap();
        let stderr = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains("standard output"), "{arguments:?}: {stderr}");
        let silent = command(arguments).stderr(full()).status().unwrap();
        assert_eq!(silent.code(), Some(2), "{arguments:?} with a full stderr");
    }
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_the_readers_decision() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("bbrf"));
    let status = command.arg("rules").stdout(writer).status().unwrap();
    assert_eq!(status.code(), Some(0));
}

#[test]
fn two_inputs_of_one_name_are_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (scan(folder.path().join("a/x.bbrf")), scan(folder.path().join("b/x.bbrf")));
    let out = folder.path().join("out");
    let refused = bbrf().arg("fit").args([&a, &b]).arg("-o").arg(&out).assert().code(2).stdout("");
    let both = contains(a.to_str().unwrap().to_owned());
    refused.stderr(both).stderr(contains(b.to_str().unwrap().to_owned()));
    assert!(!out.exists(), "nothing was begun");
    bbrf().arg("fit").args([&a, &a]).arg("-o").arg(&out).assert().code(2).stderr(contains("would both be written"));
    bbrf().arg("fit").args([&a, &b]).arg("-o").arg(&b).assert().code(2).stderr(contains("expected a folder"));
    bbrf().arg("fit").arg(&a).arg("-o").arg(folder.path()).assert().code(2).stderr(contains("names the file"));
    // Printed alone they do not meet: each has its result.
    let printed = bbrf().arg("fit").args([&a, &b]).assert().success();
    printed.stdout(contains(a.to_str().unwrap().to_owned())).stdout(contains(b.to_str().unwrap().to_owned()));
}

#[cfg(unix)]
#[test]
fn the_fit_of_one_file_never_replaces_another_input() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (scan(folder.path().join("a/x.bbrf")), scan(folder.path().join("y.bbrf")));
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    std::fs::hard_link(&second, out.join("x.bbrf")).unwrap();
    let refused = bbrf().arg("fit").args([&first, &second]).arg("-o").arg(&out).assert().code(2);
    refused.stderr(contains("would replace the input"));
}

#[test]
fn a_fit_onto_its_own_input_adds_the_model_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = scan(folder.path().join("x.bbrf"));
    let before = open_verified(&file).unwrap();
    bbrf().arg("fit").arg(&file).arg("-o").arg(&file).assert().success();
    let after = open_verified(&file).unwrap();
    assert_eq!((after.models.len(), &after.measurements), (1, &before.measurements));
    assert_eq!(after.provenance.receipts, before.provenance.receipts);
    bbrf().arg("validate").arg(&file).assert().success();
    bbrf().args(["fit", "--help"]).assert().success().stdout(contains("may be the FILE itself"));
}

#[test]
fn a_report_never_writes_over_its_input() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("x.bbrf");
    write_file(&documents::small(), &file).unwrap();
    let named_as_page = folder.path().join("y.html");
    std::fs::copy(&file, &named_as_page).unwrap();
    let before = std::fs::read(&file).unwrap();
    let link = folder.path().join("./x.bbrf");
    for output in [&file, &link] {
        let refused = bbrf().arg("report").arg(&file).arg("-o").arg(output).assert().code(2);
        refused.stderr(contains("would be overwritten"));
    }
    bbrf().arg("report").arg(&named_as_page).assert().code(2).stderr(contains("would be overwritten"));
    assert!(std::fs::read(&file).unwrap() == before && std::fs::read(&named_as_page).unwrap() == before);
}
