//! A scene, ready to be drawn.

mod nearest;

pub(super) use nearest::Bodies;

use super::camera::{Camera, Projection};
use super::grid::Grid;
use super::material::{Material, NoMaterial};
use super::shape::{Shape, Start};
use super::source::Source;
use super::vector::Vector;
use crate::donaldson::Observer;

/// Most bodies, materials or lights.
pub(super) const MOST: usize = 1000;

/// A body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// What the scene calls it.
    pub name: String,
    /// Its form.
    pub shape: Shape,
    /// Its material, by number.
    pub material: usize,
}

/// How often light may go from body to body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Bounces {
    /// As often as it does; paths end at random, and those that stay count for those that ended.
    All,
    /// At most so often.
    #[serde(untagged)]
    Most(u32),
}

/// All that is drawn, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Lights.
    pub sources: Vec<Source>,
    /// The camera.
    pub camera: Camera,
    /// Pixels in a row and rows.
    pub size: (usize, usize),
    /// Wavelengths.
    pub grid: Grid,
    /// Observer.
    pub observer: Observer,
    /// Samples of each pixel for what has no closed form.
    pub samples: u32,
    /// Bounces.
    pub bounces: Bounces,
    /// Where random numbers begin.
    pub seed: u64,
}

/// What cannot be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotDrawn {
    /// A material.
    #[error(transparent)]
    Material(#[from] NoMaterial),
    /// Nothing can be seen.
    #[error(
        "the lights of the scene make a white of Y {0}; expected a light above 0 at the wavelengths of the scene, and of these some \
         between 360 and 780 nm"
    )]
    Dark(f64),
    /// Too many.
    #[error("{count} {what}; expected 1 to {MOST}")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
    },
    /// Energy from nowhere.
    #[error(
        "material `{material}` sends back up to {albedo:.4} of {what}: it may be shown, but light may not bounce from it; expected at \
         most 1, or `bounces = 0`"
    )]
    Brighter {
        /// The material.
        material: String,
        /// What it sends back of what falls in.
        albedo: f64,
        /// Of what.
        what: &'static str,
    },
}

/// A place on a body that is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub(super) place: Vector,
    /// On the side that it is looked at from.
    pub(super) normal: Vector,
    pub(super) start: Start,
    pub(super) material: usize,
}

impl Scene {
    /// True where all of a body is looked at from outside.
    pub(super) fn is_seen_from_outside(&self, body: &Body) -> bool {
        let camera = &self.camera;
        match (&body.shape, camera.projection) {
            (Shape::Plane(_), _) => true,
            (shape, Projection::Perspective { .. }) => !shape.holds(camera.place),
            // Rays start anywhere on the film.
            (shape, Projection::Orthographic { .. }) => shape.heights(camera.place, camera.axes[2]).0 > 0.0,
        }
    }

    /// Looks whether it can be drawn.
    ///
    /// # Errors
    /// [`NotDrawn`].
    pub fn check(&self) -> Result<(), NotDrawn> {
        let counts =
            [("bodies", self.bodies.len()), ("materials", self.materials.len()), ("lights", self.sources.len())];
        if let Some((what, count)) = counts.into_iter().find(|(_, count)| !(1..=MOST).contains(count)) {
            return Err(NotDrawn::Count { what, count });
        }
        for material in &self.materials {
            material.check()?;
        }
        let white = self.white().xyz[1];
        if !(white > 0.0 && white.is_finite()) {
            return Err(NotDrawn::Dark(white));
        }
        Ok(())
    }
}
