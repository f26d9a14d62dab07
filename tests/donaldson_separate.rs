//! Reflected light told from luminescence: what is found is what was put in, and where it cannot be told that is said.
#![cfg(feature = "write")]
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod matrices;
    pub mod scans;
}

use assert_cmd::Command;
use bbrf::container::{document_bytes, open_verified, write_file};
use bbrf::dataset::Document;
use bbrf::donaldson::{Extend, Light, Luminescence, Matrix, Observer, Reradiation, Separate, separate};
use bbrf::validate::validate_bytes;
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

/// A dark signal that is a little off lifts a whole row, also where no light can be: that is no luminescence.
#[test]
fn an_offset_of_one_excitation_is_not_taken_for_light_that_it_excites() {
    let truth = Bispectral::usual(1);
    for seed in 0..5 {
        let mut measurement = truth.measured(1e-3, 30 + seed);
        let row = truth.excitation_nm.iter().position(|nm| *nm == 520.0).unwrap();
        measurement.values.row_mut(row).map_inplace(|value| *value += 4e-3);
        let found = separate(&Matrix::of(&measurement).unwrap(), Separate::default()).unwrap();
        let excited = found.factors.excitation[(0, row)];
        let exact = (-((520.0 - 400.0) / 45.0_f64).powi(2) / 2.0).exp();
        println!("excited at 520 nm: {excited:.3}, truth {exact:.3}");
        assert!((excited - exact).abs() < 0.1, "{excited} {exact}");
        assert_eq!(found.factors.rank(), 1, "{:?}", found.tried);
    }
}

/// One factor describes them at their noise, and more of them do not run away next to the diagonal, where nothing holds them.
#[test]
fn real_matrices_are_separated_at_their_floor() {
    for (name, measurement) in real() {
        let matrix = Matrix::of(&measurement).unwrap();
        let chosen = separate(&matrix, Separate::default()).unwrap();
        assert_eq!(chosen.factors.rank(), 1, "{name}: {:?}", chosen.tried);
        assert!(chosen.factors.rms < 2.0 * chosen.floor.rms, "{name}: {:?} {:?}", chosen.tried, chosen.floor);
        let photons = chosen.balance.iter().map(|balance| balance.photons.value).fold(0.0, f64::max);
        assert!((0.1..1.0).contains(&photons), "{name}: {photons}");
        for rank in 1..=3 {
            let found = separate(&matrix, Separate { rank: Some(rank) }).unwrap();
            let colour = |part: Luminescence| {
                let surface = Reradiation::of(&matrix, &found, part);
                surface.under(&Light::named("D65").unwrap(), Extend::Zero).colour(Observer::Two).unwrap()
            };
            let away = colour(Luminescence::Full).difference(&colour(Luminescence::Factors)).unwrap().de76;
            println!("{name}, {rank} factors: r.m.s. {:.2e}, CIE76 under D65 {away:.2}", found.factors.rms);
            assert!(away <= if rank == 1 { 1.7 } else { 4.0 }, "{name} {rank}: {away}");
        }
    }
}

/// What is written beside the matrix is valid, says which matrix it was made of, and is seen when that changes.
#[test]
fn the_parts_are_stored_beside_the_matrix() {
    let folder = tempfile::tempdir().unwrap();
    let [file, output] = ["matrix.bbrf", "parts.bbrf"].map(|name| folder.path().join(name));
    let document = Document { measurements: vec![Bispectral::usual(1).measured(1e-3, 5)], ..Document::default() };
    write_file(&document, &file).unwrap();
    let mut command = Command::cargo_bin("bbrf").unwrap();
    command.args(["donaldson", "separate"]).arg(&file).arg("-o").arg(&output).assert().success();
    let mut written = open_verified(&output).unwrap();
    assert_eq!(written.measurement("matrix"), document.measurement("matrix"), "the matrix stays");
    let factors = written.factorisation("matrix-factors").unwrap();
    assert_eq!((factors.rank(), factors.misfit()), (1, None));
    let peak = factors.luminescent(10, 12).unwrap();
    assert!((peak - Bispectral::usual(1).luminescent(400.0, 500.0)).abs() < 0.003, "{peak}");
    assert_eq!(factors.luminescent(12, 3), Some(0.0), "no light below the excitation");
    let rules = |document: &Document| -> Vec<String> {
        let bytes = document_bytes(document).unwrap().0;
        validate_bytes(bytes).findings.iter().map(|finding| finding.rule.to_string()).collect()
    };
    assert!(!rules(&written).iter().any(|rule| rule.contains("factorisation.")));
    written.measurements[0].values[(3, 3)] += 0.1;
    assert!(rules(&written).iter().any(|rule| rule.contains("factorisation.data-changed")), "{:?}", rules(&written));
    // A second separation does not write over the first.
    let mut again = Command::cargo_bin("bbrf").unwrap();
    let third = folder.path().join("third.bbrf");
    again.args(["donaldson", "separate"]).arg(format!("{}#matrix", output.display())).arg("-o").arg(&third);
    again.assert().code(2).stderr(predicates::str::contains("already"));
}
