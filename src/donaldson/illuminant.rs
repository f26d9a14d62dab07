//! The lights that the CIE defines.
//!
//! A, C, E and daylight from 300 nm, by their formulas and tables; fluorescent lamps and LEDs as a maintained crate has them, from
//! 380 nm, where the CIE's own tables begin.

use colorimetry::illuminant::CieIlluminant as Cie;

use super::daylight::{C, C_STEP_NM, DAYLIGHT_STEP_NM, START_NM, daylight};
use super::light::Light;
use crate::quantity::QuantityKind;

/// Last wavelength of A and E, nm.
const END_NM: f64 = 830.0;
/// Where the tables of the crate begin, nm; they have a value for each nanometre.
const LAMPS_START_NM: f64 = 380.0;

/// Lamps by name, in the order of CIE 15.
const LAMPS: &[(&str, Cie)] = &[
    ("FL1", Cie::F1),
    ("FL2", Cie::F2),
    ("FL3", Cie::F3),
    ("FL4", Cie::F4),
    ("FL5", Cie::F5),
    ("FL6", Cie::F6),
    ("FL7", Cie::F7),
    ("FL8", Cie::F8),
    ("FL9", Cie::F9),
    ("FL10", Cie::F10),
    ("FL11", Cie::F11),
    ("FL12", Cie::F12),
    ("FL3.1", Cie::F3_1),
    ("FL3.2", Cie::F3_2),
    ("FL3.3", Cie::F3_3),
    ("FL3.4", Cie::F3_4),
    ("FL3.5", Cie::F3_5),
    ("FL3.6", Cie::F3_6),
    ("FL3.7", Cie::F3_7),
    ("FL3.8", Cie::F3_8),
    ("FL3.9", Cie::F3_9),
    ("FL3.10", Cie::F3_10),
    ("FL3.11", Cie::F3_11),
    ("FL3.12", Cie::F3_12),
    ("FL3.13", Cie::F3_13),
    ("FL3.14", Cie::F3_14),
    ("FL3.15", Cie::F3_15),
    ("LED-B1", Cie::LED_B1),
    ("LED-B2", Cie::LED_B2),
    ("LED-B3", Cie::LED_B3),
    ("LED-B4", Cie::LED_B4),
    ("LED-B5", Cie::LED_B5),
    ("LED-BH1", Cie::LED_BH1),
    ("LED-RGB1", Cie::LED_RGB1),
    ("LED-V1", Cie::LED_V1),
    ("LED-V2", Cie::LED_V2),
];

impl Light {
    /// A light of the CIE by name: A, C, E, D50 and any other daylight from D40 to D250, FL1 to FL12, FL3.1 to FL3.15, LED-B1 and
    /// its like; upper or lower case. `None` for another name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let name = name.trim().to_ascii_uppercase().replace('_', "-");
        let (start, step, values) = match name.as_str() {
            "A" => (START_NM, 1.0, whole(incandescent)),
            "E" => (START_NM, 1.0, whole(|_| 100.0)),
            "C" => (START_NM, C_STEP_NM, C.to_vec()),
            _ => match name.strip_prefix('D').and_then(|digits| digits.parse().ok()) {
                Some(hundreds) => (START_NM, DAYLIGHT_STEP_NM, daylight(hundreds)?),
                None => (LAMPS_START_NM, 1.0, lamp(&name)?),
            },
        };
        let nm = (0..values.len()).map(|k| start + step * k as f64).collect();
        Self::new(name, QuantityKind::RelativeSpectrum, nm, values, None).ok()
    }

    /// The names that [`Light::named`] takes; of daylight those of the CIE.
    #[must_use]
    pub fn names() -> Vec<&'static str> {
        let formulas = ["A", "C", "E", "D50", "D55", "D65", "D75"];
        formulas.into_iter().chain(LAMPS.iter().map(|(name, _)| *name)).collect()
    }
}

/// Values at every nanometre from 300 to 830.
fn whole(value: impl Fn(f64) -> f64) -> Vec<f64> {
    let count = (END_NM - START_NM) as usize;
    (0..=count).map(|k| value(START_NM + k as f64)).collect()
}

/// CIE standard illuminant A (CIE 15:2018, equation 4.1), 100 at 560 nm.
fn incandescent(nm: f64) -> f64 {
    let exponential = |nm: f64| (1.435e7 / (2848.0 * nm)).exp_m1();
    100.0 * (560.0 / nm).powi(5) * exponential(560.0) / exponential(nm)
}

fn lamp(name: &str) -> Option<Vec<f64>> {
    let (_, lamp) = LAMPS.iter().find(|(known, _)| *known == name)?;
    Some(lamp.illuminant().as_ref().as_array().to_vec())
}
