//! Repairs that need no knowledge of the measurement: a file is written again as the standard has it. Content that does
//! not have its digest is never touched: nobody knows what it was.

use super::validate_bytes;
use crate::container::{Limits, Mismatch, WriteError, inspect, rewrite};

/// Rules whose findings go away when the document is written again.
const REPAIRED: &[&str] =
    &["structure.conventions", "structure.attributes", "structure.bytes", "digest.missing", "quantity.si-unit"];

/// What a repair would do.
#[derive(Debug)]
pub struct Repair {
    /// The bytes of the repaired file.
    pub bytes: Vec<u8>,
    /// Names of the rules that no longer find anything.
    pub repaired: Vec<&'static str>,
}

/// Why a file is not repaired.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NotRepaired {
    /// It cannot be read, or is no consistent document.
    #[error("not repaired: the document cannot be read in full; the findings say why")]
    Unreadable,
    /// Content differs from its digest.
    #[error(
        "not repaired: the content of {0} does not have its digest, and nobody knows what it was; fetch the file again"
    )]
    Changed(String),
    /// Content beside the standard that could not be kept.
    #[error("not repaired: {0} would be lost, because its values are of a type that is not written here")]
    WouldLose(String),
    /// The writer refuses.
    #[error("not repaired: {0}")]
    Write(#[from] WriteError),
}

/// The repair of a file; `None` where there is nothing to repair.
///
/// # Errors
/// [`NotRepaired`] when the file must not be touched.
pub fn repair(bytes: &[u8]) -> Result<Option<Repair>, NotRepaired> {
    let before = validate_bytes(bytes);
    let names = |report: &super::Report| -> Vec<&'static str> {
        let mut names: Vec<&str> =
            report.findings.iter().filter_map(|f| super::rule(f.rule)).map(super::Rule::name).collect();
        names.dedup();
        names
    };
    let repairable = |name: &&str| REPAIRED.contains(name) || name.starts_with("portability.");
    if !names(&before).iter().any(repairable) {
        return Ok(None);
    }
    let inspection = inspect(bytes, &Limits::default()).map_err(|_| NotRepaired::Unreadable)?;
    let changed = inspection.mismatches.iter().find_map(|mismatch| match mismatch {
        Mismatch::Digest(path) => Some(path.clone()),
        _ => None,
    });
    if let Some(path) = changed {
        return Err(NotRepaired::Changed(path));
    }
    let document = inspection.document.as_ref().map_err(|_| NotRepaired::Unreadable)?;
    document.check().map_err(|_| NotRepaired::Unreadable)?;
    if let Some(path) = inspection.foreign.lost().first() {
        return Err(NotRepaired::WouldLose(path.clone()));
    }
    let bytes = rewrite(document, &inspection.foreign)?;
    let after = names(&validate_bytes(&bytes));
    let repaired: Vec<&str> = names(&before).into_iter().filter(|name| !after.contains(name)).collect();
    Ok((!repaired.is_empty()).then_some(Repair { bytes, repaired }))
}
