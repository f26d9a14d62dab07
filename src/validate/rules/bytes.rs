//! Are the bytes those of this standard's writer?
//!
//! Where HDF5 keeps no checksum (version 1 chunk indices, the global heap), a changed bit can leave this reader with the
//! right document and mislead another library. The writer is deterministic, so the file of a document is known to the
//! byte.

use super::super::Context;
use super::super::finding::Finder;
#[cfg(feature = "write")]
use crate::container::layout;
#[cfg(feature = "write")]
use crate::dataset::Place;

/// One byte in so many may differ. A file of the right length that differs in more was laid out by another writer.
#[cfg(feature = "write")]
const ONE_IN: usize = 20;

/// Says nothing of a file of another length or version: another program wrote it.
#[cfg(feature = "write")]
pub(in super::super) fn written(context: &Context<'_>, found: &mut Finder) {
    if context.version() != Some((layout::MAJOR, layout::MINOR)) {
        return;
    }
    let Some(expected) = context.inspection.rewritten(context.bytes) else { return };
    if expected.len() != context.bytes.len() {
        return;
    }
    let mut differing = expected.iter().zip(context.bytes).enumerate().filter(|(_, (a, b))| a != b);
    let Some((first, _)) = differing.next() else { return };
    let count = differing.count() + 1;
    if count <= (expected.len() / ONE_IN).max(1) {
        let what = if count == 1 { "byte differs" } else { "bytes differ" };
        found.add(
            Place::path("/"),
            format!(
                "{count} {what} (the first at offset {first}): what is stored differs from what this standard's writer \
                 makes of the same document; another HDF5 library may read other numbers"
            ),
            "the bytes of the writer",
        );
    }
}

/// Without the writer there is nothing to compare with.
#[cfg(not(feature = "write"))]
pub(in super::super) fn written(_: &Context<'_>, _: &mut Finder) {}
