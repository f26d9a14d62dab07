//! A document with a fitted scan, built in memory.

use bbrf::dataset::{
    Acquisition, Assumption, Document, FittedParameter, FittedTerm, Id, InputFile, Measurement, Model, Notice, Place,
    Receipt, Residuals, Role, Sample, Separability,
};
use bbrf::quantity::{
    Band, Bandpass, Basis, Component, CorrelatedOver, EmissionAxis, Geometry, NormalisedAt, Part, Quantity,
    QuantityKind, Reference, ReferenceLight, SignHabit, Uncertainty, WavelengthAxis,
};
use bbrf::report::AnglePoints;
use bbrf::terms::{Denominator, Distribution, TermKind};
use ndarray::Array2;

/// The relative noise of the scan.
pub(crate) const NOISE: f64 = 0.003;
const REFERENCE: Reference = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };

pub(crate) fn id(text: &str) -> Id {
    Id::new(text).unwrap()
}

/// Signed in-plane angles without the retro diagonal.
pub(crate) fn angles() -> Vec<(f64, f64)> {
    let axis = || (-8..=8).map(|step| f64::from(step) * 10.0);
    axis().flat_map(|i| axis().filter(move |v| *v != -i).map(move |v| (i, v))).collect()
}

/// A cosine with a lobe around the mirror direction.
fn model_value(theta_i: f64, theta_v: f64) -> f64 {
    let (i, half) = (theta_i.to_radians(), ((theta_i - theta_v) / 2.0).to_radians());
    let fresnel = 0.034 + 0.966 * (1.0 - ((theta_i + theta_v) / 2.0).to_radians().cos()).powi(5);
    1.015 * i.cos() + 2.0 * fresnel * (-std::f64::consts::LN_2 * (half / 0.1).powi(2)).exp() / i.cos()
}

/// Something like normal noise, the same on every run.
fn noise(index: usize) -> f64 {
    (0..12).map(|k| ((index * 12 + k) as f64 * 12.9898).sin() * 43758.5453).map(|x| x - x.floor()).sum::<f64>() - 6.0
}

pub(crate) fn points() -> AnglePoints {
    let angles = angles();
    let predicted: Vec<f64> = angles.iter().map(|(i, v)| model_value(*i, *v)).collect();
    AnglePoints {
        geometry: angles
            .iter()
            .map(|(i, v)| Geometry::from_signed(*i, *v, SignHabit::MirrorAtEqual).unwrap())
            .collect(),
        measured: predicted.iter().enumerate().map(|(n, value)| value * (1.0 + NOISE * noise(n))).collect(),
        sigma: predicted.iter().map(|value| NOISE * value).collect(),
        predicted,
        wavelength_nm: None,
    }
}

pub(crate) fn document() -> Document {
    let sample = Sample {
        id: id("sheet"),
        title: Some("Fluorescence sheet, yellow".to_owned()),
        simulated: true,
        ..Sample::default()
    };
    let receipt = Receipt {
        tool: "bbrf 0.1.0 import pr650".to_owned(),
        inputs: vec![InputFile {
            name: "raw/ti0_tv10.txt".to_owned(),
            sha256: "00".repeat(32),
            bytes: 1734,
            dialect: "pr650-d5".to_owned(),
            records: 1,
        }],
        assumptions: vec![Assumption {
            text: "The bandpass is 8 nm <unstated in the records>".to_owned(),
            place: Place::file("scan.csv").at_line(3),
        }],
        unfilled: vec!["instruments/pr650/serial".to_owned()],
        notices: vec![Notice { text: "24 records with quality code 18".to_owned(), place: Place::default() }],
    };
    let mut document = Document {
        title: Some("Simulated scan of a \"yellow\" sheet & its <fit>".to_owned()),
        license: Some("CC0-1.0".to_owned()),
        samples: vec![sample],
        measurements: vec![measurement()],
        models: vec![model()],
        ..Document::default()
    };
    document.provenance.receipts.push(receipt);
    document
}

fn measurement() -> Measurement {
    let nm: Vec<f64> = (0..101).map(|index| 380.0 + 4.0 * f64::from(index)).collect();
    let rows = angles();
    let spectrum =
        |nm: f64| 0.3 + 1.2 * (-((nm - 530.0) / 40.0).powi(2)).exp() + 0.5 / (1.0 + (-(nm - 520.0) / 10.0).exp());
    let value = |(row, column): (usize, usize)| rows[row].0.to_radians().cos() * spectrum(nm[column]);
    let values = Array2::from_shape_fn((rows.len(), nm.len()), value);
    let geometry = |(i, v): &(f64, f64)| Geometry::from_signed(*i, *v, SignHabit::MirrorAtEqual).ok();
    let shared = Component::new("certified factor", vec![0.005], CorrelatedOver::All);
    let quantity = Quantity {
        kind: QuantityKind::RadianceFactor,
        part: Part::Total,
        normalised_at: NormalisedAt::Emission,
        basis: Basis::Energy,
        reference: REFERENCE,
        reference_light: ReferenceLight::Same,
        certified_factor: vec![0.99],
    };
    let emission = EmissionAxis::Wavelengths(WavelengthAxis::new(nm, Bandpass::Unstated).unwrap());
    let acquisitions = rows.iter().zip(0..).map(|(angles, order)| Acquisition::at(geometry(angles), order)).collect();
    let standard = Some(&values * 0.02);
    Measurement {
        sample: Some(id("sheet")),
        uncertainty: Uncertainty {
            standard: standard.map(|standard| standard.into_shared()),
            components: vec![shared],
            ..Uncertainty::default()
        },
        ..Measurement::new(id("factor"), Role::Sample, quantity, emission, acquisitions, values)
    }
}

fn parameter(name: &str, value: f64, sigma: f64, unit: &str) -> FittedParameter {
    FittedParameter {
        name: name.to_owned(),
        unit: unit.to_owned(),
        value: vec![value],
        standard_uncertainty: vec![sigma],
        shared_relative_uncertainty: Vec::new(),
        interval_low: Vec::new(),
        interval_high: Vec::new(),
    }
}

pub(crate) fn model() -> Model {
    let lambertian = FittedTerm {
        kind: TermKind::Lambertian,
        distribution: None,
        denominator: None,
        parameters: vec![FittedParameter {
            shared_relative_uncertainty: vec![0.005],
            interval_low: Vec::new(),
            interval_high: Vec::new(),
            ..parameter("albedo", 1.015_113, 0.000_412, "1")
        }],
    };
    let specular = FittedTerm {
        kind: TermKind::TorranceSparrow,
        distribution: Some(Distribution::GaussianHalfHeight),
        denominator: Some(Denominator::CosThetaI),
        parameters: vec![
            parameter("intensity", 2.01, 0.03, "1"),
            parameter("roughness", 0.1002, 0.0008, "rad"),
            parameter("refractive_index", 1.451, f64::NAN, "1"),
        ],
    };
    Model {
        id: id("sheet-fit"),
        title: Some("Lambertian + Torrance-Sparrow".to_owned()),
        measurement: id("factor"),
        data_digest: "ab".repeat(32),
        reduction: "band:500-620".to_owned(),
        mask: None,
        reference: REFERENCE,
        unit: "1".to_owned(),
        emission: EmissionAxis::Band { band: Some(Band { from_nm: 500.0, to_nm: 620.0 }) },
        terms: vec![lambertian, specular],
        nuisances: Vec::new(),
        covariance_parameters: Vec::new(),
        covariance: ndarray::ArcArray::zeros((1, 0, 0)),
        residuals: Residuals { rms: 0.002_713, reduced_chi_square: 1.03, count: 272, left_out: 0 },
        converged: true,
        method: "variable projection; every start of the grid led to this minimum".to_owned(),
        identifiability: vec!["intensity and refractive_index are correlated (-0.98)".to_owned()],
        separability: Some(separability()),
        donaldson: None,
    }
}

fn separability() -> Separability {
    let points = points();
    let axis: Vec<f64> = (-8..=8).map(|step| f64::from(step) * 10.0).collect();
    let rows: Vec<(f64, f64, f64)> = angles().into_iter().zip(&points.measured).map(|((i, v), y)| (i, v, *y)).collect();
    let average = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (mean, (values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64).sqrt())
    };
    let cosine = |i: f64| 1.05 * i.to_radians().cos();
    let over_viewing = |at: &f64| average(rows.iter().filter(|row| row.0 == *at).map(|row| row.2).collect());
    let over_incidence =
        |at: &f64| average(rows.iter().filter(|row| row.1 == *at).map(|row| row.2 / cosine(row.0)).collect());
    let (mean_over_viewing, spread_over_viewing) = axis.iter().map(over_viewing).unzip();
    let (mean_over_incidence, spread_over_incidence) = axis.iter().map(over_incidence).unzip();
    Separability {
        theta_i_deg: axis.clone(),
        mean_over_viewing,
        spread_over_viewing,
        theta_v_deg: axis,
        mean_over_incidence,
        spread_over_incidence,
        cosine_amplitude: 1.05,
        cosine_relative_rms: 0.09,
        constancy_relative_rms: 0.05,
        rank_one_relative_rms: 0.2,
    }
}
