//! One 272-point scan fitted without a start, against its peer in the same run on the same data; and the tables.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/common/scans.rs"]
mod scans;

use std::hint::black_box;

use bbrf::fit::{Fitter, GeometrySet, Share, Terms};
use bbrf::quantity::Reference;
use bbrf::terms::{Denominator, Distribution};
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::Array2;
use rayon::prelude::*;
use scans::{Random, Truth, measure, paper_grid, peer_fit, prepare, random_start};

const SCANS: usize = 2000;
/// SciPy takes milliseconds for each.
const SCIPY_SCANS: usize = 300;

fn tables(grid: &[bbrf::quantity::Geometry]) -> GeometrySet {
    GeometrySet::new(grid, &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap()
}

/// The data of the README's table: 2,000 random scans, 1 % noise.
fn scans() -> Vec<(Truth, Vec<f64>, Vec<f64>)> {
    let grid = paper_grid();
    let mut random = Random::new(20_131_111);
    (0..SCANS)
        .map(|_| {
            let truth = Truth::random(&mut random);
            let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
            (truth, values, sigma)
        })
        .collect()
}

/// A fit is right when its chi-square is within one unit of the best known.
fn share_right(scans: &[(Truth, Vec<f64>, Vec<f64>)]) {
    let grid = paper_grid();
    let prepared = prepare(&grid);
    let set = tables(&grid);
    let fitter = Fitter::new(&set, Terms { diffuse: true, specular: true });
    let mut random = Random::new(1);
    let (mut ours, mut peer) = (0, 0);
    for (truth, values, sigma) in scans {
        let best = peer_fit(&prepared, values, sigma, truth).0;
        let found = fitter.fit(values, Some(sigma)).unwrap().chi_square;
        let from_random = peer_fit(&prepared, values, sigma, &random_start(&mut random)).0;
        let reference = best.min(found);
        ours += usize::from(found <= reference + 1.0);
        peer += usize::from(from_random <= reference + 1.0);
    }
    println!(
        "share of right answers: bbrf {ours} of {SCANS}; levenberg-marquardt from a random start {peer} of {SCANS}"
    );
}

/// SciPy on the first scans, in the same run; needs the interpreter that `make bench` provides.
fn scipy(scans: &[(Truth, Vec<f64>, Vec<f64>)]) {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        println!("SciPy: not measured (BBRF_PYTHON is not set; `make bench` sets it)");
        return;
    };
    let grid = paper_grid();
    let prepared = prepare(&grid);
    let list: Vec<_> = scans
        .iter()
        .take(SCIPY_SCANS)
        .map(|(truth, values, sigma)| {
            let best = peer_fit(&prepared, values, sigma, truth).0;
            serde_json::json!({"values": values, "sigma": sigma, "best": best})
        })
        .collect();
    let column = |of: fn(&scans::Prepared) -> f64| prepared.iter().map(of).collect::<Vec<f64>>();
    let geometry = serde_json::json!({
        "phi": column(|p| p.half.phi), "cos_q": column(|p| p.half.cos_q), "sin2_q": column(|p| p.half.sin2_q),
        "masked": column(|p| p.masked), "diffuse": column(|p| p.diffuse),
    });
    let file = tempfile::NamedTempFile::new().unwrap();
    serde_json::to_writer(&file, &serde_json::json!({"geometry": geometry, "scans": list})).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/scipy_fit.py");
    let status = std::process::Command::new(python).arg(script).arg(file.path()).status().unwrap();
    assert!(status.success(), "SciPy's run failed");
}

fn fit(criterion: &mut Criterion) {
    let scans = scans();
    share_right(&scans);
    scipy(&scans);
    let grid = paper_grid();
    let prepared = prepare(&grid);
    let set = tables(&grid);
    let fitter = Fitter::new(&set, Terms { diffuse: true, specular: true });
    let mut group = criterion.benchmark_group("fit of one 272-point scan");
    let mut next = scans.iter().cycle();
    group.bench_function("bbrf, no start, covariance included, tables reused", |bencher| {
        bencher.iter(|| {
            let (_, values, sigma) = next.next().unwrap();
            black_box(fitter.fit(black_box(values), Some(black_box(sigma))).unwrap())
        });
    });
    group.bench_function("bbrf, building the tables", |bencher| bencher.iter(|| black_box(tables(black_box(&grid)))));
    let mut next = scans.iter().cycle();
    let mut random = Random::new(2);
    group.bench_function("levenberg-marquardt, four parameters, random start, no covariance", |bencher| {
        bencher.iter(|| {
            let (_, values, sigma) = next.next().unwrap();
            black_box(peer_fit(&prepared, values, sigma, &random_start(&mut random)))
        });
    });
    group.finish();
}

const WAVELENGTHS: usize = 101;

/// Spectral scans of the paper's grid: a band of fluorescence over a diffuser that is not flat, 1 % noise. With one weight
/// for all wavelengths of a geometry, or with weights of their own.
fn spectra(one_weight: bool) -> Vec<(Array2<f64>, Array2<f64>)> {
    let grid = paper_grid();
    let mut random = Random::new(7);
    (0..20)
        .map(|_| {
            let shape = Truth::random(&mut random);
            let truths: Vec<Truth> = (0..WAVELENGTHS)
                .map(|k| {
                    let x = (k as f64 - 40.0) / 12.0;
                    Truth { albedo: shape.albedo * (0.3 + (-x * x).exp()), ..shape }
                })
                .collect();
            let exact = Array2::from_shape_fn((WAVELENGTHS, grid.len()), |(b, k)| truths[b].evaluate(&grid[k]).0);
            let sigma = Array2::from_shape_fn(exact.dim(), |(b, k)| {
                0.01 * if one_weight { exact.column(k).sum() / WAVELENGTHS as f64 } else { exact[(b, k)] }
            });
            let values = Array2::from_shape_fn(exact.dim(), |at| exact[at] + sigma[at] * random.normal());
            (values, sigma)
        })
        .collect()
}

fn spectral(criterion: &mut Criterion) {
    let set = tables(&paper_grid());
    let fitter = Fitter::new(&set, Terms { diffuse: true, specular: true });
    let mut group = criterion.benchmark_group("fit of 272 geometries x 101 wavelengths");
    for (name, one_weight) in [("weights of their own", false), ("shared weights", true)] {
        let scans = spectra(one_weight);
        let mut next = scans.iter().cycle();
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let (values, sigma) = next.next().unwrap();
                black_box(fitter.fit_bands(black_box(values.view()), Some(black_box(sigma.view()))).unwrap())
            });
        });
    }
    let scans = spectra(true);
    let mut next = scans.iter().cycle();
    group.bench_function("shared weights and intensity", |bencher| {
        bencher.iter(|| {
            let (values, sigma) = next.next().unwrap();
            let fitter = fitter.sharing(Share::ShapeAndIntensity);
            black_box(fitter.fit_bands(black_box(values.view()), Some(black_box(sigma.view()))).unwrap())
        });
    });
    group.finish();
}

/// Two thousand scans in memory, one thread and all.
fn batch(criterion: &mut Criterion) {
    let scans = scans();
    let set = tables(&paper_grid());
    let fitter = Fitter::new(&set, Terms { diffuse: true, specular: true });
    let mut group = criterion.benchmark_group("2,000 scans in memory");
    group.sample_size(30);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        group.bench_function(format!("{threads} threads"), |bencher| {
            bencher.iter(|| {
                pool.install(|| {
                    scans
                        .par_iter()
                        .map(|(_, values, sigma)| fitter.fit(values, Some(sigma)).unwrap().chi_square)
                        .collect::<Vec<f64>>()
                })
            });
        });
    }
    group.finish();
}

criterion_group!(benches, fit, spectral, batch);
criterion_main!(benches);
