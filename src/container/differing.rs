//! Are the bytes of a file those that the writer makes of its document?

use super::chunk_table::Chunks;
#[cfg(feature = "write")]
use super::digest::Digests;
#[cfg(feature = "write")]
use super::storing::Storing;
use super::tree::Group;
#[cfg(feature = "write")]
use super::write::{Plan, chunks::Source, with_image};

/// Where a file differs from one of the same length that the writer makes of its document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Differing {
    /// How many bytes do.
    pub count: usize,
    /// Offset of the first of them.
    pub first: usize,
}

impl Differing {
    /// Without the writer there is nothing to compare with.
    #[cfg(not(feature = "write"))]
    pub(super) fn of(_: &[u8], _: &Chunks, _: &Group, _: &Group) -> Option<Self> {
        None
    }

    /// Compares the bytes of a file with those that its document is written as, around the chunks and with the digests
    /// that the file has. `None` where they are more or fewer, or the file has chunks of another kind.
    #[cfg(feature = "write")]
    pub(super) fn of(bytes: &[u8], chunks: &Chunks, tree: &Group, canonical: &Group) -> Option<Self> {
        let digests = Digests::stated(tree)?;
        // A file may be deflated at any one level; a header that differs from the others is a difference.
        let mut levels: Vec<u32> = chunks.0.values().filter_map(|placed| placed.level).collect();
        levels.sort_unstable();
        let usual = Storing::default();
        let compression = levels.get(levels.len() / 2).copied().unwrap_or(usual.compression);
        let storing = Storing { compression: compression.min(9), ..usual };
        let plan = Plan { source: Source::File(bytes, &chunks.0), digests: Some(&digests), storing };
        with_image(canonical, plan, |image| Self::between(image, bytes)).ok().flatten()
    }

    #[cfg(feature = "write")]
    fn between(a: &[u8], b: &[u8]) -> Option<Self> {
        /// Bytes compared at once.
        const BLOCK: usize = 1 << 14;
        if a.len() != b.len() {
            return None;
        }
        let mut found = Self { count: 0, first: a.len() };
        let blocks = a.chunks(BLOCK).zip(b.chunks(BLOCK)).enumerate().filter(|(_, (a, b))| a != b);
        for (block, (a, b)) in blocks {
            for (k, _) in a.iter().zip(b).enumerate().filter(|(_, (a, b))| a != b) {
                found.first = found.first.min(block * BLOCK + k);
                found.count += 1;
            }
        }
        Some(found)
    }
}
