//! Files open in h5py, netCDF4 and xarray with values, units, coordinates, texts and flags; and a copy through netCDF4
//! has the same digest.
//!
//! Needs the interpreter named by `BBRF_PYTHON`, with `tests/python/requirements.txt` installed; `make test` brings it.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod documents;

use std::path::Path;
use std::process::Command;

use bbrf::container::tree::{Array, Data, Dataset, Group};
use bbrf::container::{open_verified, read_file, write_file};
use bbrf::dataset::{Extension, Measurement};
use bbrf::quantity::Flag;
use bbrf::validate::{rule, validate_bytes};

fn expected(scan: &Measurement, title: &str) -> serde_json::Value {
    let number = |value: &f64| if value.is_nan() { serde_json::Value::Null } else { (*value).into() };
    let values: Vec<Vec<_>> = scan.values.rows().into_iter().map(|row| row.iter().map(number).collect()).collect();
    let flags: Vec<Vec<u16>> = scan.flags.rows().into_iter().map(|row| row.to_vec()).collect();
    serde_json::json!({
        "title": title,
        "units": scan.quantity.kind.unit(),
        "values": values,
        "flags": flags,
        "wavelengths": scan.emission.wavelengths().unwrap(),
        "theta_i": scan.acquisitions[0].geometry.unwrap().incidence.theta_deg(),
        "coordinates": ["theta_i", "phi_i", "theta_v", "phi_v", "acquisition", "wavelength_emission"],
        "flag_masks": Flag::ALL.map(Flag::bit),
        "flag_meanings": Flag::ALL.map(Flag::name).join(" "),
    })
}

fn run_python(python: &str, arguments: [&Path; 3]) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/opens_elsewhere.py");
    let output = Command::new(python).arg(script).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn h5py_netcdf4_and_xarray_show_what_we_wrote() {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let [path, json, copy] = ["a.bbrf", "expected.json", "copy.nc"].map(|name| folder.path().join(name));
    let mut document = documents::small();
    // What netCDF changes on the way: empty axes, empty texts, arrays of one.
    document.measurements.push(documents::measurement("empty", &[], 0));
    // Axes without scales, for which netCDF makes dimensions up.
    let temperatures = Dataset::new(Array::vector(Data::F64(vec![23.0, 23.5, 24.0].into()))).with_text("units", "degC");
    let content = Group {
        attributes: [("firmware".to_owned(), Array::text("3.2"))].into(),
        datasets: vec![("temperature".to_owned(), temperatures)],
        groups: Vec::new(),
    };
    document.extensions.push(Extension { domain: documents::id("org.example.goniometer"), content });
    let digest = write_file(&document, &path).unwrap();
    let scan = document.measurement("scan").unwrap();
    std::fs::write(&json, expected(scan, document.title.as_ref().unwrap()).to_string()).unwrap();
    run_python(&python, [&path, &json, &copy]);

    let copied = read_file(&copy).unwrap();
    assert_eq!(copied.computed_digest, digest);
    assert_eq!(copied.mismatched, Vec::<String>::new());
    assert!(documents::same(&copied.document, &document));
    // Laid out by another library, and with an attribute added: neither is damage.
    for file in [&copy, &path] {
        let findings = validate_bytes(std::fs::read(file).unwrap()).findings;
        assert!(findings.iter().all(|finding| finding.rule != rule("structure.bytes").unwrap().id), "{findings:?}");
    }
    let appended = read_file(&path).unwrap();
    assert_eq!(appended.unknown, ["/@history"]);
    assert!(documents::same(&open_verified(&path).unwrap(), &document));
}
