//! The clean file in every encoding of another library: what is legal keeps its digest, what some program cannot read is
//! named.
//!
//! Needs the interpreter named by `BBRF_PYTHON`, with h5py; `make test` brings it.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::path::Path;
use std::process::Command;

use bbrf::validate::{Severity, validate_bytes};
use conformance::{clean_bytes, found};

#[test]
fn a_legal_encoding_keeps_the_digest_and_an_unusual_one_is_named() {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let clean = folder.path().join("clean.bbrf");
    std::fs::write(&clean, clean_bytes()).unwrap();
    let digest = validate_bytes(clean_bytes()).digest.unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance/encodings.py");
    let output = Command::new(python).arg(script).arg(&clean).arg(folder.path().join("encodings")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let listed = String::from_utf8(output.stdout).unwrap();
    assert!(listed.lines().count() >= 20, "{listed}");
    for line in listed.lines() {
        let [name, same, rule] = line.split(' ').collect::<Vec<_>>().try_into().unwrap();
        let bytes = std::fs::read(folder.path().join(format!("encodings/{name}.bbrf"))).unwrap();
        let report = validate_bytes(&bytes);
        let found = found(&bytes);
        assert!(rule == "-" || found.contains(&rule), "{name}: {found:?}");
        if same == "same" {
            assert_eq!(report.digest.as_ref(), Some(&digest), "{name}: {found:?}");
        }
        if rule == "-" {
            let errors = report.findings.iter().filter(|finding| finding.severity > Severity::Info);
            assert_eq!(errors.count(), 0, "{name}: {:#?}", report.findings);
        }
    }
}
