//! Bispectral matrices: one that is made up, and real ones where the laboratory has them.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use bbrf::dataset::{Acquisition, Document, Excitation, Id, Measurement, Role};
use bbrf::donaldson::Reradiation;
use bbrf::quantity::{
    Bandpass, BandpassCorrection, BandpassShape, EmissionAxis, Quantity, QuantityKind, Uncertainty, WavelengthAxis,
};
use ndarray::Array2;

/// Ascending wavelengths with both ends, nm.
pub fn axis(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as usize).map(|k| from + step * k as f64).collect()
}

fn bell(nm: f64, centre: f64, sigma: f64) -> f64 {
    (-((nm - centre) / sigma).powi(2) / 2.0).exp()
}

/// An orange that glows: reflectance at a wavelength.
pub fn reflectance(nm: f64) -> f64 {
    0.08 + 0.7 / (1.0 + (-(nm - 575.0) / 12.0).exp())
}

/// Its luminescence, nm-1: excited in the ultraviolet and up to 550 nm, emitted around 600 nm.
pub fn luminescence(excitation: f64, emission: f64) -> f64 {
    let excited = 0.5 * bell(excitation, 350.0, 30.0) + bell(excitation, 480.0, 35.0);
    let emitted = bell(emission, 605.0, 18.0) / 45.0 + 0.3 * bell(emission, 650.0, 25.0) / 63.0;
    if emission > excitation { 0.6 * excited * emitted } else { 0.0 }
}

/// Its two parts on these wavelengths.
pub fn surface(excitation: &[f64], emission: &[f64]) -> Reradiation {
    let density =
        Array2::from_shape_fn((excitation.len(), emission.len()), |(i, j)| luminescence(excitation[i], emission[j]));
    let elastic = emission.iter().map(|nm| reflectance(*nm)).collect();
    Reradiation::from_parts(excitation.to_vec(), emission.to_vec(), elastic, density).unwrap()
}

/// A matrix of the usual form \[excitation, emission\] on one step from 300 and 380 to 780 nm: light that is reflected where both
/// are equal, luminescence times the step elsewhere.
pub fn values(step: f64) -> (Vec<f64>, Vec<f64>, Array2<f64>) {
    let (excitation, emission) = (axis(300.0, 780.0, step), axis(380.0, 780.0, step));
    let cell = |(i, j): (usize, usize)| {
        let (x, m): (f64, f64) = (excitation[i], emission[j]);
        let reflected = if (x - m).abs() < 1e-6 { reflectance(m) } else { 0.0 };
        reflected + step * luminescence(x, m)
    };
    let values = Array2::from_shape_fn((excitation.len(), emission.len()), cell);
    (excitation, emission, values)
}

/// The measurement of a matrix; with a width in nm that is both its bandpasses, or none stated.
pub fn measurement(
    id: &str,
    excitation: &[f64],
    emission: &[f64],
    values: Array2<f64>,
    sigma: Option<Array2<f64>>,
    width: Option<f64>,
) -> Measurement {
    let bandpass = match width {
        None => Bandpass::Unstated,
        Some(width) => Bandpass::Stated {
            fwhm_nm: vec![width],
            shape: BandpassShape::Triangular,
            correction: BandpassCorrection::Uncorrected,
        },
    };
    let emission = EmissionAxis::Wavelengths(WavelengthAxis::new(emission.to_vec(), bandpass).unwrap());
    let row = |order: u32| Acquisition { excitation: Some(order), ..Acquisition::at(None, order) };
    let acquisitions = (0..excitation.len() as u32).map(row).collect();
    let quantity = Quantity::unstated(QuantityKind::DonaldsonMatrix);
    let state = |nm: &f64| Excitation { wavelength_nm: Some(*nm), fwhm_nm: width, ..Excitation::default() };
    Measurement {
        excitations: excitation.iter().map(state).collect(),
        uncertainty: Uncertainty { standard: sigma.map(Array2::into_shared), ..Uncertainty::default() },
        ..Measurement::new(Id::new(id).unwrap(), Role::Sample, quantity, emission, acquisitions, values)
    }
}

/// A document with the orange as `orange`.
pub fn document() -> Document {
    let (excitation, emission, values) = values(10.0);
    let sigma = Array2::from_elem(values.dim(), 0.001);
    let orange = measurement("orange", &excitation, &emission, values, Some(sigma), None);
    Document { measurements: vec![orange], ..Document::default() }
}

/// The shared data of the laboratory, where there are some beside the repository.
pub fn shared() -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    path.is_dir().then_some(path)
}

/// The real matrices, as measurements with their file's name.
pub fn real() -> Vec<Measurement> {
    let Some(folder) = shared().map(|path| path.join("bispectral")) else { return Vec::new() };
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let is_matrix = |path: &&PathBuf| path.extension().is_some_and(|end| end == "BFC" || end == "csv");
    files.iter().filter(is_matrix).map(|path| read(path)).collect()
}

/// A table whose first row holds the excitations and whose first column the emissions.
fn read(path: &Path) -> Measurement {
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let table: Vec<Vec<&str>> = lines
        .skip_while(|line| !line.starts_with("r:c:") && !line.starts_with("em_nm"))
        .map(|line| line.split([',', '\t']).map(str::trim).filter(|field| !field.is_empty()).collect())
        .collect();
    let numbers = |row: &[&str]| row.iter().filter_map(|field| field.parse().ok()).collect::<Vec<f64>>();
    let excitation = numbers(&table[0][1..]);
    let rows: Vec<Vec<f64>> = table[1..].iter().map(|row| numbers(row)).filter(|row| row.len() > 1).collect();
    let emission: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let values = Array2::from_shape_fn((excitation.len(), emission.len()), |(i, j)| rows[j][i + 1]);
    let id = path.file_stem().unwrap().to_str().unwrap().to_lowercase();
    measurement(&id, &excitation, &emission, values, None, None)
}
