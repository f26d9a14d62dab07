//! Why an import has no result: sorted by what the reader of the message must do.

use std::fmt;

use crate::dataset::{DocumentError, Place};

/// What was found where, what was expected there, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// File with line or byte.
    pub place: Place,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// What to do.
    pub advice: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: found {}; expected {}; {}", self.place, self.found, self.expected, self.advice)
    }
}

/// Why an import has no result. Nothing is written then.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The file system refused.
    #[error("{file}: cannot be read ({source}); check that it exists and may be read")]
    Unreadable {
        /// The file's name as given.
        file: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// The input is damaged or not in the format: repair or export it again.
    #[error("{0}")]
    Malformed(Box<Fault>),
    /// The instrument itself says that this is no measurement: measure again, or leave it out.
    #[error("{0}")]
    Refused(Box<Fault>),
    /// Two statements of the input contradict each other.
    #[error("{0}")]
    Contradiction(Box<Fault>),
    /// The input can be read in several ways: say which.
    #[error("{0}")]
    Ambiguous(Box<Fault>),
    /// The call or a key is wrong: an unknown key, an option that does not fit.
    #[error("{0}")]
    Call(Box<Fault>),
    /// Files that a manifest lists are not there.
    #[error(
        "{manifest}: found {} of {listed} listed files missing: {}; expected every listed file; put them there or take their rows out{}",
        .missing.len(), .missing.join(", "), unlisted_text(.unlisted)
    )]
    MissingFiles {
        /// The manifest.
        manifest: String,
        /// How many files it lists.
        listed: usize,
        /// The files that are not there, with the lines that list them.
        missing: Vec<String>,
        /// Files of the same kind in the same folders that it does not list.
        unlisted: Vec<String>,
    },
    /// The document that came out is not consistent.
    #[error("the input does not make a consistent document: {0}")]
    Document(#[from] DocumentError),
}

fn unlisted_text(unlisted: &[String]) -> String {
    if unlisted.is_empty() {
        return String::new();
    }
    format!(" (present but not listed: {})", unlisted.join(", "))
}

/// The four parts of a message, boxed.
pub(crate) fn fault(
    place: Place,
    found: impl Into<String>,
    expected: impl Into<String>,
    advice: impl Into<String>,
) -> Box<Fault> {
    Box::new(Fault { place, found: found.into(), expected: expected.into(), advice: advice.into() })
}

/// The fault of an error of another room, whose text is `FOUND; expected EXPECTED`.
pub(crate) fn fault_of(place: Place, error: &impl fmt::Display, advice: &str) -> Box<Fault> {
    let text = error.to_string();
    let (found, expected) = text.split_once("; expected ").unwrap_or((&text, "another value"));
    fault(place, found, expected, advice)
}

/// A short form of a text from a file: what a message can hold, on one line.
pub(crate) fn quoted(text: &str) -> String {
    let short: String = text.chars().take(60).flat_map(char::escape_debug).collect();
    if text.chars().count() > 60 { format!("`{short}...`") } else { format!("`{short}`") }
}
