//! Directions around an axis.

use std::f64::consts::PI;

use super::super::vector::{Vector, length, minus, scaled};

/// What rounding may add to an angle.
const ROUNDING: f64 = 1e-9;

/// Directions within an angle of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cone {
    /// Of length 1.
    pub(super) axis: Vector,
    /// Radians, 0 to pi.
    pub(super) half: f64,
}

impl Cone {
    /// All directions.
    pub(super) const ALL: Self = Self { axis: [0.0, 0.0, 1.0], half: PI };

    /// One direction.
    pub(super) fn of(axis: Vector) -> Self {
        Self { axis, half: 0.0 }
    }

    /// From anywhere to anywhere, where the difference of the two places is known to be within `spread` of that of these.
    pub(super) fn between(from: Vector, to: Vector, spread: f64) -> Self {
        let way = minus(to, from);
        let far = length(way);
        if far > spread { Self { axis: scaled(way, 1.0 / far), half: (spread / far).asin() } } else { Self::ALL }
    }

    pub(super) fn reversed(self) -> Self {
        Self { axis: scaled(self.axis, -1.0), ..self }
    }

    /// The largest cosine between a direction of one and one of the other, and 0 where all are beyond a right angle.
    pub(super) fn most_cosine(&self, other: &Self) -> f64 {
        self.most_cosine_of_any(other).max(0.0)
    }

    /// The same, below 0 there.
    pub(super) fn most_cosine_of_any(&self, other: &Self) -> f64 {
        let least = angle(self.axis, other.axis) - self.half - other.half - ROUNDING;
        least.max(0.0).cos()
    }

    /// The least cosine between a direction of one and one of the other, and 0 where one is beyond a right angle.
    pub(super) fn least_cosine(&self, other: &Self) -> f64 {
        let most = angle(self.axis, other.axis) + self.half + other.half + ROUNDING;
        most.min(PI).cos().max(0.0)
    }
}

/// The angle between two directions, with its digits where they are nearly one.
pub(super) fn angle(a: Vector, b: Vector) -> f64 {
    2.0 * (0.5 * length(minus(a, b))).min(1.0).asin()
}
