//! Values straight out of the chunks that this standard's writer makes: whole rows, shuffled, deflated, checksummed.
//!
//! The reading library does it for every encoding, in four passes with an array each. Here a chunk goes through one
//! buffer into its place. Whatever is not exactly such a chunk is left to the library, which reads it or says why not.

use flate2::{Decompress, FlushDecompress, Status};
use hdf5_reader::ByteOrder;
use hdf5_reader::messages::HdfMessage;
use hdf5_reader::messages::datatype::Datatype;
use hdf5_reader::messages::filter_pipeline::FilterDescription;
use hdf5_reader::object_header::ObjectHeader;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use super::super::checksum::fletcher32;
use super::super::chunk_table::{Entry, Placed};

/// Registered numbers of shuffle, deflate and fletcher32.
const FILTERS: [u16; 3] = [2, 1, 3];
/// Bytes of the checksum behind a chunk.
const CHECKSUM: usize = 4;

/// The values of a dataset of that shape. `None` where its chunks are of another kind, or damaged.
pub(super) fn values<T: bytemuck::Pod + Send>(
    file: &[u8],
    header: &ObjectHeader,
    kind: &Datatype,
    placed: Option<&Placed>,
    shape: &[usize],
) -> Option<Vec<T>> {
    let width = size_of::<T>();
    let placed = placed.filter(|_| cfg!(target_endian = "little") && is_plain(kind) && is_usual(header, width))?;
    let (rows, row) = (*shape.first()?, shape.iter().skip(1).product::<usize>());
    let (chunk_rows, whole) = (*placed.shape.first()?, placed.shape[1..] == shape[1..]);
    if !whole || chunk_rows == 0 || rows == 0 || row == 0 {
        return None;
    }
    let entries = in_order(placed.entries.as_ref()?, chunk_rows, rows)?;
    let chunk = chunk_rows.checked_mul(row)?;
    let chunk_bytes = chunk.checked_mul(width)?;
    // Deflate makes at most 1032 bytes of one: a damaged shape must not ask for more memory than a chunk can fill.
    if entries.iter().any(|entry| entry.bytes.len().saturating_mul(1032).saturating_add(64) < chunk_bytes) {
        return None;
    }
    let mut values = vec![T::zeroed(); rows.checked_mul(row)?];
    let scratch = || (vec![0_u8; chunk_bytes], Decompress::new(true));
    let decoded =
        values.par_chunks_mut(chunk).zip(entries.par_iter()).map_init(scratch, |(shuffled, inflate), pair| {
            let (target, entry) = pair;
            decode(file.get(entry.bytes.clone())?, shuffled, inflate)?;
            gather(shuffled, chunk, bytemuck::cast_slice_mut(target), width)
        });
    let complete: Option<()> = decoded.collect();
    complete.map(|()| values)
}

fn is_plain(kind: &Datatype) -> bool {
    match kind {
        Datatype::FixedPoint { byte_order, .. } | Datatype::FloatingPoint { byte_order, .. } => {
            *byte_order == ByteOrder::LittleEndian
        }
        _ => false,
    }
}

fn is_usual(header: &ObjectHeader, width: usize) -> bool {
    let pipelines = header.messages.iter().filter_map(|message| match message {
        HdfMessage::FilterPipeline(pipeline) => Some(&pipeline.filters),
        _ => None,
    });
    let usual = |filters: &Vec<FilterDescription>| {
        let numbers = filters.iter().map(|filter| filter.id);
        let shuffled = filters.first().and_then(|shuffle| shuffle.client_data.first());
        numbers.eq(FILTERS) && shuffled.is_some_and(|stated| *stated as usize == width)
    };
    let mut count = 0;
    pipelines.inspect(|_| count += 1).all(usual) && count == 1
}

/// The chunks by their rows, if they are all there.
fn in_order(entries: &[Entry], chunk_rows: usize, rows: usize) -> Option<Vec<&Entry>> {
    let mut entries: Vec<&Entry> = entries.iter().collect();
    entries.sort_by(|a, b| a.first.cmp(&b.first));
    let expected = (0..rows).step_by(chunk_rows);
    let starts = |(entry, row): (&&Entry, usize)| {
        entry.first.first() == Some(&(row as u64)) && entry.first.iter().skip(1).all(|offset| *offset == 0)
    };
    (entries.len() == expected.len() && entries.iter().zip(expected).all(starts)).then_some(entries)
}

/// One chunk, still shuffled.
fn decode(stored: &[u8], shuffled: &mut [u8], inflate: &mut Decompress) -> Option<()> {
    let (deflated, checksum) = stored.split_at_checked(stored.len().checked_sub(CHECKSUM)?)?;
    if fletcher32(deflated).to_le_bytes() != *checksum {
        return None;
    }
    inflate.reset(true);
    let status = inflate.decompress(deflated, shuffled, FlushDecompress::Finish).ok()?;
    let whole = inflate.total_in() == deflated.len() as u64 && inflate.total_out() == shuffled.len() as u64;
    (status == Status::StreamEnd && whole).then_some(())
}

/// Puts the bytes of elements together again: `shuffled` has the first byte of all `count` elements, then the second.
fn gather(shuffled: &[u8], count: usize, target: &mut [u8], width: usize) -> Option<()> {
    match width {
        1 => target.copy_from_slice(shuffled.get(..target.len())?),
        2 => each(shuffled, count, target.as_chunks_mut::<2>().0),
        4 => each(shuffled, count, target.as_chunks_mut::<4>().0),
        8 => eights(shuffled, count, target.as_chunks_mut::<8>().0),
        _ => return None,
    }
    Some(())
}

fn each<const WIDTH: usize>(shuffled: &[u8], count: usize, elements: &mut [[u8; WIDTH]]) {
    for (byte, plane) in shuffled.chunks(count).take(WIDTH).enumerate() {
        elements.iter_mut().zip(plane).for_each(|(element, found)| element[byte] = *found);
    }
}

/// Eight elements of eight bytes at a time: a square of bytes, transposed within eight words (H. S. Warren, Hacker's
/// Delight, 7-3). A chunk does not fit into the fastest memory, so each of its bytes should be touched once.
fn eights(shuffled: &[u8], count: usize, elements: &mut [[u8; 8]]) {
    let mut planes = shuffled.chunks_exact(count);
    let planes: [&[u8]; 8] = std::array::from_fn(|_| planes.next().unwrap_or_default());
    let whole = planes.map(|plane| plane.as_chunks::<8>().0);
    let (squares, rest) = elements.as_chunks_mut::<8>();
    let done = squares.len() * 8;
    for (k, square) in squares.iter_mut().enumerate() {
        let mut rows = whole.map(|plane| plane.get(k).map_or(0, |bytes| u64::from_le_bytes(*bytes)));
        for (distance, shift, mask) in
            [(4, 32, 0x0000_0000_ffff_ffff_u64), (2, 16, 0x0000_ffff_0000_ffff), (1, 8, 0x00ff_00ff_00ff_00ff)]
        {
            for first in (0..8).filter(|row| row & distance == 0) {
                let exchanged = ((rows[first] >> shift) ^ rows[first + distance]) & mask;
                rows[first + distance] ^= exchanged;
                rows[first] ^= exchanged << shift;
            }
        }
        *square = rows.map(u64::to_le_bytes);
    }
    for (k, element) in rest.iter_mut().enumerate() {
        *element = planes.map(|plane| plane.get(done + k).copied().unwrap_or(0));
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::*;

    #[test]
    fn elements_of_every_width_come_back_in_order() {
        for width in [1, 2, 4, 8] {
            for count in [1, 7, 8, 9, 16, 41] {
                let elements: Vec<u8> = (0..count * width).map(|k| (k * 37 % 251) as u8).collect();
                let shuffled: Vec<u8> =
                    (0..width).flat_map(|byte| elements.iter().skip(byte).step_by(width).copied()).collect();
                // The last chunk of a dataset has rows that are not there.
                for kept in [count, count / 2] {
                    let mut target = vec![0; kept * width];
                    gather(&shuffled, count, &mut target, width).unwrap();
                    assert_eq!(target, elements[..kept * width], "{kept} of {count} elements of {width} bytes");
                }
            }
        }
    }
}
