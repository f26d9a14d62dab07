//! The floor of the instrument against the truth of the simulated scan, and what is made of a dark signal on it.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use std::path::PathBuf;

use bbrf::dataset::{Document, Measurement};
use bbrf::import::{Options, import};
use bbrf::quantity::Flag;
use spectra::Folder;

/// The simulator's floor (testdata/simulated_scan/scan/instrument.rs).
fn floor(nm: f64, exposure_ms: f64) -> f64 {
    const SHAPE: [(f64, f64); 5] =
        [(380.0, 3.400e-7), (460.0, 1.050e-7), (560.0, 7.0e-8), (680.0, 1.350e-7), (780.0, 5.318e-7)];
    let pair = SHAPE.windows(2).find(|pair| nm <= pair[1].0).unwrap();
    let ((from, low), (to, high)) = (pair[0], pair[1]);
    (6000.0 / exposure_ms).min(8.6) * low * (high / low).powf((nm - from) / (to - from))
}

fn scan_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan")
}

/// Values on the floor, those of them with the flag, and flagged ones more than 2 % above it.
fn count(measurement: &Measurement) -> (usize, usize, usize) {
    let nm = measurement.emission.wavelengths().unwrap();
    let (mut on, mut flagged, mut wrong) = (0, 0, 0);
    for (row, acquisition) in measurement.acquisitions.iter().enumerate() {
        for (column, nm) in nm.iter().enumerate() {
            let ratio = measurement.values[(row, column)] / floor(*nm, acquisition.exposure_ms.unwrap());
            let flag = measurement.flags_at(row, column).contains(Flag::BelowDetection);
            on += usize::from(ratio < 1.001);
            flagged += usize::from(ratio < 1.001 && flag);
            wrong += usize::from(ratio > 1.02 && flag);
        }
    }
    (on, flagged, wrong)
}

fn radiance(document: &Document) -> &Measurement {
    document.measurement("radiance").unwrap()
}

#[test]
fn the_floor_of_every_exposure_is_found() {
    let document = import(&[scan_folder().join("scan.csv")], &Options::default()).unwrap();
    let (on, flagged, wrong) = count(radiance(&document));
    assert!(on > 500 && flagged * 100 >= on * 97 && wrong <= 2, "{flagged} of {on}, {wrong} wrong");
    // Where one dark record alone lies on it, nothing shows that it does.
    let dark = count(document.measurement("dark").unwrap());
    assert!(dark.1 * 100 >= dark.0 * 85 && dark.2 == 0, "{dark:?}");
}

#[test]
fn a_scan_without_dark_records_flags_nothing_wrong() {
    let folder = Folder::new();
    let text = std::fs::read_to_string(scan_folder().join("scan.csv")).unwrap();
    let raw = scan_folder().join("raw");
    let kept: String = text.lines().filter(|line| !line.contains(",dark,")).map(|line| format!("{line}\n")).collect();
    let manifest = folder.write("scan.csv", kept);
    for entry in std::fs::read_dir(raw).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("raw/{}", path.file_name().unwrap().to_string_lossy());
        folder.write(&name, std::fs::read(&path).unwrap());
    }
    let document = import(&[manifest], &Options::default()).unwrap();
    let (on, flagged, wrong) = count(radiance(&document));
    assert!(flagged * 100 >= on * 97 && wrong <= 2, "{flagged} of {on}, {wrong} wrong");
}

#[test]
fn a_dark_signal_on_the_floor_is_an_upper_bound() {
    let document = import(&[scan_folder().join("scan.csv")], &Options::default()).unwrap();
    let receipt = &document.provenance.receipts[0];
    let said = |part: &str| receipt.assumptions.iter().any(|assumption| assumption.text.contains(part));
    assert!(said("raw/dark_1.txt, raw/dark_2.txt is taken off") && said("only an upper bound"));
    assert!(said("dark 6000 ms, sample and white 32 to"), "{:?}", receipt.assumptions);
    let (dark, white) = (document.measurement("dark").unwrap(), document.measurement("white").unwrap());
    let column = (40..60).find(|column| dark.flags_at(0, *column).contains(Flag::BelowDetection)).unwrap();
    let mean = (0..6).map(|row| white.values[(row, column)]).sum::<f64>() / 6.0;
    let expected = 0.99 * radiance(&document).values[(20, column)] / mean;
    let found = document.measurement("scan").unwrap().values[(20, column)];
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
}
