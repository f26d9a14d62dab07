//! `bbrf`: bispectral bidirectional measurements of fluorescent surfaces, as a file standard on HDF5, importers, fits,
//! a validator and pictures.
//!
//! The house, each room using only rooms above it:
//!
//! - [`quantity`]: what a number means: directions, wavelengths, typed quantities, uncertainty, flags.
//! - [`terms`]: one physical term each: value and exact derivatives, stable everywhere.
//! - [`dataset`]: the document that labs exchange.
//! - [`container`]: that document as an HDF5 file, read back to the bit.
//! - [`import`]: other people's formats, each with its receipt of assumptions.
//! - [`export`]: the document in other people's formats.
//! - [`validate`]: rules with stable ids, and what they find.
//! - [`fit`]: least squares over the terms, without a starting point.
//! - [`donaldson`]: bispectral matrices separated, factorised, estimated from a few lights, and applied to any.
//! - [`simulate`]: a sphere drawn with the terms, at the limit of the machine.
//! - [`cost`]: what accuracy costs in time, measured here and now.
//! - [`report`]: figures and the HTML page.

pub mod container;
pub mod cost;
pub mod dataset;
pub mod donaldson;
pub mod export;
pub mod fit;
pub mod import;
pub mod quantity;
pub mod report;
pub mod simulate;
pub mod terms;
pub mod validate;

#[cfg(feature = "write")]
pub mod cli;
