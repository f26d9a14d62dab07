//! A measurement as a table over excitation and emission wavelengths, for formats that know nothing else.

use crate::dataset::{Conditions, Document, Measurement, Role};
use crate::quantity::{Flag, Flags};

/// The rows of a measurement by ascending excitation.
#[derive(Debug)]
pub(super) struct Grid<'a> {
    measurement: &'a Measurement,
    rows: Vec<usize>,
    /// Excitation wavelengths, nm, strictly ascending.
    pub(super) excitation_nm: Vec<f64>,
    /// Emission wavelengths, nm.
    pub(super) emission_nm: &'a [f64],
}

impl<'a> Grid<'a> {
    /// The table, or why there is none: a band, a row without an excitation wavelength, two rows of one.
    pub(super) fn of(measurement: &'a Measurement) -> Result<Self, String> {
        let Some(emission_nm) = measurement.emission.wavelengths() else {
            return Err("its values are of a band and have no emission wavelengths".to_owned());
        };
        let nm = |(row, acquisition)| {
            let state = measurement.excitation_of(acquisition);
            let nm = state.and_then(|state| state.wavelength_nm.or(state.actual_nm));
            nm.map(|nm| (nm, row)).ok_or(format!("row {row} has no excitation wavelength"))
        };
        let mut rows: Vec<(f64, usize)> =
            measurement.acquisitions.iter().enumerate().map(nm).collect::<Result<_, _>>()?;
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(pair) = rows.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let ((nm, first), (_, second)) = (pair[0], pair[1]);
            return Err(format!("rows {first} and {second} are both of the excitation {nm} nm"));
        }
        if rows.is_empty() || emission_nm.is_empty() {
            return Err("it has no values".to_owned());
        }
        let (excitation_nm, rows) = rows.into_iter().unzip();
        Ok(Self { measurement, rows, excitation_nm, emission_nm })
    }

    /// The value at an excitation and an emission, by their positions in the table; NaN where it is missing.
    pub(super) fn value(&self, excitation: usize, emission: usize) -> f64 {
        let row = self.rows.get(excitation);
        row.and_then(|row| self.measurement.values.get((*row, emission))).copied().unwrap_or(f64::NAN)
    }

    /// One line for each thing that a table of two wavelengths has no place for, whatever its format.
    pub(super) fn lost(&self, document: &Document) -> Vec<String> {
        let measurement = self.measurement;
        let mut lost = Vec::new();
        let mut note = |is_lost: bool, what: String| lost.extend(is_lost.then_some(what));
        note(measurement.role != Role::Sample, format!("the role `{}`", measurement.role));
        note(!self.rows.is_sorted(), "the order in which the excitations were measured".to_owned());
        note(measurement.uncertainty.standard.is_some(), "the standard uncertainty of the values".to_owned());
        for component in &measurement.uncertainty.components {
            note(true, format!("the shared uncertainty component `{}`", component.name));
        }
        let missing = Flags::NONE.with(Flag::NotMeasured).0;
        let flagged = measurement.flags.iter().filter(|flags| **flags & !missing != 0).count();
        note(flagged > 0, format!("the flags of {flagged} values"));
        let rows = &measurement.acquisitions;
        note(rows.iter().any(|row| row.geometry.is_some()), "the geometry".to_owned());
        note(rows.iter().any(|row| row.repeats != 1), "how many readings a row is the mean of".to_owned());
        note(rows.iter().any(|row| row.exposure_ms.is_some()), "integration times".to_owned());
        note(rows.iter().any(|row| row.quality_code.is_some()), "quality codes of the instrument".to_owned());
        let states = &measurement.excitations;
        note(states.iter().any(|state| state.actual_nm.is_some()), "calibrated excitation wavelengths".to_owned());
        note(states.iter().any(|state| state.polarisation.is_some()), "the polarisation of the excitation".to_owned());
        note(
            states.iter().any(|state| state.shape.is_some() || state.correction.is_some()),
            "shape and correction of the excitation's bandpass".to_owned(),
        );
        let conditions = Conditions { operator: None, ..measurement.conditions.clone() };
        note(conditions != Conditions::default(), "the conditions of the measurement".to_owned());
        note(measurement.derivation.is_some(), "how the values were derived".to_owned());
        note(measurement.white_reference.is_some(), "the white reference with its certificate".to_owned());
        for extension in &document.extensions {
            note(true, format!("the extension `{}`", extension.domain));
        }
        lost
    }
}
