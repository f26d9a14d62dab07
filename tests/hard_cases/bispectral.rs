//! Bispectral matrices under lights: where steps, bandpasses, the ultraviolet, noise below 0 and colours beyond white go wrong.

use bbrf::donaldson::{Extend, Light, Luminescence, Matrix, Observer, Reradiation, Separate, separate};
use bbrf::quantity::QuantityKind;
use ndarray::Array2;

use crate::matrices::{axis, luminescence, measurement, reflectance, surface, values};
use crate::scans::Random;

fn light(nm: &[f64], values: &[f64]) -> Light {
    Light::new("lamp", QuantityKind::RelativeSpectrum, nm.to_vec(), values.to_vec(), None).unwrap()
}

/// A spectrum with a point between every two.
fn halved(light: &Light) -> Light {
    let (nm, values) = (light.nm(), light.values());
    let (mut more_nm, mut more) = (vec![nm[0]], vec![values[0]]);
    for k in 1..nm.len() {
        more_nm.extend([(nm[k - 1] + nm[k]) / 2.0, nm[k]]);
        more.extend([(values[k - 1] + values[k]) / 2.0, values[k]]);
    }
    self::light(&more_nm, &more)
}

/// The same surface with an excitation and an emission between every two.
fn refined(coarse: &Reradiation) -> Reradiation {
    let mid = |nm: &[f64]| {
        let all = nm.windows(2).flat_map(|pair| [pair[0], (pair[0] + pair[1]) / 2.0]);
        all.chain(nm.last().copied()).collect::<Vec<f64>>()
    };
    let (excitation, emission) = (mid(&coarse.excitation_nm), mid(&coarse.emission_nm));
    let near = |k: usize| [k / 2, k.div_ceil(2)];
    let density = Array2::from_shape_fn((excitation.len(), emission.len()), |(i, j)| {
        let cells = near(i).into_iter().flat_map(|a| near(j).map(|b| coarse.density[(a, b)]));
        cells.sum::<f64>() / 4.0
    });
    let elastic = (0..emission.len()).map(|j| near(j).map(|b| coarse.elastic[b]).iter().sum::<f64>() / 2.0).collect();
    Reradiation::from_parts(excitation, emission, elastic, density).unwrap()
}

fn lines() -> Light {
    // A lamp of narrow lines that fall between all steps, on a weak ground.
    let nm: Vec<f64> = (0..=2400).map(|k| 300.0 + 0.2 * f64::from(k)).collect();
    let peak = |nm: f64, centre: f64| 40.0 * (1.0 - (nm - centre).abs() / 0.6).max(0.0);
    let values: Vec<f64> = nm
        .iter()
        .map(|nm| 0.1 + [313.1, 365.3, 404.7, 435.8, 546.1, 577.3].map(|line| peak(*nm, line)).iter().sum::<f64>())
        .collect();
    light(&nm, &values)
}

/// Case 26. A naive product sums the reflected line as if it were a density: at half the step it is half, or twice.
#[test]
fn halving_the_step_of_matrix_or_light_changes_no_radiance() {
    let mut coarse = surface(&axis(300.0, 780.0, 10.0), &axis(380.0, 780.0, 10.0));
    let mut fine = refined(&coarse);
    coarse.emission_fwhm_nm = Some(vec![10.0; coarse.emission_nm.len()]);
    fine.emission_fwhm_nm = Some(vec![10.0; fine.emission_nm.len()]);
    for lamp in [Light::named("D65").unwrap(), Light::named("FL11").unwrap(), lines()] {
        let expected = coarse.under(&lamp, Extend::Zero);
        let others = [fine.under(&lamp, Extend::Zero), coarse.under(&halved(&lamp), Extend::Zero)];
        for (found, every) in others.iter().zip([2, 1]) {
            for j in 0..expected.emission_nm.len() {
                let (a, b) = (expected.total(j), found.total(every * j));
                assert!(
                    (a - b).abs() <= 1e-12 * a.abs().max(1.0),
                    "{} at {}: {a} {b}",
                    lamp.name(),
                    expected.emission_nm[j]
                );
            }
        }
        let colour = |one: &bbrf::donaldson::Prediction| one.colour(Observer::Ten).unwrap().xyz;
        for c in 0..3 {
            let off = (colour(&expected)[c] - colour(&others[0])[c]).abs();
            assert!(off < 1e-11, "{}: {off}", lamp.name());
        }
    }
}

/// Case 27. Whatever the steps and origins, what falls in is shared out whole: a line between two excitations is not lost, as it is
/// by sampling, and what is excited and emitted in one band is counted once.
#[test]
fn other_steps_and_origins_lose_no_light_and_count_no_band_twice() {
    let lamp = lines();
    let whole: f64 =
        lamp.nm().windows(2).zip(lamp.values().windows(2)).map(|(nm, v)| (nm[1] - nm[0]) * (v[0] + v[1]) / 2.0).sum();
    let exact = surface(&axis(300.0, 780.0, 1.0), &axis(380.0, 780.0, 10.0)).under(&lamp, Extend::Zero);
    for (excitation, emission) in [
        (axis(300.0, 780.0, 10.0), axis(380.0, 780.0, 10.0)),
        (axis(300.0, 780.0, 7.5), axis(380.0, 780.0, 5.0)),
        (axis(300.0, 780.0, 8.0), axis(383.0, 779.0, 6.0)),
    ] {
        let one = surface(&excitation, &emission);
        let shares: f64 = one.shares(&lamp).iter().sum();
        assert!((shares / whole - 1.0).abs() < 1e-12, "{shares} of {whole}");
        let found = one.under(&lamp, Extend::Zero);
        let ratio = found.luminescent_sum() / exact.luminescent_sum();
        assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
        let sampled: f64 =
            one.excitation_nm.iter().map(|nm| (*nm - 300.0) * 5.0).map(|k| lamp.values()[k.round() as usize]).sum();
        assert!((10.0 * sampled / whole - 1.0).abs() > 0.1, "sampling would have done as well");
    }
    // Under equal energy the factor of a band is the sum of its cells, the shared one once.
    let (excitation, emission, values) = values(10.0);
    let matrix = Matrix::of(&measurement("a", &excitation, &emission, values.clone(), None, None)).unwrap();
    let parts = separate(&matrix, Separate::default()).unwrap();
    let found = Reradiation::of(&matrix, &parts, Luminescence::Full).under(&Light::named("E").unwrap(), Extend::Zero);
    for j in 0..emission.len() {
        let sum: f64 = values.column(j).sum();
        // The first and last excitation count half: the integral ends there.
        let ends = (values[(0, j)] + values[(excitation.len() - 1, j)]) / 2.0;
        let is_inside = j > 0 && j + 1 < emission.len();
        let factor = found.factor(j).unwrap().0;
        assert!(!is_inside || (factor - sum + ends).abs() < 1e-9, "{}: {factor}, cells {sum}", emission[j]);
    }
}

/// Case 28. Tables of lamps begin at 380 nm: multiplied as they are, the brightest part of a fluorescent white is gone.
#[test]
fn light_that_begins_at_380_nm_says_what_the_matrix_misses() {
    let orange = surface(&axis(300.0, 780.0, 10.0), &axis(380.0, 780.0, 10.0));
    assert_eq!(orange.under(&Light::named("D65").unwrap(), Extend::Zero).unlit, Vec::new());
    let equal = Light::named("E").unwrap();
    let cut = light(&[380.0, 780.0], &[100.0, 100.0]);
    let (whole, missing) = (orange.under(&equal, Extend::Zero), orange.under(&cut, Extend::Zero));
    let [unlit] = missing.unlit.as_slice() else { panic!("{:?}", missing.unlit) };
    assert_eq!((unlit.from_nm, unlit.to_nm, unlit.is_excitation, unlit.is_emission), (300.0, 380.0, true, false));
    let lost = 1.0 - missing.luminescent_sum() / whole.luminescent_sum();
    assert!(
        lost > 0.1 && (unlit.luminescence_lost - lost).abs() < 1e-12 && (unlit.excitation_share - lost).abs() < 1e-12
    );
    let colour = |one: &bbrf::donaldson::Prediction| one.colour(Observer::Two).unwrap();
    let difference = colour(&whole).difference(&colour(&missing)).unwrap();
    assert!((unlit.difference.unwrap().de76 - difference.de76).abs() < 1e-9 && difference.de76 > 1.0, "{difference:?}");
    assert_eq!(orange.under(&cut, Extend::Flat).total(22), whole.total(22));
    // A light that ends within the emission leaves reflected light out as well.
    let short = orange.under(&light(&[300.0, 700.0], &[1.0, 1.0]), Extend::Zero);
    assert!(short.unlit.len() == 1 && short.unlit[0].is_emission && short.irradiance[40] == 0.0);
}

/// Case 29. Clamped at 0, the noise of two thousand cells adds up to luminescence that is not there.
#[test]
fn noise_below_zero_averages_out_and_clamped_noise_does_not() {
    let plain = surface(&axis(300.0, 780.0, 10.0), &axis(380.0, 780.0, 10.0));
    let d65 = Light::named("D65").unwrap();
    let noisy = |random: &mut Random, clamp: bool| {
        let density = plain.density.mapv(|value| {
            let noisy = value + 2e-4 * random.normal();
            if clamp { noisy.max(0.0) } else { noisy }
        });
        let parts = (plain.excitation_nm.clone(), plain.emission_nm.clone(), plain.elastic.clone());
        Reradiation::from_parts(parts.0, parts.1, parts.2, density).unwrap()
    };
    let truth = plain.under(&d65, Extend::Zero).colour(Observer::Two).unwrap();
    let trials = 40;
    for clamp in [false, true] {
        let mut random = Random::new(29);
        let mut mean = [0.0; 3];
        for _ in 0..trials {
            let colour = noisy(&mut random, clamp).under(&d65, Extend::Zero).colour(Observer::Two).unwrap();
            (0..3).for_each(|c| mean[c] += colour.xyz[c] / f64::from(trials));
        }
        let mean = bbrf::donaldson::Colour { xyz: mean, ..truth };
        let bias = mean.difference(&truth).unwrap().de76;
        println!("clamped {clamp}: the mean is off by {bias:.2} (CIE76)");
        assert!(if clamp { bias > 2.0 } else { bias < 0.3 }, "clamped {clamp}: {bias}");
    }
}

/// Case 30. Under an ultraviolet lamp nothing falls in where it glows: the ratio is 0/0, the radiance is what one sees.
#[test]
fn a_band_without_light_has_radiance_and_no_factor() {
    let orange = surface(&axis(300.0, 780.0, 10.0), &axis(380.0, 780.0, 10.0));
    let black = light(&[300.0, 360.0, 365.0, 370.0, 780.0], &[0.0, 0.0, 1.0, 0.0, 0.0]);
    let found = orange.under(&black, Extend::Zero);
    let glow = found.emission_nm.iter().position(|nm| *nm == 610.0).unwrap();
    assert!(found.total(glow) > 0.0 && found.elastic[glow] == 0.0 && found.total(glow).is_finite());
    assert_eq!((found.factor(glow), found.luminescent_factor(glow)), (None, None));
    assert_eq!(found.colour(Observer::Two), None, "there is no white to compare with");
    assert!(found.visible.luminescent[230] > 0.0);
    let expected = 5.0 * luminescence(365.0, 610.0);
    assert!((found.luminescent[glow] / expected - 1.0).abs() < 0.02, "{} {expected}", found.luminescent[glow]);
}

/// Case 31. A fluorescent yellow is brighter than white; who clips XYZ loses just what makes it so.
#[test]
fn a_colour_brighter_than_white_is_kept() {
    let (excitation, emission) = (axis(300.0, 780.0, 10.0), axis(380.0, 780.0, 10.0));
    let density = Array2::from_shape_fn((excitation.len(), emission.len()), |(i, j)| {
        let (x, m) = (excitation[i], emission[j]);
        if m > x && x < 500.0 { 0.9 * (-((m - 530.0) / 15.0).powi(2) / 2.0).exp() / 37.6 } else { 0.0 }
    });
    let elastic = emission.iter().map(|nm| reflectance(nm + 65.0).min(0.95)).collect();
    let yellow = Reradiation::from_parts(excitation, emission, elastic, density).unwrap();
    let found = yellow.under(&Light::named("D65").unwrap(), Extend::Zero);
    let colour = found.colour(Observer::Two).unwrap();
    let [l, _, b] = colour.lab().unwrap();
    assert!(colour.xyz[1] > 110.0 && l > 103.0 && b > 50.0, "{colour:?} {l} {b}");
    assert!((0..found.emission_nm.len()).any(|j| found.factor(j).unwrap().0 > 1.5));
    assert!((colour.white[1] - 100.0).abs() < 1e-9);
}
