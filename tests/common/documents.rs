//! A document of one scan, as the tests of fits need it.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use bbrf::dataset::{Acquisition, Document, Id, Measurement, Role};
use bbrf::quantity::{
    Bandpass, EmissionAxis, Geometry, Quantity, QuantityKind, Reference, Uncertainty, WavelengthAxis,
};
use ndarray::Array2;

use super::scans::{Random, Truth, measure};

/// The measurement `scan`: values and uncertainties \[N, B\] at these geometries; one column is a band, several lie at 500,
/// 510, ... nm.
pub fn scan_document(
    grid: &[Geometry],
    reference: Reference,
    values: Array2<f64>,
    sigma: Option<Array2<f64>>,
) -> Document {
    let bands = values.ncols();
    let kind = if bands == 1 { QuantityKind::BandRadianceFactor } else { QuantityKind::RadianceFactor };
    let mut quantity = Quantity::unstated(kind);
    quantity.reference = reference;
    let nm = (0..bands).map(|band| 500.0 + 10.0 * band as f64).collect();
    let emission = match bands {
        1 => EmissionAxis::Band { band: None },
        _ => EmissionAxis::Wavelengths(WavelengthAxis::new(nm, Bandpass::Unstated).unwrap()),
    };
    let acquisitions = grid.iter().zip(0..).map(|(geometry, order)| Acquisition::at(Some(*geometry), order)).collect();
    let standard = sigma.map(Array2::into_shared);
    let measurement = Measurement {
        uncertainty: Uncertainty { standard, ..Uncertainty::default() },
        ..Measurement::new(Id::new("scan").unwrap(), Role::Sample, quantity, emission, acquisitions, values)
    };
    Document { measurements: vec![measurement], ..Document::default() }
}

/// A scan of one truth for each column, with relative noise.
pub fn measured_document(
    grid: &[Geometry],
    reference: Reference,
    truths: &[Truth],
    noise: f64,
    random: &mut Random,
) -> Document {
    let columns: Vec<(Vec<f64>, Vec<f64>)> = truths.iter().map(|truth| measure(truth, grid, noise, random)).collect();
    let shape = (grid.len(), truths.len());
    let values = Array2::from_shape_fn(shape, |(row, band)| columns[band].0[row]);
    let sigma = Array2::from_shape_fn(shape, |(row, band)| columns[band].1[row]);
    scan_document(grid, reference, values, Some(sigma))
}
