//! A matrix of a document as what makes a model of it complete, in one step.

use super::super::consistency::Consistency;
use super::super::{IdTaken, Matrix, NoMatrix, NotSeparated, Separate, parts, separate};
use super::{Complete, NoComplete};
use crate::dataset::{Attachment, Document, Measurement, Model, ReflectanceSource, Step};

/// Why a matrix is not attached.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotAttached {
    /// There is no such matrix.
    #[error("no measurement `{0}` in the document of the model")]
    Missing(String),
    /// The measurement is no matrix.
    #[error(transparent)]
    Matrix(#[from] NoMatrix),
    /// It cannot be separated.
    #[error("matrix `{matrix}`: {why}")]
    Separation {
        /// The matrix.
        matrix: String,
        /// Why.
        why: NotSeparated,
    },
    /// Its parts are there, and are others.
    #[error("{0}, which is not what a separation of the matrix gives; take it out, or give the matrix another id")]
    Parts(#[from] IdTaken),
    /// Something has no digest.
    #[error("{0}")]
    Digest(String),
    /// The parts make no complete model.
    #[error(transparent)]
    Complete(#[from] NoComplete),
}

/// Attaches a matrix of the document to a model of one of its measurements: separates the matrix, stores the parts beside it (unless
/// they are there), has the model refer to them, and checks scan against matrix. `digest` gives the digest of a measurement.
///
/// The diffuse reflectance is the model's own where it was fitted to an elastic scan at every wavelength of the matrix; otherwise
/// the matrix's.
///
/// # Errors
/// [`NotAttached`]; the document may then hold parts of the matrix, and the model is as it was.
pub fn attach(
    document: &mut Document,
    model: &mut Model,
    matrix: &str,
    digest: impl Fn(&Measurement) -> Result<String, String>,
) -> Result<Consistency, NotAttached> {
    let measurement = document.measurement(matrix).ok_or_else(|| NotAttached::Missing(matrix.to_owned()))?.clone();
    let table = Matrix::of(&measurement)?;
    let separated = separate(&table, Separate::default())
        .map_err(|why| NotAttached::Separation { matrix: matrix.to_owned(), why })?;
    let digest = |part: &Measurement| digest(part).map_err(NotAttached::Digest);
    let parts = parts(&measurement, &table, &separated, &digest(&measurement)?)
        .ok_or_else(|| NotAttached::Matrix(NoMatrix::Emission(matrix.to_owned())))?;
    let attachment = Attachment {
        factorisation: parts.factorisation.id.clone(),
        elastic: parts.elastic.id.clone(),
        elastic_digest: digest(&parts.elastic)?,
        luminescent: parts.luminescent.id.clone(),
        luminescent_digest: digest(&parts.luminescent)?,
        reflectance: reflectance(document, model, &table.emission_nm),
        consistency: Vec::new(),
    };
    if !parts.are_in(document) {
        parts.store(document)?;
    }
    let mut completed = Model { donaldson: Some(attachment.clone()), ..model.clone() };
    let complete = Complete::of(document, &completed)?;
    let consistency = Consistency::of(document, &completed, &complete);
    let sentences = complete.findings().iter().chain(&consistency.findings).cloned().collect();
    completed.donaldson = Some(Attachment { consistency: sentences, ..attachment });
    *model = completed;
    document.provenance.steps.push(Step::by_this_program(format!(
        "model `{}` completed with the matrix `{matrix}` (reflectance from the {})",
        model.id,
        complete.reflectance()
    )));
    Ok(consistency)
}

/// The terms' own where they say it at every wavelength at which the matrix emits.
fn reflectance(document: &Document, model: &Model, emission_nm: &[f64]) -> ReflectanceSource {
    let scan = document.measurement(model.measurement.as_str());
    let is_spectral = scan.is_some_and(|scan| model.has_spectral_albedo(scan));
    let covers = |nm: &[f64]| match (nm, emission_nm) {
        ([low, .., high], [first, .., last]) => low <= first && high >= last,
        _ => false,
    };
    match model.emission.wavelengths() {
        Some(nm) if is_spectral && covers(nm) => ReflectanceSource::Terms,
        _ => ReflectanceSource::Matrix,
    }
}
