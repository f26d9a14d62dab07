//! Files that were written once, for their version, and are read for ever: to the digest and to the value.
//!
//! No variable of the environment rewrites them. A new version of the standard adds a file
//! (`cargo run --example conformance_kit -- golden testdata/golden PYTHON`).
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use bbrf::container::{Limits, layout, read_bytes};
use bbrf::validate::{Status, validate_bytes};
use conformance::golden::{LIST, add, add_values, bytes, folder, sha256, values};

/// A golden file as the list has it.
struct Golden {
    file: String,
    bytes: Vec<u8>,
    sha256: String,
    digest: String,
    values: String,
}

fn listed() -> Vec<Golden> {
    let list = std::fs::read_to_string(folder().join(LIST)).unwrap();
    let golden = |line: &str| {
        let [file, sha256, digest, values] = line.split(',').map(str::to_owned).collect::<Vec<_>>().try_into().unwrap();
        Golden { bytes: bytes(&file).unwrap(), file, sha256, digest, values }
    };
    list.lines().map(golden).collect()
}

#[test]
fn yesterdays_file_is_read_with_its_digest_and_its_values() {
    for Golden { file, bytes, digest, values: expected, .. } in listed() {
        let opened = read_bytes(&bytes, &Limits::default()).unwrap();
        assert_eq!(opened.computed_digest.as_str(), digest, "{file}");
        assert_eq!(opened.stored_digest, Some(digest), "{file}");
        assert_eq!(opened.mismatched, Vec::<String>::new(), "{file}");
        let expected = std::fs::read_to_string(folder().join(expected)).unwrap();
        let found = values(&opened.document);
        assert!(expected.lines().count() > 100, "{file}");
        for (number, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
            assert_eq!(found, expected, "{file}, line {}", number + 1);
        }
        assert_eq!(found.lines().count(), expected.lines().count(), "{file}");
        assert_eq!(validate_bytes(&bytes).status(), Status::Valid, "{file}");
    }
}

#[test]
fn no_golden_file_was_changed() {
    let mut expected = BTreeSet::from([LIST.to_owned()]);
    for golden in listed() {
        assert_eq!(sha256(&golden.bytes), golden.sha256, "{} is not what was written once: restore it", golden.file);
        expected.extend([golden.file, golden.values]);
    }
    let (mut there, mut size) = (BTreeSet::new(), 0);
    for entry in std::fs::read_dir(folder()).unwrap().map(Result::unwrap) {
        there.insert(entry.file_name().into_string().unwrap());
        size += entry.metadata().unwrap().len();
    }
    assert_eq!(there, expected);
    assert!(size < 200_000, "{size} bytes");
}

#[test]
fn the_current_version_has_a_golden_file() {
    let name = format!("bbrf-{}-", layout::VERSION);
    assert!(listed().iter().any(|golden| golden.file.starts_with(&name)), "none for {}", layout::VERSION);
}

#[test]
fn a_golden_file_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    add_values(folder.path(), "a", &conformance::clean()).unwrap();
    add(folder.path(), "a", b"first", "", "a").unwrap();
    let before = std::fs::read(folder.path().join("a.bbrf.gz")).unwrap();
    assert!(add_values(folder.path(), "a", &conformance::clean()).is_err());
    assert!(add(folder.path(), "a", b"second", "", "a").is_err());
    assert_eq!(std::fs::read(folder.path().join("a.bbrf.gz")).unwrap(), before);
}

#[test]
fn the_reader_in_python_gets_the_same_digest() {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return;
    };
    let reader = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/read_bbrf.py");
    let unpacked = tempfile::tempdir().unwrap();
    for golden in listed() {
        let path = unpacked.path().join(&golden.file);
        std::fs::write(&path, &golden.bytes).unwrap();
        let read = Command::new(&python).arg(&reader).arg(&path).output().unwrap();
        assert!(read.status.success(), "{}: {}", golden.file, String::from_utf8_lossy(&read.stderr));
        let read: serde_json::Value = serde_json::from_slice(&read.stdout).unwrap();
        assert_eq!(read["digest"], golden.digest, "{}", golden.file);
    }
}
