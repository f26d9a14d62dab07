//! Many incident spectra at once are each multiplied as one alone.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/scans.rs"]
mod scans;

use bbrf::simulate::reradiate;
use ndarray::Array2;
use scans::Random;

#[test]
fn every_pixel_is_the_sum_over_the_excitations_whatever_the_threads() {
    let mut random = Random::new(1);
    for (pixels, excitation, emission) in [(1, 1, 1), (0, 3, 2), (7, 49, 41), (9001, 13, 5)] {
        let incident = Array2::from_shape_fn((pixels, excitation), |_| random.uniform());
        let matrix = Array2::from_shape_fn((excitation, emission), |_| random.uniform());
        let product = |threads| {
            // What was there before does not matter, not even what is no number.
            let mut out = Array2::from_elem((pixels, emission), f64::NAN);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| reradiate(incident.as_slice().unwrap(), matrix.view(), out.as_slice_mut().unwrap()))
                .unwrap();
            out
        };
        let out = product(1);
        assert_eq!(out, product(3));
        for ((pixel, j), found) in out.indexed_iter() {
            let sum: f64 = (0..excitation).map(|k| incident[[pixel, k]] * matrix[[k, j]]).sum();
            assert!((found - sum).abs() <= 1e-14 * sum, "{found} {sum}");
        }
    }
}

#[test]
fn spectra_that_do_not_fit_the_matrix_are_refused() {
    let matrix = Array2::<f32>::zeros((2, 5));
    for (incident, out) in [(3, 5), (4, 5), (4, 11), (0, 5)] {
        let (incident, mut out) = (vec![1.0; incident], vec![7.0; out]);
        let refused = reradiate(&incident, matrix.view(), &mut out).unwrap_err().to_string();
        assert!(refused.contains("matrix of 2 excitations x 5 emissions"), "{refused}");
        assert!(out.iter().all(|value| *value == 7.0));
    }
    assert!(reradiate(&[], Array2::<f64>::zeros((0, 5)).view(), &mut []).is_err());
}
