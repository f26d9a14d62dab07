//! One 272-point scan fitted without a start, against its peer in the same run on the same data; and the tables.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/common/scans.rs"]
mod scans;

use std::hint::black_box;

use bbrf::fit::{Fitter, GeometrySet, Terms};
use bbrf::quantity::Reference;
use bbrf::terms::{Denominator, Distribution};
use criterion::{Criterion, criterion_group, criterion_main};
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

criterion_group!(benches, fit);
criterion_main!(benches);
