//! A Donaldson matrix as a BFC file of the Labsphere BFC-450. Values are printed as C's `%g` prints them, with as many
//! digits as it takes to read the same number back, so that a matrix that came from such a file goes back without a
//! changed digit. What the file cannot hold is refused where the numbers would lose their meaning, and listed elsewhere.

use std::io::Write;

use jiff::civil::DateTime;

use super::grid::Grid;
use crate::dataset::{Document, Measurement};
use crate::quantity::{Bandpass, EmissionAxis, Part, Quantity, QuantityKind};

/// The instrument's own digits.
const DIGITS: usize = 6;
/// What the instrument writes where nothing is known.
const EMPTY: &str = "<none>";

/// Why a measurement is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BfcError {
    /// It is no Donaldson matrix, or no table with equal steps.
    #[error("measurement `{measurement}` cannot be a BFC file: {why}")]
    Refused {
        /// Which.
        measurement: String,
        /// Why.
        why: String,
    },
    /// The target took nothing.
    #[error("the file could not be written: {0}")]
    Write(#[from] std::io::Error),
}

/// Writes a measurement of a document, and returns what the file does not hold, one line each.
///
/// # Errors
/// [`BfcError`] for another quantity, values that are missing, unequal steps, and several rows of one excitation; and
/// what the target reports.
pub fn write(document: &Document, measurement: &Measurement, target: &mut impl Write) -> Result<Vec<String>, BfcError> {
    let refused = |why: String| BfcError::Refused { measurement: measurement.id.to_string(), why };
    if measurement.quantity.kind != QuantityKind::DonaldsonMatrix {
        return Err(refused(format!("it is a {}, the file holds a donaldson-matrix", measurement.quantity.kind)));
    }
    let grid = Grid::of(measurement).map_err(refused)?;
    let step = |nm: &[f64], axis: &str| equal_step(nm).ok_or_else(|| refused(format!("its {axis} steps are unequal")));
    let (by_excitation, by_emission) = (step(&grid.excitation_nm, "excitation")?, step(grid.emission_nm, "emission")?);
    let lines = lines(&grid).map_err(refused)?;
    let mut end_line = |text: String| write!(target, "{text}\r\n");
    // The number is the same in every file that was seen.
    end_line("VEC_01\t5167".to_owned())?;
    end_line("BFC-450 Matrix File".to_owned())?;
    for comment in comments(document, measurement) {
        end_line(format!(";{comment}"))?;
    }
    let (first, last) = (grid.emission_nm[0], grid.emission_nm[grid.emission_nm.len() - 1]);
    let count = grid.excitation_nm.len() as f64;
    let ranges = [first, last, by_emission, count, grid.excitation_nm[0], by_excitation];
    end_line(ranges.map(general).join("\t"))?;
    // The instrument ends this line with a tab.
    end_line(format!("r:c:\t{}\t", joined(&grid.excitation_nm)))?;
    for line in lines {
        end_line(line)?;
    }
    end_line("EOD".to_owned())?;
    Ok(lost(document, measurement, &grid))
}

fn lines(grid: &Grid<'_>) -> Result<Vec<String>, String> {
    let row = |(emission, nm): (usize, &f64)| {
        let values: Vec<f64> =
            (0..grid.excitation_nm.len()).map(|excitation| grid.value(excitation, emission)).collect();
        match values.iter().position(|value| !value.is_finite()) {
            Some(at) => Err(format!(
                "the value at emission {nm} nm, excitation {} nm is missing, and the file has no sign for that",
                grid.excitation_nm[at]
            )),
            None => Ok(format!("{}\t{}", general(*nm), joined(&values))),
        }
    };
    grid.emission_nm.iter().enumerate().map(row).collect()
}

fn joined(numbers: &[f64]) -> String {
    numbers.iter().map(|number| general(*number)).collect::<Vec<_>>().join("\t")
}

/// The step of equidistant wavelengths as the file can state it: start plus a multiple of it is each of them.
fn equal_step(nm: &[f64]) -> Option<f64> {
    let (first, last) = (nm.first()?, nm.last()?);
    let step = (last - first) / (nm.len().checked_sub(1).filter(|intervals| *intervals > 0)? as f64);
    // Steps of 0.1 nm are not exact in binary.
    let step = (step * 1e6).round() / 1e6;
    let equal = |(k, nm): (usize, &f64)| (first + step * k as f64 - nm).abs() <= 1e-6 * nm;
    nm.iter().enumerate().all(equal).then_some(step)
}

/// File, sample, operator, remark, two lines of settings, date and time, as the instrument writes them.
fn comments(document: &Document, measurement: &Measurement) -> [String; 8] {
    let sample = document.samples.iter().find(|sample| Some(&sample.id) == measurement.sample.as_ref());
    let instrument = document.instruments.iter().find(|part| Some(&part.id) == measurement.instrument.as_ref());
    let settings = instrument.and_then(|instrument| instrument.accessories.as_deref()).unwrap_or("");
    let (first, second) = settings.split_once("; ").unwrap_or((settings, ""));
    let sample = sample.map(|sample| sample.title.as_deref().unwrap_or(sample.id.as_str()));
    let time = time(measurement);
    let text = |text: Option<&str>| {
        let line = text.unwrap_or("").replace(['\r', '\n'], " ").trim().to_owned();
        if line.is_empty() { EMPTY.to_owned() } else { line }
    };
    [
        text(measurement.title.as_deref()),
        text(sample),
        text(measurement.conditions.operator.as_deref()),
        EMPTY.to_owned(),
        text(Some(first)),
        text(Some(second)),
        time.map_or_else(|| EMPTY.to_owned(), |time| time.strftime("%m/%d/%Y").to_string()),
        time.map_or_else(|| EMPTY.to_owned(), |time| time.strftime("%H:%M:%S").to_string()),
    ]
}

/// The local time of the first row.
fn time(measurement: &Measurement) -> Option<DateTime> {
    let text = measurement.acquisitions.first()?.time.as_deref()?;
    text.get(..19)?.parse().ok()
}

/// A number as `%g` prints it, with six digits or as many as it takes to read it back.
fn general(number: f64) -> String {
    let text = format!("{number:e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let digits = significant(number).max(DIGITS);
    match exponent.parse::<i32>() {
        Ok(power) if power < -4 || i64::from(power) >= digits as i64 => {
            let sign = if power < 0 { '-' } else { '+' };
            format!("{mantissa}e{sign}{:02}", power.unsigned_abs())
        }
        _ => number.to_string(),
    }
}

/// How many digits it takes to read a number back.
fn significant(number: f64) -> usize {
    format!("{number:e}").split('e').next().map_or(0, |mantissa| mantissa.chars().filter(char::is_ascii_digit).count())
}

fn lost(document: &Document, measurement: &Measurement, grid: &Grid<'_>) -> Vec<String> {
    let mut lost = grid.lost(document);
    let mut note = |is_lost: bool, what: String| lost.extend(is_lost.then_some(what));
    let Quantity { part, basis, reference, reference_light, certified_factor, .. } = &measurement.quantity;
    note(*part != Part::Total, format!("the part `{part}`: such a file is read as the total"));
    let unstated = Quantity::unstated(QuantityKind::DonaldsonMatrix);
    note(*basis != unstated.basis, format!("the basis `{basis}`"));
    note(*reference != unstated.reference, format!("the reference `{reference}`"));
    note(*reference_light != unstated.reference_light, format!("the light of the reference, `{reference_light}`"));
    note(!certified_factor.is_empty(), "the certified factor of the reference".to_owned());
    if let EmissionAxis::Wavelengths(axis) = &measurement.emission {
        note(axis.bandpass != Bandpass::Unstated, "the bandpass".to_owned());
        note(!axis.actual_nm.is_empty(), "calibrated emission wavelengths".to_owned());
    }
    let states = &measurement.excitations;
    note(states.iter().any(|state| state.fwhm_nm.is_some()), "the bandwidth of the excitation".to_owned());
    note(states.iter().any(|state| state.light.is_some() || state.filter.is_some()), "light and filter".to_owned());
    let times = measurement.acquisitions.iter().filter_map(|row| row.time.as_deref());
    note(
        times.clone().any(|other| Some(other) != measurement.acquisitions[0].time.as_deref()),
        "the times of the rows".to_owned(),
    );
    note(times.count() > 0, "the zone of the time".to_owned());
    let finer = measurement.values.iter().filter(|value| significant(**value) > DIGITS).count();
    note(finer > 0, format!("that a BFC-450 prints {DIGITS} digits: {finer} values are written with more"));
    lost
}

#[cfg(test)]
mod tests {
    use super::{equal_step, general};

    #[test]
    fn numbers_are_printed_as_by_the_instrument() {
        for text in
            ["380", "0.000401615", "-2.63398e-05", "1.04", "0.18", "-0.0101138", "100000", "1e+06", "0", "1e-05"]
        {
            assert_eq!(general(text.parse().unwrap()), text);
        }
        assert_eq!(general(0.1 + 0.2), "0.30000000000000004");
    }

    #[test]
    fn a_step_is_one_for_all() {
        assert_eq!(equal_step(&[300.0, 310.0, 320.0]), Some(10.0));
        assert_eq!(equal_step(&[300.0, 310.0, 330.0]), None);
        assert_eq!(equal_step(&[300.0]), None);
    }
}
