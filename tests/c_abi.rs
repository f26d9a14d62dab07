//! A C program calls the validator, with the shared and the static library, and gets what the command prints.
//!
//! Needs the folder with the libraries in `BBRF_CAPI` and a C compiler `cc`; `make test` builds them.
#![cfg(all(feature = "write", unix))]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::path::{Path, PathBuf};
use std::process::Command;

use bbrf::validate::{Status, validate_bytes};
use conformance::{FAULTS, clean_bytes};

/// The program linked in both ways.
fn programs(libraries: &Path, folder: &Path) -> Vec<PathBuf> {
    let capi = Path::new(env!("CARGO_MANIFEST_DIR")).join("capi");
    let compiled = |name: &str, link: &[String]| {
        let program = folder.join(name);
        let mut command = Command::new("cc");
        command.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"]).arg(capi.join("include"));
        let output = command.arg(capi.join("tests/validate.c")).args(link).arg("-o").arg(&program).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        program
    };
    let at = libraries.display();
    vec![
        compiled("shared", &[format!("-L{at}"), "-lbbrf".to_owned(), format!("-Wl,-rpath,{at}")]),
        compiled("static", &[format!("{at}/libbbrf.a"), "-lpthread".to_owned(), "-ldl".to_owned(), "-lm".to_owned()]),
    ]
}

#[test]
fn a_c_program_gets_the_report_of_the_command() {
    let Ok(libraries) = std::env::var("BBRF_CAPI") else {
        eprintln!("skipped: BBRF_CAPI does not name the folder of libbbrf (make test builds and sets it)");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let fault = FAULTS.iter().find(|fault| fault.rule == "digest.object").unwrap();
    std::fs::write(at("clean.bbrf"), clean_bytes()).unwrap();
    std::fs::write(at("faulty.bbrf"), fault.bytes()).unwrap();
    std::fs::write(at("text.bbrf"), "no HDF5").unwrap();
    for program in programs(Path::new(&libraries), folder.path()) {
        for (name, status) in [("clean.bbrf", 0), ("faulty.bbrf", 1), ("text.bbrf", 2), ("none.bbrf", 2)] {
            let output = Command::new(&program).arg(at(name)).output().unwrap();
            let said = String::from_utf8(output.stdout).unwrap();
            assert_eq!(output.status.code(), Some(status), "{name}: {said}");
            let (version, report) = said.split_once('\n').unwrap();
            assert_eq!(version, env!("CARGO_PKG_VERSION"));
            let command =
                assert_cmd::Command::cargo_bin("bbrf").unwrap().args(["validate", "--json"]).arg(at(name)).output();
            let command = String::from_utf8(command.unwrap().stdout).unwrap();
            assert_eq!(report, command.trim_end(), "{name}");
        }
    }
}

/// No door is more lenient than another.
#[test]
fn faults_of_the_kit_have_the_same_verdict() {
    let Ok(libraries) = std::env::var("BBRF_CAPI") else {
        eprintln!("skipped: BBRF_CAPI does not name the folder of libbbrf (make test builds and sets it)");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let program = programs(Path::new(&libraries), folder.path()).remove(0);
    // All faults of bytes and structure, and one of every other rule.
    let of_structure = |rule: &str| rule.starts_with("structure.");
    let first = |number: usize| FAULTS.iter().position(|other| other.rule == FAULTS[number].rule) == Some(number);
    let chosen = FAULTS.iter().enumerate().filter(|(number, fault)| of_structure(fault.rule) || first(*number));
    for (_, fault) in chosen {
        let file = folder.path().join(fault.file_name());
        std::fs::write(&file, fault.bytes()).unwrap();
        let expected = match validate_bytes(fault.bytes()).status() {
            Status::Valid => 0,
            Status::Invalid => 1,
            Status::Unreadable => 2,
        };
        let status = Command::new(&program).arg(&file).output().unwrap().status;
        assert_eq!(status.code(), Some(expected), "{}", fault.file_name());
    }
}
