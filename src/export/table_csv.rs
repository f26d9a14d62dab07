//! A measurement as a table CSV: `# key: value` lines, then four angles, wavelengths, value, uncertainty, flags.

use std::fmt::Write as _;
use std::io::Write;

use crate::dataset::{Acquisition, Measurement};
use crate::quantity::Flags;

/// Which optional columns a measurement needs.
struct Columns {
    excitation: bool,
    emission: bool,
    sigma: bool,
}

/// Writes a measurement.
///
/// # Errors
/// What the target reports.
pub fn write(measurement: &Measurement, target: &mut impl Write) -> std::io::Result<()> {
    head(measurement, target)?;
    let columns = Columns {
        excitation: measurement.acquisitions.iter().any(|row| excitation_nm(measurement, row).is_some()),
        emission: measurement.emission.wavelengths().is_some(),
        sigma: measurement.uncertainty.standard.is_some(),
    };
    let mut names = vec!["theta_i_deg", "phi_i_deg", "theta_v_deg", "phi_v_deg"];
    let optional = [(columns.excitation, "excitation_nm"), (columns.emission, "emission_nm")];
    names.extend(optional.iter().filter(|(used, _)| *used).map(|(_, name)| *name));
    names.push("value");
    names.extend(columns.sigma.then_some("sigma"));
    names.push("flag");
    writeln!(target, "{}", names.join(","))?;
    for (row, acquisition) in measurement.acquisitions.iter().enumerate() {
        for emission in 0..measurement.emission.len() {
            writeln!(target, "{}", line(measurement, acquisition, &columns, (row, emission)))?;
        }
    }
    Ok(())
}

fn head(measurement: &Measurement, target: &mut impl Write) -> std::io::Result<()> {
    let quantity = &measurement.quantity;
    let mut key = |name: &str, value: &str| writeln!(target, "# {name}: {}", value.replace(['\r', '\n'], " "));
    if let Some(title) = &measurement.title {
        key("title", title)?;
    }
    key("quantity", quantity.kind.name())?;
    key("part", quantity.part.name())?;
    key("normalised-at", quantity.normalised_at.name())?;
    key("basis", quantity.basis.name())?;
    key("reference", &quantity.reference.to_string())?;
    key("reference-light", &quantity.reference_light.to_string())
}

fn excitation_nm(measurement: &Measurement, row: &Acquisition) -> Option<f64> {
    let state = usize::try_from(row.excitation?).ok()?;
    measurement.excitations.get(state)?.wavelength_nm
}

fn line(measurement: &Measurement, row: &Acquisition, columns: &Columns, at: (usize, usize)) -> String {
    let angles = row
        .geometry
        .map(|g| [g.incidence.theta_deg(), g.incidence.phi_deg(), g.viewing.theta_deg(), g.viewing.phi_deg()]);
    let mut fields: Vec<String> = match angles {
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
    fields.join(",")
}

/// The shortest text that reads back as the same number; nothing for NaN.
fn number(value: f64) -> String {
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
