//! Bispectral matrices of known truth, and the real ones where they are.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use bbrf::dataset::{Acquisition, Excitation, Id, Measurement, Role};
use bbrf::quantity::{
    Bandpass, BandpassCorrection, BandpassShape, EmissionAxis, Part, Quantity, QuantityKind, Uncertainty,
    WavelengthAxis,
};
use ndarray::Array2;

use super::scans::Random;

/// A surface: a reflectance with an edge, and one or two fluorophores.
#[derive(Debug, Clone)]
pub struct Bispectral {
    pub excitation_nm: Vec<f64>,
    pub emission_nm: Vec<f64>,
    /// Peak and width of excitation, peak and width of emission, strength.
    pub fluorophores: Vec<[f64; 5]>,
    /// Width of both bandpasses, nm: also the step.
    pub width_nm: f64,
    pub is_stated: bool,
    pub has_sigma: bool,
}

fn every(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..).map(|k| from + step * f64::from(k)).take_while(|nm| *nm <= to + 1e-9).collect()
}

impl Bispectral {
    pub fn usual(fluorophores: usize) -> Self {
        let all = [[400.0, 45.0, 500.0, 22.0, 0.05], [470.0, 30.0, 600.0, 25.0, 0.04]];
        Self {
            excitation_nm: every(300.0, 780.0, 10.0),
            emission_nm: every(380.0, 780.0, 10.0),
            fluorophores: all[..fluorophores].to_vec(),
            width_nm: 10.0,
            is_stated: false,
            has_sigma: false,
        }
    }

    pub fn reflectance(&self, nm: f64) -> f64 {
        0.1 + 0.7 / (1.0 + (-(nm - 520.0) / 15.0).exp())
    }

    /// The luminescent value of a cell: no light below the excitation.
    pub fn luminescent(&self, excitation: f64, emission: f64) -> f64 {
        if emission < excitation {
            return 0.0;
        }
        let bell = |x: f64, peak: f64, width: f64| (-((x - peak) / width).powi(2) / 2.0).exp();
        self.fluorophores.iter().map(|[x, wx, m, wm, s]| s * bell(excitation, *x, *wx) * bell(emission, *m, *wm)).sum()
    }

    /// Reflected light next to the diagonal: what two triangles that are a step apart share is a little.
    fn leak(&self, excitation: f64, emission: f64) -> f64 {
        let steps = ((emission - excitation).abs() / self.width_nm).round();
        match steps as i32 {
            0 => 0.96 * self.reflectance(emission),
            1 => 0.02 * self.reflectance(emission),
            _ => 0.0,
        }
    }

    pub fn exact(&self) -> Array2<f64> {
        Array2::from_shape_fn((self.excitation_nm.len(), self.emission_nm.len()), |(i, j)| {
            let (x, m) = (self.excitation_nm[i], self.emission_nm[j]);
            self.luminescent(x, m) + self.leak(x, m)
        })
    }

    pub fn measured(&self, noise: f64, seed: u64) -> Measurement {
        let mut random = Random::new(seed);
        let values = self.exact().mapv(|value| value + noise * random.normal());
        let sigma = self.has_sigma.then(|| Array2::from_elem(values.dim(), noise).into_shared());
        let width = self.is_stated.then_some(self.width_nm);
        let mut measurement = measurement(&self.excitation_nm, &self.emission_nm, values, width);
        measurement.uncertainty = Uncertainty { standard: sigma, ..Uncertainty::default() };
        measurement
    }
}

/// A Donaldson matrix \\[excitation, emission\\] as a measurement.
pub fn measurement(excitation: &[f64], emission: &[f64], values: Array2<f64>, width: Option<f64>) -> Measurement {
    let quantity = Quantity { part: Part::Total, ..Quantity::unstated(QuantityKind::DonaldsonMatrix) };
    let bandpass = width.map_or(Bandpass::Unstated, |width| Bandpass::Stated {
        fwhm_nm: vec![width],
        shape: BandpassShape::Triangular,
        correction: BandpassCorrection::Unstated,
    });
    let axis = EmissionAxis::Wavelengths(WavelengthAxis::new(emission.to_vec(), bandpass).unwrap());
    let row = |k: u32| Acquisition { excitation: Some(k), ..Acquisition::at(None, k) };
    let acquisitions = (0..u32::try_from(excitation.len()).unwrap()).map(row).collect();
    let state = |nm: &f64| Excitation { wavelength_nm: Some(*nm), fwhm_nm: width, ..Excitation::default() };
    Measurement {
        excitations: excitation.iter().map(state).collect(),
        ..Measurement::new(Id::new("matrix").unwrap(), Role::Sample, quantity, axis, acquisitions, values)
    }
}

/// The real matrices, where they are beside the repository.
pub fn real() -> Vec<(String, Measurement)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/bispectral");
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "BFC"));
    files.sort();
    files.iter().map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), bfc(path))).collect()
}

fn bfc(path: &std::path::Path) -> Measurement {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers =
        |line: &str| line.split('\t').filter_map(|field| field.trim().parse::<f64>().ok()).collect::<Vec<f64>>();
    let after = text.split_once("r:c:").unwrap().1;
    let mut lines = after.lines().filter(|line| !line.trim().is_empty());
    let excitation = numbers(lines.next().unwrap());
    let rows: Vec<Vec<f64>> = lines.map(numbers).filter(|row| row.len() == excitation.len() + 1).collect();
    let emission: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let values = Array2::from_shape_fn((excitation.len(), emission.len()), |(i, j)| rows[j][i + 1]);
    measurement(&excitation, &emission, values, None)
}
