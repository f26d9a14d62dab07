//! The PR-650's quality codes and what they mean for a record.
//!
//! Two-digit positive codes are those of the PR-650 (its manual, page B-30). Negative codes come from later models and
//! from host programs, and public programs contradict each other about them: they keep their number and reject.

use super::error::{ImportError, fault};
use crate::dataset::Place;
use crate::quantity::Flag;

/// What a quality code asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Action {
    /// The spectrum is a measurement.
    Keep,
    /// It is one, with a flag on every sample.
    KeepWithFlag(Flag),
    /// It is none: the values are missing, with this flag as the reason.
    Reject(Flag),
    /// The instrument is out of order: nothing that it sent is to be trusted.
    HardError,
}

/// A code with its text and action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Quality {
    /// The number.
    pub(crate) code: i32,
    /// What the manual says.
    pub(crate) text: &'static str,
    /// What to do.
    pub(crate) action: Action,
}

const fn entry(code: i32, text: &'static str, action: Action) -> Quality {
    Quality { code, text, action }
}

/// All codes of the PR-650.
pub(crate) const TABLE: &[Quality] = &[
    entry(0, "okay", Action::Keep),
    entry(1, "no end of signal", Action::Reject(Flag::Invalid)),
    entry(3, "no start signal", Action::Reject(Flag::Invalid)),
    entry(4, "no end of signal", Action::Reject(Flag::Invalid)),
    entry(5, "DMA failure", Action::HardError),
    entry(6, "no end of signal when synchronised", Action::Reject(Flag::Invalid)),
    entry(7, "cannot synchronise", Action::Reject(Flag::Invalid)),
    entry(8, "synchronisation lost", Action::Reject(Flag::Invalid)),
    entry(10, "weak light, data zeroed or not updated", Action::Reject(Flag::BelowDetection)),
    entry(12, "hardware failure", Action::HardError),
    entry(13, "software failure", Action::HardError),
    entry(14, "no sample for L*u*v* or L*a*b*", Action::Keep),
    entry(16, "adaptive integration failed, the source varies", Action::Reject(Flag::Invalid)),
    entry(17, "battery low", Action::KeepWithFlag(Flag::BatteryLow)),
    entry(18, "low light level", Action::KeepWithFlag(Flag::LowLight)),
    entry(19, "overload", Action::Reject(Flag::Saturated)),
    entry(20, "no synchronisation", Action::Reject(Flag::Invalid)),
    entry(21, "RAM failure", Action::HardError),
    entry(29, "corrupted data", Action::HardError),
    entry(30, "noisy", Action::KeepWithFlag(Flag::Noisy)),
];

/// The entry of a code.
///
/// # Errors
/// [`ImportError::Refused`] naming an unknown code, or a code that says that the instrument is out of order.
pub(crate) fn look_up(code: i32, place: Place) -> Result<Quality, ImportError> {
    if code < 0 {
        return Ok(entry(code, "a negative code, whose meaning no source agrees on", Action::Reject(Flag::Invalid)));
    }
    let known = TABLE.iter().find(|entry| entry.code == code).copied();
    let Some(quality) = known else {
        return Err(ImportError::Refused(fault(
            place,
            format!("the unknown quality code {code}"),
            "a code of the PR-650's table (0, 1, 3 to 8, 10, 12 to 14, 16 to 21, 29, 30) or a negative one",
            "look the code up in the instrument's manual, and leave the record out or measure again",
        )));
    };
    if quality.action == Action::HardError {
        return Err(ImportError::Refused(fault(
            place,
            format!("quality code {code} ({})", quality.text),
            "a record of an instrument in order",
            "have the instrument checked, and leave this record out or measure again",
        )));
    }
    Ok(quality)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_ascending() {
        assert!(TABLE.windows(2).all(|pair| pair[0].code < pair[1].code));
    }

    #[test]
    fn an_unknown_code_is_named() {
        let message = look_up(42, Place::file("f")).unwrap_err().to_string();
        assert!(message.contains("unknown quality code 42"), "{message}");
        assert_eq!(look_up(-8, Place::file("f")).unwrap().action, Action::Reject(Flag::Invalid));
        assert!(look_up(29, Place::file("f")).is_err());
    }
}
