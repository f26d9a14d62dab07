//! The document: owns its parts; parts refer to each other by id.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::{
    Extension, Factorisation, Id, Instrument, Light, Measurement, Model, Provenance, Sample, ShapeError, WhiteReference,
};

/// Everything in one file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Document {
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// SPDX identifier of the licence of the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub license: Option<String>,
    /// How to cite the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
    /// Whom to ask about the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<String>,
    /// Samples.
    #[serde(default)]
    pub samples: Vec<Sample>,
    /// Instruments.
    #[serde(default)]
    pub instruments: Vec<Instrument>,
    /// Lights.
    #[serde(default)]
    pub lights: Vec<Light>,
    /// White references.
    #[serde(default)]
    pub white_references: Vec<WhiteReference>,
    /// Measurements.
    #[serde(default)]
    pub measurements: Vec<Measurement>,
    /// Fitted models.
    #[serde(default)]
    pub models: Vec<Model>,
    /// Factors of Donaldson matrices.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub factorisations: Vec<Factorisation>,
    /// Where all that comes from.
    #[serde(default)]
    pub provenance: Provenance,
    /// What laboratories added of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub extensions: Vec<Extension>,
}

/// Why a document is not consistent.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DocumentError {
    /// Two parts of one kind have the same id.
    #[error("two parts under `{list}` have the id `{id}`; ids are unique within their list")]
    DuplicateId {
        /// The list.
        list: &'static str,
        /// The id.
        id: String,
    },
    /// A part refers to one that is not there.
    #[error("`{from}` refers to {list} `{id}`, which is not in the document")]
    DanglingReference {
        /// Who refers.
        from: String,
        /// To which list.
        list: &'static str,
        /// To which id.
        id: String,
    },
    /// Arrays that do not fit together.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A text with U+0000, which HDF5 strings cannot hold.
    #[error("a text of the document holds U+0000, which the format excludes: {0:?}")]
    NulInText(String),
}

impl Document {
    /// The measurement of that id.
    #[must_use]
    pub fn measurement(&self, id: &str) -> Option<&Measurement> {
        self.measurements.iter().find(|measurement| measurement.id.as_str() == id)
    }

    /// The model of that id.
    #[must_use]
    pub fn model(&self, id: &str) -> Option<&Model> {
        self.models.iter().find(|model| model.id.as_str() == id)
    }

    /// The factorisation of that id.
    #[must_use]
    pub fn factorisation(&self, id: &str) -> Option<&Factorisation> {
        self.factorisations.iter().find(|factorisation| factorisation.id.as_str() == id)
    }

    /// Checks what the types alone cannot: unique ids, references that lead somewhere, arrays that fit.
    ///
    /// # Errors
    /// [`DocumentError`], the first found.
    pub fn check(&self) -> Result<(), DocumentError> {
        let samples = unique("samples", self.samples.iter().map(|part| &part.id))?;
        let instruments = unique("instruments", self.instruments.iter().map(|part| &part.id))?;
        let lights = unique("lights", self.lights.iter().map(|part| &part.id))?;
        let references = unique("white_references", self.white_references.iter().map(|part| &part.id))?;
        let measurements = unique("measurements", self.measurements.iter().map(|part| &part.id))?;
        unique("models", self.models.iter().map(|part| &part.id))?;
        let factorisations = unique("factorisations", self.factorisations.iter().map(|part| &part.id))?;
        unique("extensions", self.extensions.iter().map(|part| &part.domain))?;
        for measurement in &self.measurements {
            measurement.check_shape()?;
            let from = format!("measurements/{}", measurement.id);
            present(&from, "samples", measurement.sample.as_ref(), &samples)?;
            present(&from, "instruments", measurement.instrument.as_ref(), &instruments)?;
            present(&from, "white_references", measurement.white_reference.as_ref(), &references)?;
            for excitation in &measurement.excitations {
                present(&from, "lights", excitation.light.as_ref(), &lights)?;
            }
            if let Some(derivation) = &measurement.derivation {
                present(&from, "measurements", Some(&derivation.numerator), &measurements)?;
                present(&from, "measurements", Some(&derivation.reference), &measurements)?;
                present(&from, "measurements", derivation.dark.as_ref(), &measurements)?;
            }
        }
        for model in &self.models {
            let from = format!("models/{}", model.id);
            present(&from, "measurements", Some(&model.measurement), &measurements)?;
            if let Some(attachment) = &model.donaldson {
                present(&from, "factorisations", Some(&attachment.factorisation), &factorisations)?;
                present(&from, "measurements", Some(&attachment.elastic), &measurements)?;
                present(&from, "measurements", Some(&attachment.luminescent), &measurements)?;
            }
        }
        for part in &self.factorisations {
            present(&format!("factorisations/{}", part.id), "measurements", Some(&part.measurement), &measurements)?;
        }
        Ok(())
    }
}

fn unique<'a>(list: &'static str, ids: impl Iterator<Item = &'a Id>) -> Result<BTreeSet<&'a Id>, DocumentError> {
    let mut seen = BTreeSet::new();
    for id in ids {
        if !seen.insert(id) {
            return Err(DocumentError::DuplicateId { list, id: id.to_string() });
        }
    }
    Ok(seen)
}

fn present(from: &str, list: &'static str, id: Option<&Id>, known: &BTreeSet<&Id>) -> Result<(), DocumentError> {
    match id {
        Some(id) if !known.contains(id) => {
            Err(DocumentError::DanglingReference { from: from.to_owned(), list, id: id.to_string() })
        }
        _ => Ok(()),
    }
}
