//! Rules, one function each with a stable id, and what they find.
//!
//! *May use:* `container`, `dataset`, `terms`, `quantity`.
//!
//! *Invariant:* whatever the bytes, validation ends in a report; a file that cannot be read in full is never valid.

mod baseline;
mod census;
mod checked;
mod context;
mod demand;
mod finding;
pub mod form;
mod grading;
mod registry;
#[cfg(feature = "write")]
mod repair;
mod rules;
mod significance;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::container::{FileBytes, Limits, inspect};

pub use baseline::{Baseline, BaselineError};
#[cfg(feature = "write")]
pub(crate) use checked::counted;
pub use checked::{Checked, validate_file, validate_files};
pub use context::Context;
pub use finding::{Finding, Report, Severity, Status};
pub use grading::{Grading, PROFILES, Profile, UnknownRule, profile};
pub use registry::{CLAUSES, RULES, Rule, rule};
#[cfg(feature = "write")]
pub use repair::{NotRepaired, Repair, repair};

/// Validates the bytes of a file; a vector of them is taken as it is, a slice is copied.
#[must_use]
pub fn validate_bytes(bytes: impl Into<FileBytes>) -> Report {
    let inspection = match inspect(bytes, &Limits::default()) {
        Ok(inspection) => inspection,
        Err(error) => return rules::structure::unreadable(&error),
    };
    let context = Context::new(&inspection);
    // Rules know nothing of each other; findings come in the order of the rules.
    let checked = RULES.par_iter().map(|rule| {
        let mut found = rule.finder();
        (rule.check)(&context, &mut found);
        found.findings
    });
    let findings = checked.collect::<Vec<_>>().into_iter().flatten().collect();
    let readable = context.is_this_standard();
    Report { digest: inspection.computed_digest.map(|digest| digest.to_string()), readable, findings }
}
