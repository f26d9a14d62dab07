//! A million pixels of a fluorescent sphere under one spectrum, with a film that is used again: three numbers per term, plain and with
//! vector instructions, on one and two threads; the terms pixel by pixel; the whole bispectral product per pixel; and NumPy's
//! matrix product of the same size beside them where `BBRF_PYTHON` says so. Medians, and the least, of so many repeats.
//!
//! `BBRF_REPEATS=5` makes fewer.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/common/bispectral.rs"]
mod bispectral;

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use bbrf::donaldson::{Extend, Light, Observer};
use bbrf::simulate::convex::{Component, Lighting, Renderer, Scene, Sphere, render_dense};
use bbrf::simulate::{Film, Spectral};
use bbrf::terms::{Denominator, Distribution, TorranceSparrow};

const SIDE: usize = 1128;

/// Milliseconds: median and least.
fn time(repeats: usize, mut work: impl FnMut()) -> (f64, f64) {
    work();
    let mut times: Vec<f64> = (0..repeats)
        .map(|_| {
            let begin = Instant::now();
            work();
            begin.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    (times[repeats / 2], times[0])
}

fn shining(roughness: f64) -> TorranceSparrow {
    TorranceSparrow {
        intensity: 30.0,
        roughness,
        refractive_index: 1.45,
        distribution: Distribution::GaussianHalfHeight,
        denominator: Denominator::CosThetaI,
    }
}

/// Units in the last place by which two films differ at most.
fn units(a: &Film, b: &Film) -> u32 {
    let pairs = a.numbers().iter().zip(b.numbers());
    pairs.map(|(a, b)| a.to_bits().abs_diff(b.to_bits())).max().unwrap_or(0)
}

const NUMPY: &str = "
import time, sys, numpy as np
count, rows, columns, repeats = map(int, sys.argv[1:])
rng = np.random.default_rng(1)
light, dense = rng.random((count, rows)), rng.random((rows, columns))
out = np.empty((count, columns))
times = []
for _ in range(repeats):
    begin = time.perf_counter()
    np.matmul(light, dense, out=out)
    times.append(1e3 * (time.perf_counter() - begin))
print(f'{sorted(times)[len(times) // 2]:9.2f} ms, least {min(times):.2f}')
";

fn main() {
    let repeats: usize = std::env::var("BBRF_REPEATS").ok().and_then(|text| text.parse().ok()).unwrap_or(41).max(1);
    let (excitation, emission) = (bispectral::axis(300.0, 780.0, 10.0), bispectral::axis(380.0, 780.0, 10.0));
    let surface = bispectral::surface(&excitation, &emission);
    let spectral = Spectral::new(&surface, &Light::named("D65").unwrap(), Extend::Zero, Observer::Two).unwrap();
    let sphere = Sphere::filling(SIDE, SIDE).unwrap();
    let (mut film, mut other) = (Film::new(SIDE, SIDE).unwrap(), Film::new(SIDE, SIDE).unwrap());
    let thirty = Lighting::Directional([0.5, 0.0, 0.75_f64.sqrt()]);
    let sixty = Lighting::Directional([0.75_f64.sqrt(), 0.0, 0.5]);
    let point = Lighting::Point([1.5, 1.0, 2.5]);
    let pools = [1, 2].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
    println!("{SIDE} x {SIDE}, ms, median (least)           1 thread            2 threads");
    for (name, lighting, roughness) in [
        ("light at 30 degrees, roughness 0.05", thirty, 0.05),
        ("light at 60 degrees, roughness 0.3", sixty, 0.3),
        ("point light, roughness 0.05", point, 0.05),
        ("point light, roughness 0.3", point, 0.3),
    ] {
        let scene = Scene::new(sphere, lighting, spectral.colours(), shining(roughness)).unwrap();
        println!("{name}");
        let mut draw = |way: &str, repeats: usize, work: &(dyn Fn(&mut Film) + Sync)| {
            let [one, two] = [0, 1].map(|pool: usize| {
                let (median, least) = time(repeats, || pools[pool].install(|| work(black_box(&mut film))));
                format!("{median:9.2} ({least:7.2})")
            });
            println!("  {way:<34}{one}   {two}");
        };
        let renderer = Renderer::default();
        let by = |renderer: Renderer| {
            move |film: &mut Film| {
                renderer.render(&scene, Component::Total, film).unwrap();
            }
        };
        draw("terms pixel by pixel", repeats.div_ceil(8), &by(renderer.generic()));
        draw("three numbers per term, plain", repeats, &by(renderer.plain()));
        draw("three numbers per term, vectors", repeats, &by(renderer));
        draw("whole product per pixel, vectors", repeats.div_ceil(8), &|film: &mut Film| {
            assert!(render_dense(&scene, &spectral, film));
        });
        renderer.render(&scene, Component::Total, &mut other).unwrap();
        println!("  most by which the last two differ  {} units in the last place", units(&film, &other));
    }
    let black = Instant::now();
    let mut fresh = Film::new(SIDE, SIDE).unwrap();
    let scene = Scene::new(sphere, thirty, spectral.colours(), shining(0.05)).unwrap();
    pools[1].install(|| Renderer::default().render(&scene, Component::Total, black_box(&mut fresh)).unwrap());
    println!("first image on a new film, 30 degrees, 2 threads {:9.2}", black.elapsed().as_secs_f64() * 1e3);
    if let Ok(python) = std::env::var("BBRF_PYTHON") {
        // As many pixels as the sphere covers.
        let pixels = film.numbers().chunks(3 * SIDE).map(|row| row[..SIDE].iter().filter(|x| **x > 0.0).count());
        let sizes = [pixels.sum(), excitation.len(), emission.len(), repeats.div_ceil(8)];
        for threads in ["1", "2"] {
            let mut numpy = Command::new(&python);
            numpy.args(["-c", NUMPY]).args(sizes.map(|size: usize| size.to_string()));
            let found = numpy.env("OPENBLAS_NUM_THREADS", threads).output().unwrap();
            let text = String::from_utf8_lossy(&found.stdout).into_owned();
            println!("NumPy, the product alone for the lit pixels, {threads} threads: {}", text.trim());
        }
    }
}
