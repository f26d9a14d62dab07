//! Scenes whose pictures are known in closed form.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/scenes.rs"]
mod scenes;

use bbrf::simulate::{Bounces, Camera, Choice, Grid, Kept, Layer, Picture, Place, Projection, Scene, Watch};
use scenes::*;

fn spectra(scene: &Scene, choice: &Choice) -> Picture {
    Picture::draw(scene, choice, Kept::Spectra, &[Layer::Total], &Watch::default()).unwrap()
}

/// Standard deviations that a hundred pixels may be off by, once in ten thousand runs.
const FAR: f64 = 5.0;

#[test]
fn a_white_body_in_white_light_from_all_around_cannot_be_seen() {
    let mut scene = scene(vec![ball([0.0; 3], 1.0, 0)], vec![grey(1.0)], vec![white("all", Place::Surround)]);
    scene.size = (16, 16);
    for value in luminance(&draw(&scene, &everything(&scene))).iter().filter(|value| **value != 0.0) {
        assert!((f64::from(*value) - 1.0).abs() < 1e-7, "{value}");
    }
    // A hollow of many bodies, too: every path leaves in the end.
    scene.bodies = vec![ball([-1.0, 0.0, 0.0], 1.0, 0), ball([1.0, 0.0, 0.0], 1.0, 0), floor(-1.0, 0)];
    let picture = draw(&scene, &everything(&scene));
    let seen: Vec<f64> =
        luminance(&picture).iter().map(|value| f64::from(*value)).filter(|value| *value != 0.0).collect();
    let stated = picture.noise.iter().map(|value| f64::from(*value).powi(2)).sum::<f64>().sqrt() / seen.len() as f64;
    let mean = seen.iter().sum::<f64>() / seen.len() as f64;
    assert!(seen.len() > 150 && stated < 0.02);
    assert!((mean - 1.0).abs() < FAR * stated, "{mean} +- {stated}");
}

/// An integrating sphere with a lamp at its centre: E / (1 - rho) at every place, and the same with spectra that wander.
#[test]
fn a_closed_cavity_is_the_sum_of_its_series() {
    for (material, label) in [(grey(0.6), "grey"), (glowing("glow", 0.5, 560.0, 0.4), "glowing")] {
        let mut scene = scene(
            vec![ball([0.0; 3], 2.0, 0)],
            vec![material.clone()],
            vec![lamp("lamp", Place::Point([0.0; 3], 1.0), [2.0, 1.0, 0.5])],
        );
        scene.camera =
            Camera::new([0.5, 0.0, 0.1], [2.0, 0.3, 0.0], [0.0, 0.0, 1.0], Projection::Perspective { width_deg: 80.0 })
                .unwrap();
        scene.size = (6, 6);
        for (bounces, samples) in
            [(0, 4), (1, 4), (2, 4), (3, 16)].map(|(most, samples)| (Bounces::Most(most), samples))
        {
            (scene.bounces, scene.samples) = (bounces, samples);
            let picture = spectra(&scene, &everything(&scene));
            let expected = series(&scene, 0.25, bounces);
            let peak = expected.iter().copied().fold(0.0, f64::max);
            // Nothing is left to chance: every path of a sphere sees the same, and none ends before its time.
            for (plane, expected) in picture.layer(Layer::Total).unwrap().iter().zip(&expected) {
                assert!(
                    plane.iter().all(|value| (f64::from(*value) - expected).abs() < 1e-6 * peak),
                    "{label}, {bounces:?}"
                );
            }
        }
        for (bounces, samples) in
            [4, 16, 64, 256, 1024].into_iter().flat_map(|n| [(Bounces::Most(6), n), (Bounces::All, n)])
        {
            (scene.bounces, scene.samples) = (bounces, samples);
            let picture = spectra(&scene, &everything(&scene));
            let expected = luminance_of(&series(&scene, 0.25, bounces), &picture, &scene);
            let film = picture.film(&scene, Layer::Total).unwrap();
            let y: Vec<f64> = (0..36).map(|k| f64::from(film.pixel(k % 6, k / 6).unwrap()[1])).collect();
            let mean = y.iter().sum::<f64>() / y.len() as f64;
            let squares: f64 = picture.noise.iter().map(|noise| f64::from(*noise).powi(2)).sum();
            let stated = squares.sqrt() / y.len() as f64;
            assert!(
                (mean - expected).abs() < 5.0 * stated,
                "{label}, {bounces:?}, {samples}: {mean} +- {stated} for {expected}"
            );
        }
        // Many pixels of few samples: what they are off by themselves, and not what they say they are.
        (scene.bounces, scene.size) = (Bounces::All, (24, 24));
        let errors: Vec<(f64, Vec<f64>)> = [4, 16, 64, 256]
            .into_iter()
            .map(|samples| {
                (scene.samples, scene.seed) = (samples, u64::from(samples));
                let picture = spectra(&scene, &everything(&scene));
                let expected = luminance_of(&series(&scene, 0.25, Bounces::All), &picture, &scene);
                let film = picture.film(&scene, Layer::Total).unwrap();
                let y = (0..24 * 24).map(|k| f64::from(film.pixel(k % 24, k / 24).unwrap()[1]));
                (f64::from(samples), y.map(|y| y - expected).collect())
            })
            .collect();
        let (slope, sigma) = slope(&errors);
        println!("closed cavity, {label}: the error falls as n^({slope:.3} +- {sigma:.3})");
        assert!(sigma < 0.03, "{label}: {sigma}");
        assert!((slope + 0.5).abs() < FAR * sigma, "{label}: {slope} +- {sigma}");
    }
}

/// Slope of the logarithm of the root mean square of independent errors over that of the number of samples, with its standard error.
/// That of a mean square comes from the scatter of the squares.
fn slope(errors: &[(f64, Vec<f64>)]) -> (f64, f64) {
    let points: Vec<[f64; 3]> = errors
        .iter()
        .map(|(samples, errors)| {
            let count = errors.len() as f64;
            let mean = errors.iter().map(|e| e * e).sum::<f64>() / count;
            let scatter = errors.iter().map(|e| (e * e - mean).powi(2)).sum::<f64>() / (count - 1.0);
            [samples.ln(), 0.5 * mean.ln(), 0.5 * (scatter / count).sqrt() / mean]
        })
        .collect();
    let middle = points.iter().map(|[x, ..]| x).sum::<f64>() / points.len() as f64;
    let spread = points.iter().map(|[x, ..]| (x - middle).powi(2)).sum::<f64>();
    let slope = points.iter().map(|[x, y, _]| (x - middle) * y).sum::<f64>() / spread;
    let variance = points.iter().map(|[x, _, sigma]| ((x - middle) * sigma / spread).powi(2)).sum::<f64>();
    (slope, variance.sqrt())
}

/// Y of a spectrum, as the picture weighs its own; white has 1.
fn luminance_of(spectrum: &[f64], like: &Picture, scene: &Scene) -> f64 {
    let planes = spectrum.iter().map(|value| vec![*value as f32; like.width * like.height]).collect();
    let picture = Picture { layers: vec![(Layer::Total, planes)], ..like.clone() };
    f64::from(picture.film(scene, Layer::Total).unwrap().pixel(0, 0).unwrap()[1])
}

/// Radiance over all orders of a cavity where each order lights every place alike.
fn series(scene: &Scene, strength: f64, bounces: Bounces) -> Vec<f64> {
    let nm = scene.grid.nm();
    let (surface, count) = (&scene.materials[0].surface, nm.len());
    let step = scene.grid.step();
    let at = |j: usize| if surface.emission_nm.len() == 2 { surface.elastic[0] } else { surface.elastic[j] };
    let mut incident: Vec<f64> = nm
        .iter()
        .map(|nm| strength * value(scene.sources[0].light.nm(), scene.sources[0].light.values(), *nm))
        .collect();
    // The first and the last of the lamp's mean are those of half a step.
    let light = scene.sources[0].light.shares(nm);
    for k in 0..count {
        incident[k] = strength * light[k] / if k == 0 || k == count - 1 { step / 2.0 } else { step };
    }
    let orders = match bounces {
        Bounces::Most(most) => most as usize + 1,
        Bounces::All => 2000,
    };
    let mut sum = vec![0.0; count];
    for _ in 0..orders {
        let mut out = vec![0.0; count];
        for j in 0..count {
            out[j] = at(j) * incident[j];
            if surface.emission_nm.len() > 2 {
                for (i, e) in incident.iter().enumerate() {
                    let width = if i == 0 || i == count - 1 { step / 2.0 } else { step };
                    out[j] += surface.density[(i, j)] * width * e;
                }
            }
        }
        sum.iter_mut().zip(&out).for_each(|(sum, out)| *sum += out / std::f64::consts::PI);
        incident = out;
    }
    sum
}

fn value(nm: &[f64], values: &[f64], at: f64) -> f64 {
    let after = nm.iter().position(|one| *one > at).unwrap_or(nm.len() - 1).max(1);
    values[after - 1] + (at - nm[after - 1]) / (nm[after] - nm[after - 1]) * (values[after] - values[after - 1])
}

/// Two planes without end, a point light half way between them. The kernel of one plane seen from the other has the Hankel transform
/// x K_1(x) with x = k d, and the irradiance of the lamp at height h has h e^{-k h}/... : E(0) = integral of k e^{-k d/2} / (1 - rho k d K_1(k d)) dk.
#[test]
fn two_planes_without_end_are_the_sum_of_their_series_within_the_stated_error() {
    let (distance, rho) = (2.0, 0.7);
    let expected = quadrature(distance, rho);
    // Before any bounce: 1 / h^2.
    assert!((quadrature(distance, 0.0) - 1.0).abs() < 1e-6);
    let mut scene = scene(
        vec![floor(0.0, 0), floor(distance, 0)],
        vec![grey(rho)],
        vec![white("lamp", Place::Point([0.0, 0.0, 1.0], 1.0))],
    );
    // Straight down to the place below the lamp, from beside it.
    scene.camera =
        Camera::new([1e-4, 0.0, 1.5], [0.0; 3], [0.0, 1.0, 0.0], Projection::Orthographic { width: 1e-3 }).unwrap();
    scene.size = (10, 10);
    let mut errors = Vec::new();
    for samples in [4, 16, 64, 256, 1024] {
        scene.samples = samples;
        let picture = draw(&scene, &everything(&scene));
        let pixels = luminance(&picture);
        let mean = pixels.iter().map(|value| f64::from(*value)).sum::<f64>() / pixels.len() as f64;
        let stated =
            (picture.noise.iter().map(|value| f64::from(*value).powi(2)).sum::<f64>()).sqrt() / pixels.len() as f64;
        assert!((mean - rho * expected).abs() < FAR * stated, "{samples}: {mean} +- {stated} for {}", rho * expected);
        let rms = (pixels.iter().map(|value| (f64::from(*value) - rho * expected).powi(2)).sum::<f64>()
            / pixels.len() as f64)
            .sqrt();
        errors.push(rms);
    }
    let slope = (errors[4] / errors[0]).ln() / 256.0_f64.ln();
    assert!((-0.62..-0.4).contains(&slope), "the error falls as n^{slope}: {errors:?}");
}

/// Irradiance below a point light of intensity 1 half way between two planes.
fn quadrature(distance: f64, rho: f64) -> f64 {
    let (steps, most) = (200_000, 60.0);
    let width = most / f64::from(steps);
    let at = |k: f64| k * (-k * distance / 2.0).exp() / (1.0 - rho * bessel(k * distance));
    (0..steps).map(|n| at((f64::from(n) + 0.5) * width)).sum::<f64>() * width
}

/// x K_1(x) = integral of x cosh(t) exp(-x cosh t) dt.
fn bessel(x: f64) -> f64 {
    let (steps, most) = (400, (60.0 / x).max(2.0).acosh().min(40.0));
    let width = most / f64::from(steps);
    (0..=steps)
        .map(|n| {
            let c = (f64::from(n) * width).cosh();
            let ends = if n == 0 || n == steps { 0.5 } else { 1.0 };
            ends * x * c * (-x * c).exp() * width
        })
        .sum()
}

#[test]
fn a_glowing_wall_tints_the_white_one() {
    let blue = lamp("blue", Place::Directional([0.0, -0.6, 0.8]), [1.0, 0.2, 0.0]);
    let mut scene = scene(
        vec![floor(-1.0, 0), ball([0.0; 3], 1.0, 1)],
        vec![grey(0.8), glowing("orange", 0.1, 600.0, 0.6)],
        vec![blue],
    );
    scene.samples = 64;
    scene.grid = Grid::new(300.0, 780.0, 20.0).unwrap();
    let picture = spectra(&scene, &everything(&scene));
    let only_white = {
        let mut dark = scene.clone();
        dark.materials[1] = grey(0.1);
        spectra(&dark, &everything(&dark))
    };
    // 620 nm on the floor before the ball: the lamp has little of it.
    let at = |picture: &Picture| f64::from(picture.layer(Layer::Total).unwrap()[16][17 * 24 + 12]);
    assert!(at(&picture) > 1.3 * at(&only_white), "{} and {}", at(&picture), at(&only_white));
}

#[test]
fn a_body_stands_in_the_light_of_another() {
    let sun = white("sun", Place::Directional([0.0, 0.0, 1.0]));
    let mut scene = scene(vec![floor(-1.0, 0), ball([0.0; 3], 0.5, 1)], vec![grey(0.8), grey(0.0)], vec![sun]);
    scene.camera =
        Camera::new([0.0, -10.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], Projection::Orthographic { width: 4.0 })
            .unwrap();
    scene.bounces = Bounces::Most(0);
    let picture = draw(&scene, &everything(&scene));
    let values = luminance(&picture);
    let lit = values.iter().filter(|value| (f64::from(**value) - 0.8).abs() < 1e-6).count();
    let dark = values.iter().filter(|value| **value == 0.0).count();
    assert_eq!(lit + dark, values.len());
    assert!(lit > 50 && dark > 20, "{lit} lit, {dark} dark");
}

#[test]
fn the_picture_is_the_same_for_any_number_of_threads_and_another_for_another_seed() {
    let mut scene = scene(
        vec![floor(-1.0, 0), ball([0.0; 3], 1.0, 1)],
        vec![grey(0.8), glowing("orange", 0.1, 600.0, 0.6)],
        vec![white("sun", Place::Directional([0.0, -0.6, 0.8]))],
    );
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let one = pool(1).install(|| draw(&scene, &everything(&scene)));
    assert_eq!(one, pool(3).install(|| draw(&scene, &everything(&scene))));
    scene.seed = 2;
    assert_ne!(one, draw(&scene, &everything(&scene)));
}
