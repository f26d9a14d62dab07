//! Words in texts of columns and in SpectraWin exports: which of them say something about the instrument.

use super::number::value;
use super::record::Details;

/// A particular of the instrument or of the measurement.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Particular {
    /// Make and model.
    Model(String),
    /// Serial number.
    Serial(String),
    /// Aperture.
    Aperture(String),
    /// Lenses and filters.
    Accessories(String),
    /// Time without a zone.
    LocalTime(String),
    /// Integration time, ms.
    ExposureMs(f64),
    /// Luminance, cd/m2.
    Luminance(f64),
}

impl Particular {
    /// Writes it into the details; a luminance belongs to the record and is not one of them.
    pub(super) fn apply(self, details: &mut Details) {
        match self {
            Self::Model(text) => details.model = Some(text),
            Self::Serial(text) => details.serial = Some(text),
            Self::Aperture(text) => details.aperture = Some(text),
            Self::Accessories(text) => details.accessories = Some(text),
            Self::LocalTime(text) => details.local_time = Some(text),
            Self::ExposureMs(ms) => details.exposure_ms = Some(ms),
            Self::Luminance(_) => {}
        }
    }
}

/// Reads `key: value`, `key = value` or `key,value`; `None` for a key that is not known or a value that is none.
pub(super) fn read(text: &str) -> Option<Particular> {
    let bare = text.trim_start_matches(['#', '%', '/', ' ']);
    let at = bare.find([':', '=', ',', ';', '\t'])?;
    // `Date / Time: ...` and `Luminance(cd/m2): ...`: the first mark ends the key.
    let (key, rest) = (bare[..at].trim().to_ascii_lowercase(), bare[at + 1..].trim().trim_matches('"'));
    if rest.is_empty() {
        return None;
    }
    let text = || rest.to_owned();
    let starts = |names: &[&str]| names.iter().any(|name| key.starts_with(name));
    if starts(&["model", "instrument"]) {
        Some(Particular::Model(text()))
    } else if starts(&["serial"]) {
        Some(Particular::Serial(text()))
    } else if starts(&["aperture"]) {
        Some(Particular::Aperture(text()))
    } else if starts(&["accessor"]) {
        Some(Particular::Accessories(text()))
    } else if starts(&["date", "time"]) {
        Some(Particular::LocalTime(text()))
    } else if starts(&["exp. time", "exposure", "integration"]) {
        exposure_ms(rest).map(Particular::ExposureMs)
    } else if starts(&["luminance"]) {
        value(rest).map(Particular::Luminance)
    } else {
        None
    }
}

/// `1200 msec`, `1.2 s`; a number without a unit does not say what it is.
fn exposure_ms(text: &str) -> Option<f64> {
    let split = text.find(|c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E'))?;
    let number = value(&text[..split])?;
    let unit = text[split..].trim().to_ascii_lowercase();
    match unit.as_str() {
        "ms" | "msec" | "milliseconds" => Some(number),
        "s" | "sec" | "seconds" => Some(number * 1000.0),
        _ => None,
    }
}

/// True for the name of a wavelength column.
pub(super) fn is_wavelength(name: &str) -> bool {
    let name = name.trim_matches(['"', ' ', '#']).to_lowercase();
    name.starts_with("wavelength")
        || name.starts_with("lambda")
        || name == "nm"
        || name == "wl"
        || name.starts_with('λ')
}

/// True for the name of a luminance column.
pub(super) fn is_luminance(name: &str) -> bool {
    name.trim().to_ascii_lowercase().starts_with("luminance")
}

/// True for the heading of a block of particulars.
pub(super) fn is_heading(text: &str) -> bool {
    text.replace([' ', '"'], "").eq_ignore_ascii_case("metadata,value")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particulars_are_read() {
        assert_eq!(read("Exp. Time: 1200 msec"), Some(Particular::ExposureMs(1200.0)));
        assert_eq!(read("Integration time,1.5 s"), Some(Particular::ExposureMs(1500.0)));
        assert_eq!(read("Luminance(cd/m²): 132.6"), Some(Particular::Luminance(132.6)));
        let time = "Tue Oct 10 2017 10:49:22".to_owned();
        assert_eq!(read("Date / Time: Tue Oct 10 2017 10:49:22"), Some(Particular::LocalTime(time)));
        assert_eq!(read("Exposure: 1200"), None);
        assert_eq!(read("Operator: me"), None);
    }
}
