//! Are the bytes those of this standard's writer?
//!
//! Where HDF5 keeps no checksum (version 1 chunk indices, the global heap), a changed bit can leave this reader with the
//! right document and mislead another library. The writer is deterministic, so the file of a document is known to the
//! byte.

use super::super::Context;
use super::super::finding::Finder;
use crate::container::{Differing, layout};
use crate::dataset::Place;

/// One byte in so many may differ. A file of the right length that differs in more was laid out by another writer.
const ONE_IN: usize = 20;

/// Says nothing of a file of another length or version: another program wrote it. Without the writer (a build that only
/// reads) there is nothing to compare with.
pub(in super::super) fn written(context: &Context<'_>, found: &mut Finder) {
    if context.version() != Some((layout::MAJOR, layout::MINOR)) {
        return;
    }
    let Some(Differing { count, first }) = context.inspection.differing else { return };
    if count > 0 && count <= (context.inspection.bytes.len() / ONE_IN).max(1) {
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
