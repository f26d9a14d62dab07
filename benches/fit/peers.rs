//! Other programs on the same scans in the same run: time of a fit and share of right answers, which are within one unit of
//! chi-square per degree of freedom of the best that anyone found.

use std::hint::black_box;

use bbrf::fit::Fitter;
use rayon::prelude::*;

use crate::common::optimum::Known;
use crate::common::scans::{Prepared, Random, Truth, paper_grid, peer_fit, prepare, random_start};
use crate::speed::scans;
use crate::timing::{Timed, time};
use crate::{BOTH, tables, varpro_peer};

/// Python takes milliseconds for each.
const PYTHON_SCANS: usize = 200;
/// Starts of those that are given several.
const SEVERAL: usize = 10;

/// Chi-square that another program finds from a start.
type Peer = dyn Fn(&[Prepared], &[f64], &[f64], &Truth) -> f64;

pub fn run() {
    let (scans, grid) = (scans(), paper_grid());
    let (set, prepared) = (tables(&grid), prepare(&grid));
    let fitter = Fitter::new(&set, BOTH);
    let best: Vec<f64> = scans
        .par_iter()
        .enumerate()
        .map(|(k, scan)| {
            let known = Known::new(&prepared, &scan.values, &scan.sigma);
            let reference = known.least(&scan.truth, 30, &mut Random::new(k as u64));
            reference.min(fitter.fit(&scan.values, Some(&scan.sigma)).unwrap().chi_square)
        })
        .collect();
    let say = |name: &str, timed: &Timed, found: &[f64]| {
        let unit = |k: usize| best[k] / (scans[k].values.len() as f64 - 4.0);
        let right = (0..found.len()).filter(|&k| found[k] <= best[k] + unit(k)).count();
        println!("   {name}: {timed}; right {right} of {}", found.len());
    };
    let mut found = Vec::new();
    let timed = time(scans.len(), |k| {
        found.push(fitter.fit(&scans[k].values, Some(&scans[k].sigma)).unwrap().chi_square);
    });
    say("bbrf, no start, with covariance", &timed, &found);
    let mut random = Random::new(2);
    let mut peer = |name: &str, starts: usize, fit: &Peer| {
        let mut found = Vec::new();
        let timed = time(scans.len() / starts.min(4), |k| {
            let one = |_| black_box(fit(&prepared, &scans[k].values, &scans[k].sigma, &random_start(&mut random)));
            let least = (0..starts).map(one).filter(|chi_square| chi_square.is_finite()).fold(f64::INFINITY, f64::min);
            found.push(least);
        });
        say(name, &timed, &found);
    };
    let lm = |grid: &[Prepared], values: &[f64], sigma: &[f64], start: &Truth| peer_fit(grid, values, sigma, start).0;
    peer("levenberg-marquardt (Rust), four parameters, one random start", 1, &lm);
    peer("the same, best of 10 random starts", SEVERAL, &lm);
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    peer("varpro (Rust), two parameters, one random start", 1, &varpro_peer::fit);
    peer("the same, best of 10 random starts", SEVERAL, &varpro_peer::fit);
    std::panic::set_hook(hook);
    python(&scans, &best, &prepared);
}

/// Needs the interpreter that `make bench` provides.
fn python(scans: &[crate::common::families::Scan], best: &[f64], prepared: &[Prepared]) {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        println!("   Python's programs: not measured (BBRF_PYTHON is not set; `make bench` sets it)");
        return;
    };
    let list: Vec<_> = scans
        .iter()
        .zip(best)
        .take(PYTHON_SCANS)
        .map(|(scan, best)| serde_json::json!({"values": scan.values, "sigma": scan.sigma, "best": best}))
        .collect();
    let column = |of: fn(&Prepared) -> f64| prepared.iter().map(of).collect::<Vec<f64>>();
    let geometry = serde_json::json!({
        "phi": column(|p| p.half.phi), "cos_q": column(|p| p.half.cos_q), "sin2_q": column(|p| p.half.sin2_q),
        "masked": column(|p| p.masked), "diffuse": column(|p| p.diffuse),
    });
    let file = tempfile::NamedTempFile::new().unwrap();
    serde_json::to_writer(&file, &serde_json::json!({"geometry": geometry, "scans": list})).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/fit/peers.py");
    let status = std::process::Command::new(python).arg(script).arg(file.path()).status().unwrap();
    assert!(status.success(), "the run of the Python programs failed");
}
