//! The bispectral matrix that makes a fitted model complete: terms say how light depends on the directions, the matrix how
//! it depends on both wavelengths.

use serde::{Deserialize, Serialize};

use super::{Document, Factorisation, Id, Measurement, Model};
use crate::quantity::{EmissionAxis, Part, QuantityKind, named};
use crate::terms::TermKind;

named! {
    /// Where the diffuse reflectance of a complete model comes from.
    ReflectanceSource, "source of the reflectance" {
        /// From the elastic part of the matrix.
        Matrix = "matrix",
        /// From the Lambertian term, which was fitted at every wavelength of an elastic scan.
        Terms = "terms",
    }
}

/// The separated matrix that a model is completed with: Y = Y_l + Y_d + Y_s, of which the terms say Y_s and the angular shape,
/// the luminescent part Y_l and, unless the terms do, the elastic part Y_d.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Attachment {
    /// The factors of the matrix, by id; they name the matrix.
    pub factorisation: Id,
    /// The elastic part of the matrix, by id of its measurement.
    pub elastic: Id,
    /// Digest of that measurement as it was then.
    pub elastic_digest: String,
    /// The luminescent part of the matrix, by id of its measurement.
    pub luminescent: Id,
    /// Digest of that measurement as it was then.
    pub luminescent_digest: String,
    /// Where the diffuse reflectance comes from.
    pub reflectance: ReflectanceSource,
    /// How scan and matrix go together, one sentence each.
    #[serde(default)]
    pub consistency: Vec<String>,
}

/// A complete model's parts.
#[derive(Debug, Clone, Copy)]
pub struct Attached<'a> {
    /// What the model refers to.
    pub attachment: &'a Attachment,
    /// The factors.
    pub factorisation: &'a Factorisation,
    /// The matrix as it was measured.
    pub matrix: &'a Measurement,
    /// Its elastic part, one row.
    pub elastic: &'a Measurement,
    /// Its luminescent part, rows as in the matrix.
    pub luminescent: &'a Measurement,
}

/// Why a model is not complete.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotComplete {
    /// Nothing is attached.
    #[error("model `{0}` has no matrix attached; expected one fitted by `bbrf fit --donaldson`")]
    Nothing(String),
    /// A part is not there.
    #[error("model `{model}`: its {what} `{id}` is not in the document")]
    Missing {
        /// The model.
        model: String,
        /// What is missing.
        what: &'static str,
        /// The id that is not there.
        id: String,
    },
    /// A part is another thing, or of another matrix.
    #[error("model `{model}`, {attribute}: found {found}; expected {expected}")]
    Unfit {
        /// The model.
        model: String,
        /// Which reference of the model.
        attribute: &'static str,
        /// What is there.
        found: String,
        /// What should be there.
        expected: String,
    },
}

impl Document {
    /// The parts that complete a model of the document: each there, of the right kind, and on the axes of one matrix.
    ///
    /// # Errors
    /// [`NotComplete`].
    pub fn attached<'a>(&'a self, model: &'a Model) -> Result<Attached<'a>, NotComplete> {
        let name = || model.id.to_string();
        let attachment = model.donaldson.as_ref().ok_or_else(|| NotComplete::Nothing(name()))?;
        let missing = |what, id: &Id| NotComplete::Missing { model: name(), what, id: id.to_string() };
        let measurement = |what, id: &Id| self.measurement(id.as_str()).ok_or_else(|| missing(what, id));
        let factorisation = self
            .factorisation(attachment.factorisation.as_str())
            .ok_or_else(|| missing("factorisation", &attachment.factorisation))?;
        let attached = Attached {
            attachment,
            factorisation,
            matrix: measurement("matrix", &factorisation.measurement)?,
            elastic: measurement("elastic part", &attachment.elastic)?,
            luminescent: measurement("luminescent part", &attachment.luminescent)?,
        };
        let scan = self.measurement(model.measurement.as_str());
        match attached.misfit().or_else(|| misplaced_reflectance(model, scan, attachment.reflectance)) {
            None => Ok(attached),
            Some((attribute, found, expected)) => Err(NotComplete::Unfit { model: name(), attribute, found, expected }),
        }
    }
}

/// An attribute with what was found and what was expected there.
type Misfit = (&'static str, String, String);

impl Attached<'_> {
    fn misfit(&self) -> Option<Misfit> {
        let kinds = [
            ("elastic", self.elastic, QuantityKind::RadianceFactor, Part::Elastic),
            ("luminescent", self.luminescent, QuantityKind::DonaldsonMatrix, Part::Luminescent),
        ];
        for (attribute, part, kind, of) in kinds {
            let quantity = &part.quantity;
            if (quantity.kind, quantity.part) != (kind, of) {
                let found = format!("`{}`, a {} of the part {}", part.id, quantity.kind, quantity.part);
                return Some((attribute, found, format!("a {kind} of the part {of}")));
            }
            let EmissionAxis::Wavelengths(axis) = &part.emission else {
                return Some((attribute, format!("`{}`, a band", part.id), "emission wavelengths".to_owned()));
            };
            if axis.nm != self.factorisation.emission.nm || part.check_shape().is_err() {
                let found = format!("the emission axis of `{}`", part.id);
                return Some((attribute, found, format!("that of the factorisation `{}`", self.factorisation.id)));
            }
        }
        if self.elastic.acquisitions.len() != 1 {
            let found = format!("`{}`, {} rows", self.elastic.id, self.elastic.acquisitions.len());
            return Some(("elastic", found, "one row".to_owned()));
        }
        let excitations = |part: &Measurement| -> Vec<Option<f64>> {
            part.acquisitions.iter().map(|row| part.excitation_of(row)?.centre_nm()).collect()
        };
        let mut ascending: Vec<f64> = excitations(self.luminescent).into_iter().flatten().collect();
        ascending.sort_by(f64::total_cmp);
        let is_of_the_matrix = excitations(self.luminescent) == excitations(self.matrix)
            && self.matrix.check_shape().is_ok()
            && self.matrix.emission.len() == self.luminescent.emission.len();
        if ascending != self.factorisation.excitation_nm || !is_of_the_matrix {
            let found = format!("the excitations of `{}`", self.luminescent.id);
            let expected = format!("those of the matrix `{}` and its factorisation", self.matrix.id);
            return Some(("luminescent", found, expected));
        }
        self.factorisation.misfit().map(|(array, shape, expected)| {
            ("factorisation", format!("{array} of shape {shape:?}"), format!("shape {expected:?}"))
        })
    }
}

/// A reflectance by the terms needs a Lambertian amplitude at every wavelength of an elastic factor.
fn misplaced_reflectance(model: &Model, scan: Option<&Measurement>, source: ReflectanceSource) -> Option<Misfit> {
    if source == ReflectanceSource::Matrix || scan.is_some_and(|scan| model.has_spectral_albedo(scan)) {
        return None;
    }
    let expected = "`matrix`, or an elastic factor with a lambertian albedo for each of several wavelengths".to_owned();
    Some(("reflectance", "`terms`".to_owned(), expected))
}

impl Model {
    /// True where its Lambertian term is a reflectance by wavelength: fitted to an elastic factor, one albedo for each of several
    /// wavelengths.
    #[must_use]
    pub fn has_spectral_albedo(&self, scan: &Measurement) -> bool {
        let count = self.emission.wavelengths().map_or(0, <[f64]>::len);
        let is_spectral = |term: &super::FittedTerm| {
            let albedo = term.parameters.first();
            term.kind == TermKind::Lambertian && albedo.is_some_and(|albedo| albedo.value.len() == count)
        };
        let quantity = &scan.quantity;
        let is_elastic = quantity.kind.is_factor() && quantity.part == Part::Elastic;
        is_elastic && count >= 2 && self.terms.iter().any(is_spectral)
    }
}
