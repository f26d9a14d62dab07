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

#[test]
fn what_was_assumed_is_a_line_and_all_of_it_on_demand() {
    let folder = Folder::new();
    let scan = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let said = |arguments: &[&str]| {
        let output = folder.path().join("out.bbrf");
        let run = bbrf().arg("import").arg(&scan).args(arguments).arg("-o").arg(output).assert().success();
        String::from_utf8(run.get_output().stdout.clone()).unwrap()
    };
    let (short, long) = (said(&[]), said(&["--verbose"]));
    let count = |text: &str, start: &str| text.lines().filter(|line| line.starts_with(start)).count();
    assert_eq!((count(&short, "assumed:"), count(&short, "not stated:")), (1, 1), "{short}");
    assert!(short.contains("--verbose") && !long.contains("--verbose"), "{short}");
    assert!(count(&long, "assumed:") > 1, "{long}");
    assert!(short.len() < long.len());
    // What is cut is cut between words.
    let assumed = short.lines().find(|line| line.starts_with("assumed:")).unwrap();
    let begun: Vec<&str> =
        assumed.split([';', ':']).map(str::trim).filter_map(|part| part.strip_suffix(" ...")).collect();
    assert!(!begun.is_empty(), "{assumed}");
    for part in begun {
        assert!(long.contains(&format!("{part} ")), "`{part}` ends within a word: {assumed}");
    }
}

#[test]
fn a_table_says_its_geometry_and_role_itself() {
    let folder = Folder::new();
    let table = folder.write("t.csv", "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value\n0,0,45,0,0.5\n");
    for option in [["--role", "lamp"], ["--pattern", "ti{theta_i}_tv{theta_v}.txt"], ["--geometry", "0,0,10,0"]] {
        let output = folder.path().join("out.bbrf");
        let run = bbrf().arg("import").arg(&table).args(option).arg("-o").arg(&output).assert().code(2);
        run.stderr(contains(option[0]).and(contains("a table")));
        assert!(!output.exists());
    }
}

#[test]
fn an_error_in_a_key_names_its_line() {
    let folder = Folder::new();
    let rows = "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value\n0,0,45,0,0.5\n";
    folder.write("white.txt", good(2.0));
    folder.write("a.txt", good(1.0));
    let manifest = "file,role,theta_i_deg,theta_v_deg\nwhite.txt,white,0,45\na.txt,sample,0,10\n";
    let angles = "# angles: signed, mirror-at-equal\n";
    for (name, text, line) in [
        ("table.csv", format!("# title: t\n# certified-factor: tile\n{rows}"), 2),
        ("header.csv", format!("# title: t\n# sample: s\n{}", rows.replace("value", "order")), 3),
        ("percent.csv", format!("# title: t\n{angles}# certified-factor: 99\n{manifest}"), 3),
        ("no-file.csv", format!("{angles}# title: t\n# certified-factor: nowhere.csv\n{manifest}"), 3),
        ("reference.csv", format!("{angles}# title: t\n# reference: fixed-geometry(10,45)\n{manifest}"), 3),
        ("coverage.csv", format!("{angles}# title: t\n# coverage-factor: 2\n{manifest}"), 3),
    ] {
        let input = folder.write(name, text);
        let output = folder.path().join("out.bbrf");
        let format: &[&str] = if name == "header.csv" { &["--format", "table"] } else { &[] };
        let run = bbrf().arg("import").arg(&input).args(format).arg("-o").arg(output).assert().code(2);
        run.stderr(contains(format!("{name}, line {line}:")));
    }
}
