//! Scenes drawn with the terms.
//!
//! *May use:* `donaldson`, `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* what is left out is bounded, and the bound is said.

pub mod convex;
mod film;
pub mod image;
mod reradiate;
mod spectral;
mod vector;

pub use film::{Film, LONGEST_SIDE, NoFilm};
pub use reradiate::{NoProduct, reradiate};
pub use spectral::{NoColours, Spectral};
