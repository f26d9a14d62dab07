//! A million predictions: the dense product of matrix and light, the product made once and scaled, the factors, and the three
//! numbers of a colour alone; each with its time and with the colour difference to the dense product in double precision.
//!
//! `BBRF_PREDICTIONS=100000` makes fewer. With `BBRF_PYTHON`, NumPy makes the dense product in the same run, on one thread as we
//! do. Real matrices are added where there are some in `../shared/data`: for them the colours only.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/common/bispectral.rs"]
mod bispectral;
#[path = "../tests/common/scans.rs"]
mod scans;

use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

use bbrf::dataset::Measurement;
use bbrf::donaldson::{
    By, Colour, Extend, Light, Luminescence, Matrix, Observer, Operator, Reradiation, Separate, Way, separate,
};
use ndarray::Array2;
use scans::Random;

/// Spectra that are predicted together.
const BLOCK: usize = 10_000;
/// Step of the samples, nm.
const STEP: f64 = 5.0;
const LIGHTS: [&str; 8] = ["D65", "A", "D50", "C", "E", "FL2", "FL11", "LED-B3"];
/// The dense product in double precision first: what the others are compared with.
const WAYS: [(&str, By, bool); 4] = [
    ("dense product, 64 bit", By::Product, false),
    ("dense product, 32 bit", By::Product, true),
    ("factors and elastic part", By::Factors, false),
    ("colour alone (3 numbers)", By::Colour, false),
];
const ONCE: [&str; 2] = ["one light: product made once, scaled", "one light: its colour, scaled"];

fn operators(measurement: &Measurement) -> (usize, Vec<Operator>) {
    let matrix = Matrix::of(measurement).unwrap();
    let parts = separate(&matrix, Separate::default()).unwrap();
    let surface = Reradiation::of(&matrix, &parts, Luminescence::Full);
    let widths = matrix.emission_width_nm();
    let of = |(_, by, single): &(&str, By, bool)| {
        let way = Way { by: *by, step_nm: STEP, single: *single };
        Operator::new(&surface, Some((&parts.factors, &widths)), Observer::Two, way).unwrap()
    };
    (parts.factors.rank(), WAYS.iter().map(of).collect())
}

/// Mixtures of three lights, as what falls in from all around is.
fn incident(lights: &[Vec<f64>], random: &mut Random) -> Array2<f64> {
    let mut block = Array2::zeros((BLOCK, lights[0].len()));
    for mut row in block.rows_mut() {
        for _ in 0..3 {
            let one = &lights[(random.uniform() * lights.len() as f64) as usize % lights.len()];
            let part = random.uniform();
            row.iter_mut().zip(one).for_each(|(value, light)| *value += part * light);
        }
    }
    block
}

fn timed<T>(time: &mut Duration, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let out = black_box(work());
    *time += begin.elapsed();
    out
}

/// Colours of every tenth light.
fn colours(operator: &Operator, lights: &Array2<f64>, xyz: &Array2<f64>) -> Vec<Colour> {
    let of = |row: usize| operator.colour(&lights.row(row).to_vec(), [0, 1, 2].map(|c| xyz[(row, c)])).unwrap();
    (0..BLOCK).step_by(10).map(of).collect()
}

fn compare(off: &mut Vec<f64>, found: &[Colour], reference: &[Colour]) {
    off.extend(found.iter().zip(reference).map(|(found, reference)| found.difference(reference).unwrap().de76));
}

/// Times and colour differences of each way, and of what is made once, over so many predictions.
fn measure(operators: &[Operator], lights: &[Vec<f64>], count: usize) -> ([Duration; 6], [Vec<f64>; 6]) {
    let mut times = [Duration::ZERO; 6];
    let mut off: [Vec<f64>; 6] = Default::default();
    let dense = &operators[0];
    let alone = Array2::from_shape_fn((1, lights[0].len()), |(_, k)| lights[0][k]);
    let (radiance, colour) = dense.apply(&dense.samples(&alone));
    let radiance = radiance.unwrap();
    let mut random = Random::new(1);
    for _ in 0..count.div_ceil(BLOCK) {
        let block = incident(lights, &mut random);
        let mut reference = Vec::new();
        for (way, operator) in operators.iter().enumerate() {
            let samples = operator.samples(&block);
            timed(&mut times[way], || operator.apply_only(&samples));
            let found = colours(operator, &block, &operator.apply(&samples).1);
            if way == 0 {
                reference.clone_from(&found);
            }
            compare(&mut off[way], &found, &reference);
        }
        // A light times a number keeps its colour beside its own white.
        let scales: Vec<f64> = (0..BLOCK).map(|_| random.uniform()).collect();
        let scaled =
            |base: &Array2<f64>| Array2::from_shape_fn((BLOCK, base.ncols()), |(row, c)| scales[row] * base[(0, c)]);
        timed(&mut times[4], || scaled(&radiance));
        let found = timed(&mut times[5], || scaled(&colour));
        let own = scaled(&alone);
        let reference = colours(dense, &own, &dense.apply(&dense.samples(&own)).1);
        let found = colours(dense, &own, &found);
        (4..6).for_each(|way| compare(&mut off[way], &found, &reference));
    }
    (times, off)
}

const NUMPY: &str = "
import time, sys, numpy as np
block, count, rows, columns = map(int, sys.argv[1:])
for kind in (np.float64, np.float32):
    rng = np.random.default_rng(1)
    light = rng.random((block, rows)).astype(kind)
    dense = rng.random((rows, columns)).astype(kind)
    total = 0.0
    for _ in range(-(-count // block)):
        begin = time.perf_counter()
        light @ dense
        total += time.perf_counter() - begin
    print(f'  {np.dtype(kind).itemsize * 8} bit: {total:.3f} s')
";

fn main() {
    let count = std::env::var("BBRF_PREDICTIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(1_000_000);
    let lights: Vec<Light> = LIGHTS.iter().map(|name| Light::named(name).unwrap()).collect();
    let mut materials = vec![bispectral::document().measurements.remove(0)];
    materials.extend(bispectral::real());
    for (index, material) in materials.iter().enumerate() {
        let (rank, operators) = operators(material);
        let dense = &operators[0];
        let samples: Vec<Vec<f64>> = lights.iter().map(|light| dense.sampled(light, Extend::Zero)).collect();
        let (times, mut off) = measure(&operators, &samples, if index == 0 { count } else { BLOCK });
        let (rows, columns) = (dense.nm().len(), dense.visible_nm().len());
        println!("{}: light {rows} x visible {columns}, {rank} factors", material.id);
        for (way, name) in WAYS.iter().map(|(name, ..)| *name).chain(ONCE).enumerate() {
            off[way].sort_by(f64::total_cmp);
            let (median, worst) = (off[way][off[way].len() / 2], off[way][off[way].len() - 1]);
            let seconds = if index == 0 { format!("{:9.3} s", times[way].as_secs_f64()) } else { " ".repeat(11) };
            println!("  {name:<38}{seconds}   CIE76 median {median:.1e}, worst {worst:.1e}");
        }
        if let (0, Ok(python)) = (index, std::env::var("BBRF_PYTHON")) {
            let sizes = [BLOCK, count, rows, columns].map(|size| size.to_string());
            let mut numpy = Command::new(python);
            numpy.args(["-c", NUMPY]).args(sizes).env("OPENBLAS_NUM_THREADS", "1");
            println!("NumPy, dense product of the same sizes on one thread:");
            print!("{}", String::from_utf8_lossy(&numpy.output().unwrap().stdout));
        }
    }
}
