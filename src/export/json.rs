//! The whole document as JSON, with its digest.

use std::io::Write;

use schemars::JsonSchema;
use serde::Serialize;

use crate::dataset::Document;

/// A document with its digest.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DocumentJson<'a> {
    /// Name of this schema.
    pub schema: &'static str,
    /// Digest of the document.
    pub digest: &'a str,
    /// The document; NaN is `null`.
    pub document: &'a Document,
}

/// Writes a document.
///
/// # Errors
/// What the target or the serialiser reports.
pub fn write(document: &Document, digest: &str, target: &mut impl Write) -> std::io::Result<()> {
    serde_json::to_writer_pretty(&mut *target, &DocumentJson { schema: "bbrf:document:1", digest, document })?;
    writeln!(target)
}
