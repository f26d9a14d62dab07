//! The document that labs exchange: samples, instruments, lights, references, measurements as rows of acquisitions,
//! models, provenance; and what follows from it alone: the reduction of a spectrum to the fitted number, the
//! prediction of a model with its uncertainty, its residuals.
//!
//! *May use:* `terms`, `quantity`. No HDF5, no files.
//!
//! *Invariant:* prediction, residual and reduction are defined here, once; whoever fits, validates or draws uses them.

mod adopt;
mod anonymise;
mod attachment;
mod bound;
mod calibration;
mod conditions;
mod convert;
mod direction_test;
mod document;
mod effects;
mod extension;
mod factorisation;
mod id;
mod instrument;
mod light;
mod mask;
mod measurement;
mod model;
mod place;
mod prediction_uncertainty;
mod provenance;
mod reduce;
mod residual;
mod sample;
mod single;
#[doc(hidden)]
pub mod tree;
mod twin;

pub use adopt::{Adopted, is_same_part};
pub use anonymise::{Anonymised, Suspect};
pub use attachment::{Attached, Attachment, NotComplete, ReflectanceSource};
pub use bound::{Bound, Side};
pub use calibration::Calibration;
pub use conditions::Conditions;
pub use convert::{Converted, NotConverted, Target, convert};
pub use direction_test::DirectionTest;
pub use document::{Document, DocumentError};
pub use effects::{Effect, Effects};
pub use extension::Extension;
pub use factorisation::Factorisation;
pub use id::{Id, IdError};
pub use instrument::Instrument;
pub use light::{Light, LightSpectrum};
pub use mask::{Mask, UnknownMask};
pub use measurement::{Acquisition, Derivation, Excitation, Measurement, Role, ShapeError};
pub use model::{FittedParameter, FittedTerm, Model, Residuals, Separability};
pub use place::Place;
pub use prediction_uncertainty::{Look, ParameterCovariance, PredictionError, PredictionUncertainty};
pub use provenance::{Assumption, InputFile, Notice, Provenance, Receipt, Step};
pub use reduce::{ReduceError, Reduced, Reduction, UnknownReduction, reduce};
pub use residual::{Prediction, TermsError, predict, residuals};
pub use sample::{Sample, Symmetry, WhiteReference};
pub use single::NotSingle;
pub use twin::{NoTwin, with_distribution};
