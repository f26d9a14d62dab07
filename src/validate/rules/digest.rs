//! Is the content what was written?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::Mismatch;
use crate::container::layout::name;
use crate::dataset::Place;

fn is_root(path: &str) -> bool {
    path == format!("/@{}", name::DIGEST)
}

pub(in super::super) fn object(context: &Context<'_>, found: &mut Finder) {
    for mismatch in &context.inspection.mismatches {
        if let Mismatch::Digest(path) = mismatch
            && !is_root(path)
        {
            found.add(Place::path(path), "content with another SHA-256", "the content that `sha256` was taken of");
        }
    }
}

pub(in super::super) fn document(context: &Context<'_>, found: &mut Finder) {
    let (stored, computed) = (&context.inspection.stored_digest, &context.inspection.computed_digest);
    let differs = context.inspection.mismatches.iter().any(|m| matches!(m, Mismatch::Digest(path) if is_root(path)));
    if let (Some(stored), Some(computed), true) = (stored, computed, differs) {
        found.add(Place::path(format!("/@{}", name::DIGEST)), computed.as_str(), stored.as_str());
    }
}

pub(in super::super) fn missing(context: &Context<'_>, found: &mut Finder) {
    for mismatch in &context.inspection.mismatches {
        if let Mismatch::Unsigned(path) = mismatch {
            found.add(Place::path(path), "no digest", "the SHA-256 of the content");
        }
    }
}
