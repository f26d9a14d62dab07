//! The steps of `docs/pipelines.md` for a detached signature: over the digest of the content, so that it holds for every
//! copy of it, whatever program wrote the copy.
//!
//! Needs `ssh-keygen`; the copies by another program need `BBRF_PYTHON` with h5py, which `make test` brings.
#![cfg(all(feature = "write", unix))]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use bbrf::container::document_bytes;
use conformance::{clean, clean_bytes};

fn digest(file: &Path) -> Vec<u8> {
    let output = assert_cmd::Command::cargo_bin("bbrf").unwrap().args(["info", "--digest"]).arg(file).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

fn keygen(folder: &Path, arguments: &[&str], input: &[u8]) -> bool {
    use std::io::Write as _;
    let mut command = Command::new("ssh-keygen");
    command.current_dir(folder).args(arguments).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(input).unwrap();
    child.wait().unwrap().success()
}

fn verifies(folder: &Path, file: &Path) -> bool {
    let arguments = ["-Y", "verify", "-f", "signers", "-I", "lab@example.org", "-n", "bbrf", "-s", "scan.digest.sig"];
    keygen(folder, &arguments, &digest(file))
}

#[test]
fn a_signature_holds_for_every_copy_of_the_content_and_for_nothing_else() {
    if Command::new("ssh-keygen").arg("-?").output().is_err() {
        eprintln!("skipped: ssh-keygen is not installed");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("scan.bbrf"), clean_bytes()).unwrap();
    assert!(keygen(folder.path(), &["-q", "-t", "ed25519", "-N", "", "-f", "key"], b""));
    let public = fs::read_to_string(at("key.pub")).unwrap();
    fs::write(at("signers"), format!("lab@example.org namespaces=\"bbrf\" {public}")).unwrap();
    fs::write(at("scan.digest"), digest(&at("scan.bbrf"))).unwrap();
    assert!(keygen(folder.path(), &["-q", "-Y", "sign", "-f", "key", "-n", "bbrf", "scan.digest"], b""));
    assert!(verifies(folder.path(), &at("scan.bbrf")));

    let mut changed = clean();
    changed.measurements[0].values[(0, 0)] += 1e-9;
    fs::write(at("changed.bbrf"), document_bytes(&changed).unwrap().0).unwrap();
    assert!(!verifies(folder.path(), &at("changed.bbrf")), "another number");

    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("not checked with copies by h5py: BBRF_PYTHON does not name a Python interpreter");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance/encodings.py");
    let output = Command::new(python).arg(script).arg(at("scan.bbrf")).arg(at("copies")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for copy in ["contiguous", "deflate-9-alone", "big-endian", "variable-strings", "bounds-latest"] {
        let copy = at("copies").join(format!("{copy}.bbrf"));
        assert_ne!(fs::read(&copy).unwrap(), clean_bytes());
        assert!(verifies(folder.path(), &copy), "{}", copy.display());
    }
}

fn minisign(folder: &Path, arguments: &[&str]) -> bool {
    let mut command = Command::new("minisign");
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command.output().unwrap().status.success()
}

#[test]
#[ignore = "needs minisign; make test-ecosystem"]
fn minisign_vouches_for_every_copy_of_the_content_and_for_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("scan.bbrf"), clean_bytes()).unwrap();
    assert!(minisign(folder.path(), &["-G", "-W", "-p", "key.pub", "-s", "key"]));
    fs::write(at("scan.digest"), digest(&at("scan.bbrf"))).unwrap();
    assert!(minisign(folder.path(), &["-S", "-s", "key", "-m", "scan.digest"]));
    let verifies = |file: &Path| {
        fs::write(at("copy.digest"), digest(file)).unwrap();
        let arguments = ["-V", "-m", "copy.digest", "-x", "scan.digest.minisig", "-p", "key.pub"];
        minisign(folder.path(), &arguments)
    };
    // Another chunk index and another size of the file, the same content.
    let repacked = at("repacked.bbrf");
    let status = Command::new("h5repack").args(["-f", "NONE"]).arg(at("scan.bbrf")).arg(&repacked).status().unwrap();
    assert!(status.success() && verifies(&repacked));
    let mut changed = clean();
    changed.measurements[0].values[(0, 0)] += 1e-9;
    fs::write(at("changed.bbrf"), document_bytes(&changed).unwrap().0).unwrap();
    assert!(!verifies(&at("changed.bbrf")), "another number");
}
