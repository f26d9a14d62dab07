//! The columns under `data`: what each holds, in our units, every number checked.

use super::file::File;
use super::json::Json;
use crate::import::error::ImportError;
use crate::import::receipt::Notes;
use crate::quantity::{Flag, Flags};

/// The points of a file, one entry per point in every column.
#[derive(Debug, Default)]
pub(super) struct Columns {
    /// `theta_i, phi_i, theta_r, phi_r`, degrees.
    pub(super) angles: [Vec<f64>; 4],
    /// BRDF, sr-1; NaN where the file has `null`.
    pub(super) value: Vec<f64>,
    /// Its uncertainty as the file states it, sr-1.
    pub(super) sigma: Option<Vec<f64>>,
    /// Wavelength of illumination, nm.
    pub(super) excitation_nm: Option<Vec<f64>>,
    /// Wavelength of detection, nm.
    pub(super) emission_nm: Option<Vec<f64>>,
    /// Polarisation of the illumination.
    pub(super) polarisation_i: Option<Vec<String>>,
    /// Polarisation of the detection.
    pub(super) polarisation_r: Option<Vec<String>>,
    /// Flags, where our own export wrote them.
    pub(super) flags: Option<Vec<Flags>>,
    /// True where illumination and detection were at one wavelength at every point: what is measured is reflected light.
    pub(super) is_elastic: bool,
}

const ANGLES: [&str; 4] = ["theta_i", "phi_i", "theta_r", "phi_r"];
const DEGREES: &[(&str, f64)] = &[("deg", 1.0), ("°", 1.0), ("rad", f64::NAN)];
const PER_STERADIAN: &[(&str, f64)] = &[("1/sr", 1.0), ("sr^-1", 1.0)];
const OF_UNCERTAINTY: &[(&str, f64)] = &[("1/sr", 1.0), ("sr^-1", 1.0), ("%", f64::NAN)];
/// Micro is written with either of the two letters that look the same.
const NANOMETRES: &[(&str, f64)] = &[("nm", 1.0), ("\u{3bc}m", 1e3), ("\u{b5}m", 1e3), ("um", 1e3)];

impl Columns {
    /// Takes the columns out of a file.
    ///
    /// # Errors
    /// [`ImportError`] with the path in the file for a missing column, an unknown unit, columns of unequal length, and
    /// numbers out of range.
    pub(super) fn take(file: &mut File, notes: &mut Notes) -> Result<Self, ImportError> {
        let (value, _) = file.column("BRDF", PER_STERADIAN, notes)?;
        let mut columns = Self { value, ..Self::default() };
        for (place, name) in columns.angles.iter_mut().zip(ANGLES) {
            *place = angle(file, name, notes)?;
        }
        for (name, column) in ANGLES.into_iter().zip(&columns.angles) {
            file.check_length(name, column.len(), columns.value.len())?;
        }
        columns.sigma = sigma(file, &columns.value, notes)?;
        columns.excitation_nm = wavelength(file, "wavelength_i", columns.value.len(), notes)?;
        columns.emission_nm = wavelength(file, "wavelength_r", columns.value.len(), notes)?;
        columns.polarisation_i = polarisation(file, "polarization_i", columns.value.len(), notes)?;
        columns.polarisation_r = polarisation(file, "polarization_r", columns.value.len(), notes)?;
        columns.is_elastic = columns.excitation_nm.is_some() && columns.excitation_nm == columns.emission_nm;
        columns.flags = flags(file, columns.value.len());
        columns.note_values(file, notes);
        Ok(columns)
    }

    /// Number of points.
    pub(super) fn len(&self) -> usize {
        self.value.len()
    }

    fn note_values(&self, file: &File, notes: &mut Notes) {
        let missing = self.value.iter().filter(|value| value.is_nan()).count();
        let place = || file.at("data.BRDF.values");
        if missing > 0 {
            let text =
                format!("{missing} values are `null`, which the format does not have: missing, for no stated reason");
            notes.notice(place(), text);
        }
        let negative = self.value.iter().filter(|value| **value < 0.0).count();
        if negative > 0 {
            notes.notice(place(), format!("{negative} values below 0, which the schema of the format refuses: kept"));
        }
    }
}

fn angle(file: &mut File, name: &'static str, notes: &mut Notes) -> Result<Vec<f64>, ImportError> {
    let (mut column, factor) = file.column(name, DEGREES, notes)?;
    if factor.is_nan() {
        column.iter_mut().for_each(|angle| *angle = angle.to_degrees());
    }
    let polar = name.starts_with("theta");
    let fits = |angle: f64| if polar { (0.0..=90.0).contains(&angle) } else { (0.0..360.0).contains(&angle) };
    if let Some((index, angle)) = column.iter().enumerate().find(|(_, angle)| !fits(**angle)) {
        let found = if angle.is_nan() { "null".to_owned() } else { format!("{angle} degrees") };
        let range = if polar { "0 to 90 degrees" } else { "0 up to but not including 360 degrees" };
        return Err(file.malformed(&format!("data.{name}.values"), Some(index), found, range, "correct the angle"));
    }
    Ok(column)
}

/// The uncertainty: a column `uBRDF`, else the one number under `BRDF`.
fn sigma(file: &mut File, value: &[f64], notes: &mut Notes) -> Result<Option<Vec<f64>>, ImportError> {
    let (column, factor, path) = if file.has("uBRDF") {
        let (column, factor) = file.column("uBRDF", OF_UNCERTAINTY, notes)?;
        file.check_length("uBRDF", column.len(), value.len())?;
        if file.tree.at(&["data", "BRDF", "uncertainty"]).is_some() {
            let text = "a second uncertainty beside `data.uBRDF`: not taken, kept in the extension";
            notes.notice(file.at("data.BRDF.uncertainty"), text);
        }
        (column, factor, "data.uBRDF.values")
    } else {
        let Some((column, factor)) = constant_uncertainty(file, value.len(), notes)? else { return Ok(None) };
        (column, factor, "data.BRDF.uncertainty.value")
    };
    if let Some((index, sigma)) = column.iter().enumerate().find(|(_, sigma)| **sigma < 0.0) {
        let advice = "correct the uncertainty";
        return Err(file.malformed(path, Some(index), sigma.to_string(), "an uncertainty, not negative", advice));
    }
    if !factor.is_nan() {
        return Ok(Some(column));
    }
    Ok(Some(column.iter().zip(value).map(|(percent, value)| percent / 100.0 * value.abs()).collect()))
}

/// `BRDF.uncertainty`, one for all points; some writers put a list there.
fn constant_uncertainty(
    file: &mut File,
    length: usize,
    notes: &mut Notes,
) -> Result<Option<(Vec<f64>, f64)>, ImportError> {
    let path = "data.BRDF.uncertainty";
    let Some(found) = file.tree.at(&["data", "BRDF", "uncertainty", "value"]) else { return Ok(None) };
    let column = match found {
        Json::Number(number) => vec![*number; length],
        Json::Numbers(numbers) => {
            let text = "a list where the schema of the format has one number: taken as one for each point";
            notes.notice(file.at("data.BRDF.uncertainty.value"), text);
            file.check_length("BRDF.uncertainty", numbers.len(), length)?;
            numbers.clone()
        }
        other => {
            let (what, place) = (other.what(), format!("{path}.value"));
            return Err(file.malformed(&place, None, what, "a number", "correct it, or take it out"));
        }
    };
    let factor = file.unit(path, &["data", "BRDF", "uncertainty", "unit"], OF_UNCERTAINTY)?;
    file.tree.take(&["data", "BRDF", "uncertainty", "value"], |_| Some(()));
    Ok(Some((column, factor)))
}

fn wavelength(
    file: &mut File,
    name: &'static str,
    length: usize,
    notes: &mut Notes,
) -> Result<Option<Vec<f64>>, ImportError> {
    if !file.has(name) {
        return Ok(None);
    }
    let (mut column, factor) = file.column(name, NANOMETRES, notes)?;
    file.check_length(name, column.len(), length)?;
    if factor != 1.0 {
        column.iter_mut().for_each(|nm| *nm *= factor);
    }
    if let Some((index, nm)) = column.iter().enumerate().find(|(_, nm)| !(**nm > 0.0 && nm.is_finite())) {
        let found = if nm.is_nan() { "null".to_owned() } else { format!("{nm} nm") };
        let place = format!("data.{name}.values");
        return Err(file.malformed(&place, Some(index), found, "a positive wavelength", "correct it"));
    }
    Ok(Some(column))
}

fn polarisation(
    file: &mut File,
    name: &'static str,
    length: usize,
    notes: &mut Notes,
) -> Result<Option<Vec<String>>, ImportError> {
    if !file.has(name) {
        return Ok(None);
    }
    let place = format!("data.{name}.values");
    let list = match file.take_values(name, notes) {
        Some(Json::List(list)) => list,
        other => {
            let found = other.map_or("nothing".to_owned(), |json| json.what());
            return Err(file.malformed(&place, None, found, "a list of s, p, u or of Stokes vectors", "correct it"));
        }
    };
    file.check_length(name, list.len(), length)?;
    let states = list.iter().enumerate().map(|(index, state)| match state {
        Json::Text(text) if matches!(text.as_str(), "s" | "p" | "u") => Ok(text.clone()),
        Json::Numbers(stokes) if is_stokes(stokes) => Ok(stokes_text(stokes)),
        other => {
            let expected = "s, p, u or a Stokes vector of four numbers from -1 to 1, the first 1";
            Err(file.malformed(&place, Some(index), other.what(), expected, "correct it"))
        }
    });
    let states = states.collect::<Result<Vec<_>, _>>()?;
    file.tree.take_text(&["data", name, "notation"]);
    file.take_name(name);
    Ok(Some(states))
}

fn is_stokes(stokes: &[f64]) -> bool {
    stokes.len() == 4 && stokes.first() == Some(&1.0) && stokes.iter().all(|part| (-1.0..=1.0).contains(part))
}

/// A normalised Stokes vector as text: `stokes 1 0.5 0 0`.
fn stokes_text(stokes: &[f64]) -> String {
    stokes.iter().fold("stokes".to_owned(), |text, part| format!("{text} {part}"))
}

/// What our own export puts beside the columns of the format; anything else of that name stays where it is.
fn flags(file: &mut File, length: usize) -> Option<Vec<Flags>> {
    let parse = |text: &str| -> Option<Flags> {
        let names = text.split('|').filter(|name| !name.is_empty());
        names.into_iter().try_fold(Flags::NONE, |flags, name| Flag::from_name(name).map(|flag| flags.with(flag)))
    };
    let path = ["data", "adhoc_variables", "flag"];
    let Some(Json::List(list)) = file.tree.at(&["data", "adhoc_variables", "flag", "values"]) else { return None };
    let flags = list.iter().map(|item| match item {
        Json::Text(text) => parse(text),
        _ => None,
    });
    let flags = flags.collect::<Option<Vec<_>>>().filter(|flags| flags.len() == length)?;
    file.tree.take(&path, |_| Some(()));
    Some(flags)
}
