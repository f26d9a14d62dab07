//! A sphere drawn fast is the sphere that the terms make.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/bispectral.rs"]
mod bispectral;
#[path = "common/scans.rs"]
mod scans;
#[path = "common/units.rs"]
mod units;

use bbrf::donaldson::{Extend, Light, Observer};
use bbrf::simulate::convex::{Colours, Component, Lighting, Method, Renderer, Scene, Sphere, render_dense};
use bbrf::simulate::{Film, Spectral};
use bbrf::terms::{Denominator, Distribution, TorranceSparrow};
use scans::Random;
use units::units;

const SIZE: (usize, usize) = (43, 37);
/// Rows long enough for several groups of pixels with and without a lobe.
const WIDE: (usize, usize) = (301, 11);

fn pick<T: Copy>(random: &mut Random, all: &[T]) -> T {
    all[(random.uniform() * all.len() as f64) as usize % all.len()]
}

/// From everywhere: the camera, the side, behind, and exactly along the axes and between them.
fn direction(random: &mut Random) -> [f64; 3] {
    let any = |random: &mut Random| [0; 3].map(|_| random.normal());
    match (random.uniform() * 5.0) as usize {
        0 => any(random),
        1 => [random.normal(), random.normal(), 1e-3 * random.normal()],
        2 => [0.05 * random.normal(), 0.05 * random.normal(), 1.0],
        3 => [0.3 * random.normal(), 0.3 * random.normal(), -1.0],
        _ => pick(
            random,
            &[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, -1.0]],
        ),
    }
}

fn lobe(random: &mut Random) -> TorranceSparrow {
    let distribution = pick(random, Distribution::ALL);
    TorranceSparrow {
        intensity: random.log_between(1e-3, 100.0),
        roughness: distribution.roughness_from_half_width(random.log_between(0.002, 1.0)),
        refractive_index: 1.0 + random.log_between(1e-3, 2.0),
        distribution,
        denominator: pick(random, Denominator::ALL),
    }
}

fn colour(random: &mut Random) -> [f64; 3] {
    [0; 3].map(|_| if random.uniform() < 0.1 { 0.0 } else { random.log_between(1e-3, 100.0) })
}

fn scene(random: &mut Random, point: bool, size: (usize, usize)) -> Scene {
    let (width, height) = (size.0 as f64, size.1 as f64);
    let sphere = match (random.uniform() * 3.0) as usize {
        0 => Sphere::filling(size.0, size.1),
        // Beyond the film, and small.
        1 => Sphere::new([random.uniform() * width, random.uniform() * height], random.between(1.0, 1.4 * width)),
        _ => Sphere::new([width / 2.0, height / 2.0], 0.42 * width),
    };
    let towards = direction(random);
    let lighting = if point {
        let length = towards.iter().map(|x| x * x).sum::<f64>().sqrt();
        let distance = 1.0 + random.log_between(0.02, 100.0);
        Lighting::Point(towards.map(|x| x / length * distance))
    } else {
        Lighting::Directional(towards)
    };
    let colours = Colours { luminescent: colour(random), diffuse: colour(random), specular: colour(random) };
    Scene::new(sphere.unwrap(), lighting, colours, lobe(random)).unwrap()
}

/// The worst pixel.
fn worst(a: &Film, b: &Film) -> (i64, f32, f32) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let pairs = a.numbers().iter().zip(b.numbers());
    pairs.map(|(a, b)| (units(*a, *b), *a, *b)).max_by_key(|(units, ..)| *units).unwrap()
}

fn film_of(size: (usize, usize)) -> Film {
    Film::new(size.0, size.1).unwrap()
}

fn film() -> Film {
    film_of(SIZE)
}

/// Draws random scenes both ways; every component of each.
fn compare(point: bool, size: (usize, usize), seed: u64, count: usize) {
    let mut random = Random::new(seed);
    let (mut fast, mut reference) = (film_of(size), film_of(size));
    let mut bright = 0;
    for case in 0..count {
        let scene = scene(&mut random, point, size);
        for component in Component::ALL {
            let way = Renderer::default().render(&scene, *component, &mut fast).unwrap();
            assert_eq!(way, Method::Lanes, "{scene:?}");
            Renderer::default().generic().render(&scene, *component, &mut reference).unwrap();
            let (units, fast_value, value) = worst(&fast, &reference);
            assert!(units <= 1, "case {case} {component}: {fast_value:e}, by the terms {value:e}: {scene:?}");
            assert!(fast.numbers().iter().all(|value| value.is_finite()), "case {case} {component}: {scene:?}");
            bright += usize::from(fast.numbers().iter().any(|value| *value > 0.0));
        }
    }
    assert!(bright > 2 * count, "{bright} images of {count} scenes were not black");
}

#[test]
fn every_pixel_under_parallel_light_is_that_of_the_terms() {
    compare(false, SIZE, 1, 2000);
    compare(false, WIDE, 8, 1000);
}

#[test]
fn every_pixel_under_a_point_light_is_that_of_the_terms() {
    compare(true, SIZE, 2, 2000);
    compare(true, WIDE, 9, 1000);
}

#[test]
fn threads_change_no_bit_and_vector_instructions_the_last_at_most() {
    let mut random = Random::new(3);
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (one, two) = (pool(1), pool(2));
    for case in 0..300 {
        let scene = scene(&mut random, case % 2 == 0, SIZE);
        let draw = |renderer: Renderer, pool: &rayon::ThreadPool| {
            let mut film = film();
            pool.install(|| renderer.render(&scene, Component::Total, &mut film)).unwrap();
            film
        };
        let bits = |film: &Film| film.numbers().iter().map(|value| value.to_bits()).collect::<Vec<u32>>();
        let first = draw(Renderer::default(), &one);
        assert_eq!(bits(&first), bits(&draw(Renderer::default(), &two)), "two threads");
        let plain = draw(Renderer::default().plain(), &two);
        assert_eq!(bits(&plain), bits(&draw(Renderer::default().plain(), &one)), "two threads, plain");
        let (units, value, plain) = worst(&first, &plain);
        assert!(units <= 1, "{value:e}, plain {plain:e}: {scene:?}");
    }
}

#[test]
fn a_film_that_is_used_again_keeps_nothing_of_the_last_image() {
    let mut random = Random::new(4);
    let mut used = film();
    for case in 0..200 {
        let scene = scene(&mut random, case % 2 == 0, SIZE);
        let mut fresh = film();
        Renderer::default().render(&scene, Component::Total, &mut used).unwrap();
        Renderer::default().render(&scene, Component::Total, &mut fresh).unwrap();
        assert_eq!(used, fresh);
    }
}

#[test]
fn a_specular_term_that_the_fast_way_does_not_cover_is_drawn_by_the_terms_and_said_so() {
    let mut random = Random::new(5);
    let sphere = Sphere::filling(SIZE.0, SIZE.1).unwrap();
    let colours = Colours { luminescent: [1.0; 3], diffuse: [2.0; 3], specular: [3.0; 3] };
    for (roughness, refractive_index) in [(1e-6, 1.5), (50.0, 1.5), (0.1, 1.0 + 1e-12)] {
        let term = TorranceSparrow { roughness, refractive_index, ..lobe(&mut random) };
        let term = TorranceSparrow { distribution: Distribution::Gaussian, ..term };
        let scene = Scene::new(sphere, Lighting::Directional([0.3, 0.2, 1.0]), colours, term).unwrap();
        assert_eq!(Renderer::default().render(&scene, Component::Total, &mut film()), Ok(Method::Generic));
    }
}

#[test]
fn what_is_no_scene_is_refused_with_what_was_found() {
    let sphere = Sphere::filling(8, 8).unwrap();
    let colours = Colours { luminescent: [1.0; 3], diffuse: [1.0; 3], specular: [1.0; 3] };
    let term = lobe(&mut Random::new(6));
    let refused = |lighting, colours, term| Scene::new(sphere, lighting, colours, term).unwrap_err().to_string();
    let front = Lighting::Directional([0.0, 0.0, 1.0]);
    assert!(refused(Lighting::Directional([0.0; 3]), colours, term).contains("(0, 0, 0)"));
    assert!(refused(Lighting::Directional([f64::NAN, 0.0, 1.0]), colours, term).contains("NaN"));
    assert!(refused(Lighting::Point([0.0, 0.0, 0.5]), colours, term).contains("0.5"));
    let endless = Colours { diffuse: [1.0, f64::INFINITY, 0.0], ..colours };
    assert!(refused(front, endless, term).contains("diffuse colour inf"));
    assert!(refused(front, colours, TorranceSparrow { roughness: -1.0, ..term }).contains("roughness"));
    assert!(Film::new(0, 5).is_err() && Film::new(usize::MAX, 2).is_err());
    assert!(Sphere::new([0.0, f64::NAN], 3.0).is_err() && Sphere::new([0.0; 2], f64::INFINITY).is_err());
}

fn orange() -> Spectral {
    let (excitation, emission) = (bispectral::axis(300.0, 780.0, 10.0), bispectral::axis(380.0, 780.0, 10.0));
    let surface = bispectral::surface(&excitation, &emission);
    Spectral::new(&surface, &Light::named("D65").unwrap(), Extend::Zero, Observer::Two).unwrap()
}

#[test]
fn three_numbers_per_term_make_the_image_of_the_whole_bispectral_product() {
    let spectral = orange();
    let mut random = Random::new(7);
    let (mut fast, mut dense) = (film(), film());
    for case in 0..300 {
        let mut term = lobe(&mut random);
        term.distribution = Distribution::GaussianHalfHeight;
        term.roughness = random.log_between(0.002, 1.0);
        let lighting = match case % 2 {
            0 => Lighting::Point([0.5, 1.0, 1.0 + 10.0 * random.uniform()]),
            _ => Lighting::Directional(direction(&mut random)),
        };
        let sphere = Sphere::filling(SIZE.0, SIZE.1).unwrap();
        let scene = Scene::new(sphere, lighting, spectral.colours(), term).unwrap();
        Renderer::default().render(&scene, Component::Total, &mut fast).unwrap();
        assert!(render_dense(&scene, &spectral, &mut dense));
        let (units, one, other) = worst(&fast, &dense);
        assert!(units <= 1, "case {case}: {one:e}, dense {other:e}: {scene:?}");
    }
}

/// 1 nm sums and sums over the wavelengths of the matrix differ by what 10 nm steps leave out.
#[test]
fn the_colours_are_those_that_the_surface_has_under_the_light() {
    let (excitation, emission) = (bispectral::axis(300.0, 780.0, 10.0), bispectral::axis(380.0, 780.0, 10.0));
    let surface = bispectral::surface(&excitation, &emission);
    let light = Light::named("D65").unwrap();
    let found = surface.under(&light, Extend::Zero).colour(Observer::Two).unwrap();
    let colours = orange().colours();
    for c in 0..3 {
        let sum = colours.luminescent[c] + colours.diffuse[c];
        assert!((sum / found.xyz[c] - 1.0).abs() < 0.01, "{sum} and {}", found.xyz[c]);
        assert!(
            (colours.specular[c] / found.white[c] - 1.0).abs() < 0.01,
            "{} {}",
            colours.specular[c],
            found.white[c]
        );
    }
}
