//! What lies in `testdata` is what the program beside it makes.

#![allow(clippy::unwrap_used, reason = "a test may panic, also in its helpers")]

#[path = "../testdata/simulated_scan/scan/mod.rs"]
mod scan;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use scan::lamp::DIODES;
use scan::objects::OBJECTS;
use scan::{Scan, Setup};

const COMMITTED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/simulated_scan");

/// The data of a scan folder by path; not the program and its README.
fn data(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files: Vec<PathBuf> = vec!["scan.csv".into(), "truth.json".into()];
    for entry in fs::read_dir(folder.join("raw")).unwrap() {
        files.push(Path::new("raw").join(entry.unwrap().file_name()));
    }
    files.into_iter().map(|file| (file.clone(), fs::read(folder.join(file)).unwrap())).collect()
}

fn simulate(name: &str, folder: &Path) {
    let (number, object) = OBJECTS.iter().enumerate().find(|(_, object)| object.name == name).unwrap();
    Scan::simulate(&Setup::whole(&DIODES), number, object).write(folder).unwrap();
}

#[test]
fn the_committed_scan_is_what_the_program_makes() {
    let made = tempfile::tempdir().unwrap();
    simulate("fluorescence-sheet-yellow", made.path());
    let (made, committed) = (data(made.path()), data(Path::new(COMMITTED)));
    assert_eq!(made.keys().collect::<Vec<_>>(), committed.keys().collect::<Vec<_>>());
    for (file, bytes) in &made {
        assert!(committed[file] == *bytes, "{} differs from what the program makes", file.display());
    }
}

#[test]
fn every_object_makes_a_whole_scan() {
    let made = tempfile::tempdir().unwrap();
    for object in &OBJECTS {
        simulate(object.name, made.path());
        let files = data(made.path());
        assert_eq!(files.len(), 2 + 272 + 6 + 2, "{}", object.name);
        for (file, bytes) in files.iter().filter(|(file, _)| file.starts_with("raw")) {
            let text = str::from_utf8(bytes).unwrap();
            assert_eq!(bytes.len(), 6 + 11 + 101 * 17, "{}: {}", object.name, file.display());
            assert!(!text.contains("NaN") && text.starts_with(['0', '1', '3']), "{}", file.display());
        }
    }
}

#[test]
fn the_header_is_the_sum_of_the_values_and_nothing_is_on_the_wrong_side_of_the_floor() {
    for (file, bytes) in data(Path::new(COMMITTED)).iter().filter(|(file, _)| file.starts_with("raw")) {
        let text = str::from_utf8(bytes).unwrap();
        let mut lines = text.split("\r\n").skip(1);
        let header: f64 = lines.next().unwrap().parse().unwrap();
        let values: Vec<f64> = lines.filter_map(|line| line.split_once(',')).map(|(_, v)| v.parse().unwrap()).collect();
        assert!((4.0 * values.iter().sum::<f64>() / header - 1.0).abs() < 1e-3, "{}", file.display());
        assert!(values.iter().all(|value| *value >= 6.9e-8), "{}", file.display());
    }
}
