//! 272 geometries x 101 wavelengths.

use std::hint::black_box;

use bbrf::fit::{Fitter, Share};
use ndarray::Array2;

use crate::common::scans::{Random, Truth, paper_grid};
use crate::timing::time;
use crate::{BOTH, tables};

const WAVELENGTHS: usize = 101;
const PASSES: usize = 1000;

pub fn run() {
    let set = tables(&paper_grid());
    let vector = Fitter::new(&set, BOTH);
    println!("272 geometries x {WAVELENGTHS} wavelengths, {PASSES} fits of 20 scans");
    for (dispatch, fitter) in [("plain", vector.plain()), ("vectors", vector)] {
        for (name, one_weight, share) in [
            ("weights of their own", false, Share::Shape),
            ("shared weights", true, Share::Shape),
            ("shared weights and intensity", true, Share::ShapeAndIntensity),
        ] {
            let scans = spectra(one_weight);
            let timed = time(PASSES, |k| {
                let (values, sigma) = &scans[k % scans.len()];
                let fitter = fitter.sharing(share);
                black_box(fitter.fit_bands(black_box(values.view()), Some(black_box(sigma.view()))).unwrap());
            });
            println!("   {name}, {dispatch}: {timed}");
        }
    }
}

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
