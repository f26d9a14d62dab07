//! The table CSV.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use bbrf::dataset::Document;
use bbrf::import::{ImportError, Options, import};
use bbrf::quantity::{EmissionAxis, Flag, QuantityKind, Reference};
use spectra::Folder;

fn read(text: &str) -> Result<Document, ImportError> {
    let folder = Folder::new();
    import(&[folder.write("table.csv", text)], &Options::default())
}

fn says(text: &str, parts: &[&str]) {
    let message = read(text).unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn a_full_table() {
    let text = "# quantity: radiance-factor\n# part: total\n# reference: same-geometry\n# reference_light: same\n\
        # normalised-at: emission\n# basis: energy\n# title: Sample A\n# sample: A\n# angles: signed, mirror-at-equal\n\
        # excitation_nm: 365\n# bandpass_nm: 8\n\
        theta_i_deg,theta_v_deg,emission_nm,value,sigma,flag\n\
        20,40,504,0.5,0.01,\n20,40,500,0.4,0.01,noisy|low-light\n-20,0,500,,,below-detection\n";
    let document = read(text).unwrap();
    let scan = document.measurement("scan").unwrap();
    assert_eq!(scan.shape(), (2, 2));
    assert_eq!(scan.values.row(0).to_vec(), [0.4, 0.5]);
    assert!(scan.flags_at(0, 0).contains(Flag::Noisy) && scan.flags_at(0, 0).contains(Flag::LowLight));
    assert!(scan.values[(1, 0)].is_nan() && scan.flags_at(1, 0).contains(Flag::BelowDetection));
    assert!(scan.values[(1, 1)].is_nan() && scan.flags_at(1, 1).contains(Flag::NotMeasured));
    assert_eq!(scan.quantity.reference, Reference::SameGeometry);
    assert_eq!(scan.excitations[0].wavelength_nm, Some(365.0));
    assert_eq!(scan.acquisitions[0].geometry.unwrap().incidence.phi_deg(), 180.0);
    assert_eq!(document.title.as_deref(), Some("Sample A"));
    assert!(scan.quantity.unstated_fields().is_empty());
}

#[test]
fn a_table_without_wavelengths_is_one_band() {
    let text = "# quantity: luminance-factor\n# band_nm: 500-620\n\
        theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value\n20,180,40,0,0.5\n30,180,40,0,0.6\n";
    let document = read(text).unwrap();
    let scan = document.measurement("scan").unwrap();
    assert!(matches!(scan.emission, EmissionAxis::Band { band: Some(band) } if band.to_nm == 620.0));
    assert_eq!(scan.quantity.kind, QuantityKind::LuminanceFactor);
    let unfilled = &document.provenance.receipts[0].unfilled;
    assert!(unfilled.contains(&"measurements/scan/quantity/reference".to_owned()), "{unfilled:?}");
}

#[test]
fn what_a_table_may_not_say() {
    let header = "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value\n";
    says(&format!("# quantty: radiance-factor\n{header}0,0,0,0,1\n"), &["line 1", "`quantty`"]);
    says(&format!("# quantity: reflectance\n{header}0,0,0,0,1\n"), &["line 1", "`reflectance`", "radiance-factor"]);
    says(&format!("{header}0,0,0,0,1\n0,0,95,0,1\n"), &["line 3", "95"]);
    says(&format!("{header}0,0,0,0,\n"), &["line 2", "a flag that says why"]);
    says(&format!("{header}0,0,0,0,nan\n"), &["line 2", "`nan`"]);
    says(&format!("{header}0,0,0,0,1\n0,0,0,0,2\n"), &["line 3", "line 2"]);
    says(&format!("{header}0,0,0,0\n"), &["line 2", "4 fields"]);
    says("theta_i_deg,theta_v_deg,value\n10,20,1\n", &["line 2", "sign convention"]);
    says("theta_i_deg,theta_v_deg,value,colour\n10,20,1,2\n", &["line 1", "`colour`"]);
}

#[test]
fn the_order_of_rows_is_that_of_their_column() {
    let text = "# angles: full\ntheta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value,order,repeat\n\
        10,0,0,0,1,2,\n20,0,0,0,2,0,\n10,0,0,0,3,1,2\n";
    let document = read(text).unwrap();
    let scan = document.measurement("scan").unwrap();
    assert_eq!(scan.values.column(0).to_vec(), [2.0, 3.0, 1.0]);
    assert_eq!(scan.acquisitions.iter().map(|row| row.order).collect::<Vec<_>>(), [0, 1, 2]);
}

#[test]
fn tables_of_spreadsheets_are_read() {
    let plain = "# angles: full\ntheta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,emission_nm,value,flag\n\
        10,0,20,0,380.5,1.25,\n10,0,20,0,390,,not-measured\n";
    let quoted = "# angles: full\n\"theta_i_deg\",\"phi_i_deg\",\"theta_v_deg\",\"phi_v_deg\",\"emission_nm\",\"value\",\"flag\"\n\
        10,0,20,0,380.5,1.25,\"\"\n10,0,20,0,390,NaN,not-measured\n";
    let comma = "# angles: full\ntheta_i_deg;phi_i_deg;theta_v_deg;phi_v_deg;emission_nm;value;flag\n\
        10;0;20;0;380,5;1,25;\n10;0;20;0;390;;not-measured\n";
    let expected = format!("{:?}", read(plain).unwrap().measurements);
    for text in [quoted, comma] {
        assert_eq!(format!("{:?}", read(text).unwrap().measurements), expected);
    }
}

#[test]
fn an_expanded_uncertainty_is_divided_by_its_factor_once() {
    let table =
        |key: &str| format!("{key}theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,value,sigma\n0,0,45,0,0.5,0.02\n");
    for (key, sigma, stated) in
        [("", 0.02, None), ("# coverage-factor: 1\n", 0.02, None), ("# coverage-factor: 2\n", 0.01, Some(2.0))]
    {
        let document = read(&table(key)).unwrap();
        let uncertainty = &document.measurements[0].uncertainty;
        assert_eq!(uncertainty.standard.as_ref().unwrap()[(0, 0)], sigma, "{key}");
        assert_eq!(uncertainty.statement.coverage_factor.map(bbrf::quantity::Finite::get), stated);
    }
    says(&table("# coverage-factor: 0\n"), &["line 1", "positive"]);
}
