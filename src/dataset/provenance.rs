//! Where the numbers come from: receipts of imports and the steps since.

use serde::{Deserialize, Serialize};

use super::Place;

/// Where a document comes from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Provenance {
    /// One receipt per import.
    #[serde(default)]
    pub receipts: Vec<Receipt>,
    /// What was done to the document since, in order.
    #[serde(default)]
    pub steps: Vec<Step>,
}

/// Something that was done to the document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Step {
    /// The tool and its version.
    pub tool: String,
    /// What it did.
    pub action: String,
    /// When, RFC 3339; only where the input or `SOURCE_DATE_EPOCH` gave a time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
}

impl Step {
    /// A step that this program does.
    #[must_use]
    pub fn by_this_program(action: String) -> Self {
        Self { tool: concat!("bbrf ", env!("CARGO_PKG_VERSION")).to_owned(), action, time: None }
    }
}

/// What an importer read, assumed and could not fill.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Receipt {
    /// The importer and its version.
    pub tool: String,
    /// Every file read.
    pub inputs: Vec<InputFile>,
    /// Every assumption made.
    pub assumptions: Vec<Assumption>,
    /// Fields of the document that the source did not fill, as paths.
    pub unfilled: Vec<String>,
    /// What was read and is worth a look: flags, doubts, records left out.
    pub notices: Vec<Notice>,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct InputFile {
    /// The name as the user or the manifest gave it.
    pub name: String,
    /// SHA-256 of its bytes, lower-case hexadecimal.
    pub sha256: String,
    /// Its size in bytes.
    pub bytes: u64,
    /// The dialect found, as in `pr650-d5`.
    pub dialect: String,
    /// Number of records read from it.
    pub records: u64,
}

/// Something the source does not say and the importer took for granted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Assumption {
    /// What was assumed, a sentence.
    pub text: String,
    /// Where it applies.
    pub place: Place,
}

/// Something worth a look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Notice {
    /// A sentence.
    pub text: String,
    /// Where it was seen.
    pub place: Place,
}
