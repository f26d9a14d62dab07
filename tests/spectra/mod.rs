//! Texts as instruments write them, made by code: no file of anybody's goes into the repository.
// Not every test uses every text; a failed step of a fixture is a failed test.
#![allow(dead_code, clippy::unwrap_used)]

use std::fmt::Write;
use std::path::PathBuf;

/// Wavelengths of the PR-650, nm.
pub(crate) fn grid() -> impl Iterator<Item = u32> {
    (0..101).map(|index| 380 + 4 * index)
}

/// A number as the PR-650 prints it: `1.234E-05`.
pub(crate) fn print(value: f64) -> String {
    let text = format!("{value:.3e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}E{sign}{:02}", exponent.abs())
}

/// A smooth spectrum: a broad emission around 550 nm with some light everywhere, times `scale`.
pub(crate) fn bump(nm: f64, scale: f64) -> f64 {
    scale * (1e-3 * (-((nm - 550.0) / 60.0).powi(2)).exp() + 2e-5)
}

/// The data rows of a D5 report.
pub(crate) fn rows(spectrum: impl Fn(f64) -> f64, eol: &str) -> String {
    grid().fold(String::new(), |mut text, nm| {
        write!(text, "{nm:04}.,{}{eol}", print(spectrum(f64::from(nm)))).unwrap();
        text
    })
}

/// The integral that the instrument prints: 4 nm times the sum of the printed values.
pub(crate) fn integral(spectrum: impl Fn(f64) -> f64) -> String {
    let sum: f64 = grid().map(|nm| print(spectrum(f64::from(nm))).parse::<f64>().unwrap()).sum();
    print(4.0 * sum)
}

/// A whole D5 report.
pub(crate) fn d5(status: &str, spectrum: impl Fn(f64) -> f64 + Copy) -> String {
    format!("{status}\r\n{}\r\n{}", integral(spectrum), rows(spectrum, "\r\n"))
}

/// The report of a good radiance record.
pub(crate) fn good(scale: f64) -> String {
    d5("00,0", |nm| bump(nm, scale))
}

/// A folder that is removed when it goes out of scope.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// Writes a file and returns its path.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.0.path().to_path_buf()
    }
}

/// The shared data of the laboratory, where there are some beside the repository.
pub(crate) fn shared() -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("no ../shared/data: the real files are not tested");
    None
}
