//! Why a file cannot be read or written.

use crate::dataset::{DocumentError, Place};

/// Why a file is not a readable document. Every variant says where, what was found and what was expected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system does not give the bytes.
    #[error("{place}: cannot be read: {source}")]
    Io {
        /// The file.
        place: Box<Place>,
        /// Why.
        source: std::io::Error,
    },
    /// Not HDF5, or HDF5 that is damaged or encoded in a way that the reader does not know.
    #[error("{place}: not readable as HDF5: {source}; {}", advice(source))]
    Encoding {
        /// Where.
        place: Box<Place>,
        /// What the HDF5 reader says.
        source: Box<hdf5_reader::error::Error>,
    },
    /// More than a reader should be asked to take.
    #[error(
        "{place}: {found} {what}, at most {limit} expected; the file is damaged, or beyond what this reader takes (clause \
         13 of the specification)"
    )]
    Limit {
        /// Where.
        place: Box<Place>,
        /// Of what.
        what: &'static str,
        /// How many.
        found: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// Something that the standard requires is not there.
    #[error("{place}: missing; expected {expected}")]
    Missing {
        /// Where.
        place: Box<Place>,
        /// What should be there.
        expected: String,
    },
    /// Something is there with another type, shape or value than the standard gives it.
    #[error("{place}: found {found}; expected {expected}")]
    Unexpected {
        /// Where.
        place: Box<Place>,
        /// What is there.
        found: String,
        /// What should be there.
        expected: String,
    },
    /// A version of the standard that this library does not know.
    #[error("{place}: version {found} of the standard; expected 1.x: read it with a newer bbrf")]
    Version {
        /// Where.
        place: Box<Place>,
        /// The version.
        found: String,
    },
    /// A later minor version put content into the file that this library cannot write with its digest.
    #[error(
        "{place}: holds content of a later version of the standard, which would be lost here ({}): write it with a \
         newer bbrf",
        if .unknown.is_empty() { "members of its receipts or steps".to_owned() } else { .unknown.join("; ") }
    )]
    Later {
        /// Where.
        place: Box<Place>,
        /// Paths of what is not known.
        unknown: Vec<String>,
    },
    /// The parts of the document do not fit together.
    #[error("{place}: {source}")]
    Document {
        /// Where.
        place: Box<Place>,
        /// Why.
        source: DocumentError,
    },
    /// The content is not what was written.
    #[error(
        "{place}: the content does not have the digest that is stored with it ({}); the file was damaged or \
         changed by hand: fetch it again, or see `bbrf validate`",
        .mismatched.join("; ")
    )]
    Damaged {
        /// Where.
        place: Box<Place>,
        /// Paths of what differs.
        mismatched: Vec<String>,
    },
}

impl ReadError {
    /// The same error, in that file.
    #[must_use]
    pub fn in_file(mut self, name: &str) -> Self {
        self.place_mut().file = Some(name.to_owned());
        self
    }

    /// Where it happened.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Io { place, .. }
            | Self::Encoding { place, .. }
            | Self::Limit { place, .. }
            | Self::Missing { place, .. }
            | Self::Unexpected { place, .. }
            | Self::Version { place, .. }
            | Self::Later { place, .. }
            | Self::Document { place, .. }
            | Self::Damaged { place, .. } => place,
        }
    }

    fn place_mut(&mut self) -> &mut Place {
        match self {
            Self::Io { place, .. }
            | Self::Encoding { place, .. }
            | Self::Limit { place, .. }
            | Self::Missing { place, .. }
            | Self::Unexpected { place, .. }
            | Self::Version { place, .. }
            | Self::Later { place, .. }
            | Self::Document { place, .. }
            | Self::Damaged { place, .. } => place,
        }
    }

    pub(super) fn missing(path: &str, expected: impl Into<String>) -> Self {
        Self::Missing { place: Box::new(Place::path(path)), expected: expected.into() }
    }

    pub(super) fn unexpected(path: &str, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::Unexpected { place: Box::new(Place::path(path)), found: found.into(), expected: expected.into() }
    }

    pub(super) fn encoding(path: &str, source: hdf5_reader::error::Error) -> Self {
        Self::Encoding { place: Box::new(Place::path(path)), source: Box::new(source) }
    }
}

/// What to do about an encoding that cannot be read.
fn advice(source: &hdf5_reader::error::Error) -> &'static str {
    /// Virtual datasets (HDF5 File Format Specification, IV.A.2.i).
    const VIRTUAL: u8 = 3;
    match source {
        hdf5_reader::error::Error::UnsupportedLayoutClass(VIRTUAL) => {
            "a virtual dataset has its values in other files, and the standard has none (clause 13): copy the values into \
             this one"
        }
        _ => {
            "the file is damaged, cut short or not HDF5: fetch it again; files of other formats are read by `bbrf import`"
        }
    }
}

/// Why a document cannot be put into the form of the standard.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// An extension holds what the format cannot.
    #[error("extension: `{name}`: found {found}; expected numbers or texts of a fixed type that fill their shape")]
    Extension {
        /// The object or attribute.
        name: String,
        /// What is wrong with it.
        found: String,
    },
    /// The document is not consistent, or holds a text with U+0000.
    #[error(transparent)]
    Document(#[from] DocumentError),
    /// A value whose text form means something else, as a light that is called `same`.
    #[error("{path}: `{found}` cannot be stored: it would be read back as something else")]
    Ambiguous {
        /// Where it would stand.
        path: String,
        /// Its text form.
        found: String,
    },
    /// A part that has no JSON form.
    #[error("{path}: cannot be written as JSON: {source}")]
    Json {
        /// Where it would stand.
        path: String,
        /// Why.
        source: serde_json::Error,
    },
    /// The reader would not take it back.
    #[error("the document would not be read back as it is: {0}")]
    NotReadBack(String),
}

/// Why a document was not written. Nothing was changed on disk.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The document has no form in the standard.
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// libhdf5 refused.
    #[error("libhdf5 refused {operation} at {path}")]
    Library {
        /// Which function.
        operation: &'static str,
        /// The HDF5 path.
        path: String,
    },
    /// The operating system refused.
    #[error("{}: cannot be written: {source}; the old file, if there was one, is untouched", .path.display())]
    Io {
        /// The file.
        path: std::path::PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

#[cfg(test)]
mod tests {
    use hdf5_reader::error::Error;

    use super::*;

    #[test]
    fn a_virtual_dataset_is_not_called_damaged() {
        let said =
            |class| ReadError::encoding("/measurement/scan/value", Error::UnsupportedLayoutClass(class)).to_string();
        assert!(said(3).contains("copy the values") && !said(3).contains("damaged"), "{}", said(3));
        assert!(said(9).contains("damaged"), "{}", said(9));
    }
}
