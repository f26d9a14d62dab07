//! The matrix that a command is given: `FILE.bbrf#ID`, or `FILE.bbrf` where it holds one; and its separation, as it is stored or anew.

use miette::miette;

use crate::cli::opened::open;
use crate::cli::output::print_message;
use crate::container::measurement_digest;
use crate::dataset::{Document, Measurement};
use crate::donaldson::{Matrix, Separate, Separated, restored, separate};
use crate::quantity::{Part, QuantityKind};

/// A matrix that is ready for lights.
pub(in crate::cli) struct Material {
    pub(in crate::cli) name: String,
    pub(in crate::cli) measurement: Measurement,
    pub(in crate::cli) matrix: Matrix,
    pub(in crate::cli) separated: Separated,
    pub(in crate::cli) separation: Separation,
}

/// Where a separation comes from.
#[derive(Default)]
pub(in crate::cli) struct Separation {
    /// The factorisation that is used; none where it was made anew.
    pub(in crate::cli) stored: Option<String>,
    /// What the user should know: why a stored one is not used.
    pub(in crate::cli) remark: Option<String>,
}

/// The file and the id of `FILE#ID`.
pub(in crate::cli) fn split(name: &str) -> (&str, Option<&str>) {
    match name.rsplit_once('#') {
        Some((path, id)) => (path, Some(id)),
        None => (name, None),
    }
}

/// The matrix with its separation: the stored one, unless another number of factors is asked for or the matrix has changed since.
pub(in crate::cli) fn load(name: &str, rank: Option<usize>) -> Result<Material, miette::Report> {
    let (path, id) = split(name);
    let document = open(path.as_ref())?.document;
    let measurement = pick(&document, path, id)?.clone();
    let matrix = Matrix::of(&measurement).map_err(|error| miette!("{name}: {error}"))?;
    let (separation, separated) = stored(&document, &measurement, &matrix, rank)?;
    let separated = match separated {
        Some(separated) => separated,
        None => separate(&matrix, Separate { rank }).map_err(|error| miette!("{name}: {error}"))?,
    };
    Ok(Material { name: name.to_owned(), measurement, matrix, separated, separation })
}

/// The same, with what the user should know of its separation on standard error.
pub(in crate::cli) fn load_with_remark(name: &str, rank: Option<usize>) -> Result<Material, miette::Report> {
    let material = load(name, rank)?;
    let remark = material.separation.remark.as_ref();
    remark.iter().for_each(|remark| print_message(&format!("bbrf: warning: {name}: {remark}")));
    Ok(material)
}

/// The stored separation, where one can be used, or why it is not.
fn stored(
    document: &Document,
    measurement: &Measurement,
    matrix: &Matrix,
    rank: Option<usize>,
) -> Result<(Separation, Option<Separated>), miette::Report> {
    let mut parts = document.factorisations.iter().filter(|part| part.measurement == measurement.id).peekable();
    if parts.peek().is_none() {
        return Ok((Separation::default(), None));
    }
    let digest = measurement_digest(measurement).map_err(|error| miette!("{error}"))?;
    let mut remark = None;
    for part in parts {
        let id = &part.id;
        let found = part.rank();
        if part.data_digest != digest {
            remark = Some(format!(
                "the stored separation `{id}` is of `{}` as it was before it changed, and is not used; separated anew",
                measurement.id
            ));
        } else if let Some(rank) = rank.filter(|rank| *rank != found) {
            let factors = if found == 1 { "factor" } else { "factors" };
            remark = Some(format!(
                "the stored separation `{id}` has {found} {factors}; separated anew with {rank}, as --rank asks"
            ));
        } else if let Some(separated) = restored(matrix, part) {
            return Ok((Separation { stored: Some(id.to_string()), remark: None }, Some(separated)));
        } else {
            remark = Some(format!("the stored separation `{id}` does not fit the axes of its matrix; separated anew"));
        }
    }
    Ok((Separation { stored: None, remark }, None))
}

/// The matrices of a document that may be chosen: the luminescent part that a separation leaves beside its matrix is none.
pub(in crate::cli) fn choices(document: &Document) -> Vec<&Measurement> {
    let is_matrix = |one: &&Measurement| {
        one.quantity.kind == QuantityKind::DonaldsonMatrix && one.quantity.part != Part::Luminescent
    };
    document.measurements.iter().filter(is_matrix).collect()
}

/// The matrix of that id in a document, or its only one.
pub(in crate::cli) fn pick<'a>(
    document: &'a Document,
    path: &str,
    id: Option<&str>,
) -> Result<&'a Measurement, miette::Report> {
    let matrices = choices(document);
    let names = || matrices.iter().map(|one| one.id.to_string()).collect::<Vec<_>>().join(", ");
    match (id, matrices.as_slice()) {
        (Some(id), _) => document
            .measurement(id)
            .ok_or_else(|| miette!("{path}: no measurement `{id}`; matrices of the file: {}", or_none(names()))),
        (None, [one]) => Ok(one),
        (None, []) => Err(miette!(
            help = "`bbrf info` lists what a file holds; a matrix whose source does not say what its numbers are is imported with \
                    `bbrf import --quantity donaldson-matrix`",
            "{path}: found no measurement of quantity `donaldson-matrix`; expected one"
        )),
        (None, _) => Err(miette!("{path}: holds several matrices ({}); name one as {path}#ID", names())),
    }
}

/// A list that may be empty, for a message.
pub(in crate::cli) fn or_none(names: String) -> String {
    if names.is_empty() { "none".to_owned() } else { names }
}
