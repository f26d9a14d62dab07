//! What is written is read back to the bit, and the same document gives the same bytes.
#![cfg(feature = "write")]

mod documents;

use bbrf::container::{Limits, WriteError, digest, document_bytes, open_verified, read_bytes, read_file, write_file};
use bbrf::dataset::{Document, DocumentError};
use bbrf::quantity::{Geometry, ReferenceLight};
use documents::{arbitrary_document, measurement, same, scan, small};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Writes, reads back, and compares to the bit; also that nothing is reported.
fn assert_round_trip(document: &Document) {
    let (bytes, written) = document_bytes(document).unwrap();
    let opened = read_bytes(&bytes, &Limits::default()).unwrap();
    assert!(same(&opened.document, document), "{document:#?}\n{:#?}", opened.document);
    assert_eq!(opened.computed_digest, written);
    assert_eq!(opened.stored_digest.as_deref(), Some(written.as_str()));
    assert_eq!(written, digest(document).unwrap());
    assert_eq!(opened.mismatched, Vec::<String>::new());
    assert_eq!(opened.unknown, Vec::<String>::new());
    assert!(document_bytes(document).unwrap().0 == bytes, "the same document gives the same bytes");
}

#[test]
fn the_small_document() {
    assert_round_trip(&small());
    assert_round_trip(&Document::default());
}

#[test]
fn ten_thousand_geometries() {
    let mut document = small();
    document.measurements.push(bbrf::dataset::Measurement { id: documents::id("large"), ..scan(100, 3) });
    assert_round_trip(&document);
}

#[test]
fn one_geometry_and_none() {
    let geometry = Geometry::from_degrees(10.0, 180.0, 20.0, 0.0).unwrap();
    for geometries in [vec![], vec![geometry]] {
        for columns in [0, 1] {
            let mut document = small();
            document.measurements.push(measurement("m", &geometries, columns));
            assert_round_trip(&document);
        }
    }
}

#[test]
fn any_document() {
    let cases = std::env::var("BBRF_PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(150);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let run = TestRunner::new_with_rng(config, rng).run(&arbitrary_document(), |document| {
        assert_round_trip(&document);
        Ok(())
    });
    run.unwrap();
}

#[test]
fn a_file_on_disk_is_verified() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("größe.bbrf");
    let digest = write_file(&small(), &path).unwrap();
    assert!(same(&open_verified(&path).unwrap(), &small()));
    assert_eq!(read_file(&path).unwrap().computed_digest, digest);
}

#[test]
fn what_would_read_back_as_something_else_is_refused() {
    let mut document = small();
    document.measurements[0].quantity.reference_light = ReferenceLight::Light("same".into());
    assert!(matches!(document_bytes(&document), Err(WriteError::Encode(_))));

    let mut document = small();
    document.provenance.receipts[0].tool = "a\0b".into();
    let error = document_bytes(&document).unwrap_err();
    let expected = DocumentError::NulInText("a\0b".into()).to_string();
    assert_eq!(error.to_string(), expected);

    let mut document = small();
    document.samples.clear();
    assert!(document_bytes(&document).unwrap_err().to_string().contains("not in the document"));
}
