//! A process killed at any moment while it writes leaves the old file or the new one.
//!
//! `BBRF_KILLS` sets the number of kills; `make soak-damage` asks for 500. Figures: `docs/damage.md`.
#![cfg(all(feature = "write", unix))]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;
#[path = "damaged/random.rs"]
mod random;

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use bbrf::container::{open_verified, write_file};
use bbrf::dataset::Document;
use random::Random;

const CHILD: &str = "BBRF_KILL_CHILD";
fn titled(title: &str) -> Document {
    let large = bbrf::dataset::Measurement { id: documents::id("large"), ..documents::scan(20, 40) };
    let mut document = Document { title: Some(title.to_owned()), ..documents::small() };
    document.measurements.push(large);
    document
}

/// What the child does: overwrite the file with two documents in turn until it is killed, and say when it begins.
#[test]
fn child() {
    let Ok(path) = std::env::var(CHILD) else { return };
    let documents = [titled("one"), titled("two")];
    eprintln!("begun");
    for turn in 0.. {
        write_file(&documents[turn % 2], Path::new(&path)).unwrap();
    }
}

/// A child that has begun.
fn begun(path: &Path) -> Child {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "child", "--nocapture"])
        .env(CHILD, path)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let said = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(said.into_iter().any(|line| line == "begun"), "the child did not begin");
    child
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_killed_writer_leaves_the_old_file_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.bbrf");
    let begin = Instant::now();
    write_file(&titled("one"), &path).unwrap();
    // Moments spread evenly over about three writes: encoding, writing, syncing, renaming.
    let span = 3 * begin.elapsed();
    let kills = std::env::var("BBRF_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(30);
    let mut random = Random(2026);
    let (mut unfinished, mut new) = (0, 0);
    let mut last = "one".to_owned();
    for _ in 0..kills {
        let mut child = begun(&path);
        std::thread::sleep(span.mul_f64(random.below(1 << 20) as f64 / f64::from(1 << 20)));
        child.kill().unwrap();
        child.wait().unwrap();
        let title = open_verified(&path).unwrap().title.unwrap();
        assert!(title == "one" || title == "two", "{title}");
        new += usize::from(title != last);
        last = title;
        for name in names(folder.path()) {
            assert!(name == "scan.bbrf" || (name.starts_with('.') && name.ends_with(".partial")), "{name}");
            unfinished += usize::from(name != "scan.bbrf");
        }
    }
    println!(
        "{kills} kills within {span:.0?}: {unfinished} with an unfinished file beside it, {new} after the other title"
    );
    // What the killed ones left is removed by the next that writes.
    write_file(&titled("one"), &path).unwrap();
    assert_eq!(names(folder.path()), ["scan.bbrf"]);
}
