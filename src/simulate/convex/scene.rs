//! One convex body under one spectrum: what is drawn.

use super::lighting::Lighting;
use super::sphere::Sphere;
use crate::quantity::named;
use crate::simulate::vector::length;
use crate::terms::{InvalidParameter, Term, TorranceSparrow};

named! {
    /// Which part of the image.
    Component, "component" {
        /// The sum of all.
        Total = "total",
        /// Luminescence alone.
        Luminescent = "luminescent",
        /// Diffuse reflection alone.
        Diffuse = "diffuse",
        /// The specular term alone.
        Specular = "specular",
    }
}

/// Three numbers of a colour for each term, under the irradiance of the scene across the beam.
///
/// Under one incident spectrum the spectrum of each term is a constant one times a factor of the geometry, so that three numbers
/// per term make the colour of every pixel exactly. They may be negative, as those outside a gamut are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colours {
    /// Of pi times the luminescent radiance, lit along the normal.
    pub luminescent: [f64; 3],
    /// Of pi times the diffusely reflected radiance, lit along the normal.
    pub diffuse: [f64; 3],
    /// Of the irradiance: interfaces reflect it without a change of colour. The term's own intensity multiplies it.
    pub specular: [f64; 3],
}

/// A sphere under a light without extent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    pub(super) sphere: Sphere,
    pub(super) lighting: Lighting,
    pub(super) colours: Colours,
    pub(super) specular: TorranceSparrow,
}

/// What no scene has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoScene {
    /// A direction of length 0, or a number that is none.
    #[error("light from direction ({}, {}, {}); expected finite numbers, not all 0, below 1e100", .0[0], .0[1], .0[2])]
    Direction([f64; 3]),
    /// A point light within the sphere.
    #[error(
        "point light at ({}, {}, {}), in radii of the sphere from its centre; expected a place outside the sphere, and nearer than 1e6",
        .0[0], .0[1], .0[2]
    )]
    Place([f64; 3]),
    /// A colour that a film cannot hold.
    #[error(
        "{component} colour {found}; expected a number between -1e30 and 1e30, which a film of single precision can hold"
    )]
    Colour {
        /// The term.
        component: Component,
        /// The number.
        found: f64,
    },
    /// A parameter of the specular term.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
}

impl Scene {
    /// A scene from its parts.
    ///
    /// # Errors
    /// [`NoScene`], the first that is found.
    pub fn new(
        sphere: Sphere,
        lighting: Lighting,
        colours: Colours,
        specular: TorranceSparrow,
    ) -> Result<Self, NoScene> {
        match lighting {
            Lighting::Directional(direction) if !(1e-100..=1e100).contains(&length(direction)) => {
                return Err(NoScene::Direction(direction));
            }
            Lighting::Point(place) if !(1.0 + 1e-9..=1e6).contains(&length(place)) => {
                return Err(NoScene::Place(place));
            }
            Lighting::Directional(_) | Lighting::Point(_) => {}
        }
        Term::TorranceSparrow(specular).check()?;
        let scaled = colours.specular.map(|value| specular.intensity * value);
        for (component, numbers) in [
            (Component::Luminescent, colours.luminescent),
            (Component::Diffuse, colours.diffuse),
            (Component::Specular, scaled),
        ] {
            if let Some(found) = numbers.into_iter().find(|value| !(-1e30..=1e30).contains(value)) {
                return Err(NoScene::Colour { component, found });
            }
        }
        Ok(Self { sphere, lighting, colours, specular })
    }

    /// The colours that one part of the image is made of: the others are 0.
    pub(super) fn of(&self, component: Component) -> Colours {
        let kept = |own: Component, colour: [f64; 3]| {
            if component == Component::Total || component == own { colour } else { [0.0; 3] }
        };
        Colours {
            luminescent: kept(Component::Luminescent, self.colours.luminescent),
            diffuse: kept(Component::Diffuse, self.colours.diffuse),
            specular: kept(Component::Specular, self.colours.specular),
        }
    }
}

impl Colours {
    /// What follows cos(theta_i): luminescence and diffuse reflection together.
    pub(super) fn base(&self) -> [f64; 3] {
        [0, 1, 2].map(|c| self.luminescent[c] + self.diffuse[c])
    }
}
