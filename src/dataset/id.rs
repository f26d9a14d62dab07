//! Identifiers inside a document.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// The identifier of a part of a document: an ASCII letter, digit or underscore, then those, `-` and `.`; at most 64.
///
/// It becomes the name of an HDF5 group, so it holds nothing that a reader could misunderstand. Titles are free text.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(into = "String", try_from = "String")]
#[schemars(with = "String")]
pub struct Id(String);

/// A text that cannot be an identifier.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is not an identifier; expected 1 to 64 ASCII letters, digits, `_`, `-` or `.`, the first a letter, digit or `_`"
)]
pub struct IdError(pub String);

impl Id {
    /// An identifier.
    ///
    /// # Errors
    /// [`IdError`] when the text does not have the form.
    pub fn new(text: impl Into<String>) -> Result<Self, IdError> {
        let text = text.into();
        let first_ok = text.chars().next().is_some_and(|first| first.is_ascii_alphanumeric() || first == '_');
        let rest_ok = text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.'));
        if first_ok && rest_ok && text.len() <= 64 { Ok(Self(text)) } else { Err(IdError(text)) }
    }

    /// An identifier made from any text: what an identifier may not hold becomes `-`; an empty result becomes
    /// `unnamed`.
    #[must_use]
    pub fn from_title(title: &str) -> Self {
        let mut text = String::new();
        for c in title.chars().flat_map(char::to_lowercase) {
            if c.is_ascii_alphanumeric() || matches!(c, '_' | '.') {
                text.push(c);
            } else if !text.is_empty() && !text.ends_with('-') {
                text.push('-');
            }
        }
        let text: String = text.trim_start_matches('.').chars().take(64).collect();
        let text = text.trim_matches('-');
        Self(if text.is_empty() { "unnamed".to_owned() } else { text.to_owned() })
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl Default for Id {
    fn default() -> Self {
        Self("unnamed".to_owned())
    }
}

impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl FromStr for Id {
    type Err = IdError;

    fn from_str(text: &str) -> Result<Self, IdError> {
        Self::new(text)
    }
}

impl From<Id> for String {
    fn from(id: Id) -> Self {
        id.0
    }
}

impl TryFrom<String> for Id {
    type Error = IdError;

    fn try_from(text: String) -> Result<Self, IdError> {
        Self::new(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_becomes_an_identifier() {
        assert_eq!(Id::from_title("Weiße Farbe, 3 (süß)").as_str(), "wei-e-farbe-3-s");
        assert_eq!(Id::from_title("…").as_str(), "unnamed");
        assert!(Id::new("../etc").is_err());
        assert!(Id::new("").is_err());
    }
}
