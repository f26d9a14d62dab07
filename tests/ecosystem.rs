//! Heavier partners: h5dump reads our files, and h5repack with other filters keeps the digest. Run by
//! `make test-ecosystem`; needs Debian's hdf5-tools.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;
#[path = "common/layers.rs"]
mod layers;

use std::path::Path;
use std::process::Command;

use bbrf::container::{read_file, write_file};
use bbrf::simulate::image::{Primaries, Radiance, write_exr};

fn run(program: &str, arguments: &[&str], files: &[&Path]) -> String {
    let output = Command::new(program).args(arguments).args(files).output().unwrap();
    assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
#[ignore = "needs hdf5-tools; make test-ecosystem"]
fn h5dump_reads_every_object() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bbrf");
    write_file(&documents::small(), &path).unwrap();
    let dump = run("h5dump", &[], &[&path]);
    for part in ["wavelength_emission", "value_flag", "derivation", "separability", "H5T_CSET_UTF8", "DIMENSION_SCALE"]
    {
        assert!(dump.contains(part), "{part} is not in the dump");
    }
}

#[test]
#[ignore = "needs hdf5-tools; make test-ecosystem"]
fn a_repacked_file_has_the_same_digest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bbrf");
    let digest = write_file(&documents::small(), &path).unwrap();
    for (name, filters) in [("plain", "NONE"), ("gzip", "GZIP=9"), ("shuffle", "SHUF")] {
        let packed = folder.path().join(name);
        run("h5repack", &["-f", filters], &[&path, &packed]);
        let opened = read_file(&packed).unwrap();
        assert_eq!(opened.computed_digest, digest, "{name}");
        assert_eq!(opened.mismatched, Vec::<String>::new(), "{name}");
    }
}

#[test]
#[ignore = "needs the Python package OpenEXR; make test-ecosystem"]
fn the_openexr_project_reads_every_layer_to_the_last_bit() {
    let python = std::env::var("BBRF_PYTHON").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let notes = [("seed".to_owned(), "7".to_owned())];
    let file = std::fs::File::create(&path).unwrap();
    write_exr(
        layers::SIZE,
        &layers::layers(),
        (Primaries::Xyz, Radiance::Absolute),
        &notes,
        std::io::BufWriter::new(file),
    )
    .unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/opens_exr.py");
    let parts: Vec<serde_json::Value> = serde_json::from_str(&run(&python, &[], &[&script, &path])).unwrap();
    assert_eq!(parts.len(), layers::layers().len());
    for (part, layer) in parts.iter().zip(layers::layers()) {
        assert_eq!(part["header"]["name"], layer.name);
        assert_eq!(part["header"]["spectralLayoutVersion"], "1.0");
        assert_eq!(part["header"]["comments"], "{\"seed\":\"7\"}");
        assert_eq!(part["kinds"], serde_json::json!(["float32"]));
        assert_eq!(part["shapes"], serde_json::json!([[layers::SIZE.1, layers::SIZE.0]]));
        assert_eq!(part["channels"].as_object().unwrap().len(), layer.channels.len());
        for channel in layer.channels {
            let bits: Vec<u32> = channel.values.iter().map(|value| value.to_bits()).collect();
            assert_eq!(part["channels"][&channel.name], serde_json::json!(bits), "{}", channel.name);
        }
    }
}
