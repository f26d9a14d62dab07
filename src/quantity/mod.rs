//! What a number means: directions, wavelength axes with their bandpass, typed quantities and their conversions,
//! uncertainty, and the reasons why a value is missing.
//!
//! *May use:* no other room.
//!
//! *Invariant:* nothing here has a default. What a source does not say is `unstated`, and a conversion that needs it
//! refuses.

mod angle;
mod convert;
mod direction;
mod finite;
mod flag;
mod kind;
mod photometry;
mod rounded;
mod uncertainty;
mod unit;
mod wavelength;

pub use angle::{cos_deg, sin_deg};
pub use convert::{
    Cell, Conversion, ConversionRefused, EmissionWidth, Quotient, brdf_from_radiance_factor, brrdf_from_density,
    density_from_brrdf, density_from_donaldson, donaldson_from_density, radiance_factor_from_brdf, ratio_to_reference,
    to_basis, to_fixed_geometry, to_same_geometry,
};
pub use direction::{Direction, DirectionError, Geometry, HalfAngles, SignHabit};
pub use finite::{Finite, NotFinite};
pub use flag::{Flag, Flags};
pub(crate) use kind::named;
pub use kind::{Basis, NormalisedAt, Part, Quantity, QuantityKind, Reference, ReferenceLight, UnknownName};
pub use photometry::luminous_efficacy;
pub use rounded::rounded_with_uncertainty;
pub use uncertainty::{Component, CorrelatedOver, ErrorDistribution, EvaluationType, Statement, Uncertainty};
pub(crate) use uncertainty::{rows_plain, tables_plain};
pub use unit::SiUnit;
pub use wavelength::{
    Band, Bandpass, BandpassCorrection, BandpassShape, EmissionAxis, WavelengthAxis, WavelengthError,
};
