//! How a source writes its angles, and the check of a declared sign convention against the empty diagonal.

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

use super::error::{ImportError, fault, fault_of};
use crate::dataset::Place;
use crate::quantity::{DirectionError, Geometry, SignHabit, UnknownName};

/// How a source writes its angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Angles {
    /// Four angles: theta and phi of incidence and viewing.
    Full,
    /// Two signed in-plane angles.
    Signed(SignHabit),
}

impl fmt::Display for Angles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Signed(habit) => write!(f, "signed, {}", habit.name()),
        }
    }
}

impl FromStr for Angles {
    type Err = UnknownName;

    /// Reads `full`, `signed, mirror-at-equal`, `signed, retro-at-equal`, and sentences that say the same: `signed ...
    /// retro-reflection is theta_v = -theta_i`.
    fn from_str(text: &str) -> Result<Self, UnknownName> {
        let plain: String = text.to_ascii_lowercase().split_whitespace().collect::<Vec<_>>().join(" ");
        let mirror = Self::Signed(SignHabit::MirrorAtEqual);
        let retro = Self::Signed(SignHabit::RetroAtEqual);
        match plain.replace(", ", ",").as_str() {
            "full" => return Ok(Self::Full),
            "signed,mirror-at-equal" => return Ok(mirror),
            "signed,retro-at-equal" => return Ok(retro),
            _ => {}
        }
        let compact = plain.replace(' ', "");
        let says = |what: &str| compact.split_once("retro").is_some_and(|(_, rest)| rest.contains(what));
        if compact.starts_with("signed") && says("theta_v=-theta_i") {
            return Ok(mirror);
        }
        if compact.starts_with("signed") && (says("theta_v=theta_i") || says("theta_v=+theta_i")) {
            return Ok(retro);
        }
        Err(UnknownName {
            what: "angles",
            found: text.to_owned(),
            expected: "full; signed, mirror-at-equal; signed, retro-at-equal".to_owned(),
        })
    }
}

/// The angles of one row as the source writes them, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Written {
    /// theta_i, theta_v with signs.
    Signed(f64, f64),
    /// theta_i, phi_i, theta_v, phi_v.
    Full([f64; 4]),
}

impl Written {
    /// The geometry under the declared habit.
    ///
    /// # Errors
    /// [`ImportError`] where signed angles have no declared habit, and where an angle is out of range.
    pub(crate) fn geometry(self, declared: Option<Angles>, place: &Place) -> Result<Geometry, ImportError> {
        let result = match (self, declared) {
            (Self::Full([ti, pi, tv, pv]), None | Some(Angles::Full)) => measured(ti, pi, tv, pv),
            (Self::Signed(ti, tv), Some(Angles::Signed(habit))) => Geometry::from_signed(ti, tv, habit),
            (Self::Signed(..), _) => return Err(undeclared(place.clone())),
            (Self::Full(_), Some(Angles::Signed(_))) => {
                return Err(ImportError::Contradiction(fault(
                    place.clone(),
                    "four angles under a declaration of signed angles",
                    "theta_i_deg and theta_v_deg, or `# angles: full`",
                    "correct the declaration",
                )));
            }
        };
        result.map_err(|error| ImportError::Malformed(fault_of(place.clone(), &error, "correct the angle")))
    }
}

/// A measured direction lies above the surface.
fn measured(theta_i: f64, phi_i: f64, theta_v: f64, phi_v: f64) -> Result<Geometry, DirectionError> {
    for theta in [theta_i, theta_v] {
        if !(0.0..=90.0).contains(&theta) {
            return Err(DirectionError::Theta(theta));
        }
    }
    Geometry::from_degrees(theta_i, phi_i, theta_v, phi_v)
}

fn undeclared(place: Place) -> ImportError {
    ImportError::Ambiguous(fault(
        place,
        "signed angles without a declared sign convention",
        "`# angles: signed, mirror-at-equal` (retro at theta_v = -theta_i) or `# angles: signed, retro-at-equal`",
        "declare which at the top of the file (to `bbrf import` also by `--angles signed,mirror-at-equal`)",
    ))
}

/// What a table of two angles holds and lacks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Coverage {
    /// Cells with data.
    pub(crate) present: usize,
    /// Cells of the grid.
    pub(crate) cells: usize,
    /// Empty cells on the retro diagonal.
    pub(crate) retro_gap: usize,
    /// Other empty cells, as signed angles.
    pub(crate) gaps: Vec<(f64, f64)>,
}

/// The coverage of the grid that the geometries span, in signed in-plane angles with the mirror at equal; `None` where
/// one leaves the plane, and where the geometries are no grid (fewer than half of the cells are there).
pub(crate) fn coverage(geometries: &[Geometry]) -> Option<Coverage> {
    let pairs: Vec<(f64, f64)> = geometries.iter().map(Geometry::signed_deg).collect::<Option<_>>()?;
    // Adding 0 makes -0 and 0 one key.
    let key = |angle: f64| OrderedAngle(angle + 0.0);
    let present: BTreeSet<(OrderedAngle, OrderedAngle)> = pairs.iter().map(|pair| (key(pair.0), key(pair.1))).collect();
    let incidence: BTreeSet<OrderedAngle> = pairs.iter().map(|pair| key(pair.0)).collect();
    let viewing: BTreeSet<OrderedAngle> = pairs.iter().map(|pair| key(pair.1)).collect();
    let cells = incidence.len().checked_mul(viewing.len())?;
    if 2 * present.len() < cells || cells < 4 {
        return None;
    }
    let mut found = Coverage { present: present.len(), cells, retro_gap: 0, gaps: Vec::new() };
    for i in &incidence {
        for v in viewing.iter().filter(|v| !present.contains(&(*i, **v))) {
            if v.0 == -i.0 { found.retro_gap += 1 } else { found.gaps.push((i.0, v.0)) }
        }
    }
    Some(found)
}

/// Refuses a declared habit that the empty diagonal contradicts: the declared retro diagonal full of data while the
/// declared mirror diagonal is empty.
pub(crate) fn check_habit(geometries: &[Geometry], habit: SignHabit, place: Place) -> Result<(), ImportError> {
    let Some(coverage) = coverage(geometries) else { return Ok(()) };
    let mirror_empty = coverage.gaps.iter().filter(|(i, v)| i == v && *i != 0.0).count();
    let on = |sign: f64| {
        let on_diagonal = |geometry: &&Geometry| geometry.signed_deg().is_some_and(|(i, v)| v == sign * i && i != 0.0);
        geometries.iter().filter(on_diagonal).count()
    };
    let (retro, mirror) = (on(-1.0), on(1.0));
    if mirror > 0 || retro < 2 || mirror_empty < 2 {
        return Ok(());
    }
    let (other, empty) = match habit {
        SignHabit::MirrorAtEqual => (SignHabit::RetroAtEqual, "theta_v = theta_i"),
        SignHabit::RetroAtEqual => (SignHabit::MirrorAtEqual, "theta_v = -theta_i"),
    };
    Err(ImportError::Contradiction(fault(
        place,
        format!(
            "the declaration `{}` while the diagonal {empty} is empty ({mirror_empty} cells) and the declared retro \
             diagonal holds {retro} spectra",
            habit.name()
        ),
        "the empty diagonal where the detector stands before the source",
        format!("declare `signed, {}`, or look for swapped signs", other.name()),
    )))
}

/// A finite angle as a key.
#[derive(Debug, Clone, Copy, PartialEq)]
struct OrderedAngle(f64);

impl Eq for OrderedAngle {}

impl PartialOrd for OrderedAngle {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OrderedAngle {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(habit: SignHabit, leave_out: impl Fn(f64, f64) -> bool) -> Vec<Geometry> {
        let angles: Vec<f64> = (-8..=8).map(|step| f64::from(step) * 10.0).collect();
        let pairs = angles.iter().flat_map(|i| angles.iter().map(move |v| (*i, *v)));
        pairs.filter(|(i, v)| !leave_out(*i, *v)).map(|(i, v)| Geometry::from_signed(i, v, habit).unwrap()).collect()
    }

    #[test]
    fn the_retro_gap_is_known() {
        for (habit, sign) in [(SignHabit::MirrorAtEqual, -1.0), (SignHabit::RetroAtEqual, 1.0)] {
            let found = coverage(&grid(habit, |i, v| v == sign * i || (i, v) == (10.0, 30.0))).unwrap();
            assert_eq!((found.present, found.cells, found.retro_gap, found.gaps.len()), (271, 289, 17, 1));
        }
    }

    #[test]
    fn a_wrong_habit_is_seen_at_the_empty_diagonal() {
        let wrong = grid(SignHabit::RetroAtEqual, |i, v| v == -i);
        let error = check_habit(&wrong, SignHabit::RetroAtEqual, Place::default()).unwrap_err().to_string();
        assert!(error.contains("declare `signed, mirror-at-equal`"), "{error}");
        let right = grid(SignHabit::MirrorAtEqual, |i, v| v == -i);
        assert!(check_habit(&right, SignHabit::MirrorAtEqual, Place::default()).is_ok());
        let full = grid(SignHabit::MirrorAtEqual, |_, _| false);
        assert!(check_habit(&full, SignHabit::MirrorAtEqual, Place::default()).is_ok());
    }

    #[test]
    fn a_sentence_that_declares_is_a_declaration() {
        let text = "signed in-plane polar angles in degrees; retro-reflection is theta_v = -theta_i (not measured)";
        assert_eq!(text.parse(), Ok(Angles::Signed(SignHabit::MirrorAtEqual)));
        assert!("signed".parse::<Angles>().is_err());
    }
}
