//! Real files, where they are beside the repository: every text imports or says why not.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use std::path::PathBuf;

use bbrf::import::{Options, import};
use bbrf::quantity::{Flag, QuantityKind};

fn texts(folder: PathBuf) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.sort();
    found
}

#[test]
fn every_real_text_imports() {
    let Some(shared) = spectra::shared() else { return };
    for path in texts(shared.join("pr650/real")) {
        let document = import(std::slice::from_ref(&path), &Options::default());
        let document = document.unwrap_or_else(|error| panic!("{error}"));
        assert!(!document.measurements.is_empty());
        for measurement in &document.measurements {
            assert_eq!(measurement.emission.len(), 101, "{}", path.display());
            assert_eq!(measurement.quantity.kind, QuantityKind::Unstated);
        }
    }
    for path in texts(shared.join("spectra")) {
        let document = import(std::slice::from_ref(&path), &Options::default());
        document.unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn every_format_example_imports_or_says_why_not() {
    let Some(shared) = spectra::shared() else { return };
    for path in texts(shared.join("pr650/format-examples")) {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let result = import(std::slice::from_ref(&path), &Options::default());
        let refused = match name.as_str() {
            "pr650_d5_overload19.txt" => Some("overload, no data"),
            "pr650_d1.txt" | "pr650_d2.txt" => Some("no spectrum"),
            "manifest_17x17_example.csv" => Some("missing"),
            _ => None,
        };
        match (refused, result) {
            (Some(words), Err(error)) => assert!(error.to_string().contains(words), "{error}"),
            (Some(words), Ok(_)) => panic!("{name} imports and should say {words}"),
            (None, result) => {
                let document = result.unwrap_or_else(|error| panic!("{error}"));
                let rows: usize = document.measurements.iter().map(|m| m.acquisitions.len()).sum();
                assert!(rows >= 1, "{name}");
            }
        }
    }
}

#[test]
fn white_paint_over_spectralon_is_a_radiance_factor() {
    let Some(shared) = spectra::shared() else { return };
    let real = shared.join("pr650/real");
    let options = Options {
        white: vec![real.join("smallsphere_spectralon_028.txt").display().to_string()],
        ..Options::default()
    };
    let paint = real.join("smallsphere_whitepaint_tungstenanduvamber_004.txt");
    let document = import(&[paint], &options).unwrap();
    let factor = document.measurement("scan").unwrap();
    assert_eq!(factor.quantity.kind, QuantityKind::RadianceFactor);
    assert_eq!(factor.quantity.reference.to_string(), "unstated");
    let sigma = factor.uncertainty.standard.as_ref().unwrap();
    let wavelengths = factor.emission.wavelengths().unwrap();
    for (column, nm) in wavelengths.iter().enumerate() {
        let (value, sigma) = (factor.values[(0, column)], sigma[(0, column)]);
        if value.is_nan() {
            assert!(factor.flags_at(0, column).contains(Flag::BelowDetection));
        } else if (450.0..=700.0).contains(nm) {
            assert!((0.3..1.3).contains(&value) && sigma > 0.0 && sigma < 0.2, "{nm}: {value} +- {sigma}");
        }
    }
}
