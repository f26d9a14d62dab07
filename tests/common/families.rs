//! Kinds of random scans, for tests and benches of whether a fit is at its optimum. Needs `scans` beside it.
#![allow(dead_code, unreachable_pub, missing_docs, missing_debug_implementations, clippy::unwrap_used)]

use bbrf::quantity::{Geometry, SignHabit};

use super::scans::{Random, Truth, paper_grid};

/// How the values scatter.
#[derive(Debug, Clone, Copy)]
pub enum Noise {
    /// By this share of each value.
    Relative(f64),
    /// By this share of the mean value, the same everywhere.
    Uniform(f64),
}

/// A kind of scan.
pub struct Family {
    pub name: &'static str,
    pub grid: Vec<Geometry>,
    pub noise: Noise,
    /// How many values are three times what they should be.
    pub outliers: usize,
    /// Share of the rows that is missing.
    pub missing: f64,
    pub truth: fn(&mut Random) -> Truth,
}

/// One scan. A value that is missing is NaN.
pub struct Scan {
    pub truth: Truth,
    pub values: Vec<f64>,
    pub sigma: Vec<f64>,
}

impl Family {
    fn new(name: &'static str) -> Self {
        let noise = Noise::Relative(0.01);
        Self { name, grid: paper_grid(), noise, outliers: 0, missing: 0.0, truth: Truth::random }
    }

    fn with_noise(name: &'static str, noise: Noise) -> Self {
        Self { noise, ..Self::new(name) }
    }

    fn with_truth(name: &'static str, truth: fn(&mut Random) -> Truth) -> Self {
        Self { truth, ..Self::new(name) }
    }

    fn over(name: &'static str, grid: Vec<Geometry>) -> Self {
        Self { grid, ..Self::new(name) }
    }

    /// The whole parameter box, 3 % noise, a fifth of the rows missing.
    pub fn whole_box() -> Self {
        Self {
            noise: Noise::Relative(0.03),
            missing: 0.2,
            ..Self::with_truth("whole box, 3 %, a fifth of the rows missing", |random| Truth {
                albedo: random.log_between(0.02, 1.0),
                intensity: random.log_between(0.01, 100.0),
                index_minus_one: random.between(0.05, 1.5),
                roughness: random.log_between(0.02, 1.0),
            })
        }
    }

    /// The standard box with relative noise.
    pub fn standard(relative: f64) -> Self {
        Self::with_noise("standard", Noise::Relative(relative))
    }

    /// The fourteen.
    pub fn all() -> Vec<Self> {
        vec![
            Self::standard(0.01),
            Self::with_noise("noise 1e-6", Noise::Relative(1e-6)),
            Self::with_noise("noise 5 %", Noise::Relative(0.05)),
            Self::with_noise("noise 20 %", Noise::Relative(0.2)),
            Self::with_noise("one sigma for all values", Noise::Uniform(0.01)),
            Self::with_truth("wide lobes, roughness 0.3 to 1.2", |random| Truth {
                roughness: random.log_between(0.3, 1.2),
                ..Truth::random(random)
            }),
            Self::with_truth("narrow lobes, roughness 0.015 to 0.045", |random| Truth {
                roughness: random.log_between(0.015, 0.045),
                ..Truth::random(random)
            }),
            Self::with_truth("weak lobes, intensity 0.01 to 1", |random| Truth {
                intensity: random.log_between(0.01, 1.0),
                ..Truth::random(random)
            }),
            Self::with_truth("small index, 1.03 to 1.2", |random| Truth {
                index_minus_one: random.between(0.03, 0.2),
                ..Truth::random(random)
            }),
            Self::with_truth("large index, 1.8 to 3", |random| Truth {
                index_minus_one: random.between(0.8, 2.0),
                ..Truth::random(random)
            }),
            Self::over("5-degree step", in_plane(5.0, 80.0)),
            Self::over("20-degree step", in_plane(20.0, 80.0)),
            Self::over("theta up to 30 degrees", in_plane(10.0, 30.0)),
            Self { outliers: 5, ..Self::new("5 values three times too high") },
        ]
    }

    pub fn scan(&self, random: &mut Random) -> Scan {
        let truth = (self.truth)(random);
        let exact: Vec<f64> = self.grid.iter().map(|geometry| truth.evaluate(geometry).0).collect();
        let mean = exact.iter().sum::<f64>() / exact.len() as f64;
        let sigma: Vec<f64> = exact
            .iter()
            .map(|value| match self.noise {
                Noise::Relative(share) => share * value,
                Noise::Uniform(share) => share * mean,
            })
            .collect();
        let mut values: Vec<f64> =
            exact.iter().zip(&sigma).map(|(value, sigma)| value + sigma * random.normal()).collect();
        for _ in 0..self.outliers {
            let at = (random.uniform() * values.len() as f64) as usize;
            values[at] = 3.0 * exact[at];
        }
        for value in &mut values {
            *value = if random.uniform() < self.missing { f64::NAN } else { *value };
        }
        Scan { truth, values, sigma }
    }
}

/// In-plane angles in steps up to a largest one, without the retro diagonal.
pub fn in_plane(step: f64, largest: f64) -> Vec<Geometry> {
    let count = (largest / step).round() as i32;
    let angles = || (-count..=count).map(|k| step * f64::from(k));
    angles()
        .flat_map(|i| angles().map(move |v| (i, v)))
        .filter(|(i, v)| *v != -*i)
        .map(|(i, v)| Geometry::from_signed(i, v, SignHabit::MirrorAtEqual).unwrap())
        .collect()
}
