//! What lights a scene.

use super::vector::{Vector, dot, minus, scaled};
use crate::donaldson::Light;

/// A light of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// What the scene calls it.
    pub name: String,
    /// Spectral irradiance that it makes: on a plane across the beam, of a point at its distance of reference; from all around on a
    /// plane that nothing stands before (pi times the radiance).
    pub light: Light,
    /// Where it is.
    pub place: Place,
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    /// Parallel rays from this direction, of length 1.
    Directional(Vector),
    /// A point, and the distance that its irradiance is stated for.
    Point(Vector, f64),
    /// All around.
    Surround,
}

/// What arrives from one light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beam {
    /// Unit vector to the source.
    pub(super) towards: Vector,
    /// How far it is.
    pub(super) distance: f64,
    /// Irradiance across the beam over that of the source's spectrum.
    pub(super) strength: f64,
}

impl Source {
    /// `None` for light from everywhere, and at the very place of a point.
    #[inline]
    pub(super) fn beam(&self, at: Vector) -> Option<Beam> {
        match self.place {
            Place::Directional(towards) => Some(Beam { towards, distance: f64::INFINITY, strength: 1.0 }),
            Place::Point(place, reference) => {
                let way = minus(place, at);
                let distance = dot(way, way).sqrt();
                let strength = (reference / distance).powi(2);
                (distance > 0.0).then(|| Beam { towards: scaled(way, 1.0 / distance), distance, strength })
            }
            Place::Surround => None,
        }
    }

    /// True for light from everywhere.
    #[must_use]
    pub fn is_surround(&self) -> bool {
        self.place == Place::Surround
    }
}
