//! Least squares over `terms`: start-free, with covariance and with words for what the data cannot tell.
//!
//! *May use:* `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* a fit that reports success is at the global minimum over its box as far as a deterministic grid and
//! a few polished starts can tell; what the data do not determine has no number but a sentence.
//!
//! How it works. The model is linear in its amplitudes and non-linear in roughness r and index n alone. So the
//! amplitudes are solved for, non-negatively, inside every evaluation (variable projection), and a two-parameter
//! problem is left, in ln r and ln(n-1). A coarse grid over it ([`GeometrySet`] keeps its tables) gives the starts;
//! Levenberg-Marquardt ([`descent`]) polishes the two best that differ in roughness. Everything that depends on the
//! geometries alone is in the set, sorted by half-vector angle, so that an evaluation needs one D per distinct angle and
//! one F per distinct half angle.
//!
//! On top of that: bounds and outliers are passes of the same fit over working values; errors that hang together and
//! effects of the instrument go on from it with all parameters at once.

mod columns;
mod comparison;
mod curvature;
pub mod descent;
pub mod design;
mod diagnosis;
mod effort;
mod error;
mod fits;
mod geometry_set;
mod identifiability;
mod joint;
mod left_out;
mod leverage;
mod linear;
mod loss;
mod magnitude;
mod measurement;
mod observed;
mod options;
mod outcome;
mod polish;
mod products;
mod profile;
mod repeats;
mod reweighted;
mod row;
mod samples;
mod separability;
mod solve;
mod starts;
mod statistics;

pub use crate::dataset::{Bound, Side};
pub use comparison::{Compared, Comparison, Criterion, Difference, Indistinguishable, Shape, compare_measurement};
pub use curvature::Share;
pub use diagnosis::{Diagnosis, MeasurementDiagnosis, diagnose_measurement};
pub use effort::{Effort, Nodes, UnknownNodes};
pub use error::DataError;
pub use geometry_set::{GeometrySet, SetError};
pub use joint::Nuisance;
pub use left_out::LeftOut;
pub use loss::Loss;
pub use measurement::fit_measurement;
pub use observed::{Observations, Observed};
pub use options::{FitError, FitOptions};
pub use outcome::{BandFit, Fit, Stop};
pub use profile::{Interval, Intervals, ProfileCurve, Profiled};
pub use repeats::{Repeated, Repeats, Verdict};
pub use separability::{NotSeparable, separability};
pub use solve::{Fitter, Terms};
