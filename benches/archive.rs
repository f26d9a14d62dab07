//! Import of the simulated 272-record scan, writing and reading its file, and the file's size against the raw text.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;
use std::path::{Path, PathBuf};

use bbrf::container::{Limits, document_bytes, read_bytes};
use bbrf::import::{Options, import};
use criterion::{Criterion, criterion_group, criterion_main};

fn archive(criterion: &mut Criterion) {
    let manifest: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let inputs = [manifest.clone()];
    let document = import(&inputs, &Options::default()).unwrap();
    let (bytes, _) = document_bytes(&document).unwrap();
    let raw: u64 = std::fs::read_dir(manifest.with_file_name("raw"))
        .unwrap()
        .map(|entry| entry.unwrap().metadata().unwrap().len())
        .sum();
    println!("size: raw text {raw} bytes, file {} bytes ({:.2} of it)", bytes.len(), bytes.len() as f64 / raw as f64);
    let mut group = criterion.benchmark_group("272-record scan");
    group.sample_size(30);
    group.bench_function("import", |b| b.iter(|| black_box(import(&inputs, &Options::default()).unwrap())));
    group.bench_function("write", |b| b.iter(|| black_box(document_bytes(&document).unwrap())));
    group.bench_function("read, every digest recomputed", |b| {
        b.iter(|| black_box(read_bytes(&bytes, &Limits::default()).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, archive);
criterion_main!(benches);
