//! Validation with every digest recomputed, against h5py merely reading every dataset of the same file: 50 MB, 500 MB and
//! a small file, one and two threads, alternating in one run.
//!
//! `BBRF_BENCH_MB=50` measures that size alone. Needs `BBRF_PYTHON` with h5py for the peer.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use bbrf::container::{FileBytes, read_part, write_file};
use bbrf::dataset::{Acquisition, Document, Id, Measurement, Role};
use bbrf::quantity::*;
use bbrf::validate::validate_bytes;
use ndarray::{Array2, s};
use rayon::ThreadPoolBuilder;

const WAVELENGTHS: usize = 401;
const RUNS: usize = 7;

/// Reads every dataset and prints the seconds that it took, start-up left out.
const H5PY: &str = "
import sys, time, h5py
def read(group):
    for member in group.values():
        if isinstance(member, h5py.Dataset):
            member[()]
        else:
            read(member)
begin = time.perf_counter()
with h5py.File(sys.argv[1], 'r') as file:
    read(file)
print(time.perf_counter() - begin)
";

/// A radiance factor with its uncertainty, four digits each as instruments give them, of about that many stored bytes.
fn document(megabytes: usize) -> Document {
    // A value and its uncertainty take about 13 bytes together after deflate.
    let rows = (megabytes * 1_000_000 / 13 / WAVELENGTHS).max(2);
    let mut state = 1_u64;
    let mut digits = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) % 9000 + 1000) as f64 / 10_000.0
    };
    let values = Array2::from_shape_simple_fn((rows, WAVELENGTHS), &mut digits);
    let sigma = Array2::from_shape_simple_fn((rows, WAVELENGTHS), || digits() / 100.0);
    let geometry = |row: usize| {
        let angle = |k: usize| (k % 80) as f64;
        Geometry::from_degrees(angle(row), 180.0, angle(row / 80), (row / 6400) as f64 % 360.0).unwrap()
    };
    let acquisitions = (0..rows).map(|row| Acquisition::at(Some(geometry(row)), row as u32)).collect();
    let nm = (0..WAVELENGTHS).map(|k| 380.0 + k as f64).collect();
    let bandpass = Bandpass::Stated {
        fwhm_nm: vec![4.0],
        shape: BandpassShape::Triangular,
        correction: BandpassCorrection::Uncorrected,
    };
    let emission = EmissionAxis::Wavelengths(WavelengthAxis::new(nm, bandpass).unwrap());
    let quantity = Quantity {
        reference: Reference::SameGeometry,
        ..Quantity::absolute(QuantityKind::RadianceFactor, Part::Total)
    };
    let mut measurement = Measurement {
        uncertainty: Uncertainty { standard: Some(sigma.into_shared()), ..Uncertainty::default() },
        ..Measurement::new(Id::new("scan").unwrap(), Role::Sample, quantity, emission, acquisitions, values)
    };
    measurement.state_directions();
    Document { measurements: vec![measurement], ..Document::default() }
}

fn summary(mut times: Vec<Duration>) -> (f64, String) {
    times.sort();
    let ms = |k: usize| times[k].as_secs_f64() * 1e3;
    let median = ms(times.len() / 2);
    (median, format!("{median:8.1} ms [{:.1} .. {:.1}]", ms(times.len() / 4), ms(times.len() * 3 / 4)))
}

fn h5py(python: &str, file: &Path) -> Duration {
    let output = Command::new(python).args(["-c", H5PY]).arg(file).output().unwrap();
    Duration::from_secs_f64(String::from_utf8_lossy(&output.stdout).trim().parse().unwrap())
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let only = std::env::var("BBRF_BENCH_MB").ok().and_then(|text| text.parse().ok());
    for megabytes in [50, 500].into_iter().filter(|size| only.is_none_or(|only: usize| only == *size)) {
        let file = folder.path().join("large.bbrf");
        write_file(&document(megabytes), &file).unwrap();
        let size = std::fs::metadata(&file).unwrap().len() as f64 / 1e6;
        let pools: Vec<_> = [1, 2].map(|n| ThreadPoolBuilder::new().num_threads(n).build().unwrap()).into();
        let mut times: [Vec<Duration>; 3] = Default::default();
        for _ in 0..RUNS {
            if let Ok(python) = std::env::var("BBRF_PYTHON") {
                times[0].push(h5py(&python, &file));
            }
            for (pool, times) in pools.iter().zip(&mut times[1..]) {
                let begin = Instant::now();
                let report = pool.install(|| validate_bytes(FileBytes::read(&file, u64::MAX).unwrap()));
                times.push(begin.elapsed());
                black_box(report);
            }
        }
        let mut one_row = Vec::new();
        let mut touched = 0;
        for run in 0..RUNS {
            let begin = Instant::now();
            let part = read_part(&file, "scan", |row, _| row == 1000 * run).unwrap();
            one_row.push(begin.elapsed());
            touched = touched.max(part.bytes_read);
        }
        println!("{size:.0} MB stored:");
        let base = if times[0].is_empty() { f64::NAN } else { summary(times[0].clone()).0 };
        for (name, times) in ["h5py reads", "validate, 1 thread", "validate, 2 threads"].iter().zip(times) {
            if !times.is_empty() {
                let (median, text) = summary(times);
                println!("  {name:<20} {text}  {:.2} of h5py", median / base);
            }
        }
        println!("  {:<20} {}  {:.2} MB touched", "one geometry", summary(one_row).1, touched as f64 / 1e6);
    }
    let file = folder.path().join("small.bbrf");
    let mut small = document(1);
    // About 100 kB stored.
    let rows = 12;
    let scan = &mut small.measurements[0];
    scan.acquisitions.truncate(rows);
    scan.values = scan.values.slice(s![..rows, ..]).to_shared();
    scan.flags = scan.flags.slice(s![..rows, ..]).to_shared();
    scan.uncertainty.standard = scan.uncertainty.standard.as_ref().map(|all| all.slice(s![..rows, ..]).to_shared());
    write_file(&small, &file).unwrap();
    let mut times = Vec::new();
    for _ in 0..31 {
        let begin = Instant::now();
        let status = Command::new(env!("CARGO_BIN_EXE_bbrf")).arg("validate").arg(&file).output().unwrap();
        times.push(begin.elapsed());
        black_box(status);
    }
    let size = std::fs::metadata(&file).unwrap().len() / 1000;
    println!("{size} kB stored, the whole command: {}", summary(times).1);
}
