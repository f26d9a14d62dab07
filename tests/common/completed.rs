//! Documents whose fitted scan is completed with a matrix, and scans of luminescence.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use bbrf::container::{Limits, document_bytes, measurement_digest, read_bytes};
use bbrf::dataset::{Acquisition, Document, Excitation, Id, Measurement, Model, Role};
use bbrf::donaldson::{Complete, Consistency, attach};
use bbrf::fit::{FitOptions, fit_measurement};
use bbrf::quantity::{
    Bandpass, EmissionAxis, Geometry, Part, Quantity, QuantityKind, Reference, SignHabit, Uncertainty, WavelengthAxis,
};
use ndarray::Array2;

use super::documents::measured_document;
use super::matrices::Bispectral;
use super::scans::{Random, Truth, paper_grid};

pub const TRUTH: Truth = Truth { albedo: 0.6, intensity: 8.0, roughness: 0.2, index_minus_one: 0.5 };

pub fn signed(incidence: f64, viewing: f64) -> Geometry {
    Geometry::from_signed(incidence, viewing, SignHabit::MirrorAtEqual).unwrap()
}

pub fn digest(part: &Measurement) -> Result<String, String> {
    measurement_digest(part).map_err(|error| error.to_string())
}

pub fn fit(document: &Document) -> Model {
    let scan = document.measurement("scan").unwrap();
    let options = FitOptions { data_digest: measurement_digest(scan).unwrap(), ..FitOptions::default() };
    fit_measurement(document, scan, &options).unwrap()
}

/// The document with its scan fitted and the matrix attached, as it comes back from a file.
pub fn completed(mut document: Document) -> (Document, Consistency) {
    let mut model = fit(&document);
    let consistency = attach(&mut document, &mut model, "matrix", digest).unwrap();
    document.models.push(model);
    let bytes = document_bytes(&document).unwrap().0;
    (read_bytes(bytes, &Limits::default()).unwrap().document, consistency)
}

/// A reflecting scan in one band beside a matrix.
pub fn with_matrix(matrix: Measurement) -> Document {
    let mut document = measured_document(&paper_grid(), Reference::None, &[TRUTH], 0.01, &mut Random::new(3));
    document.measurements.push(matrix);
    document
}

pub fn complete(document: &Document) -> Complete {
    Complete::of(document, &document.models[0]).unwrap()
}

/// Sets of angles for scans of luminescence.
pub fn angles() -> Vec<Geometry> {
    let all = [0.0, 20.0, 35.0, 50.0, 65.0].into_iter();
    all.flat_map(|i| [-45.0, -10.0, 15.0, 55.0].map(|v| signed(i, v))).collect()
}

/// A scan of the luminescence under a band of 10 nm at 375 nm, of the irradiance of `lamp_of`, on a grid of its own.
pub fn luminescence_scan(surface: &Bispectral, relative: f64, random: &mut Random) -> Measurement {
    let nm: Vec<f64> = (0..98).map(|k| 392.0 + 4.0 * f64::from(k)).collect();
    let geometries = angles();
    // The density straight between 370 and 380 nm under a triangle of 10 nm at 375 nm, of height 1: what lies between them and
    // what lies beyond has a share of the triangle each.
    let shares = [(360.0, 1.0 / 48.0), (370.0, 23.0 / 48.0), (380.0, 23.0 / 48.0), (390.0, 1.0 / 48.0)];
    let emitted =
        |nm: f64| shares.iter().map(|(x, share)| 10.0 * share * surface.luminescent(*x, nm) / 10.0).sum::<f64>();
    let exact = Array2::from_shape_fn((geometries.len(), nm.len()), |(row, column)| {
        geometries[row].incidence.cos_theta() * emitted(nm[column]) / std::f64::consts::PI
    });
    let peak = exact.iter().copied().fold(0.0, f64::max);
    let sigma = exact.mapv(|value| relative * value.hypot(0.02 * peak));
    let values = Array2::from_shape_fn(exact.dim(), |at| exact[at] + sigma[at] * random.normal());
    let quantity = Quantity::absolute(QuantityKind::SpectralRadiance, Part::Luminescent);
    let rows = geometries
        .iter()
        .zip(0..)
        .map(|(geometry, order)| Acquisition { excitation: Some(0), ..Acquisition::at(Some(*geometry), order) });
    let state = Excitation { wavelength_nm: Some(375.0), fwhm_nm: Some(10.0), ..Excitation::default() };
    let axis = EmissionAxis::Wavelengths(WavelengthAxis::new(nm, Bandpass::Unstated).unwrap());
    Measurement {
        excitations: vec![state],
        uncertainty: Uncertainty { standard: Some(sigma.into_shared()), ..Uncertainty::default() },
        ..Measurement::new(Id::new("scan").unwrap(), Role::Sample, quantity, axis, rows.collect(), values)
    }
}

/// The band of that scan as a light of the file, W m-2 nm-1.
pub fn lamp_of(height: f64) -> bbrf::dataset::Light {
    bbrf::dataset::Light {
        id: Id::new("diode").unwrap(),
        spectrum: Some(bbrf::dataset::LightSpectrum {
            quantity: Quantity::absolute(QuantityKind::SpectralIrradiance, Part::Total),
            axis: WavelengthAxis::new(vec![365.0, 375.0, 385.0], Bandpass::Unstated).unwrap(),
            values: vec![0.0, height, 0.0],
            flags: vec![0; 3],
        }),
        ..bbrf::dataset::Light::default()
    }
}
