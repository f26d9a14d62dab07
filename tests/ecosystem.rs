//! Heavier partners: h5dump reads our files, and h5repack with other filters keeps the digest. Run by
//! `make test-ecosystem`; needs Debian's hdf5-tools.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use std::path::Path;
use std::process::Command;

use bbrf::container::{read_file, write_file};

fn run(program: &str, arguments: &[&str], files: &[&Path]) -> String {
    let output = Command::new(program).args(arguments).args(files).output().unwrap();
    assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
#[ignore = "needs hdf5-tools; make test-ecosystem"]
fn h5dump_reads_every_object() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bbrf");
    write_file(&documents::small(), &path).unwrap();
    let dump = run("h5dump", &[], &[&path]);
    for part in ["wavelength_emission", "value_flag", "derivation", "separability", "H5T_CSET_UTF8", "DIMENSION_SCALE"]
    {
        assert!(dump.contains(part), "{part} is not in the dump");
    }
}

#[test]
#[ignore = "needs hdf5-tools; make test-ecosystem"]
fn a_repacked_file_has_the_same_digest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bbrf");
    let digest = write_file(&documents::small(), &path).unwrap();
    for (name, filters) in [("plain", "NONE"), ("gzip", "GZIP=9"), ("shuffle", "SHUF")] {
        let packed = folder.path().join(name);
        run("h5repack", &["-f", filters], &[&path, &packed]);
        let opened = read_file(&packed).unwrap();
        assert_eq!(opened.computed_digest, digest, "{name}");
        assert_eq!(opened.mismatched, Vec::<String>::new(), "{name}");
    }
}
