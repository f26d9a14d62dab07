//! Scenes drawn with the terms: only what they call for.
//!
//! *May use:* `donaldson`, `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* what is left out is bounded, and the bound is said; a picture depends on its scene, its plan and its seed, and on
//! nothing else.
//!
//! A [`Scene`] is made from a description in TOML; a plan says what of it is simulated, and why the rest need not be; a
//! [`Picture`] is drawn by it. [`convex`] is the way for one body under one light, at the limit of the machine.

mod alone;
mod camera;
mod choice;
mod colours;
pub mod convex;
mod distance;
pub mod document;
mod effect;
#[cfg(test)]
mod energy;
mod film;
mod grid;
pub mod image;
mod interface;
mod losses;
mod material;
mod picture;
mod plan;
mod random;
mod reradiate;
mod scene;
mod shape;
mod source;
mod spectral;
mod trace;
mod transport;
mod vector;
mod white;

pub use camera::{Camera, NoCamera, Projection};
pub use choice::Choice;
pub use colours::NoLayer;
pub use effect::Effect;
pub use film::{Film, LONGEST_SIDE, NoFilm};
pub use grid::{Grid, NoGrid};
pub use material::{Material, NoMaterial};
pub use picture::{Kept, Layer, NoPicture, Picture, Watch};
pub use plan::{Bound, Decision, Plan, bound, plan};
pub use reradiate::{NoProduct, Real, reradiate};
pub use scene::{Body, Bounces, NotDrawn, Scene};
pub use shape::{Ball, Cuboid, Mesh, NoMesh, Plane, Rectangle, Shape};
pub use source::{Place, Source};
pub use spectral::{NoColours, Spectral};
pub use white::WhiteOf;
