//! Matrices through the command line: from the file of an instrument into ours, and out again.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

const BFC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/bispectral/synthetic.BFC");

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn imported(input: &Path, output: &Path, options: &[&str]) {
    bbrf().arg("import").arg(input).args(options).arg("-o").arg(output).assert().success();
}

#[test]
fn a_bfc_file_comes_back_from_ours_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let (file, back) = (folder.path().join("m.bbrf"), folder.path().join("back.BFC"));
    imported(Path::new(BFC), &file, &["--set", "time-zone=Z"]);
    let run = bbrf().arg("export").arg(&file).args(["--to", "bfc", "-o"]).arg(&back).assert().success();
    run.stderr(contains("not in the file: the zone of the time"));
    assert_eq!(std::fs::read(back).unwrap(), std::fs::read(BFC).unwrap());
}

#[test]
fn a_matrix_of_an_unstated_bandpass_is_valid_with_warnings_and_is_not_converted() {
    let folder = tempfile::tempdir().unwrap();
    let (file, density) = (folder.path().join("m.bbrf"), folder.path().join("density.bbrf"));
    imported(Path::new(BFC), &file, &["--geometry", "45,180,0,0"]);
    let run = bbrf().arg("validate").arg(&file).assert().success();
    run.stdout(contains("BB0304").and(contains("BB0210").not()));
    let convert = ["--to", "bispectral-luminescent-radiance-factor", "-o"];
    let run = bbrf().arg("convert").arg(&file).args(convert).arg(&density).assert().failure();
    run.stderr(contains("bandpass").or(contains("unstated")));
    assert!(!density.exists());
}

#[test]
fn a_matrix_text_is_exported_and_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    imported(Path::new(BFC), &at("m.bbrf"), &[]);
    let export = |file: &str, to: &str, output: &str| {
        bbrf().arg("export").arg(at(file)).args(["--to", to, "-o"]).arg(at(output)).assert().success();
        std::fs::read_to_string(at(output)).unwrap()
    };
    let text = export("m.bbrf", "matrix", "m.csv");
    imported(&at("m.csv"), &at("again.bbrf"), &[]);
    assert_eq!(export("again.bbrf", "matrix", "again.csv"), text);
    let table = |text: &str| text.lines().skip_while(|line| !line.starts_with("380\t")).collect::<Vec<_>>().join("\n");
    let bfc = export("again.bbrf", "bfc", "again.BFC");
    assert_eq!(table(&bfc), table(&std::fs::read_to_string(BFC).unwrap()));
}

#[test]
fn a_format_that_is_forced_is_the_one_that_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let text = folder.path().join("m.csv");
    std::fs::write(&text, "nm,300,310\n400,0.1,0.2\n410,0.3,0.4\n").unwrap();
    let output = folder.path().join("m.bbrf");
    let run = bbrf().arg("import").arg(&text).arg("-o").arg(&output).assert().code(2);
    run.stderr(contains("--set rows=emission").and(contains("--format columns")));
    let run = bbrf().arg("import").arg(&text).args(["--format", "columns", "-o"]).arg(&output).assert().success();
    run.stdout(contains("1 rows x 2"));
    let run = bbrf().arg("import").arg(&text).args(["--set", "rows=emission", "-o"]).arg(&output).assert().success();
    run.stdout(contains("matrix: unstated of the sample, 2 rows x 2"));
    let run = bbrf().arg("import").arg(&text).args(["--role", "lamp", "-o"]).arg(&output).assert().code(2);
    run.stderr(contains("--role with a matrix"));
}
