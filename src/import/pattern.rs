//! File names that say the geometry: `ti{theta_i}_tv{theta_v}.txt`.
//!
//! Fields: `theta_i`, `phi_i`, `theta_v`, `phi_v` (degrees), `repeat`, `role`, and `n` (a running number that says
//! nothing). An angle may be written `20`, `020`, `+20`, `-20`, `m20` or `n20`, with decimals after `.` or `p`.

use super::angles::Written;
use super::error::{ImportError, fault, quoted};
use super::number::value;
use crate::dataset::{Place, Role};

const FIELDS: &[&str] = &["theta_i", "phi_i", "theta_v", "phi_v", "repeat", "role", "n"];

/// A parsed pattern.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pattern {
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone, PartialEq)]
enum Piece {
    Text(String),
    Field(&'static str),
}

/// What a file name says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Named {
    /// Angles.
    pub(super) angles: Option<Written>,
    /// Number of the repeat.
    pub(super) repeat: Option<u32>,
    /// Role.
    pub(super) role: Option<Role>,
}

impl Pattern {
    /// Reads a pattern.
    ///
    /// # Errors
    /// [`ImportError::Call`] for an unknown field, an open brace, and two fields with nothing between them.
    pub(super) fn new(text: &str) -> Result<Self, ImportError> {
        let wrong = |found: String| {
            let expected = format!("text and the fields {{{}}}", FIELDS.join("}, {"));
            ImportError::Call(fault(Place::file("--pattern"), found, expected, "as in `ti{theta_i}_tv{theta_v}.txt`"))
        };
        let mut pieces = Vec::new();
        let mut rest = text;
        while let Some(open) = rest.find('{') {
            let close =
                rest[open..].find('}').ok_or_else(|| wrong(format!("an open brace in {}", quoted(text))))? + open;
            let name = &rest[open + 1..close];
            let field = FIELDS.iter().find(|field| **field == name);
            let field = field.ok_or_else(|| wrong(format!("the field {}", quoted(name))))?;
            if open > 0 {
                pieces.push(Piece::Text(rest[..open].to_owned()));
            } else if matches!(pieces.last(), Some(Piece::Field(_))) {
                return Err(wrong(format!("two fields side by side in {}", quoted(text))));
            }
            if pieces.contains(&Piece::Field(field)) {
                return Err(wrong(format!("the field {} twice", quoted(name))));
            }
            pieces.push(Piece::Field(field));
            rest = &rest[close + 1..];
        }
        if !rest.is_empty() {
            pieces.push(Piece::Text(rest.to_owned()));
        }
        if !pieces.iter().any(|piece| matches!(piece, Piece::Field(_))) {
            return Err(wrong(format!("no field in {}", quoted(text))));
        }
        Ok(Self { pieces })
    }

    /// What a file name says; `None` where it does not fit the pattern.
    pub(super) fn read(&self, name: &str) -> Option<Named> {
        let mut values: [Option<&str>; FIELDS.len()] = [None; FIELDS.len()];
        let mut rest = name;
        for (index, piece) in self.pieces.iter().enumerate() {
            match piece {
                Piece::Text(text) => rest = rest.strip_prefix(text.as_str())?,
                Piece::Field(field) => {
                    let end = match self.pieces.get(index + 1) {
                        Some(Piece::Text(next)) => rest.find(next.as_str())?,
                        _ => rest.len(),
                    };
                    let position = FIELDS.iter().position(|name| name == field)?;
                    values[position] = Some(&rest[..end]);
                    rest = &rest[end..];
                }
            }
        }
        if rest.is_empty() { named(&values) } else { None }
    }
}

fn named(values: &[Option<&str>; FIELDS.len()]) -> Option<Named> {
    let [theta_i, phi_i, theta_v, phi_v, repeat, role, _] = values;
    let number = |text: &Option<&str>| text.map(|text| angle(text).ok_or(())).transpose().ok();
    let angles = match (number(theta_i)?, number(phi_i)?, number(theta_v)?, number(phi_v)?) {
        (Some(theta_i), None, Some(theta_v), None) => Some(Written::Signed(theta_i, theta_v)),
        (Some(theta_i), Some(phi_i), Some(theta_v), Some(phi_v)) => {
            Some(Written::Full([theta_i, phi_i, theta_v, phi_v]))
        }
        (None, None, None, None) => None,
        _ => return None,
    };
    let repeat = match repeat {
        Some(text) => Some(text.parse().ok()?),
        None => None,
    };
    let role = match role {
        Some(text) => Some(text.parse().ok()?),
        None => None,
    };
    Some(Named { angles, repeat, role })
}

/// An angle as file names write it.
fn angle(text: &str) -> Option<f64> {
    let (sign, digits) = match text.strip_prefix(['-', 'm', 'n', 'M', 'N']) {
        Some(digits) => (-1.0, digits),
        None => (1.0, text.strip_prefix(['+', 'p', 'P']).unwrap_or(text)),
    };
    let digits = digits.replace(['p', 'P'], ".");
    let plain = digits.starts_with(|c: char| c.is_ascii_digit());
    if plain { value(&digits).map(|number| sign * number) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_their_angles() {
        let pattern = Pattern::new("ti{theta_i}_tv{theta_v}.txt").unwrap();
        for (name, expected) in
            [("ti-20_tv+00.txt", (-20.0, 0.0)), ("tim20_tvn35.txt", (-20.0, -35.0)), ("ti020_tv7p5.txt", (20.0, 7.5))]
        {
            let found = pattern.read(name).unwrap();
            assert_eq!(found.angles, Some(Written::Signed(expected.0, expected.1)), "{name}");
        }
        for name in ["ti_tv.txt", "ti20_tv20.csv", "white.txt", "ti--20_tv0.txt", "xti20_tv20.txt"] {
            assert_eq!(pattern.read(name), None, "{name}");
        }
    }

    #[test]
    fn other_fields_are_read() {
        let pattern = Pattern::new("{role}_{theta_i}_{theta_v}_r{repeat}_{n}.txt").unwrap();
        let found = pattern.read("white_10_-10_r2_0017.txt").unwrap();
        assert_eq!((found.role, found.repeat), (Some(Role::White), Some(2)));
    }

    #[test]
    fn a_wrong_pattern_is_refused() {
        for text in ["{theta}", "{theta_i", "a.txt", "{theta_i}{theta_v}", "{n}_{n}"] {
            assert!(Pattern::new(text).is_err(), "{text}");
        }
    }
}
