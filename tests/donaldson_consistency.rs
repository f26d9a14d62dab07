//! A matrix of another surface is told by the spectrum of the scan, the right one is let through, and what cannot be checked is said.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod common {
    pub mod completed;
    pub mod documents;
    pub mod matrices;
    pub mod scans;
}

use bbrf::container::measurement_digest;
use bbrf::dataset::{Document, Excitation, Id, Measurement, ReflectanceSource};
use bbrf::donaldson::{Consistency, Extend, Light, attach};
use bbrf::fit::{FitOptions, fit_measurement};
use bbrf::quantity::{Bandpass, Component, CorrelatedOver, EmissionAxis, Part, Reference, WavelengthAxis};
use common::completed::{TRUTH, complete, completed, digest, fit, lamp_of, luminescence_scan, signed, with_matrix};
use common::documents::measured_document;
use common::matrices::Bispectral;
use common::scans::{Random, Truth, paper_grid};

fn checked(document: Document) -> Consistency {
    let mut model = fit(&document);
    let mut document = document;
    attach(&mut document, &mut model, "matrix", digest).unwrap()
}

#[test]
fn the_right_matrix_is_let_through_and_a_wrong_one_is_told() {
    let mut random = Random::new(20);
    let right = Bispectral { has_sigma: true, ..Bispectral::usual(1) };
    let mut wrong = right.clone();
    // Another dye, that emits 4 nm further to the red.
    wrong.fluorophores[0][2] += 4.0;
    let (mut alarms, mut told, mut sum) = (0, 0, 0.0);
    let trials = 300;
    for trial in 0..trials {
        let scan = luminescence_scan(&right, 0.02, &mut random);
        let of = |surface: &Bispectral| {
            let matrix = surface.measured(3e-4, 1000 + trial);
            checked(Document { measurements: vec![scan.clone(), matrix], ..Document::default() })
        };
        let (good, bad) = (of(&right), of(&wrong));
        assert_eq!((good.shapes.len(), bad.shapes.len()), (1, 1), "{:?}", good.findings);
        sum += good.shapes[0].reduced_chi_square;
        alarms += u32::from(!good.agrees());
        told += u32::from(!bad.agrees());
    }
    println!(
        "{trials} trials: {alarms} false alarms, {told} wrong matrices told, mean chi-square {}",
        sum / f64::from(trials as u32)
    );
    // One in a hundred is stated: 3 are expected, more than 8 come by chance in one of a thousand such tests.
    assert!(alarms <= 8, "{alarms} of {trials}");
    assert!(told >= trials as u32 * 95 / 100, "{told} of {trials}");
    let mean = sum / trials as f64;
    assert!((0.8..1.15).contains(&mean), "mean reduced chi-square {mean}");
}

#[test]
fn the_level_is_checked_where_the_irradiance_is_known_and_only_there() {
    let mut random = Random::new(21);
    let surface = Bispectral { has_sigma: true, ..Bispectral::usual(1) };
    let mut scan = luminescence_scan(&surface, 0.02, &mut random);
    let matrix = surface.measured(3e-4, 31);
    let without = checked(Document { measurements: vec![scan.clone(), matrix.clone()], ..Document::default() });
    assert!(without.shapes[0].level.is_none());
    assert!(
        without.findings.iter().any(|finding| finding.contains("level cannot be checked")),
        "{:?}",
        without.findings
    );
    scan.excitations[0].light = Some(Id::new("diode").unwrap());
    for (height, agrees) in [(1.0, true), (1.2, false)] {
        let document = Document {
            measurements: vec![scan.clone(), matrix.clone()],
            lights: vec![lamp_of(height)],
            ..Document::default()
        };
        let found = checked(document);
        let level = found.shapes[0].level.unwrap();
        assert!((level.ratio * height - 1.0).abs() < 3.0 * level.sigma, "{level:?}");
        assert_eq!((found.shapes[0].agrees(), level.agrees(), found.agrees()), (true, agrees, agrees), "{found:#?}");
    }
    // A scale that the certificate leaves open is no disagreement.
    let mut document = Document { measurements: vec![scan, matrix], lights: vec![lamp_of(1.2)], ..Document::default() };
    document.measurements[0].uncertainty.components = vec![Component::new("scale", vec![0.2], CorrelatedOver::All)];
    assert!(checked(document).agrees());
}

/// An elastic scan with an albedo for each wavelength.
fn elastic_scan(surface: &Bispectral, random: &mut Random) -> Document {
    let nm: Vec<f64> = (0..81).map(|k| 380.0 + 5.0 * f64::from(k)).collect();
    let truths: Vec<Truth> = nm.iter().map(|nm| Truth { albedo: surface.reflectance(*nm), ..TRUTH }).collect();
    let mut document = measured_document(&paper_grid(), Reference::None, &truths, 0.01, random);
    let scan = &mut document.measurements[0];
    scan.quantity.part = Part::Elastic;
    scan.emission = EmissionAxis::Wavelengths(WavelengthAxis::new(nm, Bandpass::Unstated).unwrap());
    document
}

#[test]
fn an_elastic_scan_of_all_wavelengths_says_the_reflectance_itself() {
    let surface = Bispectral { has_sigma: true, ..Bispectral::usual(1) };
    let mut document = elastic_scan(&surface, &mut Random::new(22));
    document.measurements.push(surface.measured(3e-4, 41));
    let mut model = {
        let scan = document.measurement("scan").unwrap();
        let options = FitOptions {
            data_digest: measurement_digest(scan).unwrap(),
            reduction: bbrf::dataset::Reduction::None,
            ..FitOptions::default()
        };
        fit_measurement(&document, scan, &options).unwrap()
    };
    let found = attach(&mut document, &mut model, "matrix", digest).unwrap();
    assert!(found.agrees() && found.shapes.len() == 1, "{found:#?}");
    assert!((found.shapes[0].level.unwrap().ratio - 1.0).abs() < 0.02);
    document.models.push(model);
    let complete = complete(&document);
    assert_eq!(complete.reflectance(), ReflectanceSource::Terms);
    let geometry = signed(30.0, -10.0);
    let lit = complete.under(&Light::named("E").unwrap(), Extend::Zero);
    let radiated = lit.at(&geometry);
    let model = &document.models[0];
    for (j, nm) in complete.emission_nm().iter().enumerate() {
        let column = model.emission.wavelengths().unwrap().iter().position(|one| one == nm).unwrap();
        let albedo = model.terms[0].parameter_at("albedo", column).unwrap();
        let e = lit.prediction().irradiance[j];
        assert!((radiated.diffuse[j] / e - albedo * 30.0_f64.to_radians().cos()).abs() < 1e-12);
        let known = model.prediction_uncertainty(column, &geometry, &Reference::None).unwrap().standard.unwrap();
        let expected = (known * e).hypot(radiated.luminescent_sigma[j]);
        assert!((radiated.total_sigma[j] / expected - 1.0).abs() < 1e-9);
    }
    // A surface whose edge lies 10 nm elsewhere.
    let mut other = Bispectral::usual(1).measured(3e-4, 42);
    other.id = Id::new("other").unwrap();
    for row in 0..49 {
        for column in 1..41 {
            if 300.0 + 10.0 * row as f64 == 380.0 + 10.0 * column as f64 {
                other.values[(row, column)] += surface.reflectance(370.0 + 10.0 * column as f64)
                    - surface.reflectance(380.0 + 10.0 * column as f64);
            }
        }
    }
    document.measurements.push(other);
    let mut model = document.models[0].clone();
    let found = attach(&mut document, &mut model, "other", digest).unwrap();
    assert!(!found.agrees(), "{found:#?}");
}

#[test]
fn what_cannot_be_checked_is_said() {
    let surface = Bispectral::usual(1);
    let (_, band) = completed(with_matrix(surface.measured(1e-4, 51)));
    assert!(band.shapes.is_empty() && band.agrees());
    assert!(band.findings.iter().any(|finding| finding.contains("one band only")), "{:?}", band.findings);
    let mut random = Random::new(52);
    let mut scan = luminescence_scan(&surface, 0.02, &mut random);
    scan.excitations[0].wavelength_nm = Some(250.0);
    let document = |scan: &Measurement| Document {
        measurements: vec![scan.clone(), surface.measured(1e-4, 53)],
        ..Document::default()
    };
    let outside = checked(document(&scan));
    assert!(outside.shapes.is_empty(), "{outside:?}");
    assert!(outside.findings.iter().any(|finding| finding.contains("from 300 to 780 nm")), "{:?}", outside.findings);
    // A light of the CIE that the file names and does not hold.
    scan.excitations[0] = Excitation { light: Some(Id::new("d65").unwrap()), ..Excitation::default() };
    let light = bbrf::dataset::Light { id: Id::new("d65").unwrap(), ..bbrf::dataset::Light::default() };
    let named = Document { lights: vec![light], ..document(&scan) };
    let named = checked(named);
    assert!(named.shapes[0].light.as_ref().unwrap().contains("d65"), "{named:?}");
    scan.excitations.clear();
    scan.acquisitions.iter_mut().for_each(|row| row.excitation = None);
    let unknown = checked(document(&scan));
    assert!(
        unknown.findings.iter().any(|finding| finding.contains("does not say what fell")),
        "{:?}",
        unknown.findings
    );
}
