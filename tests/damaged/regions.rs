//! Which bytes of an HDF5 file are headers, heaps, indices and data.

use std::ops::Range;

use hdf5_reader::Hdf5File;
use hdf5_reader::btree_v1::collect_btree_v1_leaves_storage;
use hdf5_reader::group::Group;
use hdf5_reader::messages::HdfMessage;
use hdf5_reader::messages::layout::DataLayout;

/// A kind of content.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Region {
    /// Superblock and object headers, with the attributes in them.
    Headers,
    /// Heaps: names, texts and sequences of variable length.
    Heap,
    /// B-trees and other indices of groups and chunks.
    Index,
    /// Chunks and contiguous values.
    Data,
}

pub const REGIONS: [Region; 4] = [Region::Headers, Region::Heap, Region::Index, Region::Data];

const HEAPS: [&[u8]; 6] = [b"GCOL", b"HEAP", b"FRHP", b"FHDB", b"FHIB", b"SMTB"];
const INDICES: [&[u8]; 11] =
    [b"TREE", b"SNOD", b"BTHD", b"BTIN", b"BTLF", b"FAHD", b"FADB", b"EAHD", b"EAIB", b"EASB", b"EADB"];

/// The regions that a file has. A byte outside the data belongs to the structure whose signature precedes it.
pub fn of_file(bytes: &[u8]) -> Vec<(Region, Vec<Range<usize>>)> {
    let mut of_byte = vec![Region::Headers; bytes.len()];
    let mut current = Region::Headers;
    let data = data(bytes);
    for range in &data {
        of_byte[range.clone()].fill(Region::Data);
    }
    for at in 0..bytes.len() {
        if of_byte[at] == Region::Data {
            continue;
        }
        let signature = &bytes[at..(at + 4).min(bytes.len())];
        if HEAPS.contains(&signature) {
            current = Region::Heap;
        } else if INDICES.contains(&signature) {
            current = Region::Index;
        } else if [&b"OHDR"[..], b"OCHK"].contains(&signature) {
            current = Region::Headers;
        }
        of_byte[at] = current;
    }
    let ranges = |region: Region| {
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for at in (0..bytes.len()).filter(|at| of_byte[*at] == region) {
            match ranges.last_mut() {
                Some(last) if last.end == at => last.end += 1,
                _ => ranges.push(at..at + 1),
            }
        }
        (region, ranges)
    };
    REGIONS.map(ranges).into_iter().filter(|part| !part.1.is_empty()).collect()
}

/// Where chunks and contiguous values lie.
fn data(bytes: &[u8]) -> Vec<Range<usize>> {
    let file = Hdf5File::from_bytes(bytes).unwrap();
    let mut found = Vec::new();
    of_group(&file, &file.root_group().unwrap(), &mut found);
    found
}

fn of_group(file: &Hdf5File, group: &Group, found: &mut Vec<Range<usize>>) {
    let (groups, datasets) = group.members().unwrap();
    groups.iter().for_each(|child| of_group(file, child, found));
    let (offsets, lengths) = (file.superblock().offset_size, file.superblock().length_size);
    let mut add = |address: u64, size: u64| found.push(address as usize..(address + size) as usize);
    for dataset in &datasets {
        let header = file.get_or_parse_header(dataset.address()).unwrap();
        for message in &header.messages {
            let HdfMessage::DataLayout(message) = message else { continue };
            match &message.layout {
                DataLayout::Contiguous { address, size } if *address != u64::MAX => add(*address, *size),
                DataLayout::Chunked { address, dims, chunk_indexing: None, .. } => {
                    let rank = Some(dataset.shape().len() as u32);
                    let leaves =
                        collect_btree_v1_leaves_storage(file.storage(), *address, offsets, lengths, rank, dims, None);
                    for (key, address) in leaves.unwrap() {
                        if let hdf5_reader::btree_v1::BTreeV1Key::RawData { chunk_size, .. } = key {
                            add(address, u64::from(chunk_size));
                        }
                    }
                }
                _ => {}
            }
        }
    }
}
