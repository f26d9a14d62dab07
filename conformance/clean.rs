//! The clean document that every fault is made in: one part of every kind, and no rule objects to any of it.

use bbrf::container::measurement_digest;
use bbrf::dataset::tree::{Array, Data, Dataset, Group};
use bbrf::dataset::*;
use bbrf::quantity::*;
use bbrf::terms::{Denominator, Distribution, TermKind};
use ndarray::{Array2, Array3};

pub fn id(text: &str) -> Id {
    Id::new(text).expect("an identifier")
}

fn finite(number: f64) -> Option<Finite> {
    Finite::try_from(number).ok()
}

/// Digits that look like noise and are the same everywhere: the fraction of a multiple of the golden ratio, centred.
fn scatter(index: usize) -> f64 {
    (index as f64 * 0.618_033_988_749_895).fract() - 0.5
}

fn axis(from: f64, step: f64, count: usize, width: f64) -> EmissionAxis {
    let nm = (0..count).map(|k| from + step * k as f64).collect();
    EmissionAxis::Wavelengths(WavelengthAxis {
        nm,
        bandpass: Bandpass::Stated {
            fwhm_nm: vec![width],
            shape: BandpassShape::Triangular,
            correction: BandpassCorrection::Uncorrected,
        },
        actual_nm: Vec::new(),
    })
}

/// In-plane geometries of -60 to 60 degrees in steps of 20 without the retro gap, the first once more at the end.
fn geometries() -> Vec<Geometry> {
    let angle = |step: i32| f64::from(step) * 20.0;
    let pairs = (-3..=3).flat_map(|i| (-3..=3).map(move |v| (i, v))).filter(|(i, v)| *i != -v);
    let mut all: Vec<Geometry> =
        pairs.filter_map(|(i, v)| Geometry::from_signed(angle(i), angle(v), SignHabit::MirrorAtEqual).ok()).collect();
    all.push(all[0]);
    all
}

fn rows(geometries: &[Geometry]) -> Vec<Acquisition> {
    let row = |(order, geometry): (u32, &Geometry)| Acquisition {
        excitation: Some(0),
        time: Some(format!("2026-11-22T10:{order:02}:00Z")),
        exposure_ms: Some(40.0),
        ..Acquisition::at(Some(*geometry), order)
    };
    (0..).zip(geometries).map(row).collect()
}

fn with_noise(values: Array2<f64>, relative: f64) -> (Array2<f64>, Uncertainty) {
    let columns = values.ncols();
    let standard = values.mapv(|value: f64| relative * value.abs().max(1e-3));
    let noisy = Array2::from_shape_fn(values.dim(), |(row, column)| {
        values[(row, column)] + standard[(row, column)] * scatter(row * columns + column)
    });
    let statement = Statement { evaluation: Some(EvaluationType::A), ..Statement::default() };
    let components = vec![Component::new("certified factor", vec![0.002], CorrelatedOver::All)];
    (noisy, Uncertainty { standard: Some(standard.into_shared()), statement, components })
}

const TERMS: [&str; 4] = ["albedo", "intensity", "roughness", "refractive_index"];
const TRUTH: [f64; 4] = [0.6, 8.0, 0.2, 1.5];

fn fitted_terms() -> Vec<FittedTerm> {
    let units = ["1", "1", "rad", "1"];
    let parameter = |k: usize| FittedParameter {
        name: TERMS[k].to_owned(),
        unit: units[k].to_owned(),
        value: vec![TRUTH[k]],
        standard_uncertainty: vec![TRUTH[k] / 1000.0],
        shared_relative_uncertainty: Vec::new(),
        interval_low: Vec::new(),
        interval_high: Vec::new(),
    };
    vec![
        FittedTerm {
            kind: TermKind::Lambertian,
            distribution: None,
            denominator: None,
            parameters: vec![parameter(0)],
        },
        FittedTerm {
            kind: TermKind::TorranceSparrow,
            distribution: Some(Distribution::GaussianHalfHeight),
            // The one of the three that obeys reciprocity.
            denominator: Some(Denominator::CosThetaV),
            parameters: vec![parameter(1), parameter(2), parameter(3)],
        },
    ]
}

fn scan() -> Measurement {
    let geometries = geometries();
    let terms: Vec<_> = fitted_terms().iter().map(|term| term.term_at(0).expect("all parameters")).collect();
    let value = |row: usize| {
        predict(&terms, &geometries[row], &Reference::SameGeometry).expect("defined below 90 degrees").total()
    };
    let values = Array2::from_shape_fn((geometries.len(), 5), |(row, _)| value(row));
    let (values, uncertainty) = with_noise(values, 0.01);
    let quantity = Quantity {
        kind: QuantityKind::RadianceFactor,
        part: Part::Elastic,
        normalised_at: NormalisedAt::Emission,
        basis: Basis::Energy,
        reference: Reference::SameGeometry,
        reference_light: ReferenceLight::Light("lamp".to_owned()),
        certified_factor: vec![0.99],
    };
    Measurement {
        title: Some("in-plane scan".to_owned()),
        sample: Some(id("paint")),
        instrument: Some(id("radiometer")),
        white_reference: Some(id("white")),
        excitations: vec![Excitation { light: Some(id("lamp")), ..Excitation::default() }],
        uncertainty,
        conditions: Conditions {
            operator: Some("A. Person".to_owned()),
            temperature_celsius: finite(23.0),
            humidity_percent: finite(45.0),
            ..Conditions::default()
        },
        ..Measurement::new(id("scan"), Role::Sample, quantity, axis(500.0, 10.0, 5, 8.0), rows(&geometries), values)
    }
}

/// Six excitations from 380 nm on, emission around 540 nm.
fn bispectral(name: &str, kind: QuantityKind, part: Part, normalised_at: NormalisedAt) -> Measurement {
    let excitations: Vec<Excitation> = (0..6)
        .map(|k| Excitation {
            light: Some(id("lamp")),
            wavelength_nm: Some(380.0 + 20.0 * f64::from(k)),
            fwhm_nm: Some(10.0),
            ..Excitation::default()
        })
        .collect();
    let emission = axis(360.0, 10.0, 30, 10.0);
    let geometry = Geometry::from_degrees(45.0, 180.0, 0.0, 0.0).expect("angles");
    let rows = (0..6_u32).map(|k| Acquisition { excitation: Some(k), ..Acquisition::at(Some(geometry), k) }).collect();
    let width = if kind == QuantityKind::DonaldsonMatrix { 10.0 } else { 1.0 };
    let (from, step) = (360.0, 10.0);
    let values = Array2::from_shape_fn((6, 30), |(row, column)| {
        let (excited, emitted) = (380.0 + 20.0 * row as f64, from + step * column as f64);
        let on_diagonal = kind == QuantityKind::DonaldsonMatrix && excited == emitted;
        let emission = 0.006 * (-((emitted - 540.0) / 25.0_f64).powi(2)).exp() * width;
        if on_diagonal { 0.4 } else { emission }
    });
    let (mut values, uncertainty) = with_noise(values, 0.02);
    // Noise around nothing is there on either side.
    values.indexed_iter_mut().filter(|(_, value)| value.abs() < 1e-6).for_each(|((row, column), value)| {
        *value = 1e-5 * scatter(row * 30 + column);
    });
    let quantity = Quantity {
        kind,
        part,
        normalised_at,
        basis: Basis::Energy,
        reference: Reference::SameGeometry,
        reference_light: ReferenceLight::Same,
        certified_factor: vec![0.99],
    };
    Measurement {
        sample: Some(id("paint")),
        instrument: Some(id("radiometer")),
        white_reference: Some(id("white")),
        excitations,
        uncertainty,
        ..Measurement::new(id(name), Role::Sample, quantity, emission, rows, values)
    }
}

fn calibration(subject: &str) -> Vec<Calibration> {
    vec![Calibration {
        subject: Some(subject.to_owned()),
        artefact: Some("tile 7".to_owned()),
        certificate: Some("No 2026-113".to_owned()),
        laboratory: Some("a national institute".to_owned()),
        date: Some("2026-01-10".to_owned()),
        expires: Some("2028-01-10".to_owned()),
        relative_standard_uncertainty: finite(0.002),
        statement: Statement {
            coverage_factor: finite(2.0),
            coverage_probability: finite(0.95),
            ..Statement::default()
        },
    }]
}

fn raw() -> Measurement {
    let geometries = geometries();
    let values = Array2::from_shape_fn((geometries.len(), 5), |(row, column)| 0.01 + 1e-4 * (row + column) as f64);
    let (values, uncertainty) = with_noise(values, 0.01);
    // What the instrument looked at drifts; nobody compares it.
    Measurement {
        instrument: Some(id("radiometer")),
        excitations: vec![Excitation { light: Some(id("lamp")), ..Excitation::default() }],
        uncertainty,
        ..Measurement::new(
            id("white"),
            Role::White,
            Quantity::absolute(QuantityKind::SpectralRadiance, Part::Total),
            axis(500.0, 10.0, 5, 8.0),
            rows(&geometries),
            values,
        )
    }
}

fn extension() -> Extension {
    let temperatures = Dataset::new(Array::vector(Data::F64(vec![23.0, 23.1].into()))).with_text("units", "degC");
    let content = Group {
        attributes: [("firmware".to_owned(), Array::text("3.2"))].into(),
        datasets: vec![("temperature".to_owned(), temperatures)],
        groups: Vec::new(),
    };
    Extension { domain: id("org.example.goniometer"), content }
}

/// The document.
pub fn clean() -> Document {
    let mut scan = scan();
    let rows = i32::try_from(scan.acquisitions.len()).expect("a small scan");
    scan.derivation = Some(Derivation {
        numerator: id("white"),
        numerator_row: (0..rows).collect(),
        reference: id("white"),
        reference_group: (0..rows).collect(),
        row_reference: (0..rows).collect(),
        dark: None,
    });
    let mut measurements = vec![
        raw(),
        scan,
        bispectral(
            "density",
            QuantityKind::BispectralLuminescentRadianceFactor,
            Part::Luminescent,
            NormalisedAt::Excitation,
        ),
        bispectral("matrix", QuantityKind::DonaldsonMatrix, Part::Total, NormalisedAt::Excitation),
    ];
    let parts = separated(&measurements[3]);
    measurements.extend(parts);
    measurements.iter_mut().for_each(Measurement::state_directions);
    let spectrum = LightSpectrum {
        quantity: Quantity::absolute(QuantityKind::RelativeSpectrum, Part::Total),
        axis: WavelengthAxis {
            nm: vec![400.0, 500.0, 600.0],
            bandpass: Bandpass::Stated {
                fwhm_nm: vec![8.0],
                shape: BandpassShape::Triangular,
                correction: BandpassCorrection::Uncorrected,
            },
            actual_nm: vec![400.1, 500.1, 599.9],
        },
        values: vec![0.8, 1.0, f64::NAN],
        flags: vec![0, 0, Flag::NotMeasured.bit()],
    };
    let mut document = Document {
        title: Some("Fluorescent paint, größer als 1: 蛍光".to_owned()),
        license: Some("CC-BY-4.0".to_owned()),
        citation: Some("A. Person, 2026".to_owned()),
        contact: Some("a.person@example.org".to_owned()),
        samples: vec![Sample {
            id: id("paint"),
            width_mm: finite(50.0),
            height_mm: finite(60.0),
            symmetry: Some(Symmetry::Isotropic),
            holder: Some("black velvet".to_owned()),
            ..Sample::default()
        }],
        instruments: vec![Instrument {
            id: id("radiometer"),
            model: Some("PR-650".to_owned()),
            distance_mm: finite(800.0),
            visual_field_deg: finite(0.3),
            calibration: calibration("spectral radiance"),
            ..Instrument::default()
        }],
        lights: vec![Light { id: id("lamp"), spectrum: Some(spectrum), ..Light::default() }],
        white_references: vec![WhiteReference {
            id: id("white"),
            certificate: Some("No 2026-7".to_owned()),
            certified_nm: vec![400.0, 700.0],
            certified_factor: vec![0.99, 0.991],
            certified_relative_uncertainty: finite(0.002),
            calibration: calibration("radiance factor"),
            ..WhiteReference::default()
        }],
        measurements,
        models: Vec::new(),
        factorisations: Vec::new(),
        provenance: Provenance {
            receipts: vec![Receipt {
                tool: "hand".to_owned(),
                inputs: vec![InputFile {
                    name: "scan.txt".to_owned(),
                    sha256: "ab".repeat(32),
                    bytes: 1500,
                    dialect: "pr650-d5".to_owned(),
                    records: 1,
                }],
                assumptions: vec![Assumption { text: "none".to_owned(), place: Place::file("scan.txt").at_line(3) }],
                unfilled: Vec::new(),
                notices: Vec::new(),
            }],
            steps: vec![Step { tool: "hand".to_owned(), action: "made".to_owned(), time: None }],
        },
        extensions: vec![extension()],
    };
    let factorisation = factorisation(&document);
    document.factorisations.push(factorisation);
    let model = model(&document);
    document.models.push(model);
    document
}

/// What the matrix reflects at its own wavelength, and what it emits elsewhere.
fn separated(matrix: &Measurement) -> [Measurement; 2] {
    let nm = matrix.emission.wavelengths().expect("wavelengths");
    let row_of = |column: usize| matrix.excitations.iter().position(|state| state.wavelength_nm == Some(nm[column]));
    let mut luminescent = Measurement { id: id("matrix-luminescent"), ..matrix.clone() };
    luminescent.quantity.part = Part::Luminescent;
    let mut elastic = Measurement { id: id("matrix-elastic"), excitations: Vec::new(), ..matrix.clone() };
    let row = Acquisition::at(matrix.acquisitions[0].geometry, 0);
    elastic.acquisitions = vec![row];
    elastic.quantity.kind = QuantityKind::RadianceFactor;
    elastic.quantity.part = Part::Elastic;
    elastic.quantity.normalised_at = NormalisedAt::Emission;
    let reflected = |(_, column): (usize, usize)| row_of(column).map_or(f64::NAN, |row| matrix.values[(row, column)]);
    let shape = (1, nm.len());
    elastic.values = Array2::from_shape_fn(shape, reflected).into_shared();
    elastic.flags = elastic.values.mapv(|value| if value.is_nan() { Flag::NotMeasured.bit() } else { 0 }).into_shared();
    elastic.uncertainty.standard = Some(Array2::from_elem(shape, 0.01).into_shared());
    for (row, column) in (0..nm.len()).filter_map(|column| Some((row_of(column)?, column))) {
        luminescent.values[(row, column)] = 0.0;
        luminescent.flags[(row, column)] = Flag::Interpolated.bit();
    }
    [elastic, luminescent]
}

/// What the matrix was made of: one emission spectrum whatever excites it.
fn factorisation(document: &Document) -> Factorisation {
    let matrix = document.measurement("matrix").expect("the matrix");
    let EmissionAxis::Wavelengths(emission) = matrix.emission.clone() else { unreachable!("wavelengths") };
    let excitation_nm: Vec<f64> = matrix.excitations.iter().filter_map(|state| state.wavelength_nm).collect();
    let bell = |nm: f64| 0.06 * (-((nm - 540.0) / 25.0_f64).powi(2)).exp();
    let elastic = |u: f64| emission.nm.iter().map(|nm| if excitation_nm.contains(nm) { u } else { f64::NAN }).collect();
    let (rows, columns) = ((1, excitation_nm.len()), (1, emission.nm.len()));
    Factorisation {
        id: id("factors"),
        title: None,
        measurement: matrix.id.clone(),
        data_digest: measurement_digest(matrix).expect("a storable matrix"),
        excitation: Array2::from_elem(rows, 1.0).into_shared(),
        excitation_u: Array2::from_elem(rows, 0.01).into_shared(),
        emission_factor: Array2::from_shape_fn(columns, |(_, column)| bell(emission.nm[column])).into_shared(),
        emission_factor_u: Array2::from_elem(columns, 1e-3).into_shared(),
        elastic: elastic(0.4),
        elastic_u: elastic(0.01),
        excitation_nm,
        emission,
        reach_nm: 20.0,
        floor: 1e-3,
        residual_rms: 1e-3,
        residual_count: 100,
        method: "made".to_owned(),
        findings: Vec::new(),
    }
}

/// The terms that the scan was made of, with what they leave on it.
fn model(document: &Document) -> Model {
    let scan = document.measurement("scan").expect("the scan");
    let reduction = Reduction::Band(Band { from_nm: 495.0, to_nm: 545.0 });
    let data = reduce(document, scan, reduction).expect("a scan that can be reduced");
    let variance = |k: usize| (TRUTH[k] / 1000.0).powi(2);
    let covariance =
        Array3::from_shape_fn(
            (1, 4, 4),
            |(_, i, j)| if i == j { variance(i) } else { 0.1 * (variance(i) * variance(j)).sqrt() },
        );
    let names = [
        "lambertian.albedo",
        "torrance-sparrow.intensity",
        "torrance-sparrow.roughness",
        "torrance-sparrow.refractive_index",
    ];
    let digest =
        |part: &str| measurement_digest(document.measurement(part).expect("the part")).expect("a storable part");
    let mut model = Model {
        id: id("fit"),
        title: None,
        measurement: id("scan"),
        data_digest: measurement_digest(scan).expect("a storable scan"),
        reduction: reduction.to_string(),
        mask: None,
        reference: Reference::SameGeometry,
        unit: "1".to_owned(),
        emission: data.emission.clone(),
        terms: fitted_terms(),
        nuisances: Vec::new(),
        covariance_parameters: names.map(str::to_owned).to_vec(),
        covariance: covariance.into_shared(),
        residuals: Residuals { rms: 0.0, reduced_chi_square: 0.0, count: 0, left_out: 0 },
        converged: true,
        method: "made".to_owned(),
        identifiability: Vec::new(),
        separability: None,
        donaldson: Some(Attachment {
            factorisation: id("factors"),
            elastic: id("matrix-elastic"),
            elastic_digest: digest("matrix-elastic"),
            luminescent: id("matrix-luminescent"),
            luminescent_digest: digest("matrix-luminescent"),
            reflectance: ReflectanceSource::Matrix,
            consistency: vec!["the scan is one band: its shape cannot be checked".to_owned()],
        }),
    };
    model.residuals = residuals(&model, &data, 4).expect("complete terms").1;
    model
}
