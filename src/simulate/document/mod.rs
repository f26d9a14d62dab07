//! A scene as its TOML describes it, and the way from there to a [`Scene`].
//!
//! x points to the right, y up and z to whoever looks along -z; lengths are in one unit of the author's choice, which only a point
//! light's distance of reference depends on. Files that a scene names come through a [`Library`], for this room opens none.

mod description;
mod lights;
mod materials;
mod objects;
mod place;
mod resolve;
mod words;

pub use description::{CameraSection, FilmSection, SceneDocument, View, Wavelengths};
pub use lights::LightSection;
pub use materials::MaterialSection;
pub use objects::{BoxSection, MeshSection, ObjectSection, PlaneSection, SphereSection};
pub use place::NotAScene;
pub use resolve::{Corners, Library, Points, Resolved, Source};

use self::place::Places;

impl SceneDocument {
    /// Reads a description and makes the scene of it; `file` is what errors call it.
    ///
    /// # Errors
    /// [`NotAScene`] with line, column and key.
    pub fn resolve(file: &str, text: &str, library: &mut dyn Library) -> Result<Resolved, NotAScene> {
        let places = Places::of(file, text)?;
        let document = places.read()?;
        resolve::resolve(document, &places, library)
    }
}

#[cfg(doc)]
use super::Scene;
