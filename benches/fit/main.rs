//! The figures of the fit: is it right, how well, how often said, and how long does it take; peers on the same data in the same
//! run. Parts can be asked for by name: `cargo bench --bench fit -- recovery speed`; `BBRF_TRIALS` sets the number of scans.
#![allow(missing_docs, clippy::unwrap_used, unreachable_pub)]

#[path = "../../tests/common"]
mod common {
    pub mod families;
    pub mod optimum;
    pub mod scans;
}
mod cost;
mod coverage;
mod families;
mod peers;
mod precision;
mod recovery;
mod spectra;
mod speed;
mod timing;
mod varpro_peer;

use bbrf::fit::{Fitter, GeometrySet, Intervals, Terms};
use bbrf::quantity::{Geometry, Reference};
use bbrf::terms::{Denominator, Distribution};
use ndarray::{ArrayView2, aview1};

const BOTH: Terms = Terms { diffuse: true, specular: true };
/// One part of the bench.
type Part = (&'static str, fn());

fn main() {
    let parts: [Part; 8] = [
        ("speed", speed::run),
        ("spectra", spectra::run),
        ("peers", peers::run),
        ("precision", precision::run),
        ("coverage", coverage::run),
        ("recovery", recovery::run),
        ("families", families::run),
        ("cost", cost::run),
    ];
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    for (name, run) in parts {
        if asked.is_empty() || asked.iter().any(|asked| asked == name) {
            let begin = std::time::Instant::now();
            println!("\n== {name}");
            run();
            println!("   ({:.1} s)", begin.elapsed().as_secs_f64());
        }
    }
}

fn tables(grid: &[Geometry]) -> GeometrySet {
    GeometrySet::new(grid, &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap()
}

/// How many scans: so many, or as many as `BBRF_TRIALS` says.
fn trials(usual: usize) -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// One row of values.
fn row(values: &[f64]) -> ArrayView2<'_, f64> {
    aview1(values).into_shape_with_order((1, values.len())).unwrap()
}

/// "Cannot tell" is said: no specular term is seen, or the interval of roughness or index is open.
fn cannot_tell(intervals: &Intervals) -> [bool; 2] {
    [intervals.roughness, intervals.index_minus_one]
        .map(|interval| interval.is_none_or(|interval| !interval.is_closed()))
}

/// The fit with its 95 % intervals.
fn with_intervals(set: &GeometrySet, values: &[f64], sigma: &[f64]) -> (bbrf::fit::Fit, Intervals) {
    Fitter::new(set, BOTH).fit_with_intervals(row(values), Some(row(sigma)), 0.95).unwrap()
}
