//! Films as files: PNG for the eye, EXR for programs.
//!
//! Both are made in memory or on any writer; whoever writes a file does it whole or not at all, as with every other output. The same
//! input gives the same bytes: no date is in them, and they do not depend on the threads.

mod exr;
mod gamut;
mod png;
mod srgb;

pub use exr::{Channel, Layer, NoExr, Primaries, Radiance, spectral_channel, write_exr};
pub use gamut::{Gamut, OutOfGamut};
pub use png::{Depth, NoPng, Png};
pub(in crate::simulate) use srgb::cones;
pub use srgb::{NoDisplay, Srgb};

/// What stands beside the pixels: names and texts, as the plan, the seed and the conventions.
pub type Notes = [(String, String)];
