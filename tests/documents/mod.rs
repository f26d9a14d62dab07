//! Documents for tests: a small one with every kind of part, and arbitrary ones.
#![allow(dead_code, unused_imports, unreachable_pub, clippy::unwrap_used, reason = "each test uses some of it")]

mod arbitrary;

use bbrf::dataset::*;
use bbrf::quantity::*;
use bbrf::terms::{Denominator, Distribution, TermKind};
use ndarray::{ArcArray, Array2};

pub use arbitrary::document as arbitrary_document;

pub fn id(text: &str) -> Id {
    Id::new(text).unwrap()
}

/// A scan with one row per pair of in-plane angles in a grid of `side` x `side`, and `columns` wavelengths.
pub fn scan(side: usize, columns: usize) -> Measurement {
    let angle = |step: usize| -80.0 + 160.0 * step as f64 / side.max(2) as f64;
    let geometries: Vec<Geometry> = (0..side * side)
        .map(|row| Geometry::from_signed(angle(row / side), angle(row % side), SignHabit::MirrorAtEqual).unwrap())
        .collect();
    measurement("scan", &geometries, columns)
}

/// A measurement of a radiance factor in given geometries.
pub fn measurement(name: &str, geometries: &[Geometry], columns: usize) -> Measurement {
    let rows = geometries.len();
    let acquisitions = (0_u32..).zip(geometries).map(|(order, geometry)| Acquisition::at(Some(*geometry), order));
    let nm = (0..columns).map(|column| 380.0 + 4.0 * column as f64).collect();
    let bandpass = Bandpass::Stated {
        fwhm_nm: vec![8.0],
        shape: BandpassShape::Triangular,
        correction: BandpassCorrection::Uncorrected,
    };
    // Four digits, as the instrument gives them.
    let value = |row: usize, column: usize| ((row * 7919 + column * 104_729) % 9973) as f64 / 10_000.0 + 0.001;
    let values = Array2::from_shape_fn((rows, columns), |(row, column)| value(row, column));
    let quantity = Quantity {
        kind: QuantityKind::RadianceFactor,
        part: Part::Total,
        normalised_at: NormalisedAt::Emission,
        basis: Basis::Energy,
        reference: Reference::SameGeometry,
        reference_light: ReferenceLight::Same,
        certified_factor: vec![0.99],
    };
    let emission = EmissionAxis::Wavelengths(WavelengthAxis { nm, bandpass, actual_nm: vec![] });
    let uncertainty = Uncertainty {
        standard: Some(values.mapv(|value| value * 0.01).into_shared()),
        statement: Statement { evaluation: Some(EvaluationType::A), ..Statement::default() },
        components: vec![Component::new("certificate", vec![0.005], CorrelatedOver::All)],
    };
    let mut measurement = Measurement {
        title: Some("a scan".into()),
        sample: Some(id("paint")),
        instrument: Some(id("pr650")),
        white_reference: Some(id("white")),
        uncertainty,
        ..Measurement::new(id(name), Role::Sample, quantity, emission, acquisitions.collect(), values)
    };
    measurement.state_directions();
    measurement
}

/// A document with one part of every kind.
pub fn small() -> Document {
    let mut raw = scan(3, 5);
    raw.id = id("raw");
    raw.quantity = Quantity::absolute(QuantityKind::SpectralRadiance, Part::Total);
    raw.excitations = vec![Excitation {
        light: Some(id("lamp")),
        wavelength_nm: Some(375.0),
        fwhm_nm: None,
        filter: Some(String::new()),
        ..Excitation::default()
    }];
    for row in &mut raw.acquisitions {
        row.excitation = Some(0);
        row.time = Some("2026-11-22T03:01:40Z".into());
        row.quality_code = Some(-1);
        row.exposure_ms = Some(40.0);
    }
    let mut scan = scan(3, 5);
    scan.flags[[1, 2]] = Flag::BelowDetection.bit();
    scan.values[[1, 2]] = f64::NAN;
    scan.derivation = Some(Derivation {
        numerator: id("raw"),
        numerator_row: (0..9).collect(),
        reference: id("raw"),
        reference_group: vec![0; 9],
        row_reference: vec![0; 9],
        dark: None,
    });
    let data_digest = bbrf::container::measurement_digest(&scan).unwrap();
    Document {
        title: Some("Daylight-fluorescent paint, größer als 1: 蛍光".into()),
        license: Some("CC-BY-4.0".into()),
        citation: None,
        contact: Some("a laboratory".into()),
        samples: vec![Sample {
            id: id("paint"),
            title: Some("orange".into()),
            material: Some(String::new()),
            mark: None,
            simulated: true,
            ..Sample::default()
        }],
        instruments: vec![Instrument {
            id: id("pr650"),
            model: Some("PR-650".into()),
            serial: None,
            aperture: None,
            accessories: None,
            distance_mm: Some(Finite::try_from(800.0).unwrap()),
            ..Instrument::default()
        }],
        lights: vec![Light {
            id: id("lamp"),
            title: None,
            spectrum: Some(LightSpectrum {
                quantity: Quantity::absolute(QuantityKind::RelativeSpectrum, Part::Total),
                axis: WavelengthAxis { nm: vec![370.0, 380.0], bandpass: Bandpass::Unstated, actual_nm: vec![] },
                values: vec![1.0, f64::NAN],
                flags: vec![0, Flag::NotMeasured.bit()],
            }),
            ..Light::default()
        }],
        white_references: vec![WhiteReference {
            id: id("white"),
            title: None,
            certificate: Some("No 1".into()),
            certified_nm: vec![400.0, 500.0],
            certified_factor: vec![0.98, 0.99],
            certified_relative_uncertainty: Some(Finite::try_from(0.005).unwrap()),
            ..WhiteReference::default()
        }],
        measurements: vec![raw, scan],
        models: vec![model(data_digest.clone())],
        factorisations: vec![factorisation(data_digest)],
        provenance: provenance(),
        extensions: vec![],
    }
}

pub fn model(data_digest: String) -> Model {
    let parameter = |name: &str, unit: &str, value: f64| FittedParameter {
        name: name.into(),
        unit: unit.into(),
        value: vec![value],
        standard_uncertainty: vec![value / 100.0],
        shared_relative_uncertainty: vec![],
        interval_low: vec![value * 0.98],
        interval_high: vec![value * 1.02],
    };
    Model {
        id: id("fit"),
        title: None,
        measurement: id("scan"),
        data_digest,
        reduction: "band:500-620".into(),
        mask: Some("rows:7".into()),
        reference: Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 },
        unit: "1".into(),
        emission: EmissionAxis::Band { band: Some(Band { from_nm: 500.0, to_nm: 620.0 }) },
        terms: vec![
            FittedTerm {
                kind: TermKind::Lambertian,
                distribution: None,
                denominator: None,
                parameters: vec![parameter("albedo", "1", 0.8)],
            },
            FittedTerm {
                kind: TermKind::TorranceSparrow,
                distribution: Some(Distribution::GaussianHalfHeight),
                denominator: Some(Denominator::CosThetaI),
                parameters: vec![
                    parameter("intensity", "1", 30.0),
                    parameter("roughness", "rad", 0.05),
                    parameter("refractive_index", "1", 1.45),
                ],
            },
        ],
        nuisances: Vec::new(),
        covariance_parameters: vec!["lambertian.albedo".into(), "torrance-sparrow.intensity".into()],
        covariance: ArcArray::from_shape_vec((1, 2, 2), vec![1e-4, 1e-5, 1e-5, 1e-3]).unwrap(),
        residuals: Residuals { rms: 0.01, reduced_chi_square: 1.02, count: 9, left_out: 1 },
        converged: true,
        method: "variable projection".into(),
        identifiability: vec!["the refractive index is weakly determined".into()],
        separability: Some(Separability {
            theta_i_deg: vec![0.0, 10.0],
            mean_over_viewing: vec![1.0, 0.9],
            spread_over_viewing: vec![0.1, 0.1],
            theta_v_deg: vec![0.0, 10.0, 20.0],
            mean_over_incidence: vec![1.0; 3],
            spread_over_incidence: vec![0.01; 3],
            cosine_amplitude: 1.0,
            cosine_relative_rms: 0.01,
            constancy_relative_rms: 0.02,
            rank_one_relative_rms: 0.03,
        }),
        donaldson: None,
    }
}

fn provenance() -> Provenance {
    let place = Place::file("scan/01.txt").at_line(3);
    Provenance {
        receipts: vec![Receipt {
            tool: "bbrf 0.1.0".into(),
            inputs: vec![InputFile {
                name: "scan/01.txt".into(),
                sha256: "00".repeat(32),
                bytes: 1500,
                dialect: "pr650-d5".into(),
                records: 1,
            }],
            assumptions: vec![Assumption { text: "angles are mirror-at-equal".into(), place: place.clone() }],
            unfilled: vec!["samples/paint/mark".into()],
            notices: vec![Notice { text: "quality code -1".into(), place }],
        }],
        steps: vec![Step { tool: "bbrf 0.1.0".into(), action: "fit".into(), time: None }],
    }
}

/// Equality to the bit: the digests compare NaN by its bits, everything else by `==`.
pub fn same(a: &Document, b: &Document) -> bool {
    let digest = |document| bbrf::container::digest(document).unwrap();
    digest(a) == digest(b) && format!("{a:?}") == format!("{b:?}")
}

/// Two factors over three excitations and two emissions, of the scan for want of a matrix.
fn factorisation(data_digest: String) -> Factorisation {
    let table = |rows: usize, columns: usize| {
        ndarray::ArcArray2::from_shape_fn((rows, columns), |(i, j)| 0.1 * (1 + i + j) as f64)
    };
    Factorisation {
        id: id("factors"),
        title: None,
        measurement: id("scan"),
        data_digest,
        excitation_nm: vec![380.0, 390.0, 400.0],
        emission: WavelengthAxis::new(vec![500.0, 510.0], Bandpass::Unstated).unwrap(),
        excitation: table(2, 3),
        excitation_u: table(2, 3),
        emission_factor: table(2, 2),
        emission_factor_u: table(2, 2),
        elastic: vec![f64::NAN, 0.5],
        elastic_u: vec![f64::NAN, 0.01],
        reach_nm: 15.0,
        floor: 1e-3,
        residual_rms: 1.2e-3,
        residual_count: 6,
        method: "made".into(),
        findings: vec!["the emission width is unstated".into()],
    }
}
