//! Where the chunks of a file lie.

use std::collections::HashMap;
use std::ops::Range;

use hdf5_reader::Hdf5File;
use hdf5_reader::btree_v1::{BTreeV1Key, collect_btree_v1_leaves_storage};
use hdf5_reader::messages::HdfMessage;
use hdf5_reader::messages::layout::DataLayout;
use hdf5_reader::object_header::ObjectHeader;

/// The chunks of every dataset that has an index of the form that this standard's writer makes, by path.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Chunks(pub(super) HashMap<String, Placed>);

/// Where the chunks of a dataset lie in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Placed {
    /// Lengths of a chunk.
    pub(super) shape: Vec<usize>,
    /// Level of deflate, as the header of the dataset states it.
    pub(super) level: Option<u32>,
    /// The chunks; `None` for an index that no writer of this standard makes, so a damaged one.
    pub(super) entries: Option<Vec<Entry>>,
}

/// A chunk in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Entry {
    /// First element along every axis, as the index says.
    pub(super) first: Vec<u64>,
    /// Where its bytes are.
    pub(super) bytes: Range<usize>,
}

impl Chunks {
    /// Takes the chunks of a dataset, if they have an index of that form that can be read.
    pub(super) fn take(&mut self, file: &Hdf5File, header: &ObjectHeader, axes: usize, path: &str) {
        let layouts = header.messages.iter().filter_map(|message| match message {
            HdfMessage::DataLayout(message) => Some(&message.layout),
            _ => None,
        });
        for layout in layouts {
            if let DataLayout::Chunked { address, dims, chunk_indexing: None, .. } = layout {
                let shape = dims.iter().take(axes).map(|length| *length as usize).collect();
                let (level, entries) = (level(header), entries(file, *address, dims, axes));
                self.0.insert(path.to_owned(), Placed { shape, level, entries });
            }
        }
    }
}

/// The level of deflate (filter 1) that a header states.
fn level(header: &ObjectHeader) -> Option<u32> {
    header.messages.iter().find_map(|message| match message {
        HdfMessage::FilterPipeline(pipeline) => {
            pipeline.filters.iter().find(|filter| filter.id == 1)?.client_data.first().copied()
        }
        _ => None,
    })
}

fn entries(file: &Hdf5File, address: u64, dims: &[u32], axes: usize) -> Option<Vec<Entry>> {
    let superblock = file.superblock();
    let (offsets, lengths) = (superblock.offset_size, superblock.length_size);
    let rank = Some(u32::try_from(axes).ok()?);
    let leaves = collect_btree_v1_leaves_storage(file.storage(), address, offsets, lengths, rank, dims, None).ok()?;
    let chunk = |(key, address): &(BTreeV1Key, u64)| match key {
        BTreeV1Key::RawData { chunk_size, filter_mask: 0, offsets } => {
            let from = usize::try_from(*address).ok()?;
            let to = from.checked_add(usize::try_from(*chunk_size).ok()?)?;
            Some(Entry { first: offsets.clone(), bytes: from..to })
        }
        _ => None,
    };
    leaves.iter().map(chunk).collect()
}
