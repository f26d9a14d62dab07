//! A bispectral matrix as arrays, excitation by emission.

use ndarray::Array2;

use crate::dataset::Measurement;
use crate::quantity::{Bandpass, EmissionAxis, Flag, QuantityKind};

/// A Donaldson matrix \[excitation, emission\]: on and next to the diagonal reflected light, off it luminescent radiance
/// factors times an emission width.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Centres of the excitation, nm, ascending.
    pub excitation_nm: Vec<f64>,
    /// Centres of the emission, nm, ascending.
    pub emission_nm: Vec<f64>,
    /// Values \[excitation, emission\]; NaN where there is none. Negative noise is data and stays.
    pub values: Array2<f64>,
    /// Standard uncertainties of the values, independent, where stated.
    pub sigma: Option<Array2<f64>>,
    /// Full width at half maximum of the excitation, nm, where every one is stated.
    pub excitation_fwhm_nm: Option<Vec<f64>>,
    /// Full width at half maximum of the emission, nm, where it is stated: the width that the luminescent values hold.
    pub emission_fwhm_nm: Option<Vec<f64>>,
    /// The row of the measurement that each excitation has.
    pub rows: Vec<usize>,
}

/// Why a measurement is no matrix.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoMatrix {
    /// Another quantity.
    #[error("measurement `{measurement}` holds `{found}`; expected `donaldson-matrix`")]
    Kind {
        /// The measurement.
        measurement: String,
        /// What it holds.
        found: QuantityKind,
    },
    /// Bands have no wavelengths.
    #[error("measurement `{0}` has no emission wavelengths; a matrix needs them")]
    Emission(String),
    /// A row without an excitation wavelength.
    #[error("measurement `{measurement}`, row {row}: no excitation wavelength; a row of a matrix is one excitation")]
    Excitation {
        /// The measurement.
        measurement: String,
        /// The row.
        row: usize,
    },
    /// Two rows of one excitation.
    #[error(
        "measurement `{measurement}`: rows {first} and {second} are both excited at {nm} nm; expected one row each"
    )]
    Twice {
        /// The measurement.
        measurement: String,
        /// A row.
        first: usize,
        /// Another.
        second: usize,
        /// Their excitation.
        nm: f64,
    },
    /// An emission axis that is none.
    #[error(
        "measurement `{measurement}`: emission {nm} nm at index {index}; expected positive wavelengths that ascend"
    )]
    Axis {
        /// The measurement.
        measurement: String,
        /// Where on the axis.
        index: usize,
        /// The wavelength there, nm.
        nm: f64,
    },
    /// Too small for what was asked.
    #[error("measurement `{measurement}`: {rows} excitations x {columns} emissions; expected 3 x 3 or more")]
    Small {
        /// The measurement.
        measurement: String,
        /// Excitations.
        rows: usize,
        /// Emissions.
        columns: usize,
    },
}

impl Matrix {
    /// The matrix that a measurement holds. Values flagged as unusable are missing.
    ///
    /// # Errors
    /// [`NoMatrix`].
    pub fn of(measurement: &Measurement) -> Result<Self, NoMatrix> {
        let matrix = Self::of_any_size(measurement)?;
        let (rows, columns) = matrix.values.dim();
        if rows < 3 || columns < 3 {
            return Err(NoMatrix::Small { measurement: measurement.id.to_string(), rows, columns });
        }
        Ok(matrix)
    }

    /// The same, however small: one cell can be drawn, if not separated.
    pub(crate) fn of_any_size(measurement: &Measurement) -> Result<Self, NoMatrix> {
        let name = || measurement.id.to_string();
        if measurement.quantity.kind != QuantityKind::DonaldsonMatrix {
            return Err(NoMatrix::Kind { measurement: name(), found: measurement.quantity.kind });
        }
        let EmissionAxis::Wavelengths(axis) = &measurement.emission else { return Err(NoMatrix::Emission(name())) };
        let state = |row: usize| {
            let index = measurement.acquisitions[row].excitation?;
            let excitation = measurement.excitations.get(usize::try_from(index).ok()?)?;
            Some((excitation.centre_nm().filter(|nm| nm.is_finite())?, excitation.fwhm_nm))
        };
        let mut states = Vec::with_capacity(measurement.acquisitions.len());
        for row in 0..measurement.acquisitions.len() {
            let (nm, fwhm) = state(row).ok_or_else(|| NoMatrix::Excitation { measurement: name(), row })?;
            states.push((nm, fwhm, row));
        }
        states.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(pair) = states.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let (first, second) = (pair[0].2, pair[1].2);
            return Err(NoMatrix::Twice { measurement: name(), first, second, nm: pair[0].0 });
        }
        let (count, columns) = (states.len(), axis.nm.len());
        if count == 0 || columns == 0 || measurement.check_shape().is_err() {
            return Err(NoMatrix::Small { measurement: name(), rows: count, columns });
        }
        let emission_nm = if axis.actual_nm.len() == columns { axis.actual_nm.clone() } else { axis.nm.clone() };
        let is_wrong = |k: &usize| {
            let nm = emission_nm[*k];
            !(nm.is_finite() && nm > 0.0 && (*k == 0 || nm > emission_nm[*k - 1]))
        };
        if let Some(index) = (0..columns).find(is_wrong) {
            return Err(NoMatrix::Axis { measurement: name(), index, nm: emission_nm[index] });
        }
        let excluded = Flag::ALL.iter().filter(|flag| flag.excludes_from_fit()).fold(0, |mask, flag| mask | flag.bit());
        let value = |at: (usize, usize)| {
            if measurement.flags[at] & excluded == 0 { measurement.values[at] } else { f64::NAN }
        };
        let shape = (count, columns);
        let values = Array2::from_shape_fn(shape, |(row, column)| value((states[row].2, column)));
        let sigma = measurement.uncertainty.standard.as_ref();
        let sigma = sigma.map(|sigma| Array2::from_shape_fn(shape, |(row, column)| sigma[(states[row].2, column)]));
        let emission_fwhm_nm = match &axis.bandpass {
            Bandpass::Stated { fwhm_nm, .. } if fwhm_nm.len() == 1 => Some(vec![fwhm_nm[0]; columns]),
            Bandpass::Stated { fwhm_nm, .. } if fwhm_nm.len() == columns => Some(fwhm_nm.clone()),
            _ => None,
        };
        let is_width = |widths: &Vec<f64>| widths.iter().all(|width| *width > 0.0 && width.is_finite());
        let excitation_fwhm_nm: Option<Vec<f64>> = states.iter().map(|state| state.1).collect();
        Ok(Self {
            excitation_nm: states.iter().map(|state| state.0).collect(),
            emission_nm,
            values,
            sigma,
            excitation_fwhm_nm: excitation_fwhm_nm.filter(is_width),
            emission_fwhm_nm: emission_fwhm_nm.filter(is_width),
            rows: states.iter().map(|state| state.2).collect(),
        })
    }

    /// The emission width w that the luminescent values hold, nm, one per emission; where it is unstated the step of the axis,
    /// which is what the instruments of such files are set to.
    #[must_use]
    pub fn emission_width_nm(&self) -> Vec<f64> {
        self.emission_fwhm_nm.clone().unwrap_or_else(|| steps(&self.emission_nm))
    }
}

/// The width of the cell around each wavelength, nm: half the way to both neighbours, and as wide to the outside.
#[must_use]
pub fn steps(nm: &[f64]) -> Vec<f64> {
    let gap = |k: usize| nm[k + 1] - nm[k];
    let last = nm.len().saturating_sub(1);
    let cell = |k: usize| match k {
        _ if last == 0 => 0.0,
        0 => gap(0),
        k if k == last => gap(k - 1),
        k => (gap(k - 1) + gap(k)) / 2.0,
    };
    (0..nm.len()).map(cell).collect()
}
