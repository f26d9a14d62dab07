//! JSON for programs: what `bbrf validate --json` prints and the C interface returns.

use schemars::JsonSchema;
use serde::Serialize;

use super::FormError;
use crate::validate::Checked;

/// The name of its JSON Schema, which is `schema/validate.json`.
pub const JSON_SCHEMA: &str = "bbrf:validate:1";

/// What is said of all files, beside the name of the schema.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ValidateResult<'a> {
    files: &'a [Checked],
}

#[derive(Serialize)]
struct Named<'a> {
    schema: &'static str,
    #[serde(flatten)]
    result: ValidateResult<'a>,
}

/// The report as JSON.
///
/// # Errors
/// [`FormError`], should the report not be JSON.
pub fn json(files: &[Checked]) -> Result<String, FormError> {
    let report = Named { schema: JSON_SCHEMA, result: ValidateResult { files } };
    serde_json::to_string_pretty(&report).map_err(|error| FormError { form: "JSON", why: error.to_string() })
}
