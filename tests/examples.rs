//! The programs in `examples/` that know the specification alone: what they write is valid and read back identical, and
//! what we write they read identical.
//!
//! Needs the interpreter named by `BBRF_PYTHON`, with h5py; `make test` brings it. The one in C needs libhdf5.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;
mod documents;
mod spec;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bbrf::container::{read_file, write_file};
use bbrf::dataset::{Document, Measurement};
use bbrf::quantity::Flag;
use bbrf::validate::validate_bytes;
use conformance::FAULTS;
use serde_json::Value;

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)
}

/// Runs a Python example; `None` where there is no interpreter.
fn python(name: &str, file: &Path) -> Option<Output> {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return None;
    };
    Some(Command::new(python).arg(example(name)).arg(file).output().unwrap())
}

fn read_by_python(file: &Path) -> Option<Value> {
    let output = python("read_bbrf.py", file)?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// A number as JSON; `null` for NaN.
fn number(value: f64) -> Value {
    if value.is_nan() { Value::Null } else { value.into() }
}

fn matrix<T: Copy>(array: &ndarray::ArcArray2<T>, json: impl Fn(T) -> Value) -> Value {
    array.rows().into_iter().map(|row| row.iter().map(|value| json(*value)).collect::<Value>()).collect()
}

fn expected(measurement: &Measurement) -> Value {
    let quantity = &measurement.quantity;
    let angles = |row: &bbrf::dataset::Acquisition| -> Value {
        let geometry = row
            .geometry
            .map(|g| [g.incidence.theta_deg(), g.incidence.phi_deg(), g.viewing.theta_deg(), g.viewing.phi_deg()]);
        geometry.unwrap_or([f64::NAN; 4]).into_iter().map(number).collect()
    };
    let named: std::collections::BTreeSet<&str> = Flag::ALL
        .into_iter()
        .filter(|flag| measurement.flags.iter().any(|mask| mask & flag.bit() != 0))
        .map(Flag::name)
        .collect();
    let shared = measurement
        .uncertainty
        .components
        .iter()
        .map(|component| serde_json::json!([component.name, component.correlated_over.name(), component.relative]));
    serde_json::json!({
        "role": measurement.role.name(),
        "quantity": quantity.kind.name(),
        "units": quantity.kind.unit(),
        "part": quantity.part.name(),
        "normalised_at": quantity.normalised_at.name(),
        "basis": quantity.basis.name(),
        "reference": quantity.reference.to_string(),
        "reference_light": quantity.reference_light.to_string(),
        "value": matrix(&measurement.values, number),
        "flag": matrix(&measurement.flags, Value::from),
        "flag_names": named,
        "geometry": measurement.acquisitions.iter().map(angles).collect::<Value>(),
        "has_geometry": measurement.acquisitions.iter().map(|row| row.geometry.is_some()).collect::<Value>(),
        "wavelength_nm": measurement.emission.wavelengths(),
        "uncertainty": measurement.uncertainty.standard.as_ref().map(|standard| matrix(standard, number)),
        "shared": shared.collect::<Value>(),
    })
}

fn same(read: &Value, document: &Document, digest: &str) {
    assert_eq!(read["digest"], digest);
    assert_eq!(read.get("title").and_then(Value::as_str), document.title.as_deref());
    assert_eq!(read["measurements"].as_object().unwrap().len(), document.measurements.len());
    for measurement in &document.measurements {
        let (read, expected) = (&read["measurements"][measurement.id.as_str()], expected(measurement));
        for (name, value) in expected.as_object().unwrap() {
            assert_eq!(&read[name], value, "{}: {name}", measurement.id);
        }
    }
}

#[test]
fn what_the_python_example_writes_is_valid_and_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("written.bbrf");
    let Some(output) = python("write_bbrf.py", &file) else { return };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = validate_bytes(std::fs::read(&file).unwrap());
    assert_eq!(report.findings, [], "{:#?}", report.findings);
    let opened = read_file(&file).unwrap();
    assert_eq!((opened.mismatched, opened.unknown), (vec![], vec![]));
    let scan = opened.document.measurement("scan").unwrap();
    for (k, value) in (0_u32..).zip(&scan.values) {
        assert!((value - (0.8 + 1e-3 * f64::from(k).sin())).abs() < 1e-15, "{k}: {value}");
    }
    let read = read_by_python(&file).unwrap();
    same(&read, &opened.document, opened.computed_digest.as_str());
}

#[test]
fn the_python_example_reads_what_we_write() {
    let folder = tempfile::tempdir().unwrap();
    let documents =
        [documents::small(), conformance::clean(), spec::full::full(), spec::full::minimal(), Document::default()];
    for (k, document) in documents.iter().enumerate() {
        let file = folder.path().join(format!("{k}.bbrf"));
        let digest = write_file(document, &file).unwrap();
        let Some(read) = read_by_python(&file) else { return };
        same(&read, document, digest.as_str());
    }
}

#[test]
fn the_python_example_refuses_what_does_not_have_its_digest() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("changed.bbrf");
    let mut seen = 0;
    for fault in FAULTS.iter().filter(|fault| fault.rule.starts_with("digest.object")) {
        std::fs::write(&file, fault.bytes()).unwrap();
        let Some(output) = python("read_bbrf.py", &file) else { return };
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains("Damaged"), "{}: {said}", fault.file_name());
        seen += 1;
    }
    assert!(seen > 2, "{seen} faults");
}

#[test]
fn the_examples_are_short_and_need_h5py_and_numpy_alone() {
    for name in ["read_bbrf.py", "write_bbrf.py"] {
        let text = std::fs::read_to_string(example(name)).unwrap();
        assert!(text.lines().count() < 120, "{name}: {} lines", text.lines().count());
        let imported = text.lines().filter_map(|line| line.strip_prefix("import ")).collect::<Vec<_>>();
        assert_eq!(imported, ["hashlib", "json", "sys", "h5py", "numpy as np"], "{name}");
    }
}

/// The flags of a compiler that finds libhdf5; `None` where neither h5cc nor pkg-config knows it.
fn c_compiler() -> Option<Command> {
    if Command::new("h5cc").arg("-show").output().is_ok_and(|output| output.status.success()) {
        return Some(Command::new("h5cc"));
    }
    let flags = Command::new("pkg-config").args(["--cflags", "--libs", "hdf5"]).output().ok()?;
    let flags = String::from_utf8(flags.stdout).ok().filter(|text| flags.status.success() && !text.is_empty())?;
    let mut compiler = Command::new("cc");
    compiler.args(flags.split_whitespace());
    Some(compiler)
}

#[test]
#[ignore = "needs libhdf5-dev; make test-ecosystem"]
fn the_example_in_c_reads_what_we_write() {
    let mut compiler =
        c_compiler().unwrap_or_else(|| panic!("neither h5cc nor `pkg-config hdf5` is here (Debian: libhdf5-dev)"));
    let folder = tempfile::tempdir().unwrap();
    let (program, file) = (folder.path().join("read_bbrf"), folder.path().join("small.bbrf"));
    // Libraries go behind what uses them.
    let arguments: Vec<_> = compiler.get_args().map(ToOwned::to_owned).collect();
    let compiler = compiler.arg(example("read_bbrf.c")).arg("-o").arg(&program).args(arguments);
    // h5cc leaves its object file where it runs.
    let output = compiler.current_dir(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let document = documents::small();
    write_file(&document, &file).unwrap();
    let output = Command::new(&program).arg(&file).arg("scan").output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    let scan = document.measurement("scan").unwrap();
    let mut lines = printed.lines();
    assert_eq!(lines.next(), Some(scan.quantity.kind.unit()));
    for ((row, column), value) in scan.values.indexed_iter() {
        let cells: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!(cells[..2], [row.to_string(), column.to_string()]);
        let read: f64 = cells[2].parse().unwrap();
        assert!(read.to_bits() == value.to_bits() || read.is_nan() && value.is_nan(), "{row}, {column}: {read}");
        assert_eq!(cells[3], scan.flags[(row, column)].to_string());
    }
}
