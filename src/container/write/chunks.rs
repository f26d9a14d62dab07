//! The chunks of a dataset as they lie in the file: shuffled, deflated, with their checksum.
//!
//! They are made here and given to libhdf5 ready (`H5Dwrite_chunk`): over all cores, by the deflate that also reads, and
//! in a known order, so that a file can be built again around chunks that it already has.

use std::collections::HashMap;
use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::super::checksum::fletcher32;
use super::super::chunk_table::Placed;

/// Where chunks come from.
#[derive(Debug, Clone, Copy)]
pub(in super::super) enum Source<'a> {
    /// The values are encoded.
    Values,
    /// They are taken from a file that has them, by the path of the dataset.
    File(&'a [u8], &'a HashMap<String, Placed>),
}

/// A chunk with the first row that it holds.
pub(super) struct Chunk<'a> {
    pub(super) first_row: u64,
    pub(super) bytes: std::borrow::Cow<'a, [u8]>,
}

/// The chunks of an array whose values are `bytes`, deflated at a level, with an element to fill the last one up; chunks are whole rows.
/// `None` where the file that they are to be taken from has others.
pub(super) fn chunks<'a>(
    (source, level): (Source<'a>, u32),
    path: &str,
    bytes: &[u8],
    fill: &[u8],
    shape: &[usize],
) -> Option<Vec<Chunk<'a>>> {
    let row_bytes = fill.len() * shape.iter().skip(1).product::<usize>();
    let chunk_bytes = row_bytes * shape.first()?;
    if chunk_bytes == 0 {
        return Some(Vec::new());
    }
    if let Source::File(file, placed) = source {
        let placed = placed.get(path).filter(|placed| placed.shape == shape)?;
        let count = bytes.len().div_ceil(chunk_bytes);
        if let Some(entries) = placed.entries.as_ref().filter(|entries| entries.len() == count) {
            // At the rows where they belong: the rows that the index gives may be what is damaged.
            let taken = entries.iter().enumerate().map(|(k, entry)| {
                Some(Chunk { first_row: (k * shape[0]) as u64, bytes: file.get(entry.bytes.clone())?.into() })
            });
            if let Some(taken) = taken.collect() {
                return Some(taken);
            }
        }
    }
    let values: Vec<&[u8]> = bytes.chunks(chunk_bytes).collect();
    let encoded = values.into_par_iter().enumerate().map(|(k, values)| {
        let encoded = encode(values, chunk_bytes, fill, level)?;
        Some(Chunk { first_row: (k * shape[0]) as u64, bytes: encoded.into() })
    });
    encoded.collect()
}

/// One chunk; the last is filled up to its full length.
fn encode(values: &[u8], length: usize, fill: &[u8], level: u32) -> Option<Vec<u8>> {
    let width = fill.len();
    let mut shuffled = vec![0; length];
    for (byte, plane) in shuffled.chunks_mut(length / width).enumerate() {
        plane.fill(fill[byte]);
        for (target, element) in plane.iter_mut().zip(values.chunks(width)) {
            *target = element[byte];
        }
    }
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(length / 2), Compression::new(level));
    encoder.write_all(&shuffled).ok()?;
    let mut encoded = encoder.finish().ok()?;
    let checksum = fletcher32(&encoded);
    encoded.extend_from_slice(&checksum.to_le_bytes());
    Some(encoded)
}
