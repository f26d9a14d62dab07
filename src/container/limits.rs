//! What a reader may be made to spend on a file that it does not know.

/// Budgets of a reader; a damaged or malicious header cannot ask for more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Largest file, bytes.
    pub file_bytes: u64,
    /// Decoded bytes allowed whatever the size of the file.
    pub decoded_bytes_floor: u64,
    /// Decoded bytes allowed for each byte of the file. Deflate cannot make more than 1032 bytes out of one.
    pub decoded_bytes_per_byte: u64,
    /// Depth of groups within groups.
    pub depth: usize,
    /// Number of groups, datasets and attributes.
    pub objects: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 16 << 30,
            decoded_bytes_floor: 1 << 20,
            decoded_bytes_per_byte: 1100,
            depth: 16,
            objects: 1_000_000,
        }
    }
}

impl Limits {
    /// How many bytes a file of that size may decode to.
    #[must_use]
    pub fn decoded_bytes(&self, file_bytes: u64) -> u64 {
        file_bytes.saturating_mul(self.decoded_bytes_per_byte).saturating_add(self.decoded_bytes_floor)
    }
}
