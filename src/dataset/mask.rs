//! Which rows a fit leaves out on request.

use std::fmt;
use std::str::FromStr;

use super::Reduced;
use crate::quantity::Geometry;

/// One condition: a row that meets it takes no part.
#[derive(Debug, Clone, PartialEq)]
enum Condition {
    /// Incidence beyond an angle, degrees.
    IncidenceAbove(f64),
    /// Viewing beyond an angle, degrees.
    ViewingAbove(f64),
    /// The half vector further from the normal than an angle, degrees.
    HalfAngleAbove(f64),
    /// Rows of the measurement, from 0, first and last.
    Rows(usize, usize),
}

/// Conditions of which a row must meet none to take part, as in `theta-i>70,rows:3-5`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mask {
    conditions: Vec<Condition>,
}

/// A text that is no mask.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no mask; expected `theta-i>DEGREES`, `theta-v>DEGREES`, `half-angle>DEGREES`, `rows:N` or `rows:FIRST-LAST` \
     (counted from 0), several separated by commas"
)]
pub struct UnknownMask(String);

impl FromStr for Mask {
    type Err = UnknownMask;

    fn from_str(text: &str) -> Result<Self, UnknownMask> {
        let parts = text.split(',').map(str::trim).filter(|part| !part.is_empty());
        let conditions = parts.map(|part| condition(part).ok_or_else(|| UnknownMask(part.to_owned())));
        Ok(Self { conditions: conditions.collect::<Result<_, _>>()? })
    }
}

fn condition(text: &str) -> Option<Condition> {
    if let Some(rows) = text.strip_prefix("rows:") {
        let (first, last) = rows.split_once('-').unwrap_or((rows, rows));
        let (first, last) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
        return (first <= last).then_some(Condition::Rows(first, last));
    }
    let (name, degrees) = text.split_once('>')?;
    let degrees = degrees.trim().parse::<f64>().ok().filter(|degrees| degrees.is_finite())?;
    match name.trim() {
        "theta-i" => Some(Condition::IncidenceAbove(degrees)),
        "theta-v" => Some(Condition::ViewingAbove(degrees)),
        "half-angle" => Some(Condition::HalfAngleAbove(degrees)),
        _ => None,
    }
}

impl fmt::Display for Mask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, condition) in self.conditions.iter().enumerate() {
            f.write_str(if k > 0 { "," } else { "" })?;
            match condition {
                Condition::IncidenceAbove(degrees) => write!(f, "theta-i>{degrees}"),
                Condition::ViewingAbove(degrees) => write!(f, "theta-v>{degrees}"),
                Condition::HalfAngleAbove(degrees) => write!(f, "half-angle>{degrees}"),
                Condition::Rows(first, last) if first == last => write!(f, "rows:{first}"),
                Condition::Rows(first, last) => write!(f, "rows:{first}-{last}"),
            }?;
        }
        Ok(())
    }
}

impl Mask {
    /// True where nothing is masked.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.conditions.is_empty()
    }

    /// True for a row that takes no part.
    #[must_use]
    pub fn hides(&self, row: usize, geometry: &Geometry) -> bool {
        self.conditions.iter().any(|condition| match *condition {
            Condition::IncidenceAbove(degrees) => geometry.incidence.theta_deg() > degrees,
            Condition::ViewingAbove(degrees) => geometry.viewing.theta_deg() > degrees,
            Condition::HalfAngleAbove(degrees) => geometry.half_angles().phi.to_degrees() > degrees,
            Condition::Rows(first, last) => (first..=last).contains(&row),
        })
    }
}

impl Reduced {
    /// Takes the rows that a mask hides out of the values, and tells how many they were.
    pub fn apply(&mut self, mask: &Mask) -> usize {
        let hidden: Vec<usize> =
            (0..self.rows.len()).filter(|&k| mask.hides(self.rows[k], &self.geometry[k])).collect();
        for &k in &hidden {
            self.values.column_mut(k).fill(f64::NAN);
        }
        self.bounds.retain(|bound| !hidden.contains(&bound.geometry));
        hidden.len()
    }
}
