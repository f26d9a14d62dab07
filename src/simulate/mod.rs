//! Scenes drawn with the terms: so far one convex body under one incident spectrum.
//!
//! *May use:* `donaldson`, `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* what is left out is below what the image can show: every pixel is that of the terms in double precision, to one
//! unit in the last place of single precision; the image depends neither on the threads nor on the processor.
//!
//! One convex body casts no shadow on itself and sees nothing of its own light, so that a pixel needs its own normal alone.

mod dense;
mod film;
mod generic;
mod lighting;
mod lobe;
mod render;
mod scene;
mod shade;
mod spectral;
mod sphere;
mod vector;

pub use dense::render_dense;
pub use film::{Film, LONGEST_SIDE, NoFilm};
pub use lighting::Lighting;
pub use render::{Renderer, Way};
pub use scene::{Colours, Component, NoScene, Scene};
pub use spectral::{NoColours, Spectral};
pub use sphere::{NoSphere, Sphere};
