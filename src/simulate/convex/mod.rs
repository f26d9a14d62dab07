//! One convex body under one light: a sphere seen from afar, at the limit of the machine.
//!
//! One convex body casts no shadow on itself and sees nothing of its own light, so that a pixel needs its own normal alone; under one
//! spectrum three numbers per term make its colour.
//!
//! *Invariant:* every pixel is that of the terms in double precision, to one unit in the last place of single precision; the image
//! depends neither on the threads nor on the processor.

mod dense;
mod generic;
mod lighting;
mod lobe;
mod render;
mod scene;
mod shade;
mod sphere;
mod stretch;

pub use dense::render_dense;
pub use lighting::Lighting;
pub use render::{Method, Renderer};
pub use scene::{Colours, Component, NoScene, Scene};
pub use sphere::{NoSphere, Sphere};
