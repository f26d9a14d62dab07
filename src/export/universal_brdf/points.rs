//! The columns under `data`: one entry per value that is there.

use serde_json::{Map, Value, json};

use super::convert::Conversion;
use crate::dataset::{Acquisition, Excitation, Measurement};
use crate::quantity::{Flags, Part};

/// The points of a measurement.
#[derive(Debug, Default)]
pub(super) struct Points {
    /// Incidence and viewing, degrees.
    angles: [Vec<f64>; 4],
    /// BRDF, 1/sr.
    pub(super) value: Vec<f64>,
    /// Its standard uncertainty, 1/sr; empty where one is unknown.
    sigma: Vec<f64>,
    /// Wavelength of illumination, nm; empty where one is unknown.
    excitation_nm: Vec<f64>,
    /// Wavelength of detection, nm; empty for a band.
    emission_nm: Vec<f64>,
    /// Polarisation of the illumination; empty where one is unknown.
    polarisation: Vec<Value>,
    flags: Vec<Flags>,
    /// Values left out, because they are missing, in no known geometry, or have no BRDF there.
    pub(super) left_out: usize,
    /// True where uncertainties are left out because some are unknown.
    pub(super) sigma_left_out: bool,
    /// True where wavelengths of excitation are left out because some are unknown.
    pub(super) excitation_left_out: bool,
    /// True where polarisations are left out because some are unknown or in words.
    pub(super) polarisation_left_out: bool,
}

impl Points {
    pub(super) fn of(measurement: &Measurement, conversion: &Conversion) -> Self {
        let mut points = Self::default();
        for (row, acquisition) in measurement.acquisitions.iter().enumerate() {
            points.row(measurement, row, acquisition, conversion);
        }
        points.keep_whole_columns(measurement);
        points
    }

    fn row(&mut self, measurement: &Measurement, row: usize, acquisition: &Acquisition, conversion: &Conversion) {
        let scale = acquisition.geometry.and_then(|geometry| Some((geometry, conversion.scale(&geometry)?)));
        let Some((geometry, scale)) = scale else {
            self.left_out += measurement.emission.len();
            return;
        };
        let (i, v) = (geometry.incidence, geometry.viewing);
        let angles = [i.theta_deg(), i.phi_deg(), v.theta_deg(), v.phi_deg()];
        let state = measurement.excitation_of(acquisition);
        for column in 0..measurement.emission.len() {
            let value = measurement.values.get((row, column)).map_or(f64::NAN, |value| value * scale);
            if !value.is_finite() {
                self.left_out += 1;
                continue;
            }
            self.value.push(value);
            self.angles.iter_mut().zip(angles).for_each(|(list, angle)| list.push(angle));
            let sigma = measurement.uncertainty.standard.as_ref().and_then(|sigma| sigma.get((row, column)));
            self.sigma.extend(sigma.map(|sigma| sigma * scale).filter(|sigma| sigma.is_finite()));
            let emission = measurement.emission.wavelengths().and_then(|nm| nm.get(column)).copied();
            self.emission_nm.extend(emission);
            self.excitation_nm.extend(excitation_nm(measurement, state, emission));
            self.polarisation.extend(state.and_then(|state| polarisation(state.polarisation.as_deref()?)));
            self.flags.push(measurement.flags_at(row, column));
        }
    }

    /// A column holds a number for every point, or is not there.
    fn keep_whole_columns(&mut self, measurement: &Measurement) {
        let whole = self.value.len();
        if self.sigma.len() < whole {
            self.sigma.clear();
            self.sigma_left_out = measurement.uncertainty.standard.is_some();
        }
        if self.excitation_nm.len() < whole {
            self.excitation_left_out = !self.excitation_nm.is_empty();
            self.excitation_nm.clear();
        }
        // One notation for all: letters, or Stokes vectors.
        let letters = self.polarisation.iter().filter(|state| state.is_string()).count();
        if self.polarisation.len() < whole || (letters > 0 && letters < whole) {
            self.polarisation.clear();
            self.polarisation_left_out = measurement.excitations.iter().any(|state| state.polarisation.is_some());
        }
        if self.flags.iter().all(|flags| flags.0 == 0) {
            self.flags.clear();
        }
    }

    /// The columns by name, each as JSON on one line; `kept` is what an import of the format had no place for.
    pub(super) fn columns(&self, measurement: &Measurement, kept: Map<String, Value>) -> Vec<(String, String)> {
        let mut data = Map::new();
        let mut add = |name: &str, unit: &str, values: &[f64]| {
            data.insert(name.to_owned(), json!({ "name": name, "unit": unit, "values": values }));
        };
        for (name, list) in ["theta_i", "phi_i", "theta_r", "phi_r"].into_iter().zip(&self.angles) {
            add(name, "deg", list);
        }
        add("BRDF", "1/sr", &self.value);
        if !self.sigma.is_empty() {
            // The schema calls it BRDF.
            data.insert("uBRDF".to_owned(), json!({ "name": "BRDF", "unit": "1/sr", "values": self.sigma }));
        }
        for (name, list) in [("wavelength_i", &self.excitation_nm), ("wavelength_r", &self.emission_nm)] {
            if !list.is_empty() {
                data.insert(name.to_owned(), json!({ "name": name, "unit": "nm", "values": list }));
            }
        }
        self.polarisations(measurement, &mut data);
        if !self.flags.is_empty() {
            let names = |flags: &Flags| flags.iter().map(|flag| flag.name()).collect::<Vec<_>>().join("|");
            let values: Vec<String> = self.flags.iter().map(names).collect();
            let description = "Flags of bbrf: why a value is doubtful; empty for none.";
            let flag = json!({ "description": description, "unit": "", "type": "string", "values": values });
            data.insert("adhoc_variables".to_owned(), json!({ "flag": flag }));
        }
        super::metadata::merge(&mut data, kept);
        data.into_iter().map(|(name, column)| (name, column.to_string())).collect()
    }

    fn polarisations(&self, measurement: &Measurement, data: &mut Map<String, Value>) {
        let notation = |state: Option<&Value>| if state.is_some_and(Value::is_string) { "sp" } else { "inStokes" };
        if !self.polarisation.is_empty() {
            let notation = notation(self.polarisation.first());
            let column = json!({ "name": "polarization_i", "notation": notation, "values": self.polarisation });
            data.insert("polarization_i".to_owned(), column);
        }
        if let Some(state) = measurement.conditions.viewing_polarisation.as_deref().and_then(polarisation) {
            let (notation, values) = (notation(Some(&state)), vec![state; self.value.len()]);
            let column = json!({ "name": "polarization_r", "notation": notation, "values": values });
            data.insert("polarization_r".to_owned(), column);
        }
    }

    /// How many directions lie at 90 degrees.
    pub(super) fn grazing(&self) -> usize {
        let [theta_i, _, theta_v, _] = &self.angles;
        theta_i.iter().zip(theta_v).filter(|(i, v)| **i == 90.0 || **v == 90.0).count()
    }
}

/// The wavelength of illumination: that of the state, or, for reflected light without one, that of detection.
fn excitation_nm(measurement: &Measurement, state: Option<&Excitation>, emission: Option<f64>) -> Option<f64> {
    let stated = state.and_then(|state| state.wavelength_nm);
    stated.or_else(|| emission.filter(|_| measurement.quantity.part == Part::Elastic))
}

/// A polarisation as the format writes it; `None` for one in words.
pub(super) fn polarisation(text: &str) -> Option<Value> {
    if matches!(text, "s" | "p" | "u") {
        return Some(Value::from(text));
    }
    let parts = text.strip_prefix("stokes ")?.split(' ').map(|part| part.parse::<f64>().ok());
    let stokes = parts.collect::<Option<Vec<f64>>>()?;
    let normalised = stokes.len() == 4 && stokes.first() == Some(&1.0);
    (normalised && stokes.iter().all(|part| (-1.0..=1.0).contains(part))).then(|| json!(stokes))
}
