//! What a file says of its parts can be stated by the names of their fields, and the page of inputs lists every key.
#![allow(clippy::unwrap_used, reason = "a test")]

use std::path::Path;

use bbrf::dataset::{Document, Symmetry};
use bbrf::import::{ImportError, KEYS, Options, import};

const TABLE: &str = "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value,sigma\n0,0,30,0,0.8,0.01\n";

fn imported(keys: &str) -> Result<Document, ImportError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.csv");
    std::fs::write(&path, format!("# quantity: radiance-factor\n# instrument: PR-650\n# sample: sheet\n{keys}{TABLE}"))
        .unwrap();
    import(&[path], &Options::default())
}

#[test]
fn particulars_are_stated_by_the_names_of_their_fields() {
    let keys = "# instrument.visual-field-deg: 0.3\n# instrument.distance_mm: 800\n\
                # instrument.calibration-0.certificate: 113\n# instrument.calibration-0.expires: 2028-01-10\n\
                # sample.symmetry: isotropic\n# sample.width-mm: 50\n# conditions.operator: A. Person\n\
                # conditions.temperature-celsius: 23.5\n# document.contact: 12\n";
    let document = imported(keys).unwrap();
    let instrument = &document.instruments[0];
    assert!((instrument.spot_mm().unwrap() - 4.188_799).abs() < 1e-6, "{:?}", instrument.spot_mm());
    assert_eq!(instrument.calibration[0].expires.as_deref(), Some("2028-01-10"));
    // A certificate is a text though it reads as a number.
    assert_eq!(instrument.calibration[0].certificate.as_deref(), Some("113"));
    assert_eq!(document.contact.as_deref(), Some("12"));
    assert_eq!(document.samples[0].symmetry, Some(Symmetry::Isotropic));
    assert_eq!(document.measurements[0].conditions.temperature_celsius.map(|t| t.get()), Some(23.5));
    assert_eq!(document.measurements[0].direction_tests.len(), 1);
}

#[test]
fn a_field_that_there_is_not_is_refused_with_its_line() {
    for (key, expected) in [
        ("instrument.colour: red", "a field of that part"),
        ("sample.symmetry: round", "isotropic"),
        ("instrument.distance-mm: far", "f64"),
        ("instrument.calibration-3.date: 2026-01-01", "a field of that part"),
        ("conditions.: x", "one of"),
        ("light.distance-mm: 100", "without a light"),
    ] {
        let error = imported(&format!("# {key}\n")).unwrap_err().to_string();
        assert!(error.contains(expected), "{key}: {error}");
    }
}

#[test]
fn a_percentage_is_no_certified_factor() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let mut options = Options::default();
    options.settings.state("certified-factor", "99").unwrap();
    let error = import(&[root], &options).unwrap_err().to_string();
    assert!(error.contains("divide a percentage by 100"), "{error}");
}

#[test]
fn values_in_per_cent_are_noticed() {
    let document = imported("").unwrap();
    assert!(document.provenance.receipts[0].notices.is_empty());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.csv");
    std::fs::write(&path, format!("# quantity: radiance-factor\n{}", TABLE.replace("0.8", "80"))).unwrap();
    let document = import(&[path], &Options::default()).unwrap();
    assert!(document.provenance.receipts[0].notices.iter().any(|notice| notice.text.contains("per cent")));
}

#[test]
fn the_page_of_inputs_lists_every_key_and_flag() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/inputs.md")).unwrap();
    let flags = bbrf::quantity::Flag::ALL.map(bbrf::quantity::Flag::name);
    for name in KEYS.iter().chain(&flags) {
        assert!(page.contains(&format!("`{name}`")), "docs/inputs.md lacks `{name}`");
    }
}
