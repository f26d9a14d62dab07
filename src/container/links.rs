//! Links that lead nowhere, or out of the file. The HDF5 reader leaves them out; libraries that follow every link reject
//! the whole file for one.

use hdf5_reader::btree_v2::{self, BTreeV2Header, BTreeV2Record};
use hdf5_reader::error::{Error, Result};
use hdf5_reader::fractal_heap::FractalHeap;
use hdf5_reader::group::Group;
use hdf5_reader::io::Cursor;
use hdf5_reader::messages::HdfMessage;
use hdf5_reader::messages::link::{self, LinkMessage, LinkTarget};
use hdf5_reader::messages::link_info::LinkInfoMessage;
use hdf5_reader::object_header::ObjectHeader;
use hdf5_reader::{ExternalLinkResolver, Hdf5File};

/// Turns every external link into an error: a document is one file.
pub(super) struct RefuseExternal;

impl ExternalLinkResolver for RefuseExternal {
    fn resolve_external_link(&self, filename: &str) -> Result<Option<Hdf5File>> {
        Err(Error::InvalidData(format!("a link to another file, `{filename}`; a document is one file")))
    }
}

/// The first soft link of a group that is none of its members: name and target. Groups in the form of HDF5 before 1.8
/// are not searched; this standard's writer makes none.
pub(super) fn dangling(group: &Group, is_member: impl Fn(&str) -> bool, limit: usize) -> Result<Option<LinkMessage>> {
    let (offsets, lengths) = (group.offset_size(), group.length_size());
    let header = ObjectHeader::parse_at_storage_with_limit(group.storage(), group.address(), offsets, lengths, limit)?;
    let mut links = Vec::new();
    for message in header.messages {
        match message {
            HdfMessage::Link(link) => links.push(link),
            HdfMessage::LinkInfo(info) => dense(group, &info, &mut links)?,
            _ => {}
        }
    }
    let leads_nowhere = |link: &LinkMessage| matches!(link.target, LinkTarget::Soft { .. }) && !is_member(&link.name);
    Ok(links.into_iter().find(leads_nowhere))
}

/// Links that were too many for the header.
fn dense(group: &Group, info: &LinkInfoMessage, links: &mut Vec<LinkMessage>) -> Result<()> {
    let (storage, offsets, lengths) = (group.storage(), group.offset_size(), group.length_size());
    if Cursor::is_undefined_offset(info.fractal_heap_address, offsets) {
        return Ok(());
    }
    let heap = FractalHeap::parse_at_storage(storage, info.fractal_heap_address, offsets, lengths)?;
    let index = BTreeV2Header::parse_at_storage(storage, info.btree_name_index_address, offsets, lengths)?;
    let records = btree_v2::collect_btree_v2_records_storage(storage, &index, offsets, lengths, None, &[], None)?;
    for record in &records {
        let BTreeV2Record::LinkNameHash { heap_id, .. } = record else { continue };
        let bytes = heap.get_object_storage(heap_id, storage, offsets, lengths)?;
        links.push(link::parse(&mut Cursor::new(&bytes), offsets, lengths, bytes.len())?);
    }
    Ok(())
}
