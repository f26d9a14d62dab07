//! Errors that hang together and instruments that see other angles than they say: what is claimed is what is found.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod scans;
}

use bbrf::dataset::{Acquisition, Document, Effect, Effects, FittedParameter, Id, Measurement, Model, Reduction, Role};
use bbrf::fit::{FitOptions, Nuisance, Share, fit_measurement};
use bbrf::quantity::{
    Bandpass, Component, CorrelatedOver, EmissionAxis, Geometry, Part, Quantity, QuantityKind, Reference, Uncertainty,
    WavelengthAxis,
};
use common::scans::{Random, Truth, paper_grid};
use ndarray::Array2;

fn trials() -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(60)
}

const TRUTH: Truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.1, index_minus_one: 0.5 };

/// A scan whose values are `exact` with the noise of each and a scale of each record.
struct Setup {
    nm: Vec<f64>,
    grid: Vec<Geometry>,
    noise: f64,
    record: f64,
}

impl Setup {
    fn document(&self, exact: &Array2<f64>, random: &mut Random) -> Document {
        let scale: Vec<f64> = self.grid.iter().map(|_| 1.0 + self.record * random.normal()).collect();
        let noise = |value: f64| self.noise * value;
        let values = Array2::from_shape_fn(exact.dim(), |(row, k)| {
            scale[row] * (exact[(row, k)] + noise(exact[(row, k)]) * random.normal())
        });
        let mut measurement = Measurement::new(
            Id::from_title("scan"),
            Role::Sample,
            Quantity { reference: Reference::None, ..Quantity::absolute(QuantityKind::RadianceFactor, Part::Total) },
            EmissionAxis::Wavelengths(WavelengthAxis::new(self.nm.clone(), Bandpass::Unstated).unwrap()),
            self.grid.iter().zip(0..).map(|(geometry, order)| Acquisition::at(Some(*geometry), order)).collect(),
            values,
        );
        let record =
            (self.record > 0.0).then(|| Component::new("record scale", vec![self.record], CorrelatedOver::Wavelengths));
        measurement.uncertainty = Uncertainty {
            standard: Some(exact.mapv(noise).into_shared()),
            components: record.into_iter().collect(),
            ..Uncertainty::default()
        };
        Document { measurements: vec![measurement], ..Document::default() }
    }
}

fn fit(document: &Document, options: &FitOptions) -> Model {
    fit_measurement(document, &document.measurements[0], options).unwrap()
}

fn parameter<'a>(model: &'a Model, name: &str) -> &'a FittedParameter {
    model.terms.iter().flat_map(|term| &term.parameters).find(|parameter| parameter.name == name).unwrap()
}

fn spectral() -> FitOptions {
    FitOptions { reduction: Reduction::None, ..FitOptions::default() }
}

/// Thirty wavelengths of one record share its error: taken for independent, roughness and index would be claimed about
/// five times too well known.
#[test]
fn wavelengths_that_share_the_scale_of_their_record_do_not_count_as_independent() {
    let nm: Vec<f64> = (0..30).map(|k| 400.0 + 10.0 * f64::from(k)).collect();
    let setup = Setup { nm, grid: paper_grid(), noise: 0.002, record: 0.01 };
    let exact = Array2::from_shape_fn((setup.grid.len(), 30), |(row, k)| {
        let truth = Truth { albedo: 0.2 + 0.02 * k as f64, ..TRUTH };
        truth.evaluate(&setup.grid[row]).0
    });
    let mut random = Random::new(11);
    let (mut square, mut claimed, mut covered) = ([0.0; 2], [0.0; 2], [0; 2]);
    let count = trials();
    for _ in 0..count {
        let model = fit(&setup.document(&exact, &mut random), &spectral());
        assert!(model.method.contains("sharing its scale"), "{}", model.method);
        for (k, (name, truth)) in [("roughness", 0.1), ("refractive_index", 1.5)].into_iter().enumerate() {
            let fitted = parameter(&model, name);
            let sigma = fitted.standard_uncertainty[0];
            square[k] += (fitted.value[0] - truth).powi(2);
            claimed[k] += sigma * sigma;
            covered[k] += usize::from(fitted.interval_low[0] <= truth && truth <= fitted.interval_high[0]);
        }
    }
    for k in 0..2 {
        let ratio = (square[k] / claimed[k]).sqrt();
        println!("error / claimed {ratio:.3}, covered {} of {count}", covered[k]);
        assert!((ratio - 1.0).abs() < 4.0 / (2.0 * count as f64).sqrt(), "parameter {k}: error / claimed {ratio}");
        assert!(covered[k] as f64 > 0.84 * count as f64, "parameter {k}: {} of {count}", covered[k]);
    }
}

/// One emission value has its whole uncertainty in one number: nothing changes.
#[test]
fn one_wavelength_is_fitted_as_before() {
    let setup = Setup { nm: vec![550.0], grid: paper_grid(), noise: 0.01, record: 0.01 };
    let exact = Array2::from_shape_fn((setup.grid.len(), 1), |(row, _)| TRUTH.evaluate(&setup.grid[row]).0);
    let model = fit(&setup.document(&exact, &mut Random::new(3)), &spectral());
    assert!(!model.method.contains("sharing its scale"), "{}", model.method);
}

/// Half a degree of misalignment changes D at the edge of a narrow lobe by tens of percent.
#[test]
fn an_offset_of_the_angles_is_found_and_its_doubt_is_carried() {
    let setup = Setup { nm: vec![550.0], grid: paper_grid(), noise: 0.01, record: 0.0 };
    let offset = 0.4;
    let effects = Effects::default().with(Effect::ViewingOffset, offset);
    let exact = Array2::from_shape_fn((setup.grid.len(), 1), |(row, _)| {
        effects.seen(&setup.grid[row]).iter().map(|(geometry, share)| share * TRUTH.evaluate(geometry).0).sum()
    });
    let nuisance = Nuisance { effect: Effect::ViewingOffset, value: 0.0, sigma: 1.0 };
    let options = FitOptions { nuisances: vec![nuisance], ..FitOptions::default() };
    let mut random = Random::new(5);
    let (mut square, mut claimed, mut worst) = (0.0, 0.0, 0.0_f64);
    let count = trials() / 2;
    for _ in 0..count {
        let document = setup.document(&exact, &mut random);
        let naive = fit(&document, &FitOptions::default());
        let model = fit(&document, &options);
        let found = &model.nuisances[0];
        square += ((found.value[0] - offset) / found.standard_uncertainty[0]).powi(2);
        for (name, truth) in [("albedo", 0.5), ("intensity", 20.0), ("roughness", 0.1), ("refractive_index", 1.5)] {
            let fitted = parameter(&model, name);
            claimed += ((fitted.value[0] - truth) / fitted.standard_uncertainty[0]).powi(2) / 4.0;
        }
        let roughness = parameter(&naive, "roughness");
        worst = worst.max((roughness.value[0] - 0.1).abs() / roughness.standard_uncertainty[0]);
        assert!(naive.residuals.reduced_chi_square > 2.0 && model.residuals.reduced_chi_square < 1.5);
    }
    let scatter = 4.0 * (2.0 / count as f64).sqrt();
    assert!((square / count as f64 - 1.0).abs() < scatter, "offset: {}", square / count as f64);
    assert!((claimed / count as f64 - 1.0).abs() < scatter, "parameters: {}", claimed / count as f64);
    assert!(worst > 3.0, "the geometry believed gives a roughness {worst} standard uncertainties off");
}

/// A source of three degrees makes a lobe of three degrees look wider and weaker.
#[test]
fn a_known_size_of_the_source_is_part_of_the_forward_model() {
    let truth = Truth { roughness: 0.05, ..TRUTH };
    let setup = Setup { nm: vec![550.0], grid: paper_grid(), noise: 1e-4, record: 0.0 };
    let effects = Effects::default().with(Effect::SourceSize, 4.0).with(Effect::Aperture, 2.0);
    let exact = Array2::from_shape_fn((setup.grid.len(), 1), |(row, _)| {
        effects.seen(&setup.grid[row]).iter().map(|(geometry, share)| share * truth.evaluate(geometry).0).sum()
    });
    let document = setup.document(&exact, &mut Random::new(2));
    let known = |effect, value| Nuisance { effect, value, sigma: 0.0 };
    let nuisances = vec![known(Effect::SourceSize, 4.0), known(Effect::Aperture, 2.0)];
    let model = fit(&document, &FitOptions { nuisances, ..FitOptions::default() });
    let naive = fit(&document, &FitOptions::default());
    let off = |model: &Model| {
        let fitted = parameter(model, "roughness");
        (fitted.value[0] - 0.05) / fitted.standard_uncertainty[0]
    };
    assert!(off(&model).abs() < 4.0, "{}", off(&model));
    assert!(off(&naive).abs() > 10.0, "{}", off(&naive));
    assert!(model.identifiability.iter().any(|note| note.contains("source-size taken as 4 degrees")));
}

/// The average over two discs against one of ten thousand points each.
#[test]
fn seven_points_on_a_disc_are_the_mean_of_a_lobe() {
    let nominal = Geometry::from_degrees(30.0, 180.0, 35.0, 0.0).unwrap();
    let effects = Effects::default().with(Effect::SourceSize, 3.0);
    let mean: f64 = effects.seen(&nominal).iter().map(|(geometry, share)| share * TRUTH.evaluate(geometry).0).sum();
    let (mut sum, mut count) = (0.0, 0.0);
    for ring in 0..100 {
        for turn in 0..100 {
            let radius = 1.5 * ((f64::from(ring) + 0.5) / 100.0_f64).sqrt();
            let angle = std::f64::consts::TAU * (f64::from(turn) + 0.5) / 100.0;
            // About the direction (30, 180), with its two tangents.
            let (sin, cos) = 30.0_f64.to_radians().sin_cos();
            let (sin_r, cos_r) = f64::to_radians(radius).sin_cos();
            let (y, x) = angle.sin_cos();
            let x_axis = -sin * cos_r - cos * sin_r * x;
            let (y_axis, z_axis) = (-sin_r * y, cos * cos_r - sin * sin_r * x);
            let theta = x_axis.hypot(y_axis).atan2(z_axis).to_degrees();
            let phi = y_axis.atan2(x_axis).to_degrees().rem_euclid(360.0);
            sum += TRUTH.evaluate(&Geometry::from_degrees(theta, phi, 35.0, 0.0).unwrap()).0;
            count += 1.0;
        }
    }
    assert!((mean / (sum / count) - 1.0_f64).abs() < 2e-4, "{mean} {}", sum / count);
}

#[test]
fn intensity_that_all_wavelengths_share_is_one_number() {
    let nm: Vec<f64> = (0..8).map(|k| 400.0 + 10.0 * f64::from(k)).collect();
    let setup = Setup { nm, grid: paper_grid(), noise: 0.01, record: 0.0 };
    let exact = Array2::from_shape_fn((setup.grid.len(), 8), |(row, k)| {
        Truth { albedo: 0.2 + 0.1 * k as f64, ..TRUTH }.evaluate(&setup.grid[row]).0
    });
    let document = setup.document(&exact, &mut Random::new(8));
    let shared = fit(&document, &FitOptions { share: Some(Share::ShapeAndIntensity), ..spectral() });
    let own = fit(&document, &spectral());
    let each = fit(&document, &FitOptions { share: None, ..spectral() });
    let counts = |model: &Model| ["albedo", "intensity", "roughness"].map(|name| parameter(model, name).value.len());
    assert_eq!((counts(&shared), counts(&own), counts(&each)), ([8, 1, 1], [8, 8, 1], [8, 8, 8]));
    for model in [&shared, &own, &each] {
        for fitted in model.terms.iter().flat_map(|term| &term.parameters).filter(|fitted| fitted.name != "albedo") {
            let truth = match fitted.name.as_str() {
                "intensity" => 20.0,
                "roughness" => 0.1,
                _ => 1.5,
            };
            for (value, sigma) in fitted.value.iter().zip(&fitted.standard_uncertainty) {
                assert!((value - truth).abs() < 4.5 * sigma, "{} {value} {sigma}", fitted.name);
            }
        }
    }
    let sigma = |model: &Model, name: &str| parameter(model, name).standard_uncertainty[0];
    // Its doubt is for the greater part that of the index, which all share in either case.
    assert!(sigma(&shared, "intensity") < sigma(&own, "intensity"));
    assert!(sigma(&own, "roughness") < 0.6 * sigma(&each, "roughness"));
}
