//! A few rows of a large file are had without reading the rest of it.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use assert_cmd::Command;
use bbrf::container::{ReadError, open_verified, read_part, write_file};
use bbrf::dataset::{Acquisition, Document, Measurement};
use bbrf::quantity::Uncertainty;
use ndarray::ArcArray2;

/// The scan of the documents, so many times over that its matrices lie in several chunks; no digit repeats.
fn large(folder: &tempfile::TempDir) -> (std::path::PathBuf, Measurement) {
    let scan = documents::scan(5, 40);
    let columns = scan.emission.len();
    let rows = 4_000_000 / 8 / columns;
    let pseudo = |row: usize, column: usize| ((row * 7919 + column * 104_729) % 1_000_003) as f64 / 999_983.0;
    let values = ArcArray2::from_shape_fn((rows, columns), |(row, column)| pseudo(row, column));
    let acquisitions: Vec<Acquisition> = (0..rows)
        .map(|row| Acquisition {
            order: row as u32,
            excitation: None,
            ..scan.acquisitions[row % scan.acquisitions.len()].clone()
        })
        .collect();
    let measurement = Measurement {
        flags: ArcArray2::from_shape_fn((rows, columns), |(row, _)| u16::from(row % 11 == 0) << 6),
        uncertainty: Uncertainty {
            standard: Some(values.mapv(|value| value / 100.0).into_shared()),
            ..scan.uncertainty
        },
        acquisitions,
        values,
        derivation: None,
        direction_tests: Vec::new(),
        sample: None,
        instrument: None,
        white_reference: None,
        excitations: Vec::new(),
        ..scan
    };
    let path = folder.path().join("large.bbrf");
    let document = Document { measurements: vec![measurement.clone()], ..Document::default() };
    write_file(&document, &path).unwrap();
    (path, measurement)
}

#[test]
fn rows_are_those_of_the_whole_file_and_the_rest_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = large(&folder);
    assert_eq!(open_verified(&path).unwrap().measurements[0].values, whole.values);
    let rows = whole.acquisitions.len();
    for wanted in [vec![0], vec![rows - 1], vec![5, 6, 7, rows / 2, rows - 2, rows - 1]] {
        let part = read_part(&path, whole.id.as_str(), |row, _| wanted.contains(&row)).unwrap();
        let found = part.measurement;
        for (k, row) in wanted.iter().enumerate() {
            assert_eq!(found.acquisitions[k], whole.acquisitions[*row]);
            assert_eq!(found.values.row(k), whole.values.row(*row), "row {row}");
            assert_eq!(found.flags.row(k), whole.flags.row(*row), "flags of row {row}");
            let sigma = |m: &Measurement, row: usize| m.uncertainty.standard.as_ref().unwrap().row(row).to_vec();
            assert_eq!(sigma(&found, k), sigma(&whole, *row), "uncertainty of row {row}");
        }
        assert_eq!(found.acquisitions.len(), wanted.len());
        assert_eq!((found.quantity, found.emission), (whole.quantity.clone(), whole.emission.clone()));
        assert_eq!(part.file_bytes, std::fs::metadata(&path).unwrap().len());
    }
    let one = read_part(&path, whole.id.as_str(), |row, _| row == 3).unwrap();
    assert!(one.bytes_read < one.file_bytes / 2, "{} of {} bytes", one.bytes_read, one.file_bytes);
}

#[test]
fn a_measurement_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = large(&folder);
    let error = read_part(&path, "nothing", |_, _| true).unwrap_err();
    assert!(matches!(error, ReadError::Missing { .. }), "{error}");
    assert!(error.to_string().contains("/measurement/nothing"), "{error}");
}

#[test]
fn a_damaged_chunk_is_refused_and_the_others_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = large(&folder);
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 3;
    bytes[middle] ^= 1;
    std::fs::write(&path, bytes).unwrap();
    let read = |row: usize| read_part(&path, whole.id.as_str(), |k, _| k == row);
    let rows = whole.acquisitions.len();
    let refused = (0..rows).step_by(rows / 40).filter(|row| read(*row).is_err()).count();
    assert!(refused > 0 && refused < 30, "{refused} of 40 rows refused");
}

#[test]
fn the_command_exports_one_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let (path, whole) = large(&folder);
    let geometry = whole.acquisitions[1].geometry.unwrap();
    let angles = [geometry.incidence.theta_deg(), geometry.incidence.phi_deg()];
    let text = format!("{},{},{},{}", angles[0], angles[1], geometry.viewing.theta_deg(), geometry.viewing.phi_deg());
    let export = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("bbrf").unwrap();
        command.args(["export", "--to", "csv"]).arg(&path).args(arguments);
        command.output().unwrap()
    };
    let output = export(&["--measurement", whole.id.as_str(), "--geometry", &text]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).unwrap();
    let expected =
        whole.acquisitions.iter().filter(|row| row.geometry == Some(geometry)).count() * whole.emission.len();
    assert_eq!(table.lines().filter(|line| !line.starts_with('#')).count(), expected + 1);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("bytes read") && said.contains("bbrf validate"), "{said}");
    let none = export(&["--measurement", whole.id.as_str(), "--rows", "99999999..100000000"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&none.stderr).contains("no such row"));
}
