//! `bbrf`: bispectral bidirectional measurements of fluorescent surfaces, as a file standard on HDF5, importers, fits,
//! a validator and pictures.
//!
//! The house, each room using only rooms above it:
//!
//! - [`quantity`]: what a number means: directions, wavelengths, typed quantities, uncertainty, flags.
//! - [`terms`]: one physical term each: value and exact derivatives, stable everywhere.
//! - [`dataset`]: the document that labs exchange.
//! - [`import`]: other people's formats, each with its receipt of assumptions.

pub mod dataset;
pub mod import;
pub mod quantity;
pub mod terms;

#[cfg(feature = "write")]
pub mod cli;
