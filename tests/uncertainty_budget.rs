//! One uncertainty budget from signals to fitted parameters: linear propagation (JCGM 100:2008), confirmed by Monte Carlo
//! (JCGM 101:2008), and the page that shows it. `BBRF_UPDATE=1` writes the page, `BBRF_TRIALS` sets the number of draws.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test")]

#[path = "common/scans.rs"]
mod scans;

use std::fmt::Write as _;

use bbrf::fit::{Fitter, GeometrySet, Terms};
use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution};
use scans::{Random, Truth};

/// A matt orange sheet with a broad highlight.
const TRUTH: Truth = Truth { albedo: 0.85, intensity: 12.0, roughness: 0.18, index_minus_one: 0.5 };
const PARAMETERS: [&str; 4] = ["albedo", "intensity", "roughness / rad", "refractive index - 1"];

/// Radiance of the white at its own geometry, over which everything is measured; the certificate's number for it.
const CERTIFIED: f64 = 0.985;
/// Relative noise of one reading, and absolute noise in units of the white's signal.
const NOISE: (f64, f64) = (0.003, 2e-4);
/// Diameter of the spot along the normal and extent of the sample, mm: beyond 76 degrees the spot leaves the sample.
const SPOT_MM: f64 = 4.19;
const SAMPLE_MM: f64 = 18.0;
/// Relative slope of the factor with wavelength at the edge of the band, per nm.
const SLOPE: f64 = 0.004;

/// What is not noise: name, standard uncertainty, how it was found.
const INPUTS: [(&str, f64, &str); 6] = [
    ("certified factor of the white, relative", 0.0025, "certificate: 0.5 %, k = 2, normal (type B)"),
    ("zero of the incidence angle, degrees", 0.1, "alignment of the stage, rectangular half width 0.17 (type B)"),
    ("zero of the viewing angle, degrees", 0.1, "alignment of the arm, rectangular half width 0.17 (type B)"),
    ("diameter of the spot, relative", 0.02, "data sheet of the lens (type B)"),
    ("stray light over the white's signal", 5e-4, "black trap in place of the sample (type A)"),
    ("wavelength scale, nm", 0.3, "lines of a mercury lamp (type A)"),
];

/// The paper's scan: -80 to 80 degrees without the retro gap.
fn angles() -> Vec<(f64, f64)> {
    let steps = || (-8..=8).map(|step| 10.0 * f64::from(step));
    steps().flat_map(|i| steps().map(move |v| (i, v))).filter(|(i, v)| *v != -*i).collect()
}

fn geometry(i: f64, v: f64) -> Geometry {
    let within = |angle: f64| angle.clamp(-89.9, 89.9);
    Geometry::from_signed(within(i), within(v), SignHabit::MirrorAtEqual).unwrap()
}

/// Share of the spot that lies on the sample.
fn on_sample(viewing_deg: f64, spot: f64) -> f64 {
    (SAMPLE_MM * viewing_deg.to_radians().cos() / spot).min(1.0)
}

/// What the instrument shows and what the laboratory makes of it, under errors of the inputs; `noise` draws a normal
/// number for each reading.
fn measured(errors: &[f64; 6], mut noise: impl FnMut() -> f64) -> Vec<f64> {
    let [certificate, incidence, viewing, spot, stray, wavelength] = *errors;
    let white = CERTIFIED * (1.0 + certificate) + stray;
    angles()
        .into_iter()
        .map(|(i, v)| {
            let true_value = TRUTH.evaluate(&geometry(i + incidence, v + viewing)).0;
            let seen = true_value * (1.0 + SLOPE * wavelength) * on_sample(v, SPOT_MM * (1.0 + spot)) + stray;
            let signal = seen * (1.0 + NOISE.0 * noise()) + NOISE.1 * noise();
            // Divided by the white, times its certificate, corrected for the share of the spot as the data sheet has it.
            signal / white * CERTIFIED / on_sample(v, SPOT_MM)
        })
        .collect()
}

/// Standard uncertainty of each value from the noise of its reading.
fn sigma(values: &[f64]) -> Vec<f64> {
    let per_angle = values.iter().zip(angles());
    per_angle.map(|(value, (_, v))| (NOISE.0 * value).hypot(NOISE.1 / on_sample(v, SPOT_MM))).collect()
}

struct Pipeline {
    set: GeometrySet,
}

impl Pipeline {
    fn new() -> Self {
        let geometry: Vec<Geometry> = angles().into_iter().map(|(i, v)| geometry(i, v)).collect();
        let (distribution, denominator) = (Distribution::GaussianHalfHeight, Denominator::CosThetaI);
        Self { set: GeometrySet::new(&geometry, &Reference::None, distribution, denominator).unwrap() }
    }

    /// Parameters and their standard uncertainties from the noise alone.
    fn fitted(&self, values: &[f64]) -> ([f64; 4], [f64; 4]) {
        let terms = Terms { diffuse: true, specular: true };
        let fit = Fitter::new(&self.set, terms).fit(values, Some(&sigma(values))).unwrap();
        let band = &fit.bands[0];
        ([band.diffuse, band.intensity, fit.roughness, fit.index_minus_one], fit.standard_uncertainty(0))
    }
}

/// Contribution of each input, in the order of `INPUTS` with the noise last, to each parameter.
fn linear(pipeline: &Pipeline) -> Vec<[f64; 4]> {
    let mut contributions: Vec<[f64; 4]> = (0..INPUTS.len())
        .map(|input| {
            let at = |sign: f64| {
                let mut errors = [0.0; 6];
                errors[input] = sign * INPUTS[input].1;
                pipeline.fitted(&measured(&errors, || 0.0)).0
            };
            let (up, down) = (at(1.0), at(-1.0));
            std::array::from_fn(|k| (up[k] - down[k]) / 2.0)
        })
        .collect();
    contributions.push(pipeline.fitted(&measured(&[0.0; 6], || 0.0)).1);
    contributions
}

/// Mean and standard deviation of the parameters over draws of everything.
fn monte_carlo(pipeline: &Pipeline, draws: usize) -> [(f64, f64); 4] {
    let mut random = Random::new(20_261_122);
    let mut sums = [(0.0, 0.0); 4];
    let centre = TRUTH.as_array();
    for _ in 0..draws {
        let errors = INPUTS.map(|(_, sigma, _)| sigma * random.normal());
        let values = measured(&errors, || random.normal());
        for (sum, (value, truth)) in sums.iter_mut().zip(pipeline.fitted(&values).0.into_iter().zip(centre)) {
            // About the truth, so that nothing cancels.
            let offset = value - truth;
            *sum = (sum.0 + offset, sum.1 + offset * offset);
        }
    }
    let n = draws as f64;
    std::array::from_fn(|k| {
        let mean = sums[k].0 / n;
        (centre[k] + mean, ((sums[k].1 / n - mean * mean) * n / (n - 1.0)).sqrt())
    })
}

fn combined(contributions: &[[f64; 4]]) -> [f64; 4] {
    std::array::from_fn(|k| contributions.iter().map(|c| c[k] * c[k]).sum::<f64>().sqrt())
}

fn trials(default: usize) -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

#[test]
fn linear_propagation_agrees_with_monte_carlo() {
    let pipeline = Pipeline::new();
    let linear = combined(&linear(&pipeline));
    let draws = trials(2000);
    let drawn = monte_carlo(&pipeline, draws);
    for k in 0..4 {
        // Scatter of a standard deviation of that many draws, four times; and 2 % for what is not linear.
        let tolerance = 4.0 / (2.0 * draws as f64).sqrt() + 0.02;
        let ratio = drawn[k].1 / linear[k];
        println!("{}: linear {:.3e}, Monte Carlo {:.3e}, ratio {ratio:.4}", PARAMETERS[k], linear[k], drawn[k].1);
        assert!((ratio - 1.0).abs() < tolerance, "{}: {ratio}", PARAMETERS[k]);
    }
}

#[test]
fn the_page_shows_the_budget() {
    let pipeline = Pipeline::new();
    let contributions = linear(&pipeline);
    let total = combined(&contributions);
    let drawn = monte_carlo(&pipeline, 2000);
    let mut table = String::from("| input | standard uncertainty | how it was found |");
    PARAMETERS.iter().for_each(|name| write!(table, " {name} |").unwrap());
    table.push_str("\n|---|---|---|---|---|---|---|\n");
    let noise = ("noise of a reading, relative", NOISE.0, "repeats (type A), independent between readings");
    for ((name, sigma, how), c) in INPUTS.iter().chain([&noise]).zip(&contributions) {
        // What only the rounding of a fit moves is nothing.
        let cell = |k: usize| if c[k].abs() < 1e-7 * total[k] { "0".to_owned() } else { format!("{:.1e}", c[k].abs()) };
        let cells = [0, 1, 2, 3].map(cell).join(" | ");
        writeln!(table, "| {name} | {sigma} | {how} | {cells} |").unwrap();
    }
    let row = |name: &str, u: [f64; 4]| format!("| **{name}** | | | {} |\n", u.map(|u| format!("{u:.1e}")).join(" | "));
    table.push_str(&row("combined, linear", total));
    table.push_str(&row("combined, Monte Carlo, 2000 draws", drawn.map(|d| d.1)));
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/uncertainty_budget.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once("<!-- table -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    if std::env::var_os("BBRF_UPDATE").is_some() {
        std::fs::write(&path, format!("{before}<!-- table -->\n{table}<!-- end -->{after}")).unwrap();
        return;
    }
    // Another mathematical library may turn a last digit.
    let numbers =
        |text: &str| -> Vec<f64> { text.split(['|', '\n', ' ']).filter_map(|word| word.parse().ok()).collect() };
    let (shown, computed) = (numbers(rest.split_once("<!-- end -->").unwrap().0), numbers(&table));
    assert_eq!(shown.len(), computed.len(), "docs/uncertainty_budget.md: run with BBRF_UPDATE=1");
    for (shown, computed) in shown.iter().zip(&computed) {
        assert!((shown - computed).abs() <= 0.11 * computed.abs(), "docs/uncertainty_budget.md: {shown} is {computed}");
    }
}
