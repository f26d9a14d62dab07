//! The bytes of an HDF5 file as a tree, through the pure-Rust reader, within limits.
//!
//! Anything wrong ends the read: half a tree is no tree.

mod chunks;
pub(super) mod part;

use std::collections::HashSet;
use std::sync::Arc;

use hdf5_reader::error::Error;
use hdf5_reader::messages::link::LinkTarget;
use hdf5_reader::object_header::ObjectHeader;
use hdf5_reader::{Attribute, Datatype, Hdf5File, OpenOptions, StringSize};

use super::chunk_table::Chunks;
use super::encoding::{self, Construct, Encoded};
use super::error::ReadError;
use super::file_bytes::FileBytes;
use super::limits::Limits;
use super::links;
use super::tree::{Array, Attributes, Data, Dataset, Group};
use crate::dataset::Place;

/// What a file holds, and how.
pub(super) struct Read {
    pub(super) tree: Group,
    pub(super) unusual: Vec<Encoded>,
    pub(super) chunks: Chunks,
}

/// The tree of a file, with what is unusual in its encoding.
///
/// # Errors
/// [`ReadError`] when the bytes are no HDF5, damaged, or beyond the limits.
pub(super) fn from_bytes(bytes: &FileBytes, limits: &Limits) -> Result<Read, ReadError> {
    let size = bytes.len() as u64;
    within("bytes", size, limits.file_bytes, "/")?;
    let file =
        Hdf5File::from_owner(bytes.clone(), options(size, limits)).map_err(|error| ReadError::encoding("/", error))?;
    let root = file.root_group().map_err(|error| ReadError::encoding("/", error))?;
    let mut walk = Walk::new(&file, bytes, limits, size);
    encoding::of_file(&file, &mut walk.unusual);
    let tree = walk.group(&root, "", 0)?;
    Ok(Read { tree, unusual: walk.unusual, chunks: walk.chunks })
}

/// How a file of that size is opened.
fn options(size: u64, limits: &Limits) -> OpenOptions {
    let most = usize::try_from(limits.decoded_bytes(size)).unwrap_or(usize::MAX);
    OpenOptions::default()
        .with_chunk_cache_bytes(0)
        .with_external_link_resolver(Arc::new(links::RefuseExternal))
        .with_max_chunk_bytes(most)
        .with_max_read_bytes(most)
        .with_max_object_header_bytes(usize::try_from(size).unwrap_or(usize::MAX))
}

fn within(what: &'static str, found: u64, limit: u64, path: &str) -> Result<(), ReadError> {
    if found <= limit {
        return Ok(());
    }
    Err(ReadError::Limit { place: Box::new(Place::path(path)), what, found, limit })
}

struct Walk<'a> {
    file: &'a Hdf5File,
    bytes: &'a [u8],
    unusual: Vec<Encoded>,
    chunks: Chunks,
    limits: &'a Limits,
    decoded_limit: u64,
    decoded_left: u64,
    objects: u64,
}

impl<'a> Walk<'a> {
    /// A walk over a file of that size; `bytes` are the whole file, or nothing where it is not held.
    fn new(file: &'a Hdf5File, bytes: &'a [u8], limits: &'a Limits, size: u64) -> Self {
        let decoded = limits.decoded_bytes(size);
        Self {
            file,
            bytes,
            limits,
            decoded_left: decoded,
            objects: 0,
            decoded_limit: decoded,
            unusual: Vec::new(),
            chunks: Chunks::default(),
        }
    }

    fn group(&mut self, group: &hdf5_reader::group::Group, path: &str, depth: usize) -> Result<Group, ReadError> {
        let shown = if path.is_empty() { "/" } else { path };
        let failed = |error: Error| ReadError::encoding(shown, error);
        within("levels of groups", depth as u64, self.limits.depth as u64, shown)?;
        self.count(1, shown)?;
        let header = self.file.get_or_parse_header(group.address()).map_err(failed)?;
        encoding::of_group(&header, shown, &mut self.unusual);
        let mut tree =
            Group { attributes: self.attributes(&group.attributes().map_err(failed)?, shown)?, ..Group::default() };
        let (groups, datasets) = group.members().map_err(failed)?;
        let names: HashSet<&str> =
            datasets.iter().map(|d| last_name(d.name())).chain(groups.iter().map(|g| last_name(g.name()))).collect();
        let most = usize::try_from(self.decoded_limit).unwrap_or(usize::MAX);
        if let Some(link) = links::dangling(group, |name| names.contains(name), most).map_err(failed)? {
            let target = match link.target {
                LinkTarget::Soft { path } => path,
                _ => String::new(),
            };
            self.unusual.push((format!("{path}/{}", link.name), Construct::DanglingLink(target)));
        }
        for dataset in &datasets {
            let name = last_name(dataset.name());
            let read = self.dataset(dataset, &format!("{path}/{name}"))?;
            tree.datasets.push((name.to_owned(), read));
        }
        for child in &groups {
            let name = last_name(child.name());
            let read = self.group(child, &format!("{path}/{name}"), depth + 1)?;
            tree.groups.push((name.to_owned(), read));
        }
        Ok(tree)
    }

    fn dataset(&mut self, dataset: &hdf5_reader::Dataset, path: &str) -> Result<Dataset, ReadError> {
        self.count(1, path)?;
        let attributes = self.attributes(&dataset.attributes(), path)?;
        let shape = lengths(dataset.shape(), path)?;
        let header =
            self.file.get_or_parse_header(dataset.address()).map_err(|error| ReadError::encoding(path, error))?;
        encoding::of_dataset(dataset, &header, path, &mut self.unusual);
        self.chunks.take(self.file, &header, shape.len(), path);
        let data = match encoding::unreadable(&header) {
            Some(why) => Data::Other(why),
            None => self.values(dataset, &header, &shape, path)?,
        };
        let is_scale = attributes.get("CLASS").and_then(Array::as_text) == Some("DIMENSION_SCALE");
        Ok(Dataset { attributes, is_scale, ..Dataset::new(Array { shape, data }) })
    }

    fn values(
        &mut self,
        dataset: &hdf5_reader::Dataset,
        header: &ObjectHeader,
        shape: &[usize],
        path: &str,
    ) -> Result<Data, ReadError> {
        let failed = |error: Error| ReadError::encoding(path, error);
        let kind = dataset.dtype();
        if is_string(kind) {
            let width = hdf5_reader::dtype_element_size(kind).map_err(failed)?.max(1);
            self.spend(dataset.num_elements().map_err(failed)?, width, path)?;
            return dataset.read_strings().map(Data::Text).map_err(failed);
        }
        macro_rules! read {
            ($($variant:ident: $type:ty),+) => {
                match type_of(kind) {
                    $(Some(Numeric::$variant) => {
                        self.spend(dataset.num_elements().map_err(failed)?, size_of::<$type>(), path)?;
                        let placed = self.chunks.0.get(path);
                        if let Some(values) = chunks::values::<$type>(self.bytes, header, kind, placed, shape) {
                            return Ok(Data::$variant(values.into()));
                        }
                        let array = dataset.read_array_uncached_parallel::<$type>().map_err(failed)?;
                        Ok(Data::$variant(array.into_raw_vec_and_offset().0.into()))
                    })+
                    None => Ok(Data::Other(format!("{kind:?}"))),
                }
            };
        }
        read!(U8: u8, U16: u16, U32: u32, U64: u64, I8: i8, I16: i16, I32: i32, I64: i64, F32: f32, F64: f64)
    }

    fn attributes(&mut self, attributes: &[Attribute], path: &str) -> Result<Attributes, ReadError> {
        self.count(attributes.len() as u64, path)?;
        encoding::of_attributes(attributes, path, &mut self.unusual);
        let read = |attribute: &Attribute| {
            let path = format!("{path}@{}", attribute.name);
            Ok((attribute.name.clone(), attribute_array(attribute, &path)?))
        };
        attributes.iter().map(read).collect()
    }

    fn count(&mut self, objects: u64, path: &str) -> Result<(), ReadError> {
        self.objects += objects;
        within("groups, datasets and attributes", self.objects, self.limits.objects, path)
    }

    /// Takes the decoded size of an array from what the file may still decode to.
    fn spend(&mut self, elements: u64, width: usize, path: &str) -> Result<(), ReadError> {
        let bytes = elements.saturating_mul(width as u64);
        within(
            "decoded bytes",
            bytes.saturating_add(self.decoded_limit - self.decoded_left),
            self.decoded_limit,
            path,
        )?;
        self.decoded_left -= bytes;
        Ok(())
    }
}

fn last_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

fn lengths(shape: &[u64], path: &str) -> Result<Vec<usize>, ReadError> {
    let length = |length: &u64| {
        usize::try_from(*length).map_err(|_| ReadError::unexpected(path, format!("an axis of {length}"), "less"))
    };
    shape.iter().map(length).collect()
}

fn attribute_array(attribute: &Attribute, path: &str) -> Result<Array, ReadError> {
    let failed = |error: Error| ReadError::encoding(path, error);
    let shape = lengths(&attribute.shape, path)?;
    let data = if is_string(&attribute.datatype) {
        let empty = attribute.shape.contains(&0);
        Data::Text(if empty { Vec::new() } else { attribute.read_strings().map_err(failed)? })
    } else {
        macro_rules! read {
            ($($variant:ident: $type:ty),+) => {
                match type_of(&attribute.datatype) {
                    $(Some(Numeric::$variant) => Data::$variant(attribute.read_1d::<$type>().map_err(failed)?.into()),)+
                    None => Data::Other(format!("{:?}", attribute.datatype)),
                }
            };
        }
        read!(U8: u8, U16: u16, U32: u32, U64: u64, I8: i8, I16: i16, I32: i32, I64: i64, F32: f32, F64: f64)
    };
    Ok(Array { shape, data })
}

enum Numeric {
    U8,
    U16,
    U32,
    U64,
    I8,
    I16,
    I32,
    I64,
    F32,
    F64,
}

fn type_of(kind: &Datatype) -> Option<Numeric> {
    Some(match kind {
        Datatype::FixedPoint { size: 1, signed: false, .. } => Numeric::U8,
        Datatype::FixedPoint { size: 2, signed: false, .. } => Numeric::U16,
        Datatype::FixedPoint { size: 4, signed: false, .. } => Numeric::U32,
        Datatype::FixedPoint { size: 8, signed: false, .. } => Numeric::U64,
        Datatype::FixedPoint { size: 1, signed: true, .. } => Numeric::I8,
        Datatype::FixedPoint { size: 2, signed: true, .. } => Numeric::I16,
        Datatype::FixedPoint { size: 4, signed: true, .. } => Numeric::I32,
        Datatype::FixedPoint { size: 8, signed: true, .. } => Numeric::I64,
        Datatype::FloatingPoint { size: 4, .. } => Numeric::F32,
        Datatype::FloatingPoint { size: 8, .. } => Numeric::F64,
        _ => return None,
    })
}

fn is_string(kind: &Datatype) -> bool {
    match kind {
        Datatype::String { size: StringSize::Fixed(_) | StringSize::Variable, .. } => true,
        Datatype::VarLen { kind, .. } => matches!(kind, hdf5_reader::VarLenKind::String),
        _ => false,
    }
}
