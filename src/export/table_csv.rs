//! A measurement as a table CSV: `# key: value` lines, then angles, wavelengths, value, uncertainty and flags, one value
//! per line. Importing the table gives the same rows; what it cannot hold is listed.

pub(super) mod head;
mod lost;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write;

use crate::dataset::{Acquisition, Document, Measurement};
use crate::quantity::Flags;

/// Which optional columns a measurement needs.
struct Columns {
    excitation: bool,
    emission: bool,
    sigma: bool,
    order: bool,
    time: bool,
    exposure: bool,
    /// The number of each row among those that nothing else tells apart; empty where there are none.
    repeat: Vec<u32>,
}

/// Writes a measurement of a document, and returns what the table does not hold, one line each.
///
/// # Errors
/// What the target reports.
pub fn write(document: &Document, measurement: &Measurement, target: &mut impl Write) -> std::io::Result<Vec<String>> {
    for (name, value) in head::keys(document, measurement) {
        writeln!(target, "# {name}: {value}")?;
    }
    let columns = Columns::of(measurement);
    writeln!(target, "{}", columns.names().join(","))?;
    for (row, acquisition) in measurement.acquisitions.iter().enumerate() {
        for emission in 0..measurement.emission.len() {
            writeln!(target, "{}", line(measurement, acquisition, &columns, (row, emission)))?;
        }
    }
    Ok(lost::lost(document, measurement))
}

impl Columns {
    fn of(measurement: &Measurement) -> Self {
        let rows = &measurement.acquisitions;
        let in_order = (0_u32..).zip(rows).all(|(position, row)| row.order == position);
        let order = !in_order || !repeats(rows, false).is_empty();
        Self {
            excitation: rows.iter().any(|row| excitation_nm(measurement, row).is_some()),
            emission: measurement.emission.wavelengths().is_some(),
            sigma: measurement.uncertainty.standard.is_some(),
            order,
            time: rows.iter().any(|row| row.time.is_some()),
            exposure: rows.iter().any(|row| row.exposure_ms.is_some()),
            repeat: repeats(rows, order),
        }
    }

    fn names(&self) -> Vec<&'static str> {
        let columns = [
            (true, "theta_i_deg"),
            (true, "phi_i_deg"),
            (true, "theta_v_deg"),
            (true, "phi_v_deg"),
            (self.excitation, "excitation_nm"),
            (self.emission, "emission_nm"),
            (true, "value"),
            (self.sigma, "sigma"),
            (true, "flag"),
            (self.order, "order"),
            (!self.repeat.is_empty(), "repeat"),
            (self.time, "time"),
            (self.exposure, "exposure_ms"),
        ];
        columns.iter().filter(|(used, _)| *used).map(|(_, name)| *name).collect()
    }
}

/// Numbers the rows of one geometry and excitation (and order, if that has a column); nothing if no two are alike.
fn repeats(rows: &[Acquisition], order: bool) -> Vec<u32> {
    let mut counts = BTreeMap::new();
    let number = |row: &Acquisition| {
        let angles = angles(row).map(|angles| angles.map(|angle| (angle + 0.0).to_bits()));
        let count = counts.entry((angles, row.excitation, order.then_some(row.order))).or_insert(0_u32);
        *count += 1;
        *count
    };
    let numbers: Vec<u32> = rows.iter().map(number).collect();
    if numbers.iter().any(|number| *number > 1) { numbers } else { Vec::new() }
}

fn angles(row: &Acquisition) -> Option<[f64; 4]> {
    let g = row.geometry?;
    Some([g.incidence.theta_deg(), g.incidence.phi_deg(), g.viewing.theta_deg(), g.viewing.phi_deg()])
}

fn excitation_nm(measurement: &Measurement, row: &Acquisition) -> Option<f64> {
    measurement.excitation_of(row)?.wavelength_nm
}

fn line(measurement: &Measurement, row: &Acquisition, columns: &Columns, at: (usize, usize)) -> String {
    let mut fields: Vec<String> = match angles(row) {
        Some(angles) => angles.map(number).to_vec(),
        None => vec![String::new(); 4],
    };
    if columns.excitation {
        fields.push(excitation_nm(measurement, row).map_or(String::new(), number));
    }
    if let Some(nm) = measurement.emission.wavelengths().filter(|_| columns.emission) {
        fields.push(nm.get(at.1).copied().map_or(String::new(), number));
    }
    fields.push(measurement.values.get(at).copied().map_or(String::new(), number));
    if let Some(standard) = &measurement.uncertainty.standard {
        fields.push(standard.get(at).copied().map_or(String::new(), number));
    }
    fields.push(flag_names(measurement.flags_at(at.0, at.1)));
    let of_row = [
        columns.order.then(|| row.order.to_string()),
        columns.repeat.get(at.0).map(u32::to_string),
        columns.time.then(|| row.time.clone().unwrap_or_default()),
        columns.exposure.then(|| row.exposure_ms.map_or(String::new(), number)),
    ];
    fields.extend(of_row.into_iter().flatten());
    fields.join(",")
}

/// The shortest text that reads back as the same number; nothing for NaN.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if value.is_nan() {
        String::new()
    } else if magnitude != 0.0 && !(1e-5..1e16).contains(&magnitude) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

fn flag_names(flags: Flags) -> String {
    let mut names: Vec<String> = flags.iter().map(|flag| flag.name().to_owned()).collect();
    if flags.unknown_bits() != 0 {
        let mut unknown = String::new();
        let _ = write!(unknown, "{:#x}", flags.unknown_bits());
        names.push(unknown);
    }
    names.join("|")
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_read_back_and_are_short() {
        for (value, text) in [(0.1, "0.1"), (1e-9, "1e-9"), (-0.0, "-0"), (380.0, "380"), (1.5e300, "1.5e300")] {
            assert_eq!(number(value), text);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(number(f64::NAN), "");
    }
}
