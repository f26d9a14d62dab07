//! The values of an array as bytes, as libhdf5 takes them.

use std::borrow::Cow;

use super::super::tree::Data;

/// Values as bytes.
pub(super) struct Raw<'a> {
    /// One element after the other.
    pub(super) bytes: Cow<'a, [u8]>,
    /// Bytes of an element.
    pub(super) width: usize,
}

impl<'a> Raw<'a> {
    /// `None` for a type whose values are not kept.
    pub(super) fn of(data: &'a Data) -> Option<Self> {
        match data {
            Data::Text(texts) => Some(Self::texts(texts)),
            Data::Other(_) => None,
            numbers => {
                let bytes = numbers.bytes();
                let width = bytes.len() / numbers.len().max(1);
                Some(Self { bytes, width })
            }
        }
    }

    /// Fixed-length UTF-8, padded with NUL to the longest text; at least one byte, because HDF5 has no empty type.
    fn texts(texts: &[String]) -> Self {
        let width = texts.iter().map(String::len).max().unwrap_or(0).max(1);
        let mut bytes = vec![0_u8; width * texts.len()];
        for (slot, text) in bytes.chunks_mut(width).zip(texts) {
            slot[..text.len()].copy_from_slice(text.as_bytes());
        }
        Self { bytes: bytes.into(), width }
    }
}
