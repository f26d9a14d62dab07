//! A document with everything that the standard has, and one with as little as it allows.

use bbrf::dataset::*;
use bbrf::quantity::*;
use ndarray::ArcArray2;

use crate::conformance::{clean, id};

fn number(value: f64) -> Option<Finite> {
    Finite::try_from(value).ok()
}

fn text() -> Option<String> {
    Some("a text".to_owned())
}

fn statement() -> Statement {
    Statement {
        coverage_factor: number(2.0),
        coverage_probability: number(0.95),
        distribution: Some(ErrorDistribution::StudentT),
        degrees_of_freedom: number(5.0),
        evaluation: Some(EvaluationType::A),
    }
}

/// Every part with every field, each list at least once short and once long.
pub fn full() -> Document {
    let mut document = clean();
    document.samples.iter_mut().for_each(|sample| {
        *sample = Sample {
            title: text(),
            material: text(),
            mark: text(),
            holder: text(),
            thickness_mm: number(1.0),
            ..sample.clone()
        }
    });
    for link in document.instruments.iter_mut().flat_map(|part| &mut part.calibration) {
        link.statement = statement();
    }
    let chain = document.instruments[0].calibration.clone();
    document.instruments.iter_mut().for_each(|part| {
        *part = Instrument {
            serial: text(),
            aperture: text(),
            accessories: text(),
            solid_angle_sr: number(1e-5),
            stray_light_relative: number(1e-4),
            ..part.clone()
        }
    });
    document.lights.iter_mut().for_each(|part| {
        *part = Light {
            title: text(),
            make: text(),
            distance_mm: number(1000.0),
            beam_diameter_mm: number(60.0),
            solid_angle_sr: number(1e-4),
            polarisation: text(),
            calibration: chain.clone(),
            ..part.clone()
        };
        part.spectrum.iter_mut().for_each(|spectrum| spectrum.quantity.certified_factor = vec![1.0; 3]);
    });
    document.white_references.iter_mut().for_each(|part| {
        *part = WhiteReference { title: text(), material: text(), calibration: chain.clone(), ..part.clone() }
    });
    let one_factor = WhiteReference {
        certified_nm: vec![],
        certified_factor: vec![0.99],
        id: id("other"),
        ..document.white_references[0].clone()
    };
    document.white_references.push(one_factor);
    let extended: Vec<Measurement> = document.measurements.iter().map(measured).collect();
    document.measurements = extended;
    let mut band = document.measurements[1].clone();
    band.id = id("band");
    band.emission = EmissionAxis::Band { band: Some(Band { from_nm: 500.0, to_nm: 540.0 }) };
    band.quantity.certified_factor = vec![0.99];
    for array in [Some(&mut band.values), band.uncertainty.standard.as_mut()].into_iter().flatten() {
        *array = ArcArray2::from_shape_fn((array.nrows(), 1), |(row, _)| array[[row, 0]]);
    }
    band.flags = ArcArray2::zeros(band.values.dim());
    band.uncertainty.components[0].relative = vec![0.01];
    band.uncertainty.components.truncate(1);
    document.measurements.push(band);
    let mut model = document.models[0].clone();
    model.title = text();
    model.nuisances = vec![FittedParameter {
        name: "viewing-offset".to_owned(),
        unit: "degree".to_owned(),
        value: vec![0.1],
        standard_uncertainty: vec![0.02],
        shared_relative_uncertainty: Vec::new(),
        interval_low: Vec::new(),
        interval_high: Vec::new(),
    }];
    model.mask = Some("theta-i>70".to_owned());
    model.identifiability = vec!["a sentence".to_owned()];
    model.terms.iter_mut().flat_map(|term| &mut term.parameters).for_each(|parameter| {
        parameter.interval_low = parameter.value.iter().map(|value| 0.9 * value).collect();
        parameter.interval_high = vec![f64::NAN; parameter.value.len()];
        parameter.shared_relative_uncertainty = vec![0.002];
    });
    model.separability = Some(Separability {
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
    });
    let mut of_band = document.models[0].clone();
    of_band.id = id("of_band");
    of_band.emission = EmissionAxis::Band { band: Some(Band { from_nm: 500.0, to_nm: 540.0 }) };
    let mut spectral = of_band.clone();
    spectral.id = id("spectral");
    spectral.emission = document.measurements[1].emission.clone();
    spectral.terms[0].parameters[0].value = vec![0.6; 5];
    spectral.terms[0].parameters[0].standard_uncertainty = vec![0.01; 5];
    let tables: Vec<_> = (0..spectral.emission.len()).filter_map(|_| spectral.covariance_at(0)).collect();
    let covariance = ndarray::stack(ndarray::Axis(0), &tables).unwrap().into_shared();
    let spectral = Model { covariance, ..spectral };
    document.models.extend([Model { id: id("second"), ..model }, of_band, spectral]);
    for factorisation in &mut document.factorisations {
        factorisation.title = text();
        factorisation.findings = vec!["a sentence".to_owned()];
    }
    document.provenance = provenance();
    document
}

/// A measurement with everything; lists of one number and lists of all take turns.
fn measured(measurement: &Measurement) -> Measurement {
    let mut all = measurement.clone();
    all.title = text();
    all.conditions = Conditions {
        laboratory: text(),
        operator: text(),
        temperature_celsius: number(23.0),
        humidity_percent: number(45.0),
        environment: text(),
        viewing_polarisation: text(),
        relative_drift: number(0.001),
        drift_handling: text(),
    };
    for row in &mut all.acquisitions {
        row.time = Some("2026-11-22T10:00:00Z".to_owned());
        row.exposure_ms = Some(40.0);
        row.quality_code = Some(0);
    }
    let columns = all.emission.len();
    let long = vec![0.99; columns];
    if all.id.as_str() == "scan" {
        all.quantity.certified_factor = long.clone();
        if let EmissionAxis::Wavelengths(axis) = &mut all.emission {
            axis.actual_nm = axis.nm.clone();
            if let Bandpass::Stated { fwhm_nm, .. } = &mut axis.bandpass {
                *fwhm_nm = long;
            }
        }
    }
    all.uncertainty.statement = statement();
    let shared =
        |relative| Component { statement: statement(), ..Component::new("a cause", relative, CorrelatedOver::All) };
    all.uncertainty.components = vec![shared(vec![0.001; columns]), shared(vec![0.002])];
    all.derivation.iter_mut().for_each(|derivation| derivation.dark = Some(id("white")));
    all
}

/// Receipts and steps with every member.
pub fn provenance() -> Provenance {
    let place = || Place::file("scan.txt").at_line(3);
    let everywhere = Place { byte: Some(120), path: Some("/measurement/scan/value".to_owned()), ..place() };
    Provenance {
        receipts: vec![Receipt {
            tool: "importer 1.0".to_owned(),
            inputs: vec![InputFile {
                name: "scan.txt".to_owned(),
                sha256: "ab".repeat(32),
                bytes: 1500,
                dialect: "pr650-d5".to_owned(),
                records: 1,
            }],
            assumptions: vec![Assumption {
                text: "angles are mirror-at-equal".to_owned(),
                place: everywhere.at_index([0, 2]),
            }],
            unfilled: vec!["samples/paint/mark".to_owned()],
            notices: vec![Notice { text: "quality code -1".to_owned(), place: place() }],
        }],
        steps: vec![Step {
            tool: "fitter 1.0".to_owned(),
            action: "fit".to_owned(),
            time: Some("2026-11-22T10:00:00Z".to_owned()),
        }],
    }
}

/// One part of every kind with as little in it as the standard allows, and again with as little in what it may have.
pub fn minimal() -> Document {
    let axis = WavelengthAxis { nm: vec![500.0, 510.0], bandpass: Bandpass::Unstated, actual_nm: vec![] };
    let quantity = Quantity::unstated(QuantityKind::Unstated);
    let emission = EmissionAxis::Wavelengths(axis.clone());
    let row = Acquisition::at(None, 0);
    let least =
        Measurement::new(id("least"), Role::Sample, quantity.clone(), emission, vec![row], ArcArray2::zeros((1, 2)));
    let band = Measurement {
        id: id("band"),
        emission: EmissionAxis::Band { band: None },
        values: ArcArray2::zeros((1, 1)),
        flags: ArcArray2::zeros((1, 1)),
        excitations: vec![Excitation::default()],
        uncertainty: Uncertainty {
            standard: Some(ArcArray2::zeros((1, 1))),
            components: vec![Component::new("a cause", vec![0.01], CorrelatedOver::All)],
            ..Uncertainty::default()
        },
        derivation: Some(Derivation {
            numerator: id("least"),
            numerator_row: vec![0],
            reference: id("least"),
            reference_group: vec![0],
            row_reference: vec![0],
            dark: None,
        }),
        ..least.clone()
    };
    let model = Model {
        measurement: id("least"),
        emission: EmissionAxis::Band { band: None },
        donaldson: None,
        ..clean().models[0].clone()
    };
    let chain = || vec![Calibration::default()];
    let spectrum = LightSpectrum { quantity, axis, values: vec![0.0; 2], flags: vec![0; 2] };
    let other = || id("other");
    Document {
        samples: vec![Sample::default()],
        instruments: vec![
            Instrument::default(),
            Instrument { id: other(), calibration: chain(), ..Instrument::default() },
        ],
        lights: vec![
            Light::default(),
            Light { id: other(), calibration: chain(), spectrum: Some(spectrum), ..Light::default() },
        ],
        white_references: vec![
            WhiteReference::default(),
            WhiteReference { id: other(), calibration: chain(), ..WhiteReference::default() },
        ],
        measurements: vec![least, band],
        models: vec![model],
        ..Document::default()
    }
}
