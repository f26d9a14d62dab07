//! The golden files: what a version of the standard looked like on disk, kept for ever in `testdata/golden`.
//!
//! A file is made once, for its version, and never again: tomorrow's reader has to read it as it is. `golden.csv` lists
//! the files (compressed by gzip, because an index of chunks is mostly empty), the SHA-256 of their bytes before that, the
//! digests of their documents, and where their values are.

use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use bbrf::dataset::Document;
use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use sha2::{Digest, Sha256};

/// The list.
pub const LIST: &str = "golden.csv";

/// The folder in the repository.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/golden")
}

/// SHA-256 of bytes as hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Every measured value, with its geometry, wavelength, uncertainty and flags, and every fitted parameter: numbers as the
/// shortest text that gives them back to the bit.
pub fn values(document: &Document) -> String {
    let mut text = String::from("what,row,column,theta_i_deg,theta_v_deg,wavelength_nm,value,uncertainty,flags\n");
    for measurement in &document.measurements {
        for ((row, column), value) in measurement.values.indexed_iter() {
            let geometry = measurement.acquisitions[row].geometry;
            let theta =
                geometry.map(|g| (g.incidence.theta_deg(), g.viewing.theta_deg())).unwrap_or((f64::NAN, f64::NAN));
            let wavelength = measurement.emission.wavelengths().map_or(f64::NAN, |nm| nm[column]);
            let sigma = measurement.uncertainty.standard.as_ref().map_or(f64::NAN, |sigma| sigma[(row, column)]);
            let flags = measurement.flags[(row, column)];
            let _ = writeln!(
                text,
                "measurement/{},{row},{column},{:?},{:?},{wavelength:?},{value:?},{sigma:?},{flags}",
                measurement.id, theta.0, theta.1
            );
        }
    }
    for model in &document.models {
        for (term, parameter) in model.terms.iter().flat_map(|term| term.parameters.iter().map(move |p| (term, p))) {
            for (column, (value, sigma)) in parameter.value.iter().zip(&parameter.standard_uncertainty).enumerate() {
                let name = format!("model/{}/{}.{}", model.id, term.kind, parameter.name);
                let _ = writeln!(text, "{name},,{column},,,,{value:?},{sigma:?},");
            }
        }
    }
    text
}

/// Adds the values of a document to the golden set, as `NAME.csv`.
///
/// # Errors
/// Where there is a file of that name: what was once written stays.
pub fn add_values(folder: &Path, name: &str, document: &Document) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    new_file(folder, &format!("{name}.csv"))?.write_all(values(document).as_bytes())
}

/// Adds a file to the golden set, as `NAME.bbrf.gz`; `values` names its values.
///
/// # Errors
/// As [`add_values`].
pub fn add(folder: &Path, name: &str, bytes: &[u8], digest: &str, values: &str) -> io::Result<()> {
    let file = format!("{name}.bbrf.gz");
    let mut compressed = GzEncoder::new(new_file(folder, &file)?, Compression::best());
    compressed.write_all(bytes)?;
    compressed.finish()?;
    let mut list = OpenOptions::new().append(true).create(true).open(folder.join(LIST))?;
    writeln!(list, "{file},{},{digest},{values}.csv", sha256(bytes))
}

/// The bytes of a golden file.
pub fn bytes(file: &str) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    GzDecoder::new(fs::File::open(folder().join(file))?).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn new_file(folder: &Path, name: &str) -> io::Result<fs::File> {
    OpenOptions::new().write(true).create_new(true).open(folder.join(name))
}
