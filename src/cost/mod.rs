//! What accuracy costs in time: ladders of settings, measured here and now.
//!
//! A [`Candidate`] is a setting that a command can be told to use, with its error against a stated reference and the work that
//! takes the time. [`measured`] has all candidates take turns, and makes a [`Ladder`] of them, of which a [`Wish`] takes a rung. Fits,
//! predictions, complete models, images and files have ladders of their own here.
//!
//! *May use:* `fit`, `donaldson`, `simulate`, `container`, `dataset`, `quantity`.
//!
//! *Invariant:* a rung is nothing that a command cannot be told; its error is measured, not assumed; its time was measured in turns
//! with those of all other rungs.

mod answer;
mod best;
mod eval;
mod fit;
mod image;
mod ladder;
mod measured;
mod model;
#[cfg(feature = "write")]
mod storage;
mod timing;

pub use answer::{Answer, Wish};
pub use best::mark_best;
pub use eval::{EvalLadder, NoEvalLadder, eval_ladder};
pub use fit::{fit_ladder, parameter_distance};
pub use image::image_ladder;
pub use ladder::{Ladder, Meaning, Rung, Task};
pub use measured::{Candidate, measured};
pub use model::{ModelLadder, NoModelLadder, model_ladder};
#[cfg(feature = "write")]
pub use storage::{NoStorageLadder, storage_ladder};
pub use timing::{Patience, Timing, Work, take_turns};
