//! A million pixels of a fluorescent sphere under one spectrum, with a film that is used again: three numbers per term, plain and with
//! vector instructions, on one and two threads; the terms pixel by pixel; the whole bispectral product per pixel; and NumPy's
//! matrix product of the same size beside them where `BBRF_PYTHON` says so. Medians, and the least, of so many repeats.
//!
//! `BBRF_REPEATS=5` makes fewer.
#![allow(missing_docs, clippy::unwrap_used)]
#![allow(unsafe_code, reason = "the peer of the product of matrices is called by pointers")]

#[path = "../tests/common/bispectral.rs"]
mod bispectral;
#[path = "../tests/common/scenes.rs"]
mod scenes;

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use bbrf::donaldson::{Extend, Light, Observer};
use bbrf::simulate::convex::{Colours, Component, Lighting, Renderer, Scene, Sphere, render_dense};
use bbrf::simulate::{
    Ball, Body, Bounces, Camera, Choice, Effect, Kept, Layer, Picture, Place, Projection, Real, Shape, Watch, plan,
    reradiate,
};
use bbrf::simulate::{Film, Spectral};
use bbrf::terms::{Denominator, Distribution, TorranceSparrow};
use ndarray::Array2;
use rayon::prelude::*;

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

/// The diffuse term of a sphere under parallel light and nothing else, as a loop written for it alone.
struct Diffuse<'a> {
    row: usize,
    towards: [f64; 3],
    colour: [f64; 3],
    out: &'a mut [f32],
}

impl pulp::WithSimd for Diffuse<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let radius = SIDE as f64 / 2.0;
        let (up, inverse) = (radius - (self.row as f64 + 0.5), 1.0 / radius);
        let square = radius * radius - up * up;
        let half = square.max(0.0).sqrt();
        let first = (radius - half - 0.5).ceil().max(0.0) as usize;
        let last = ((radius + half - 0.5).floor() as usize + 1).min(SIDE);
        let (red, rest) = self.out.split_at_mut(SIDE);
        let (green, blue) = rest.split_at_mut(SIDE);
        for plane in [&mut *red, &mut *green, &mut *blue] {
            plane[..first].fill(0.0);
            plane[last..].fill(0.0);
        }
        let pixels = red[first..last].iter_mut().zip(&mut green[first..last]).zip(&mut blue[first..last]);
        let beside = up * inverse * self.towards[1];
        for (column, ((red, green), blue)) in pixels.enumerate() {
            let right = (first as i32 + column as i32) as f64 + (0.5 - radius);
            let depth = square - right * right;
            let z = if depth > 0.0 { depth.sqrt() * inverse } else { 0.0 };
            let cosine = right * inverse * self.towards[0] + beside + z * self.towards[2];
            let lit = if (cosine > 0.0) & (z > 0.0) { cosine } else { 0.0 };
            *red = (lit * self.colour[0]) as f32;
            *green = (lit * self.colour[1]) as f32;
            *blue = (lit * self.colour[2]) as f32;
        }
    }
}

/// A scene of one effect beside the loop written for it alone.
fn one_effect(repeats: usize, sphere: Sphere, film: &mut Film, pools: &[rayon::ThreadPool; 2]) {
    let (towards, colour) = ([0.5, 0.0, 0.75_f64.sqrt()], [20.0, 30.0, 10.0]);
    let colours = Colours { luminescent: [0.0; 3], diffuse: colour, specular: [0.0; 3] };
    let scene = Scene::new(sphere, Lighting::Directional(towards), colours, shining(0.05)).unwrap();
    let (renderer, arch) = (Renderer::default(), pulp::Arch::new());
    let mut own = vec![0.0_f32; 3 * SIDE * SIDE];
    println!("diffuse term alone, light at 30 degrees");
    for (threads, pool) in [1, 2].into_iter().zip(pools) {
        // In turns, so that what else the machine does falls on both.
        let (mut of_scene, mut by_hand) = (Vec::new(), Vec::new());
        for _ in 0..=repeats {
            of_scene.push(time(1, || {
                pool.install(|| renderer.render(&scene, Component::Total, black_box(&mut *film)).unwrap());
            }));
            by_hand.push(time(1, || {
                pool.install(|| {
                    own.par_chunks_mut(3 * SIDE).with_min_len(8).enumerate().for_each(|(row, out)| {
                        arch.dispatch(Diffuse { row, towards, colour, out: black_box(out) });
                    });
                });
            }));
        }
        for (name, mut times) in [("scene", of_scene), ("loop written for it", by_hand)] {
            times.sort_by(|a, b| a.0.total_cmp(&b.0));
            println!("  {name:<34}{:9.2} ({:7.2})   {threads} threads", times[times.len() / 2].0, times[0].0);
        }
    }
    let most = film.numbers().iter().zip(&own).map(|(a, b)| a.to_bits().abs_diff(b.to_bits())).max().unwrap_or(0);
    println!("  most by which they differ          {most} units in the last place");
}

/// What `bbrf render` calls: the plan of a sphere alone beside the full simulation, and what planning adds where nothing can be skipped.
fn pictures(repeats: usize, pools: &[rayon::ThreadPool; 2]) {
    let sun = Place::Directional([0.5, 0.0, 0.75_f64.sqrt()]);
    let mut sphere = scenes::scene(
        vec![scenes::ball([0.0; 3], 1.0, 0)],
        vec![scenes::glowing("paper", 0.4, 520.0, 0.5)],
        vec![scenes::white("sun", sun)],
    );
    sphere.materials[0].specular = Some(shining(0.05));
    sphere.camera =
        Camera::new([0.0, 0.0, 9.0], [0.0; 3], [0.0, 1.0, 0.0], Projection::Orthographic { width: 2.0 }).unwrap();
    sphere.size = (SIDE, SIDE);
    let draw = |scene: &bbrf::simulate::Scene, choice: &Choice| {
        black_box(Picture::draw(scene, choice, Kept::Colour, &[Layer::Total], &Watch::default()).unwrap());
    };
    let report = |name: &str, (median, least): (f64, f64)| println!("  {name:<46}{median:9.2} ({least:7.2})");
    println!("pictures on 2 threads: a sphere alone, {SIDE} x {SIDE}");
    let planned = plan(&sphere, Kept::Colour, 0.0).unwrap().choice;
    report("plan", time(repeats, || drop(black_box(plan(&sphere, Kept::Colour, 0.0).unwrap()))));
    report("as planned, on fresh memory", time(repeats, || pools[1].install(|| draw(&sphere, &planned))));
    let full = scenes::everything(&sphere);
    report(
        "everything, the product at every pixel",
        time(repeats.div_ceil(8), || pools[1].install(|| draw(&sphere, &full))),
    );
    let mut room = sphere.clone();
    room.bodies = vec![
        scenes::ball([0.0; 3], 1.0, 0),
        Body {
            name: "other".to_owned(),
            shape: Shape::Sphere(Ball { centre: [1.6, 0.2, -0.3], radius: 0.8 }),
            material: 0,
        },
        scenes::floor(-1.5, 1),
    ];
    room.materials.push(scenes::grey(0.6));
    room.materials[0].specular = Some(TorranceSparrow { intensity: 0.3, ..shining(0.1) });
    room.sources.push(scenes::lamp("sky", Place::Surround, [0.2, 0.3, 0.4]));
    room.bounces = Bounces::Most(4);
    (room.size, room.samples) = ((320, 240), 8);
    let choice = plan(&room, Kept::Colour, 0.0).unwrap().choice;
    assert!(Effect::ALL.iter().all(|effect| choice.has(*effect)), "something is skipped");
    println!("nothing to skip, 320 x 240, 8 samples");
    let (mut alone, mut with_plan) = (Vec::new(), Vec::new());
    for _ in 0..repeats.div_ceil(2) {
        alone.push(time(1, || pools[1].install(|| draw(&room, &choice))).0);
        with_plan.push(time(1, || pools[1].install(|| draw(&room, &plan(&room, Kept::Colour, 0.0).unwrap().choice))).0);
    }
    for (name, mut times) in [("everything", alone), ("plan, and what it says", with_plan)] {
        times.sort_by(f64::total_cmp);
        report(name, (times[times.len() / 2], times[0]));
    }
    report("plan alone", time(repeats, || drop(black_box(plan(&room, Kept::Colour, 0.0).unwrap()))));
    room.materials[0].specular = None;
    report("the same without interfaces", time(repeats.div_ceil(2), || pools[1].install(|| draw(&room, &choice))));
    report("its plan", time(repeats, || drop(black_box(plan(&room, Kept::Colour, 0.0).unwrap()))));
    report(
        "plan alone, 1 CIELAB",
        time(repeats.div_ceil(8), || drop(black_box(plan(&room, Kept::Colour, 1.0).unwrap()))),
    );
}

const NUMPY: &str = "
import time, sys, numpy as np
count, rows, columns, repeats = map(int, sys.argv[1:5])
rng = np.random.default_rng(1)
light, dense = rng.random((count, rows)).astype(sys.argv[5]), rng.random((rows, columns)).astype(sys.argv[5])
out = np.empty((count, columns), sys.argv[5])
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
    one_effect(repeats, sphere, &mut other, &pools);
    pictures(repeats, &pools);
    let black = Instant::now();
    let mut fresh = Film::new(SIDE, SIDE).unwrap();
    let scene = Scene::new(sphere, thirty, spectral.colours(), shining(0.05)).unwrap();
    pools[1].install(|| Renderer::default().render(&scene, Component::Total, black_box(&mut fresh)).unwrap());
    println!("first image on a new film, 30 degrees, 2 threads {:9.2}", black.elapsed().as_secs_f64() * 1e3);
    // As many pixels as the sphere covers.
    let lit = film.numbers().chunks(3 * SIDE).map(|row| row[..SIDE].iter().filter(|x| **x > 0.0).count()).sum();
    products::<f64>("f8", [lit, excitation.len(), emission.len()], repeats.div_ceil(4), &pools);
    products::<f32>("f4", [lit, excitation.len(), emission.len()], repeats.div_ceil(4), &pools);
}

/// The product alone for the lit pixels: our own, that of a crate of hand-written vector code, and NumPy's.
fn products<A>(kind: &str, [count, rows, columns]: [usize; 3], repeats: usize, pools: &[rayon::ThreadPool; 2])
where
    A: Real + From<f32>,
{
    let any = |(i, j): (usize, usize)| A::from(((i * 31 + j * 17) % 97) as f32 / 97.0);
    let (light, dense) = (Array2::from_shape_fn((count, rows), any), Array2::from_shape_fn((rows, columns), any));
    let mut out = Array2::<A>::zeros((count, columns));
    println!("{count} spectra times {rows} x {columns}, {kind}");
    for (threads, pool) in [1, 2].into_iter().zip(pools) {
        let (median, least) = time(repeats, || {
            pool.install(|| {
                reradiate(light.as_slice().unwrap(), dense.view(), black_box(out.as_slice_mut().unwrap())).unwrap()
            });
        });
        println!("  reradiate  {threads} threads             {median:9.2} ms, least {least:.2}");
        let parallelism = if threads == 1 { gemm::Parallelism::None } else { gemm::Parallelism::Rayon(threads) };
        let (zero, one) = (A::zero(), A::one());
        let (median, least) = time(repeats, || {
            let (to, a, b) = (black_box(out.as_mut_ptr()), light.as_ptr(), dense.as_ptr());
            let [c, r] = [columns, rows].map(usize::cast_signed);
            // Sound: the three are in standard order and of these sizes.
            let work = || unsafe {
                gemm::gemm(
                    count,
                    columns,
                    rows,
                    to,
                    1,
                    c,
                    false,
                    a,
                    1,
                    r,
                    b,
                    1,
                    c,
                    zero,
                    one,
                    false,
                    false,
                    false,
                    parallelism,
                );
            };
            work();
        });
        println!("  crate gemm {threads} threads             {median:9.2} ms, least {least:.2}");
        let Ok(python) = std::env::var("BBRF_PYTHON") else { continue };
        let mut numpy = Command::new(&python);
        numpy.args(["-c", NUMPY]).args([count, rows, columns, repeats].map(|size| size.to_string())).arg(kind);
        let found = numpy.env("OPENBLAS_NUM_THREADS", threads.to_string()).output().unwrap();
        println!("  NumPy      {threads} threads             {}", String::from_utf8_lossy(&found.stdout).trim_end());
    }
}
