//! The matrix that `bbrf donaldson estimate --json` printed, beside what was put in.

use std::error::Error;
use std::path::Path;

use serde_json::Value;

use crate::fitted::{json, number};
use crate::yellow_paint::{YELLOW_PAINT, emission, luminescent};

/// Emission width of the estimated matrix, nm: the default of the command.
const WIDTH_NM: f64 = 10.0;

/// So many of so many intervals of 95 % hold the truth.
#[derive(Debug, Default)]
pub(crate) struct Covered {
    pub(crate) held: usize,
    pub(crate) of: usize,
}

/// How the estimate compares with the truth.
#[derive(Debug)]
pub(crate) struct Compared {
    pub(crate) reflectance: Covered,
    pub(crate) emission: Covered,
    pub(crate) excitation: Covered,
    pub(crate) cells: Covered,
    /// Root mean square difference of the best reflectance from the true one.
    pub(crate) reflectance_rms: f64,
    /// Where the emission peaks, found and true, nm.
    pub(crate) peak_nm: (f64, f64),
    /// Where it is excited most, found and true, nm.
    pub(crate) excited_nm: (f64, f64),
    /// Median width of the intervals of the excitation spectrum, in its peak.
    pub(crate) excitation_width: f64,
}

impl Covered {
    fn add(&mut self, interval: &Value, truth: f64) -> Result<(), Box<dyn Error>> {
        self.of += 1;
        // Bounds of numbers that are exactly zero are zero up to rounding.
        let (low, high) = (number(&interval["low"])? - 1e-12, number(&interval["high"])? + 1e-12);
        self.held += usize::from((low..=high).contains(&truth));
        Ok(())
    }
}

/// Reads `estimate.json`.
///
/// # Errors
/// When it cannot be read or lacks what is looked for.
pub(crate) fn compare(folder: &Path) -> Result<Compared, Box<dyn Error>> {
    let found = json(&folder.join("estimate.json"))?;
    let emission_nm = wavelengths(&found, "emission_nm")?;
    let excitation_nm = wavelengths(&found, "excitation_nm")?;
    let mut cells = Covered::default();
    for (row, excitation) in list(&found, "luminescent")?.iter().zip(&excitation_nm) {
        let row = row.as_array().ok_or("estimate.json: a row is no list")?;
        for (cell, emission) in row.iter().zip(&emission_nm).filter(|(_, emission)| *emission >= excitation) {
            cells.add(cell, luminescent(*excitation, *emission, WIDTH_NM))?;
        }
    }
    let reflectance_at = |nm: f64| YELLOW_PAINT.reflectance_at(nm);
    let emission_at = |nm: f64| emission(nm, WIDTH_NM);
    let excitation_at = |nm: f64| YELLOW_PAINT.excitation_at(nm);
    Ok(Compared {
        reflectance: covered(list(&found, "reflectance")?, &emission_nm, reflectance_at)?,
        emission: covered(list(&found, "emission")?, &emission_nm, emission_at)?,
        excitation: covered(list(&found, "excitation")?, &excitation_nm, excitation_at)?,
        cells,
        reflectance_rms: rms(list(&found, "reflectance")?, &emission_nm, reflectance_at)?,
        peak_nm: (peak(list(&found, "emission")?, &emission_nm), YELLOW_PAINT.emission_nm.0),
        excited_nm: (peak(list(&found, "excitation")?, &excitation_nm), YELLOW_PAINT.excitation_nm.0),
        excitation_width: median_width(list(&found, "excitation")?)?,
    })
}

fn list<'a>(found: &'a Value, name: &str) -> Result<&'a [Value], Box<dyn Error>> {
    let list = found[name].as_array().ok_or_else(|| format!("estimate.json: no {name}"))?;
    Ok(list)
}

fn wavelengths(found: &Value, name: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    list(found, name)?.iter().map(number).collect()
}

fn covered(intervals: &[Value], nm: &[f64], truth: impl Fn(f64) -> f64) -> Result<Covered, Box<dyn Error>> {
    let mut covered = Covered::default();
    for (interval, nm) in intervals.iter().zip(nm) {
        covered.add(interval, truth(*nm))?;
    }
    Ok(covered)
}

fn rms(intervals: &[Value], nm: &[f64], truth: impl Fn(f64) -> f64) -> Result<f64, Box<dyn Error>> {
    let mut sum = 0.0;
    for (interval, nm) in intervals.iter().zip(nm) {
        sum += (number(&interval["best"])? - truth(*nm)).powi(2);
    }
    Ok((sum / nm.len() as f64).sqrt())
}

fn peak(intervals: &[Value], nm: &[f64]) -> f64 {
    let best = |interval: &Value| interval["best"].as_f64().unwrap_or(f64::NAN);
    let highest = intervals.iter().zip(nm).max_by(|one, other| best(one.0).total_cmp(&best(other.0)));
    highest.map_or(f64::NAN, |(_, nm)| *nm)
}

fn median_width(intervals: &[Value]) -> Result<f64, Box<dyn Error>> {
    let width = |interval: &Value| Ok(number(&interval["high"])? - number(&interval["low"])?);
    let mut widths: Vec<f64> = intervals.iter().map(width).collect::<Result<_, Box<dyn Error>>>()?;
    widths.sort_by(f64::total_cmp);
    Ok(widths[widths.len() / 2])
}
