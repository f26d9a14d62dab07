//! How the values of a file are laid down: what it costs in bytes and time, and never what it says.

/// Settings of a writer. The digests of a file do not depend on them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Storing {
    /// Level of deflate, 0 (none) to 9.
    pub compression: u32,
    /// Bytes of a chunk before compression, about; at least a row.
    pub chunk_bytes: usize,
    /// Values of measurements and their uncertainties take 4 bytes each where that loses nothing
    /// ([`Document::round_to_single`](crate::dataset::Document::round_to_single) makes it so).
    pub single: bool,
}

impl Default for Storing {
    /// Beyond level 4 files hardly shrink; a chunk of 1 MiB fits a cache and is worth a thread.
    fn default() -> Self {
        Self { compression: 4, chunk_bytes: 1 << 20, single: false }
    }
}

impl Storing {
    /// The same with every number in its range.
    #[cfg(feature = "write")]
    pub(super) fn in_range(self) -> Self {
        Self { compression: self.compression.min(9), chunk_bytes: self.chunk_bytes.clamp(1, 1 << 30), ..self }
    }
}
