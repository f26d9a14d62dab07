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
use bbrf::donaldson::{Colour, Extend, Light, Luminescence, Matrix, Observer, Reradiation, Separate, separate};
use bbrf::quantity::QuantityKind;
use ndarray::{Array2, ArrayView1, Axis};
use scans::Random;

/// Spectra that are predicted together.
const BLOCK: usize = 10_000;
const LIGHTS: [&str; 8] = ["D65", "A", "D50", "C", "E", "FL2", "FL11", "LED-B3"];

/// A surface over lights that are given on one axis: everything is linear in them.
struct Operators {
    /// Radiance of each emission from each wavelength of the light \[light, emission\].
    dense: Array2<f64>,
    /// Its elastic part alone: for each emission where its window begins, and what it weighs.
    elastic: Vec<(usize, Vec<f64>)>,
    /// The share of each excitation in the light, in the same form.
    shares: Vec<(usize, Vec<f64>)>,
    /// How many excitations lie at or below each emission.
    below: Vec<usize>,
    /// Excitation \[excitation, k\] and emission \[emission, k\] of the factors.
    excited: Array2<f64>,
    emitted: Array2<f64>,
    /// X, Y and Z from radiances \[emission, 3\], and those of white from the light \[light, 3\].
    colour: Array2<f64>,
    white: Array2<f64>,
}

const NAMES: [&str; 6] = [
    "dense product, 64 bit",
    "dense product, 32 bit",
    "factors and elastic part",
    "colour alone (3 numbers)",
    "one light: product made once, scaled",
    "one light: its colour, scaled",
];

fn light(nm: &[f64], values: Vec<f64>) -> Light {
    Light::new("unit", QuantityKind::RelativeSpectrum, nm.to_vec(), values, None).unwrap()
}

fn operators(measurement: &Measurement, nm: &[f64]) -> Operators {
    let matrix = Matrix::of(measurement).unwrap();
    let parts = separate(&matrix, Separate::default()).unwrap();
    let surface = Reradiation::of(&matrix, &parts, Luminescence::Full);
    let (rows, columns, k) = (nm.len(), matrix.emission_nm.len(), parts.factors.rank());
    let mut all = Operators {
        dense: Array2::zeros((rows, columns)),
        elastic: Vec::new(),
        shares: Vec::new(),
        below: Vec::new(),
        excited: parts.factors.excitation.t().to_owned(),
        emitted: Array2::zeros((columns, k)),
        colour: Array2::zeros((columns, 3)),
        white: Array2::zeros((rows, 3)),
    };
    let width = matrix.emission_width_nm();
    let (mut elastic, mut shares) = (Array2::zeros((rows, columns)), Array2::zeros((rows, matrix.excitation_nm.len())));
    for row in 0..rows {
        let mut values = vec![0.0; rows];
        values[row] = 1.0;
        let unit = light(nm, values);
        let found = surface.under(&unit, Extend::Zero);
        for j in 0..columns {
            all.dense[(row, j)] = found.total(j);
            elastic[(row, j)] = found.elastic[j];
            let matching = Observer::Two.matching(matrix.emission_nm[j] as usize);
            (0..3).for_each(|c| all.white[(row, c)] += matching[c] * width[j] * found.irradiance[j]);
        }
        surface.shares(&unit).iter().enumerate().for_each(|(i, share)| shares[(row, i)] = *share);
    }
    for (j, width) in width.iter().enumerate() {
        (0..k).for_each(|factor| all.emitted[(j, factor)] = parts.factors.emission[(factor, j)] / width);
        all.below.push(matrix.excitation_nm.partition_point(|nm| *nm <= matrix.emission_nm[j]));
        let matching = Observer::Two.matching(matrix.emission_nm[j] as usize);
        (0..3).for_each(|c| all.colour[(j, c)] = matching[c] * width);
    }
    all.elastic = elastic.columns().into_iter().map(band).collect();
    all.shares = shares.columns().into_iter().map(band).collect();
    all
}

/// Where a column is not 0: the first row, and the values from there.
fn band(column: ArrayView1<'_, f64>) -> (usize, Vec<f64>) {
    let used: Vec<usize> = (0..column.len()).filter(|row| column[*row] != 0.0).collect();
    let (first, last) = (used.first().copied().unwrap_or(0), used.last().copied().unwrap_or(0));
    (first, (first..=last).map(|row| column[row]).collect())
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

/// Elastic light and products of factors. An emission is excited at or below its wavelength only: the product alone would let what
/// red light seems to excite in the noise shine in the blue, which is wrong by ten units of CIE76.
fn by_factors(all: &Operators, light: &Array2<f64>) -> Array2<f64> {
    let sum = |light: &[f64], (first, weights): &(usize, Vec<f64>)| {
        light[*first..].iter().zip(weights).map(|(light, weight)| light * weight).sum::<f64>()
    };
    let mut out = Array2::zeros((light.nrows(), all.elastic.len()));
    let mut excited = vec![0.0; all.excited.ncols()];
    for (mut out, light) in out.rows_mut().into_iter().zip(light.rows()) {
        let light = light.to_slice().unwrap();
        excited.fill(0.0);
        let mut excitation = 0;
        for (j, value) in out.iter_mut().enumerate() {
            while excitation < all.below[j] {
                let share = sum(light, &all.shares[excitation]);
                excited.iter_mut().zip(all.excited.row(excitation)).for_each(|(sum, factor)| *sum += share * factor);
                excitation += 1;
            }
            let luminescent: f64 = excited.iter().zip(all.emitted.row(j)).map(|(a, b)| a * b).sum();
            *value = sum(light, &all.elastic[j]) + luminescent;
        }
    }
    out
}

fn colour(xyz: ArrayView1<'_, f64>, white: ArrayView1<'_, f64>) -> Colour {
    let of = |one: ArrayView1<'_, f64>| [0, 1, 2].map(|c| 100.0 * one[c] / white[1]);
    Colour { observer: Observer::Two, xyz: of(xyz), white: of(white) }
}

/// Times and colour differences of each way, over so many predictions.
fn measure(all: &Operators, lights: &[Vec<f64>], count: usize) -> ([Duration; 6], [Vec<f64>; 6]) {
    let mut times = [Duration::ZERO; 6];
    let mut off: [Vec<f64>; 6] = Default::default();
    let dense_32 = all.dense.mapv(|value| value as f32);
    let three = all.dense.dot(&all.colour);
    let once = ArrayView1::from(&lights[0]).insert_axis(Axis(0)).dot(&all.dense);
    let colour_once = once.dot(&all.colour);
    let mut random = Random::new(1);
    for _ in 0..count.div_ceil(BLOCK) {
        let light = incident(lights, &mut random);
        let light_32 = light.mapv(|value| value as f32);
        let scales: Vec<f64> = (0..BLOCK).map(|_| random.uniform()).collect();
        let mut timed = |way: usize, work: &dyn Fn() -> Array2<f64>| {
            let begin = Instant::now();
            let out = black_box(work());
            times[way] += begin.elapsed();
            out
        };
        let dense = timed(0, &|| light.dot(&all.dense));
        let reference = dense.dot(&all.colour);
        let white = light.dot(&all.white);
        let mut single = Array2::<f32>::zeros((0, 0));
        let begin = Instant::now();
        single.clone_from(&black_box(light_32.dot(&dense_32)));
        let time_32 = begin.elapsed();
        let found = [
            (1, single.mapv(f64::from).dot(&all.colour)),
            (2, timed(2, &|| by_factors(all, &light)).dot(&all.colour)),
            (3, timed(3, &|| light.dot(&three))),
        ];
        // The scaled light keeps its colour beside its own white.
        let scaled =
            |base: &Array2<f64>| Array2::from_shape_fn((BLOCK, base.ncols()), |(row, c)| scales[row] * base[(0, c)]);
        let own = scaled(&ArrayView1::from(&lights[0]).insert_axis(Axis(0)).to_owned());
        let own_reference = own.dot(&all.dense).dot(&all.colour);
        let own_white = own.dot(&all.white);
        let products = timed(4, &|| scaled(&once)).dot(&all.colour);
        let colours = timed(5, &|| scaled(&colour_once));
        times[1] += time_32;
        let mut compare = |way: usize, xyz: &Array2<f64>, reference: &Array2<f64>, white: &Array2<f64>| {
            for row in (0..BLOCK).step_by(10) {
                let of = |xyz: &Array2<f64>| colour(xyz.row(row), white.row(row));
                off[way].push(of(xyz).difference(&of(reference)).unwrap().de76);
            }
        };
        compare(0, &reference, &reference, &white);
        found.iter().for_each(|(way, xyz)| compare(*way, xyz, &reference, &white));
        compare(4, &products, &own_reference, &own_white);
        compare(5, &colours, &own_reference, &own_white);
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
    let nm = bispectral::axis(300.0, 780.0, 5.0);
    let on_axis = |name: &&str| {
        let light = Light::named(name).unwrap();
        let at = |nm: f64| {
            let k = light.nm().partition_point(|one| *one <= nm).min(light.nm().len() - 1);
            if k == 0 {
                return 0.0;
            }
            let part = (nm - light.nm()[k - 1]) / (light.nm()[k] - light.nm()[k - 1]);
            light.values()[k - 1] + part * (light.values()[k] - light.values()[k - 1])
        };
        nm.iter().map(|nm| at(*nm)).collect::<Vec<f64>>()
    };
    let lights: Vec<Vec<f64>> = LIGHTS.iter().map(on_axis).collect();
    let orange = bispectral::document().measurements.remove(0);
    let mut materials = vec![orange];
    materials.extend(bispectral::real());
    for (index, material) in materials.iter().enumerate() {
        let all = operators(material, &nm);
        let (times, mut off) = measure(&all, &lights, if index == 0 { count } else { BLOCK });
        let (rows, columns) = all.dense.dim();
        println!("{}: light {rows} x emission {columns}, {} factors", material.id, all.excited.ncols());
        for (way, name) in NAMES.iter().enumerate() {
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
