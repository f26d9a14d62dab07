//! A disk that is full: the old file or the new one, whole, no rest beside it, and the command says so with status 2.
#![cfg(all(feature = "write", unix))]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use std::collections::BTreeMap;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bbrf::container::{open_verified, write_file};
use bbrf::dataset::{Document, Measurement};

/// Names the folder that the outer process mounted for the inner one.
const SMALL_DISK: &str = "BBRF_SMALL_DISK";
/// Size of that disk.
const DISK_KIB: usize = 1024;

fn bbrf() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin("bbrf"))
}

fn document() -> Document {
    let large = Measurement { id: documents::id("large"), ..documents::scan(12, 60) };
    let mut document = documents::small();
    document.measurements.push(large);
    document
}

/// Every file of a folder with its bytes.
fn content(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.clone(), std::fs::read(path).unwrap())).collect()
}

/// The commands that write, each with what it writes.
fn commands(input: &Path, folder: &Path) -> Vec<(Vec<String>, PathBuf)> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let word = |path: &Path| path.to_str().unwrap().to_owned();
    let input = word(input);
    let with = |name: &str, words: &[&str]| {
        let output = folder.join(name);
        let words = words.iter().map(|word| (*word).to_owned()).chain(["-o".to_owned(), word(&output)]);
        (words.collect::<Vec<_>>(), output)
    };
    vec![
        with("a.bbrf", &["import", &word(&manifest)]),
        with("a.bbrf", &["fit", &input, "--measurement", "large"]),
        with("a.bbrf", &["migrate", &input, "--anonymise"]),
        with("a.csv", &["export", &input, "--to", "csv", "--measurement", "large"]),
        with("a.json", &["export", &input, "--to", "json"]),
        with("a.html", &["report", &input]),
    ]
}

fn refused(arguments: &[String], run: &Output) {
    let said = String::from_utf8_lossy(&run.stderr);
    assert_eq!(run.status.code(), Some(2), "{arguments:?}: {said}");
    let output = arguments.last().unwrap();
    assert!(said.contains(output.as_str()), "{arguments:?} does not name its output: {said}");
    let why = ["No space left", "File too large"];
    assert!(why.iter().any(|why| said.contains(why)), "{arguments:?} does not say why: {said}");
    assert!(said.contains("make room"), "{arguments:?} does not say what to do: {said}");
}

/// Does what follows in a mount of its own, of this process alone; without root where the system lets users do so.
#[test]
fn a_full_disk_leaves_the_old_file_and_status_2() {
    let folder = tempfile::tempdir().unwrap();
    let script = format!(
        "mount -t tmpfs -o size={DISK_KIB}k none \"$1\" && touch \"$2\" && exec \"$3\" --exact inside --nocapture"
    );
    let mounted = folder.path().join("mounted");
    let disk = folder.path().join("disk");
    std::fs::create_dir(&disk).unwrap();
    let run = Command::new("unshare")
        .args(["--mount", "--map-root-user", "sh", "-c", &script, "sh"])
        .args([&disk, &mounted, &std::env::current_exe().unwrap()])
        .env(SMALL_DISK, &disk)
        .output();
    if !mounted.exists() {
        let why = run.map_or_else(|error| error.to_string(), |run| String::from_utf8_lossy(&run.stderr).into_owned());
        eprintln!("skipped: no disk can be mounted here: {}", why.trim());
        return;
    }
    let run = run.unwrap();
    let said = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{said}{}", String::from_utf8_lossy(&run.stderr));
    assert!(said.contains("refused and left the old file"), "the inner test did not run: {said}");
    println!("{}", said.lines().filter(|line| line.contains("refused and")).collect::<String>());
}

#[test]
fn inside() {
    let Some(disk) = std::env::var_os(SMALL_DISK).map(PathBuf::from) else { return };
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bbrf");
    write_file(&document(), &input).unwrap();
    let filler = disk.join("filler");
    let (mut kept, mut written) = (0, 0);
    for (arguments, output) in commands(&input, &disk) {
        // An output that was there before, and one that was not.
        for old in [Some(&b"the old file"[..]), None] {
            for free_kib in [0, 4, 32, 64, 128, 256, DISK_KIB - 4] {
                std::fs::remove_file(&output).ok();
                if let Some(old) = old {
                    std::fs::write(&output, old).unwrap();
                }
                std::fs::write(&filler, vec![1; (DISK_KIB - 4 - free_kib) << 10]).unwrap();
                let before = content(&disk);
                let run = bbrf().args(&arguments).output().unwrap();
                if run.status.success() {
                    written += 1;
                    let after = content(&disk);
                    assert_eq!(after.len(), before.len() + usize::from(old.is_none()), "{arguments:?}");
                    assert_ne!(after.get(&output), before.get(&output), "{arguments:?}");
                    if output.extension().is_some_and(|extension| extension == "bbrf") {
                        open_verified(&output).unwrap();
                    }
                } else {
                    kept += 1;
                    refused(&arguments, &run);
                    assert!(
                        content(&disk) == before,
                        "{arguments:?}, {free_kib} KiB free: something else is there now"
                    );
                }
                std::fs::remove_file(&filler).unwrap();
            }
        }
        std::fs::remove_file(&output).ok();
    }
    println!("full disk: {kept} writes refused and left the old file, {written} had room enough");
    assert!(kept > 0 && written > 0);
}

/// The limit of the shell: the process is killed by a signal at the byte where it reaches it, or told, as it asks.
#[test]
fn a_limit_of_file_size_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("input.bbrf");
    write_file(&document(), &input).unwrap();
    let out = folder.path().join("out");
    for (signal, told) in [("trap '' XFSZ; ", true), ("", false)] {
        for (arguments, output) in commands(&input, &out) {
            std::fs::remove_dir_all(&out).ok();
            std::fs::create_dir(&out).unwrap();
            std::fs::write(&output, "the old file").unwrap();
            // 8 blocks of 512 bytes: less than any output needs.
            let script = format!("{signal}ulimit -f 8; exec \"$0\" \"$@\"");
            let program = assert_cmd::cargo::cargo_bin("bbrf");
            let run = Command::new("sh").arg("-c").arg(script).arg(program).args(&arguments).output().unwrap();
            assert_eq!(std::fs::read(&output).unwrap(), b"the old file", "{arguments:?}");
            if told {
                refused(&arguments, &run);
                assert_eq!(content(&out).len(), 1, "{arguments:?} leaves something beside its output");
            } else {
                assert!(run.status.signal().is_some(), "{arguments:?}: {:?}", run.status);
            }
        }
    }
}
