//! Each rule finds the fault that is made for it, and leaves the clean file alone.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod documents;

use bbrf::container::tree::{Array, Data, Dataset, Group};
use bbrf::container::{Limits, document_bytes, inspect, tree_bytes};
use bbrf::dataset::Document;
use bbrf::quantity::{Bandpass, EmissionAxis, Geometry, ReferenceLight};
use bbrf::validate::{RULES, Report, Severity, Status, rule, validate_bytes};

/// The tree of the small document, with its digests.
fn tree() -> Group {
    let (bytes, _) = document_bytes(&documents::small()).unwrap();
    let mut tree = inspect(&bytes, &Limits::default()).unwrap().tree;
    // The writer puts the scales in; what the reader saw of them must not be written twice.
    strip_foreign(&mut tree);
    tree
}

fn strip_foreign(group: &mut Group) {
    for (_, dataset) in &mut group.datasets {
        dataset.attributes.retain(|name, _| !matches!(name.as_str(), "CLASS" | "NAME" | "_FillValue"));
        dataset.attributes.retain(|_, array| !matches!(array.data, Data::Other(_)));
    }
    group.groups.iter_mut().for_each(|(_, group)| strip_foreign(group));
}

type Edit = fn(&mut Group);
type Change = fn(&mut Document);

fn scan(tree: &mut Group) -> &mut Group {
    tree.at_mut("measurement/scan").unwrap()
}

fn numbers<'a>(group: &'a mut Group, name: &str) -> &'a mut Vec<f64> {
    match &mut group.dataset_mut(name).unwrap().array.data {
        Data::F64(numbers) => numbers,
        other => panic!("{name} is {other:?}"),
    }
}

fn set_text(group: &mut Group, dataset: &str, attribute: &str, text: &str) {
    group.dataset_mut(dataset).unwrap().attributes.insert(attribute.into(), Array::text(text));
}

/// Faults that only a file can have.
const FILE_FAULTS: &[(&str, Edit)] = &[
    ("structure.version-stated", |tree| drop(tree.attributes.remove("bbrf_version"))),
    ("structure.major-version", |tree| drop(tree.attributes.insert("bbrf_version".into(), Array::text("2.0")))),
    ("structure.minor-version", |tree| drop(tree.attributes.insert("bbrf_version".into(), Array::text("1.7")))),
    ("structure.conventions", |tree| drop(tree.attributes.insert("Conventions".into(), Array::text("CF-1.11")))),
    ("structure.complete", |tree| scan(tree).datasets.retain(|(name, _)| name != "value_flag")),
    ("structure.readable", |tree| drop(scan(tree).attributes.insert("role".into(), Array::text("specimen")))),
    ("structure.shapes", |tree| {
        let value = scan(tree).dataset_mut("value").unwrap();
        value.array = Array { shape: vec![1, 5], data: Data::F64(vec![1.0; 5]) };
    }),
    ("structure.attributes", |tree| set_text(scan(tree), "value_flag", "flag_meanings", "one two")),
    ("structure.unknown", |tree| {
        let extra = Dataset::new(Array::vector(Data::F64(vec![1.0])));
        scan(tree).datasets.push(("temperature".into(), extra));
    }),
    ("digest.object", |tree| numbers(scan(tree), "value")[0] += 1e-9),
    ("digest.document", |tree| numbers(scan(tree), "value")[0] += 1e-9),
    ("digest.missing", |tree| drop(tree.attributes.remove("digest"))),
    ("quantity.units", |tree| set_text(scan(tree), "value", "units", "percent")),
    ("quantity.other-units", |tree| set_text(scan(tree), "theta_i", "units", "radian")),
    ("geometry.polar-range", |tree| numbers(scan(tree), "theta_v")[2] = -45.0),
    ("geometry.azimuth-range", |tree| numbers(scan(tree), "phi_v")[2] = 360.0),
    ("reference.dangling", |tree| drop(scan(tree).attributes.insert("sample".into(), Array::text("other")))),
];

fn nm(document: &mut Document) -> &mut Vec<f64> {
    match &mut document.measurements[1].emission {
        EmissionAxis::Wavelengths(axis) => &mut axis.nm,
        EmissionAxis::Band { .. } => panic!("the scan has wavelengths"),
    }
}

fn set_bandpass(document: &mut Document, change: fn(&mut Bandpass)) {
    if let EmissionAxis::Wavelengths(axis) = &mut document.measurements[1].emission {
        change(&mut axis.bandpass);
    }
}

/// Faults that a document can have.
const DOCUMENT_FAULTS: &[(&str, Change)] = &[
    ("quantity.unstated", |d| d.measurements[1].quantity.reference = bbrf::quantity::Reference::Unstated),
    ("quantity.certified-factor", |d| d.measurements[1].quantity.certified_factor = vec![0.9, 0.9]),
    ("wavelength.positive", |d| nm(d)[0] = 0.0),
    ("wavelength.ascending", |d| nm(d).swap(1, 2)),
    ("wavelength.bandpass-length", |d| {
        set_bandpass(d, |bandpass| {
            if let Bandpass::Stated { fwhm_nm, .. } = bandpass {
                fwhm_nm.push(8.0);
            }
        });
    }),
    ("wavelength.bandpass-unstated", |d| set_bandpass(d, |bandpass| *bandpass = Bandpass::Unstated)),
    ("geometry.unknown", |d| d.measurements[1].acquisitions[0].geometry = None),
    ("geometry.retro", |d| {
        d.measurements[1].acquisitions[0].geometry = Some(Geometry::from_degrees(10.0, 30.0, 10.0, 30.0).unwrap());
    }),
    ("flag.unknown-bits", |d| d.measurements[1].flags[[0, 0]] = 0x8000),
    ("flag.nan-without-reason", |d| d.measurements[1].values[[0, 0]] = f64::NAN),
    ("flag.infinite", |d| d.measurements[1].values[[0, 0]] = f64::INFINITY),
    ("flag.value-not-measured", |d| d.measurements[1].flags[[0, 0]] = 1),
    ("uncertainty.missing", |d| d.measurements[1].uncertainty.standard = None),
    ("uncertainty.negative", |d| d.measurements[1].uncertainty.standard.as_mut().unwrap()[[0, 0]] = -0.1),
    ("uncertainty.shared", |d| d.measurements[1].uncertainty.components[0].relative = vec![0.1, 0.1]),
    ("reference.light", |d| d.measurements[1].quantity.reference_light = ReferenceLight::Light("d65".into())),
    ("reference.excitation", |d| d.measurements[1].acquisitions[0].excitation = Some(0)),
    ("model.data-changed", |d| d.measurements[1].values[[0, 0]] += 1e-9),
    ("model.covariance-symmetric", |d| d.models[0].covariance[[0, 1]] *= 2.0),
    ("model.covariance-diagonal", |d| d.models[0].covariance[[0, 0]] = -1e-6),
    ("model.covariance-parameters", |d| drop(d.models[0].covariance_parameters.pop())),
    ("model.parameter-bounds", |d| d.models[0].terms[1].parameters[1].value = vec![-0.05]),
    ("model.not-converged", |d| d.models[0].converged = false),
];

/// A document that no rule objects to.
fn clean() -> Document {
    let mut document = documents::small();
    let geometry = |row: usize| Some(Geometry::from_degrees(10.0, 180.0, 15.0 + row as f64, 0.0).unwrap());
    for measurement in &mut document.measurements {
        for (row, acquisition) in measurement.acquisitions.iter_mut().enumerate() {
            acquisition.geometry = geometry(row);
        }
    }
    if let Some(spectrum) = &mut document.lights[0].spectrum {
        spectrum.axis.bandpass =
            Bandpass::Stated {
                fwhm_nm: vec![8.0],
                shape: bbrf::quantity::BandpassShape::Triangular,
                correction: bbrf::quantity::BandpassCorrection::Unstated,
            };
    }
    document.models[0].data_digest = bbrf::container::measurement_digest(&document.measurements[1]).unwrap();
    document
}

fn assert_finds(report: &Report, name: &str) {
    let rule = rule(name).unwrap();
    let found = report.findings.iter().find(|finding| finding.rule == rule.id);
    let found = found.unwrap_or_else(|| panic!("{name} finds nothing: {:#?}", report.findings));
    assert_eq!(found.severity, rule.severity);
    assert!(!found.place.to_string().is_empty() && !found.expected.is_empty());
}

#[test]
fn the_clean_file_is_left_alone() {
    let report = validate_bytes(&document_bytes(&clean()).unwrap().0);
    assert_eq!(report.findings, []);
    assert_eq!(report.status(), Status::Valid);
}

#[test]
fn each_fault_of_a_file_is_found() {
    let untouched = validate_bytes(&tree_bytes(&tree()).unwrap());
    for (name, edit) in FILE_FAULTS {
        let id = rule(name).unwrap().id;
        assert!(!untouched.findings.iter().any(|finding| finding.rule == id), "{name} without its fault");
        let mut tree = tree();
        edit(&mut tree);
        assert_finds(&validate_bytes(&tree_bytes(&tree).unwrap()), name);
    }
}

#[test]
fn each_fault_of_a_document_is_found() {
    for (name, change) in DOCUMENT_FAULTS {
        let mut document = clean();
        change(&mut document);
        assert_finds(&validate_bytes(&document_bytes(&document).unwrap().0), name);
    }
}

#[test]
fn what_is_no_hdf5_is_unreadable() {
    for bytes in [&b""[..], b"no HDF5", &document_bytes(&clean()).unwrap().0[..3000]] {
        let report = validate_bytes(bytes);
        assert_finds(&report, "structure.hdf5");
        assert_eq!(report.status(), Status::Unreadable);
    }
}

#[test]
fn bytes_that_the_writer_does_not_make_are_found() {
    let clean = document_bytes(&clean()).unwrap().0;
    let index = clean.windows(4).position(|window| window == b"TREE").unwrap();
    let mut damaged = clean.clone();
    // The address of the first chunk index's left neighbour, which this reader does not follow.
    damaged[index + 9] ^= 4;
    let report = validate_bytes(&damaged);
    assert_finds(&report, "structure.bytes");
    assert_eq!(report.status(), Status::Invalid);
    let found = &report.findings[0].found;
    assert!(found.contains(&format!("1 byte differs (the first at offset {})", index + 9)), "{found}");
}

#[test]
fn every_rule_is_tested_and_named_once() {
    let tested: Vec<&str> =
        FILE_FAULTS.iter().map(|fault| fault.0).chain(DOCUMENT_FAULTS.iter().map(|f| f.0)).collect();
    for (position, rule) in RULES.iter().enumerate() {
        let name = rule.id.strip_prefix("bbrf:1.0:").unwrap();
        assert!(tested.contains(&name) || matches!(name, "structure.hdf5" | "structure.bytes"), "{name} has no fault");
        let others = RULES.iter().skip(position + 1);
        assert!(others.into_iter().all(|other| other.id != rule.id && other.alias != rule.alias), "{name} twice");
        assert!(!rule.rationale.is_empty() && !rule.example.is_empty() && !rule.repair.is_empty());
    }
    assert!(RULES.iter().any(|rule| rule.severity == Severity::Info));
}
