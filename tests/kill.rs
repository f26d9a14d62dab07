//! A process killed at any moment while it writes leaves the old file or the new one.
#![cfg(all(feature = "write", unix))]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use bbrf::container::{open_verified, write_file};
use bbrf::dataset::Document;

const CHILD: &str = "BBRF_KILL_CHILD";
const KILLS: u64 = 30;

fn titled(title: &str) -> Document {
    let large = bbrf::dataset::Measurement { id: documents::id("large"), ..documents::scan(20, 40) };
    let mut document = Document { title: Some(title.to_owned()), ..documents::small() };
    document.measurements.push(large);
    document
}

/// What the child does: overwrite the file with two documents in turn until it is killed.
#[test]
fn child() {
    let Ok(path) = std::env::var(CHILD) else { return };
    let documents = [titled("one"), titled("two")];
    for turn in 0.. {
        write_file(&documents[turn % 2], Path::new(&path)).unwrap();
    }
}

#[test]
fn a_killed_writer_leaves_the_old_file_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.bbrf");
    write_file(&titled("one"), &path).unwrap();
    for kill in 0..KILLS {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child"])
            .env(CHILD, &path)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Spread over start, encoding, writing, syncing and renaming.
        std::thread::sleep(Duration::from_millis(20 + kill * 37 % 150));
        child.kill().unwrap();
        child.wait().unwrap();
        let title = open_verified(&path).unwrap().title.unwrap();
        assert!(title == "one" || title == "two", "{title}");
    }
    for entry in std::fs::read_dir(folder.path()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(name == "scan.bbrf" || (name.starts_with('.') && name.ends_with(".partial")), "{name}");
    }
    // What the killed ones left is removed by the next that writes.
    write_file(&titled("one"), &path).unwrap();
    let names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["scan.bbrf"]);
}
