//! Which geometries to measure, before anyone measures: the uncertainty that a list of them will give for a material that
//! is guessed, what it leaves undetermined, and the geometries that help most.
//!
//! The predicted uncertainty is the Cramer-Rao bound from the exact derivatives of `terms`. A fit reaches it where the
//! noise is small enough for the model to be linear within it; `tests/design.rs` compares the two.

mod candidates;
mod choice;
mod guess;
mod prediction;
mod sensitivity;
mod unresolved;

pub use candidates::{CandidateGrid, UnknownGrid, in_plane_grid};
pub use choice::{Added, Goal, UnknownGoal, choose};
pub use guess::{Guess, GuessError, GuessedParameter, Noise};
pub use prediction::{Predicted, predict};
pub use sensitivity::Sensitivities;
