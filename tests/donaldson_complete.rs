//! A complete model gives what its parts give, keeps the two kinds of light apart, and says what it does not know.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod common {
    pub mod bispectral;
    pub mod completed;
    pub mod documents;
    pub mod matrices;
    pub mod scans;
}

use bbrf::container::measurement_digest;
use bbrf::dataset::{Document, Id, Instrument, NotComplete, ReflectanceSource};
use bbrf::donaldson::{
    Complete, Extend, Light, Luminescence, Matrix, NoComplete, Reradiation, Separate, attach, separate,
};
use bbrf::fit::{FitOptions, fit_measurement};
use bbrf::quantity::{Flag, QuantityKind, Reference};
use bbrf::terms::{Denominator, Distribution, Term, TermKind, TorranceSparrow};
use common::completed::{complete, completed, digest, luminescence_scan, signed, with_matrix};
use common::matrices::Bispectral;
use common::scans::Random;

/// D G F over cos(theta_i), written down once more: in the plane, Gaussian of half height, exact Fresnel.
fn specular_by_hand(term: &TorranceSparrow, incidence: f64, viewing: f64) -> f64 {
    // Directions in the plane as vectors (x, z); the mirror direction lies at the same signed angle.
    let vector = |degrees: f64, side: f64| [side * degrees.to_radians().sin(), degrees.to_radians().cos()];
    let (l, v) = (vector(incidence, -1.0), vector(viewing, 1.0));
    let sum = [l[0] + v[0], l[1] + v[1]];
    let length = sum[0].hypot(sum[1]);
    let q = [sum[0] / length, sum[1] / length];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let phi = q[1].clamp(-1.0, 1.0).acos();
    let d = (-(2.0_f64.ln()) * (phi / term.roughness).powi(2)).exp();
    let g = 1.0_f64.min(2.0 * q[1] * v[1] / dot(v, q)).min(2.0 * q[1] * l[1] / dot(v, q));
    let (c, n) = (dot(l, q), term.refractive_index);
    let (inside, outside) = ((1.0 - (1.0 - c * c) / (n * n)).sqrt(), c);
    let (s, p) = ((outside - n * inside) / (outside + n * inside), (n * outside - inside) / (n * outside + inside));
    term.intensity * d * g * (s * s + p * p) / 2.0 / l[1]
}

/// A lamp with two lines between the wavelengths of the matrix, and a band.
fn lamp() -> Light {
    let nm = vec![300.0, 364.0, 365.5, 367.0, 404.0, 405.0, 406.0, 500.0, 560.0, 620.0, 780.0];
    let values = vec![0.1, 0.1, 3.0, 0.1, 0.1, 5.0, 0.1, 0.4, 1.0, 0.4, 0.2];
    Light::new("lamp", QuantityKind::SpectralIrradiance, nm, values, None).unwrap()
}

/// The integral of light times density over the excitation in steps of 0.01 nm.
fn luminescence_by_hand(surface: &Reradiation, light: &Light, emission: usize) -> f64 {
    let line = |nm: &[f64], values: &dyn Fn(usize) -> f64, at: f64| {
        let after = nm.iter().position(|point| *point >= at).unwrap();
        if after == 0 {
            return values(0);
        }
        let part = (at - nm[after - 1]) / (nm[after] - nm[after - 1]);
        (1.0 - part) * values(after - 1) + part * values(after)
    };
    let axis = &surface.excitation_nm;
    let density = |k: usize| surface.density[(k, emission)];
    let steps = ((axis[axis.len() - 1] - axis[0]) * 100.0).round() as usize;
    let value = |k: usize| {
        let nm = axis[0] + k as f64 * 0.01;
        line(light.nm(), &|k| light.values()[k], nm) * line(axis, &density, nm)
    };
    (0..steps).map(|k| (value(k) + value(k + 1)) / 2.0 * 0.01).sum()
}

#[test]
fn y_is_the_sum_of_its_three_parts_as_one_would_write_them_down() {
    let (document, _) = completed(with_matrix(Bispectral::usual(2).measured(1e-4, 1)));
    let complete = complete(&document);
    let surface = complete.surface();
    let Term::TorranceSparrow(term) = document.models[0].terms[1].term_at(0).unwrap() else {
        panic!("a specular term")
    };
    let light = lamp();
    let lit = complete.under(&light, Extend::Zero);
    for (incidence, viewing) in [(0.0, 0.0), (30.0, 30.0), (30.0, 20.0), (-50.0, 35.0), (75.0, -60.0)] {
        let cosine = f64::to_radians(incidence).cos();
        let radiated = lit.at(&signed(incidence, viewing));
        let specular = specular_by_hand(&term, incidence, viewing);
        for (j, e) in lit.prediction().irradiance.iter().enumerate() {
            let expected =
                [cosine * luminescence_by_hand(surface, &light, j), cosine * surface.elastic[j] * e, specular * e];
            let found = [radiated.luminescent[j], radiated.diffuse[j], radiated.specular[j]];
            for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
                let tolerance = if k == 0 { 1e-6 } else { 1e-12 };
                assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{k}: {found}, {expected}");
            }
            assert!((radiated.total[j] - expected.iter().sum::<f64>()).abs() < 2e-6);
        }
    }
}

/// What is written beside the matrix and read back is the separation, digit by digit, also of the real matrices.
#[test]
fn a_complete_model_from_a_file_is_what_was_separated() {
    let real = common::bispectral::real();
    let made = [
        Bispectral::usual(1).measured(3e-4, 5),
        Bispectral { has_sigma: true, ..Bispectral::usual(2) }.measured(3e-4, 6),
    ];
    for mut matrix in made.into_iter().chain(real) {
        matrix.id = Id::new("matrix").unwrap();
        let arrays = Matrix::of(&matrix).unwrap();
        let separated = separate(&arrays, Separate::default()).unwrap();
        let direct = Reradiation::of(&arrays, &separated, Luminescence::Full);
        let (document, _) = completed(with_matrix(matrix));
        let complete = complete(&document);
        for light in ["D65", "FL11"] {
            let light = Light::named(light).unwrap();
            let (a, b) = (direct.under(&light, Extend::Zero), complete.surface().under(&light, Extend::Zero));
            let bits = |list: &[f64]| list.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
            for (a, b) in [
                (&a.luminescent, &b.luminescent),
                (&a.elastic, &b.elastic),
                (&a.luminescent_sigma, &b.luminescent_sigma),
                (&a.total_sigma, &b.total_sigma),
            ] {
                assert_eq!(bits(a), bits(b));
            }
        }
    }
}

#[test]
fn a_factor_of_the_interface_in_the_geometry_of_the_matrix_is_not_counted_twice() {
    let geometry = signed(45.0, 0.0);
    let mut matrix = Bispectral::usual(1).measured(1e-4, 7);
    matrix.acquisitions.iter_mut().for_each(|row| row.geometry = Some(geometry));
    matrix.quantity.reference = Reference::SameGeometry;
    let (document, _) = completed(with_matrix(matrix));
    let complete = complete(&document);
    let Term::TorranceSparrow(term) = document.models[0].terms[1].term_at(0).unwrap() else {
        panic!("a specular term")
    };
    let lit = complete.under(&Light::named("E").unwrap(), Extend::Zero);
    let radiated = lit.at(&geometry);
    let in_matrix = specular_by_hand(&term, 45.0, 0.0) / 45.0_f64.to_radians().cos();
    assert!(in_matrix > 0.005, "{in_matrix}");
    for (j, e) in lit.prediction().irradiance.iter().enumerate() {
        // Where the matrix was measured the whole model gives the matrix back.
        let reflected = (radiated.diffuse[j] + radiated.specular[j]) / e / 45.0_f64.to_radians().cos();
        assert!((reflected - complete.surface().elastic[j]).abs() < 1e-12, "{reflected}");
        assert!(
            (radiated.diffuse[j] / e / 45.0_f64.to_radians().cos() - (complete.surface().elastic[j] - in_matrix)).abs()
                < 1e-12
        );
        // And there the fit of the interface adds no uncertainty.
        assert!(
            (radiated.total_sigma[j] / 45.0_f64.to_radians().cos() - lit.prediction().total_sigma[j]).abs() < 1e-12
        );
    }
}

#[test]
fn the_uncertainty_is_that_of_the_matrix_and_of_the_terms() {
    let (document, _) = completed(with_matrix(Bispectral::usual(1).measured(3e-4, 8)));
    let complete = complete(&document);
    let model = &document.models[0];
    let (light, geometry) = (lamp(), signed(40.0, 30.0));
    let lit = complete.under(&light, Extend::Zero);
    let radiated = lit.at(&geometry);
    let Term::TorranceSparrow(term) = model.terms[1].term_at(0).unwrap() else { panic!("a specular term") };
    let value = |shift: [f64; 3]| {
        let [intensity, roughness, refractive_index] =
            [term.intensity + shift[0], term.roughness + shift[1], term.refractive_index + shift[2]];
        specular_by_hand(&TorranceSparrow { intensity, roughness, refractive_index, ..term }, 40.0, 30.0)
    };
    let slope: Vec<f64> = (0..3)
        .map(|k| {
            let mut step = [0.0; 3];
            step[k] = 1e-6;
            (value(step) - value(step.map(|step| -step))) / 2e-6
        })
        .collect();
    let covariance = model.covariance_at(0).unwrap();
    let at = |name: &str| model.covariance_parameters.iter().position(|one| one == name).unwrap();
    let rows = ["intensity", "roughness", "refractive_index"].map(|name| at(&format!("torrance-sparrow.{name}")));
    let variance: f64 = (0..3)
        .flat_map(|i| (0..3).map(move |j| (i, j)))
        .map(|(i, j)| slope[i] * covariance[(rows[i], rows[j])] * slope[j])
        .sum();
    let cosine = 40.0_f64.to_radians().cos();
    for (j, e) in lit.prediction().irradiance.iter().enumerate() {
        let expected = (cosine * lit.prediction().total_sigma[j]).hypot(variance.sqrt() * e);
        assert!((radiated.total_sigma[j] / expected - 1.0).abs() < 1e-6, "{} {expected}", radiated.total_sigma[j]);
        assert!((radiated.specular_sigma[j] / (variance.sqrt() * e) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn light_at_a_right_angle_excites_nothing_and_is_never_nan() {
    let mut matrix = Bispectral::usual(1).measured(3e-4, 9);
    // An emission whose own excitation nobody measured: its elastic value is unknown.
    matrix.flags[(20, 12)] = Flag::NotMeasured.bit();
    matrix.values[(20, 12)] = f64::NAN;
    let (document, _) = completed(with_matrix(matrix));
    let complete = complete(&document);
    assert!(complete.surface().elastic[12].is_nan());
    let lit = complete.under(&lamp(), Extend::Zero);
    let grazing = lit.at(&signed(90.0, 20.0));
    assert!(grazing.luminescent.iter().chain(&grazing.diffuse).all(|value| *value == 0.0));
    assert!(grazing.total.iter().chain(&grazing.total_sigma).all(|value| value.is_finite()), "{grazing:?}");
    // In the light what is not known stays unknown, and nothing else goes with it.
    let lit = lit.at(&signed(20.0, 30.0));
    assert!(lit.diffuse[12].is_nan() && lit.total[12].is_nan());
    assert!(lit.luminescent[12].is_finite() && lit.specular[12].is_finite());
    assert_eq!(lit.total.iter().filter(|value| value.is_nan()).count(), 1);
    assert!(complete.findings().iter().any(|finding| finding.contains("no elastic value at 1 emission")));
    // Two directions along the surface that face each other: a typed reason, and no light of it.
    let opposite = complete.under(&lamp(), Extend::Zero).at(&signed(90.0, 90.0));
    assert!(opposite.undefined.is_some() && opposite.specular.iter().all(|value| value.is_nan()));
    assert!(opposite.luminescent.iter().all(|value| *value == 0.0));
}

#[test]
fn a_missing_luminescent_cell_is_told_and_the_factors_stand_in_for_it() {
    let mut matrix = Bispectral::usual(1).measured(1e-4, 10);
    matrix.flags[(8, 14)] = Flag::Saturated.bit();
    let (document, _) = completed(with_matrix(matrix));
    let complete = complete(&document);
    assert!(
        complete.findings().iter().any(|finding| finding.starts_with("1 luminescent cells")),
        "{:?}",
        complete.findings()
    );
    let truth = Bispectral::usual(1).luminescent(380.0, 520.0) / 10.0;
    let found = complete.bispectral(380.0, &signed(0.0, 0.0)).unwrap().luminescent[14];
    assert!((found / truth - 1.0).abs() < 0.05, "{found} {truth}");
}

#[test]
fn one_excitation_gives_a_density_and_a_line_that_are_never_one_array() {
    let (document, _) = completed(with_matrix(Bispectral::usual(1).measured(1e-4, 11)));
    let complete = complete(&document);
    let geometry = signed(60.0, 10.0);
    let at = |nm: f64| complete.bispectral(nm, &geometry).unwrap();
    let (low, high, between) = (at(400.0), at(410.0), at(404.0));
    let surface = complete.surface();
    for j in 0..surface.emission_nm.len() {
        assert!((low.luminescent[j] - 0.5 * surface.density[(10, j)]).abs() < 1e-15);
        let straight = 0.6 * low.luminescent[j] + 0.4 * high.luminescent[j];
        assert!((between.luminescent[j] - straight).abs() < 1e-15);
        let sigma = (0.6 * low.luminescent_sigma[j]).hypot(0.4 * high.luminescent_sigma[j]);
        assert!((between.luminescent_sigma[j] - sigma).abs() < 1e-15);
    }
    let line = between.reflected.unwrap();
    assert!((line.diffuse - 0.5 * (0.6 * surface.elastic[2] + 0.4 * surface.elastic[3])).abs() < 1e-15);
    // Excited below the first emission there is no line.
    assert!(at(350.0).reflected.is_none());
    for (nm, says) in [(290.0, "from 300 to 780 nm"), (f64::NAN, "NaN nm")] {
        let error = complete.bispectral(nm, &geometry).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn a_light_that_stops_short_is_told() {
    let (document, _) = completed(with_matrix(Bispectral::usual(1).measured(1e-4, 12)));
    let complete = complete(&document);
    let under = |name: &str| complete.under(&Light::named(name).unwrap(), Extend::Zero).prediction().unlit.clone();
    let unlit = under("FL11");
    assert!(unlit.iter().any(|one| one.is_excitation && one.excitation_share > 0.1), "{unlit:?}");
    assert!(under("D65").is_empty());
}

#[test]
fn parts_that_do_not_go_together_are_no_complete_model() {
    let (document, _) = completed(with_matrix(Bispectral::usual(1).measured(1e-4, 13)));
    let of = |change: &dyn Fn(&mut Document)| {
        let mut document = document.clone();
        change(&mut document);
        Complete::of(&document, &document.models[0]).unwrap_err()
    };
    let parts = |error| matches!(error, NoComplete::Parts(NotComplete::Unfit { .. } | NotComplete::Missing { .. }));
    assert!(parts(of(&|d| d.models[0].donaldson.as_mut().unwrap().elastic = Id::new("scan").unwrap())));
    assert!(parts(of(&|d| d.models[0].donaldson.as_mut().unwrap().luminescent = Id::new("matrix").unwrap())));
    assert!(parts(of(&|d| d.models[0].donaldson.as_mut().unwrap().reflectance = ReflectanceSource::Terms)));
    assert!(parts(of(&|d| d.factorisations.clear())));
    assert!(matches!(of(&|d| d.models[0].donaldson = None), NoComplete::Parts(NotComplete::Nothing(_))));
    let fixed = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    let error = of(&|d| d.measurements[1].quantity.reference = fixed);
    assert!(matches!(error, NoComplete::Reference { .. }), "{error}");
}

#[test]
fn a_matrix_over_a_fixed_reference_is_brought_to_its_own_geometry() {
    let mut matrix = Bispectral::usual(1).measured(1e-4, 14);
    matrix.acquisitions.iter_mut().for_each(|row| row.geometry = Some(signed(60.0, 0.0)));
    matrix.quantity.reference = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    let direct = Matrix::of(&matrix).unwrap();
    let direct = Reradiation::of(&direct, &separate(&direct, Separate::default()).unwrap(), Luminescence::Full);
    let (document, _) = completed(with_matrix(matrix));
    let complete = complete(&document);
    assert!((complete.surface().elastic[5] / direct.elastic[5] - 2.0).abs() < 1e-12);
    assert!((complete.surface().density[(8, 14)] / direct.density[(8, 14)] - 2.0).abs() < 1e-12);
}

#[test]
fn a_matrix_comes_over_with_what_it_refers_to_and_no_id_is_lost() {
    let instrument = |title: &str| Instrument {
        id: Id::new("instrument").unwrap(),
        model: Some(title.to_owned()),
        ..Instrument::default()
    };
    let mut matrix = Bispectral::usual(1).measured(1e-4, 61);
    matrix.id = Id::new("scan").unwrap();
    matrix.instrument = Some(Id::new("instrument").unwrap());
    matrix.values[(0, 0)] = f64::NAN;
    matrix.flags[(0, 0)] = Flag::NotMeasured.bit();
    let other = Document { measurements: vec![matrix], instruments: vec![instrument("BFC")], ..Document::default() };
    let mut document = with_matrix(Bispectral::usual(1).measured(1e-4, 62));
    document.instruments.push(instrument("PR"));
    let first = document.adopt(&other, "scan").unwrap();
    assert_eq!((first.id.as_str(), first.renamed.len()), ("scan-2", 2), "{:?}", first.renamed);
    assert_eq!(document.measurement("scan-2").unwrap().instrument.as_ref().unwrap().as_str(), "instrument-2");
    // What is there already is not taken twice, missing numbers or not.
    let again = document.adopt(&other, "scan-3");
    assert!(again.is_none());
    let same = Document {
        measurements: vec![document.measurement("scan-2").unwrap().clone()],
        instruments: document.instruments.clone(),
        ..Document::default()
    };
    let count = document.measurements.len();
    assert_eq!(document.adopt(&same, "scan-2").unwrap().id.as_str(), "scan-2");
    assert_eq!((document.measurements.len(), document.instruments.len()), (count, 2));
    document.check().unwrap();
}

#[test]
fn a_luminescence_has_no_interface() {
    let surface = Bispectral::usual(1);
    let scan = luminescence_scan(&surface, 0.02, &mut Random::new(71));
    let mut document = Document { measurements: vec![scan, surface.measured(1e-4, 72)], ..Document::default() };
    let scan = document.measurement("scan").unwrap();
    let options = FitOptions {
        terms: vec![TermKind::Lambertian, TermKind::TorranceSparrow],
        data_digest: measurement_digest(scan).unwrap(),
        ..FitOptions::default()
    };
    let mut model = fit_measurement(&document, scan, &options).unwrap();
    attach(&mut document, &mut model, "matrix", digest).unwrap();
    // Even one that was put there by force is none of a reflected beam.
    if let Some(term) = model.terms.iter_mut().find(|term| term.kind == TermKind::TorranceSparrow) {
        for (parameter, value) in term.parameters.iter_mut().zip([5.0, 0.2, 1.5]) {
            parameter.value = vec![value; parameter.value.len()];
        }
        term.distribution = Some(Distribution::GaussianHalfHeight);
        term.denominator = Some(Denominator::CosThetaI);
    }
    document.models.push(model);
    let complete = complete(&document);
    let radiated = complete.under(&lamp(), Extend::Zero).at(&signed(20.0, 20.0));
    assert!(radiated.specular.iter().all(|value| *value == 0.0));
    assert!(radiated.total_sigma.iter().all(|sigma| sigma.is_finite()));
    assert!(complete.findings().iter().any(|finding| finding.contains("Y_s is 0")));
}
