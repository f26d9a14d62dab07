//! What a laboratory adds beside the standard.

use serde::{Deserialize, Serialize};

use super::Id;
use super::tree::Group;

/// Content of a laboratory's own, under its reverse domain name, as in `org.example.goniometer`. It is digested and kept
/// by every tool, and no rule of the standard looks into it. Dimension scales inside are kept as plain datasets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Extension {
    /// Reverse domain name.
    pub domain: Id,
    /// Groups, datasets and attributes.
    pub content: Group,
}
