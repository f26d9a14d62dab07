//! From a pixel to a ray.

use super::vector::{Vector, along, cross, minus, unit};

/// Where the scene is seen from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    pub(super) place: Vector,
    /// Right, up, and the direction of looking.
    pub(super) axes: [Vector; 3],
    pub(super) projection: Projection,
}

/// How it is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Along parallel lines; so wide a piece of the scene fills the width of the film.
    Orthographic {
        /// In units of the scene.
        width: f64,
    },
    /// From a point, with this angle between the left and the right edge of the film.
    Perspective {
        /// Degrees.
        width_deg: f64,
    },
}

/// What no camera sees.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoCamera {
    /// No direction.
    #[error("the camera looks from where it stands: `at` and `from` are one place; expected two")]
    Direction,
    /// No upper edge.
    #[error("`up` points where the camera looks; expected another direction")]
    Up,
    /// A width of nothing.
    #[error("the camera sees a width of {0}; expected a number above 0, and below 179 for degrees")]
    Width(f64),
}

impl Camera {
    /// Where it stands.
    #[must_use]
    pub fn place(&self) -> [f64; 3] {
        self.place
    }

    /// A camera at a place, looking at another.
    ///
    /// # Errors
    /// [`NoCamera`].
    pub fn new(from: Vector, at: Vector, up: Vector, projection: Projection) -> Result<Self, NoCamera> {
        let forward = unit(minus(at, from)).ok_or(NoCamera::Direction)?;
        let right = unit(cross(forward, up)).ok_or(NoCamera::Up)?;
        let (width, most) = match projection {
            Projection::Orthographic { width } => (width, 1e12),
            Projection::Perspective { width_deg } => (width_deg, 179.0),
        };
        if !(width > 0.0 && width < most) {
            return Err(NoCamera::Width(width));
        }
        Ok(Self { place: from, axes: [right, cross(right, forward), forward], projection })
    }

    /// Place and direction of the ray through a point of the film, given from -1 to 1 across its width; y in the same unit, up.
    #[inline]
    pub(super) fn ray(&self, x: f64, y: f64) -> (Vector, Vector) {
        let [right, up, forward] = self.axes;
        match self.projection {
            Projection::Orthographic { width } => {
                let half = width / 2.0;
                (along(along(self.place, right, x * half), up, y * half), forward)
            }
            Projection::Perspective { width_deg } => {
                let reach = (width_deg / 2.0).to_radians().tan();
                let way = along(along(forward, right, x * reach), up, y * reach);
                (self.place, unit(way).unwrap_or(forward))
            }
        }
    }
}
