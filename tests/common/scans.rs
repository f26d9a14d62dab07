//! Random scans of known truth, and the peer: the `levenberg-marquardt` crate on all four parameters. Shared by tests
//! and benches.
#![allow(dead_code, unreachable_pub, missing_docs, missing_debug_implementations, clippy::unwrap_used)]

use bbrf::quantity::{Geometry, HalfAngles, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution, Term, TorranceSparrow, diffuse_factor, fresnel, specular_factor};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DVector, Dyn, Matrix4, OMatrix, U4, Vector4};

/// SplitMix64: small, documented, the same everywhere.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        (self.between(low.ln(), high.ln())).exp()
    }

    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// The paper's 17 x 17 in-plane angles without the retro diagonal: 272 geometries.
pub fn paper_grid() -> Vec<Geometry> {
    let angles = || (-8..=8).map(|step| 10.0 * f64::from(step));
    angles()
        .flat_map(|i| angles().map(move |v| (i, v)))
        .filter(|(i, v)| *v != -*i)
        .map(|(i, v)| Geometry::from_signed(i, v, SignHabit::MirrorAtEqual).unwrap())
        .collect()
}

/// Albedo, intensity, roughness, n - 1.
#[derive(Debug, Clone, Copy)]
pub struct Truth {
    pub albedo: f64,
    pub intensity: f64,
    pub roughness: f64,
    pub index_minus_one: f64,
}

impl Truth {
    /// The box of the standard recovery test.
    pub fn random(random: &mut Random) -> Self {
        Self {
            albedo: random.between(0.1, 1.0),
            intensity: random.log_between(1.0, 100.0),
            index_minus_one: random.between(0.3, 0.8),
            roughness: random.log_between(0.045, 0.4),
        }
    }

    pub fn as_array(&self) -> [f64; 4] {
        [self.albedo, self.intensity, self.roughness, self.index_minus_one]
    }

    pub fn terms(&self) -> [Term; 2] {
        [
            Term::Lambertian { albedo: self.albedo },
            Term::TorranceSparrow(TorranceSparrow {
                intensity: self.intensity,
                roughness: self.roughness,
                refractive_index: 1.0 + self.index_minus_one,
                distribution: Distribution::GaussianHalfHeight,
                denominator: Denominator::CosThetaI,
            }),
        ]
    }

    /// Value and derivatives in (albedo, intensity, roughness, n - 1).
    pub fn evaluate(&self, geometry: &Geometry) -> (f64, [f64; 4]) {
        let [diffuse, specular] = self.terms().map(|term| term.evaluate(geometry, &Reference::None).unwrap());
        (diffuse.value + specular.value, [diffuse.by[0], specular.by[0], specular.by[1], specular.by[2]])
    }

    /// Standard uncertainties at the Cramer-Rao bound for relative noise.
    pub fn cramer_rao(&self, grid: &[Geometry], relative: f64) -> [f64; 4] {
        let mut information = Matrix4::zeros();
        for geometry in grid {
            let (value, by) = self.evaluate(geometry);
            let row = Vector4::from(by) / (relative * value);
            information += row * row.transpose();
        }
        let scale = Vector4::from_fn(|k, _| information[(k, k)].sqrt().recip());
        let scaled = Matrix4::from_fn(|i, j| information[(i, j)] * scale[i] * scale[j]);
        let inverse = scaled.try_inverse().unwrap();
        std::array::from_fn(|k| inverse[(k, k)].sqrt() * scale[k])
    }
}

/// Measured values with relative noise, and their true standard uncertainties.
pub fn measure(truth: &Truth, grid: &[Geometry], relative: f64, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    grid.iter()
        .map(|geometry| {
            let value = truth.evaluate(geometry).0;
            (value * (1.0 + relative * random.normal()), relative * value)
        })
        .unzip()
}

/// What the peer may keep of the geometries: half-vector angles and angular factors are not made anew in every
/// evaluation, as a careful user of the crate would have it.
#[derive(Clone, Copy)]
pub struct Prepared {
    pub half: HalfAngles,
    pub diffuse: f64,
    pub masked: f64,
}

pub fn prepare(grid: &[Geometry]) -> Vec<Prepared> {
    grid.iter()
        .map(|geometry| {
            let half = geometry.half_angles();
            let diffuse = diffuse_factor(geometry, &Reference::None).unwrap();
            let masked = specular_factor(Denominator::CosThetaI, geometry, &half, &Reference::None).unwrap();
            Prepared { half, diffuse, masked }
        })
        .collect()
}

/// The peer's problem: albedo and intensity, ln roughness, ln(n - 1), as its documentation has it.
pub struct Peer<'a> {
    pub grid: &'a [Prepared],
    pub values: &'a [f64],
    pub sigma: &'a [f64],
    pub p: Vector4<f64>,
}

impl Peer<'_> {
    pub fn truth(&self) -> Truth {
        Truth { albedo: self.p[0], intensity: self.p[1], roughness: self.p[2].exp(), index_minus_one: self.p[3].exp() }
    }
}

impl LeastSquaresProblem<f64, Dyn, U4> for Peer<'_> {
    type ParameterStorage = Owned<f64, U4>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U4>;

    fn set_params(&mut self, p: &Vector4<f64>) {
        self.p = *p;
    }

    fn params(&self) -> Vector4<f64> {
        self.p
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let truth = self.truth();
        Some(DVector::from_fn(self.grid.len(), |k, _| {
            let point = &self.grid[k];
            let d = Distribution::GaussianHalfHeight.evaluate(&point.half, truth.roughness).value;
            let f = fresnel(&point.half, truth.index_minus_one).value;
            let predicted = truth.albedo * point.diffuse + truth.intensity * d * f * point.masked;
            (predicted - self.values[k]) / self.sigma[k]
        }))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U4>> {
        let truth = self.truth();
        let mut jacobian = OMatrix::<f64, Dyn, U4>::zeros(self.grid.len());
        for (k, point) in self.grid.iter().enumerate() {
            let d = Distribution::GaussianHalfHeight.evaluate(&point.half, truth.roughness);
            let f = fresnel(&point.half, truth.index_minus_one);
            let scaled = point.masked / self.sigma[k];
            jacobian[(k, 0)] = point.diffuse / self.sigma[k];
            jacobian[(k, 1)] = d.value * f.value * scaled;
            jacobian[(k, 2)] = truth.intensity * d.by_log_roughness * f.value * scaled;
            jacobian[(k, 3)] = truth.intensity * d.value * f.by_index * truth.index_minus_one * scaled;
        }
        Some(jacobian)
    }
}

/// The peer's chi-square and parameters from a start.
pub fn peer_fit(grid: &[Prepared], values: &[f64], sigma: &[f64], start: &Truth) -> (f64, Truth) {
    peer_fit_within(grid, values, sigma, start, 100)
}

/// The same, given up after 5 times `patience` evaluations; 100 is the crate's own number.
pub fn peer_fit_within(
    grid: &[Prepared],
    values: &[f64],
    sigma: &[f64],
    start: &Truth,
    patience: usize,
) -> (f64, Truth) {
    let p = Vector4::new(start.albedo, start.intensity, start.roughness.ln(), start.index_minus_one.ln());
    let problem = Peer { grid, values, sigma, p };
    let (problem, report) = LevenbergMarquardt::new().with_tol(1e-10).with_patience(patience).minimize(problem);
    (2.0 * report.objective_function, problem.truth())
}

/// A start drawn from the box in which a user without knowledge would draw.
pub fn random_start(random: &mut Random) -> Truth {
    Truth {
        albedo: random.log_between(0.05, 1.5),
        intensity: random.log_between(0.1, 100.0),
        index_minus_one: random.log_between(0.05, 1.5),
        roughness: random.log_between(0.005, 1.0),
    }
}
