//! The matrix that a command is given: `FILE.bbrf#ID`, or `FILE.bbrf` where it holds one.

use miette::miette;

use crate::cli::opened::open;
use crate::dataset::{Document, Measurement};
use crate::quantity::{Part, QuantityKind};

/// The file and the id of `FILE#ID`.
pub(in crate::cli::command) fn split(name: &str) -> (&str, Option<&str>) {
    match name.rsplit_once('#') {
        Some((path, id)) => (path, Some(id)),
        None => (name, None),
    }
}

/// The measurement that holds the matrix.
pub(super) fn load(name: &str) -> Result<Measurement, miette::Report> {
    let (path, id) = split(name);
    let document = open(path.as_ref())?.document;
    pick(&document, path, id).cloned()
}

/// The matrix of that id in a document, or its only one.
pub(in crate::cli::command) fn pick<'a>(
    document: &'a Document,
    path: &str,
    id: Option<&str>,
) -> Result<&'a Measurement, miette::Report> {
    // The luminescent part that a separation leaves beside its matrix is none to choose.
    let is_matrix = |one: &&Measurement| {
        one.quantity.kind == QuantityKind::DonaldsonMatrix && one.quantity.part != Part::Luminescent
    };
    let matrices: Vec<&Measurement> = document.measurements.iter().filter(is_matrix).collect();
    let names = || matrices.iter().map(|one| one.id.to_string()).collect::<Vec<_>>().join(", ");
    match (id, matrices.as_slice()) {
        (Some(id), _) => document
            .measurement(id)
            .ok_or_else(|| miette!("{path}: no measurement `{id}`; matrices of the file: {}", or_none(names()))),
        (None, [one]) => Ok(one),
        (None, []) => Err(miette!(
            help = "`bbrf info` lists what a file holds; `bbrf import` reads matrices of other formats",
            "{path}: found no measurement of quantity `donaldson-matrix`; expected one"
        )),
        (None, _) => Err(miette!("{path}: holds several matrices ({}); name one as {path}#ID", names())),
    }
}

/// A list that may be empty, for a message.
pub(super) fn or_none(names: String) -> String {
    if names.is_empty() { "none".to_owned() } else { names }
}
