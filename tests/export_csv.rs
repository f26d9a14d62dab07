//! A table that is exported and imported has the same rows.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::tree::Group;
use bbrf::container::{open_verified, write_file};
use bbrf::dataset::{Document, Excitation, Extension, Measurement};
use bbrf::export::table_csv;
use bbrf::import::{Options, import};
use bbrf::quantity::{Band, Bandpass, EmissionAxis, Flag, Uncertainty};

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

/// Exports, imports, and compares rows, values and flags to the bit; returns what was listed as lost.
fn assert_same_rows(document: &Document, measurement: &Measurement) -> (Document, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let mut text = Vec::new();
    let lost = table_csv::write(document, measurement, &mut text).unwrap();
    std::fs::write(&path, &text).unwrap();
    let imported = import(std::slice::from_ref(&path), &Options::default()).unwrap();
    let again = imported.measurement(measurement.id.as_str()).unwrap();
    let rows = |of: &Measurement| -> Vec<_> {
        let plain = |row: &bbrf::dataset::Acquisition| {
            let mut row = row.clone();
            row.repeats = 1;
            row.quality_code = None;
            row
        };
        of.acquisitions.iter().map(plain).collect()
    };
    assert_eq!(rows(again), rows(measurement), "{}", measurement.id);
    let bits = |values: &ndarray::ArcArray2<f64>| values.mapv(|value| if value.is_nan() { 0 } else { value.to_bits() });
    assert_eq!(bits(&again.values), bits(&measurement.values), "{}", measurement.id);
    assert_eq!(again.flags, measurement.flags);
    assert_eq!(again.uncertainty.standard.as_ref().map(bits), measurement.uncertainty.standard.as_ref().map(bits));
    assert_eq!(again.emission.wavelengths(), measurement.emission.wavelengths());
    (imported, lost)
}

fn simulated(folder: &Path) -> PathBuf {
    let (scan, file) = (Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan"), folder.join("a.bbrf"));
    bbrf().arg("import").arg(scan.join("scan.csv")).arg("-o").arg(&file).assert().success();
    file
}

#[test]
fn every_measurement_of_the_simulated_scan() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = open_verified(&simulated(folder.path())).unwrap();
    document.extensions = vec![Extension { domain: documents::id("org.example.arm"), content: Group::default() }];
    for id in ["scan", "radiance", "white", "dark"] {
        let (again, _) = assert_same_rows(&document, document.measurement(id).unwrap());
        assert_eq!(again.license, document.license, "{id}");
    }
    let (_, lost) = assert_same_rows(&document, document.measurement("scan").unwrap());
    assert!(lost.iter().any(|line| line.contains("derivation")), "{lost:?}");
    assert!(lost.iter().any(|line| line.contains("shared uncertainty")), "{lost:?}");
    assert!(lost.iter().any(|line| line.contains("org.example.arm")), "{lost:?}");
}

#[test]
fn a_band_with_repeats_times_and_its_particulars() {
    let mut document = documents::small();
    let mut band = document.measurement("scan").unwrap().clone();
    let rows = band.acquisitions.len();
    band.id = documents::id("band");
    band.emission = EmissionAxis::Band { band: Some(Band { from_nm: 500.0, to_nm: 620.5 }) };
    band.values = ndarray::ArcArray2::from_shape_fn((rows, 1), |(row, _)| row as f64 / 7.0);
    band.flags = ndarray::ArcArray2::zeros((rows, 1));
    (band.values[(0, 0)], band.flags[(0, 0)]) = (f64::NAN, Flag::Saturated.bit());
    band.uncertainty = Uncertainty::default();
    band.excitations = vec![Excitation {
        light: Some(document.lights[0].id.clone()),
        wavelength_nm: Some(365.5),
        fwhm_nm: Some(10.25),
        filter: Some("UG1".into()),
        ..Excitation::default()
    }];
    for (row, acquisition) in band.acquisitions.iter_mut().enumerate() {
        acquisition.geometry = None;
        acquisition.excitation = Some(0);
        acquisition.order = u32::try_from(row / 2 + 5).unwrap();
        acquisition.time = Some(format!("2024-05-01T10:00:0{row}+09:00"));
        acquisition.exposure_ms = Some(12.5 + row as f64);
    }
    document.measurements.push(band.clone());
    let (again, _) = assert_same_rows(&document, &band);
    let imported = again.measurement("band").unwrap();
    assert_eq!((&imported.emission, &imported.excitations), (&band.emission, &band.excitations));
    assert_eq!(imported.quantity, band.quantity);
    assert_eq!((&imported.sample, &imported.instrument), (&band.sample, &band.instrument));
    assert_eq!((&again.license, &again.citation), (&document.license, &document.citation));
    assert_eq!(again.samples[0].simulated, document.samples[0].simulated);
}

#[test]
fn one_bandpass_is_kept_and_several_are_listed() {
    let mut document = documents::small();
    let scan = document.measurement("scan").unwrap().clone();
    let (again, _) = assert_same_rows(&document, &scan);
    let EmissionAxis::Wavelengths(axis) = &again.measurement("scan").unwrap().emission else { return };
    assert!(matches!(&axis.bandpass, Bandpass::Stated { fwhm_nm, .. } if fwhm_nm == &[8.0]));
    let mut several = scan;
    several.quantity.certified_factor = vec![0.9; several.emission.len()];
    document.measurements[1] = several.clone();
    let lost = table_csv::write(&document, &several, &mut Vec::new()).unwrap();
    assert!(lost.iter().any(|line| line.starts_with("the certified factor of ")), "{lost:?}");
}

#[test]
fn the_command_lists_what_is_lost_and_does_not_overwrite_its_input() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.bbrf");
    write_file(&documents::small(), &file).unwrap();
    let before = std::fs::read(&file).unwrap();
    let export = |to: &str, output: &Path| {
        let mut command = bbrf();
        command.args(["export", "--to", to, "--measurement", "scan"]).arg(&file).arg("-o").arg(output);
        command
    };
    let link = folder.path().join("b.bbrf");
    std::fs::hard_link(&file, &link).unwrap();
    for output in [file.clone(), folder.path().join("./a.bbrf"), link] {
        for to in ["json", "csv"] {
            export(to, &output).assert().code(2).stderr(predicates::str::contains("would be overwritten"));
            assert_eq!(std::fs::read(&file).unwrap(), before);
        }
    }
    let stderr = predicates::str::contains("not in the table: the shared uncertainty component `certificate`");
    export("csv", &folder.path().join("a.csv")).assert().success().stderr(stderr);
}

/// A column of uncertainties alone leaves open whether they are expanded.
#[test]
fn a_table_says_that_its_uncertainties_are_standard() {
    let document = documents::small();
    let measurement = document.measurement("scan").unwrap();
    let text = |measurement: &Measurement| {
        let mut text = Vec::new();
        table_csv::write(&document, measurement, &mut text).unwrap();
        String::from_utf8(text).unwrap()
    };
    assert!(measurement.uncertainty.standard.is_some());
    assert!(text(measurement).lines().any(|line| line == "# coverage-factor: 1"));
    let without = Measurement { uncertainty: Uncertainty::default(), ..measurement.clone() };
    assert!(!text(&without).contains("coverage"));
}
