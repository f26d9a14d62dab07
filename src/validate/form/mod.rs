//! A report in the forms that people and pipelines read.

mod json;
mod junit;
mod markdown;
mod sarif;
mod text;

pub use json::{JSON_SCHEMA, ValidateResult, json};
pub use junit::junit;
pub use markdown::markdown;
pub use sarif::sarif;
pub use text::text;

/// Why a report has no such form.
#[derive(Debug, thiserror::Error)]
#[error("the report cannot be written as {form}: {why}")]
pub struct FormError {
    /// The form.
    pub form: &'static str,
    /// Why.
    pub why: String,
}
