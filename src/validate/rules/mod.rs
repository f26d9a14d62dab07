//! The checks, by group.

pub(super) mod acquisition;
pub(super) mod albedo;
pub(super) mod bytes;
pub(super) mod calibration;
pub(super) mod digest;
pub(super) mod factorisation;
pub(super) mod flags;
pub(super) mod geometry;
mod hemisphere;
pub(super) mod light;
pub(super) mod model;
pub(super) mod physics;
pub(super) mod portability;
pub(super) mod provenance;
pub(super) mod quantity;
pub(super) mod reference;
pub(super) mod structure;
pub(super) mod uncertainty;
pub(super) mod wavelength;
