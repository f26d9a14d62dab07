//! Numbers with a unit in `metadata`, as in `{"value": 20, "unit": "°C"}`.

use super::json::Json;
use crate::quantity::Finite;

/// A unit with what turns a number of it into ours: times the first, plus the second.
pub(super) type Units = &'static [(&'static str, f64, f64)];

pub(super) const MILLIMETRES: Units = &[
    ("pm", 1e-9, 0.0),
    ("nm", 1e-6, 0.0),
    ("\u{3bc}m", 1e-3, 0.0),
    ("\u{b5}m", 1e-3, 0.0),
    ("mm", 1.0, 0.0),
    ("cm", 10.0, 0.0),
    ("dm", 100.0, 0.0),
    ("m", 1e3, 0.0),
    ("km", 1e6, 0.0),
];
pub(super) const NANOMETRES: Units = &[("nm", 1.0, 0.0), ("\u{3bc}m", 1e3, 0.0), ("\u{b5}m", 1e3, 0.0)];
pub(super) const CELSIUS: Units = &[("°C", 1.0, 0.0), ("K", 1.0, -273.15)];
pub(super) const PER_CENT: Units = &[("%", 1.0, 0.0)];
pub(super) const STERADIANS: Units = &[("sr", 1.0, 0.0)];

/// Takes a number out where its unit is one of these; its uncertainty, for which we have no place, stays.
pub(super) fn take_quantity(tree: &mut Json, path: &[&str], units: Units) -> Option<Finite> {
    tree.at(path)?;
    let (Some(Json::Number(number)), Some(Json::Text(unit))) =
        (member(tree, path, "value"), member(tree, path, "unit"))
    else {
        return None;
    };
    let (_, factor, offset) = units.iter().find(|(name, ..)| name == unit)?;
    let number = Finite::try_from(number * factor + offset).ok()?;
    for key in ["value", "unit"] {
        let whole: Vec<&str> = path.iter().copied().chain([key]).collect();
        tree.take(&whole, |_| Some(()));
    }
    Some(number)
}

fn member<'a>(tree: &'a Json, path: &[&str], key: &str) -> Option<&'a Json> {
    tree.at(path)?.at(&[key])
}
