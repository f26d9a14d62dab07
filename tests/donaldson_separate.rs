//! Reflected light told from luminescence: what is found is what was put in, and where it cannot be told that is said.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod matrices;
    pub mod scans;
}

use bbrf::donaldson::{Matrix, Separate, separate};
use common::matrices::{Bispectral, real};

#[test]
fn the_parts_of_a_known_matrix_are_found() {
    for (stated, rank) in [(false, 1), (true, 1), (true, 2)] {
        let truth = Bispectral { is_stated: stated, ..Bispectral::usual(rank) };
        let matrix = Matrix::of(&truth.measured(1e-3, 5)).unwrap();
        let found = separate(&matrix, Separate::default()).unwrap();
        assert_eq!(found.factors.rank(), rank, "{:?}", found.tried);
        assert_eq!(found.overlap.is_stated, stated);
        assert!((found.floor.rms / 1e-3 - 1.0).abs() < 0.1, "{:?}", found.floor);
        let mut worst: f64 = 0.0;
        for (j, nm) in matrix.emission_nm.iter().enumerate() {
            let pull = (found.elastic[j] - truth.reflectance(*nm)) / found.elastic_sigma[j];
            worst = worst.max(pull.abs());
            // Of two fluorophores the band next to the diagonal is told less well.
            assert!(found.elastic_sigma[j] < 0.01 * (rank * rank) as f64, "{nm}: {}", found.elastic_sigma[j]);
        }
        assert!(worst < 4.5, "{stated} {rank}: {worst}");
        for ((i, j), value) in found.luminescent.indexed_iter() {
            let (excitation, emission) = (matrix.excitation_nm[i], matrix.emission_nm[j]);
            let pull = (value - truth.luminescent(excitation, emission)) / found.luminescent_sigma[(i, j)];
            assert!(pull.abs() < 6.0 || emission < excitation, "{stated} {rank}, {excitation} {emission}: {pull}");
        }
    }
}

#[test]
fn real_matrices_are_separated_at_their_floor() {
    for (name, measurement) in real() {
        let matrix = Matrix::of(&measurement).unwrap();
        for rank in [None, Some(1), Some(2), Some(3)] {
            let found = separate(&matrix, Separate { rank }).unwrap();
            println!(
                "{name} {rank:?} -> {} tried {:?} floor {:?} reach {:?}",
                found.factors.rank(),
                found.tried,
                found.floor,
                found.overlap.reach_nm[0]
            );
            let top = found.balance.iter().map(|b| b.photons.value).fold(0.0, f64::max);
            println!(
                "   elastic {:.3} .. {:.3}; photons at most {top:.3}; {:?}",
                found.elastic.iter().copied().fold(f64::INFINITY, f64::min),
                found.elastic.iter().copied().fold(0.0, f64::max),
                found.findings
            );
        }
    }
}
