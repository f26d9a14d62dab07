//! A tree as the bytes of an HDF5 file, through libhdf5.
//!
//! The file is built in memory and reaches the disk through [`replace`](super::replace) like every other output: a full
//! disk is then an ordinary error, and the same tree gives the same bytes wherever they go.

pub(super) mod chunks;
mod library;
mod raw;

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

use super::digest::Digests;
use super::error::WriteError;
use super::layout::name;
use super::storing::Storing;
use super::tree::{Array, Attributes, Data, Dataset, Group};
use chunks::{Chunk, Source};
use library::{Handle, Storage, exclusively, memory_file};
use raw::Raw;

/// What goes into a file beside the tree.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan<'a> {
    /// Where chunks come from.
    pub(super) source: Source<'a>,
    /// The digests with which objects are signed that are not yet.
    pub(super) digests: Option<&'a Digests>,
    /// How values are laid down.
    pub(super) storing: Storing,
}

/// The bytes of the file that holds a tree.
///
/// # Errors
/// [`WriteError::Library`] when libhdf5 refuses something.
pub(super) fn to_bytes(root: &Group, plan: Plan<'_>) -> Result<Vec<u8>, WriteError> {
    with_image(root, plan, <[u8]>::to_vec)
}

/// The same bytes for one look, without a copy of them.
///
/// # Errors
/// As [`to_bytes`].
pub(super) fn with_image<R>(root: &Group, plan: Plan<'_>, look: impl FnOnce(&[u8]) -> R) -> Result<R, WriteError> {
    // Over all cores, and therefore before the library is taken.
    let mut chunks = HashMap::new();
    prepare(root, "", &plan, &mut chunks)?;
    let made = Made { digests: plan.digests, storing: plan.storing, chunks };
    exclusively(|| {
        let file = memory_file()?;
        write_group(&file, root, "", &made)?;
        file.image(look)
    })
}

/// What was made of a tree before it is written.
struct Made<'a> {
    digests: Option<&'a Digests>,
    storing: Storing,
    /// The chunks of every dataset that has any, by its path.
    chunks: HashMap<String, Vec<Chunk<'a>>>,
}

/// Makes the chunks of all datasets.
fn prepare<'a>(
    group: &Group,
    path: &str,
    plan: &Plan<'a>,
    made: &mut HashMap<String, Vec<Chunk<'a>>>,
) -> Result<(), WriteError> {
    for (name, dataset) in &group.datasets {
        let path = format!("{path}/{name}");
        let Storage { chunk: Some(shape), nan_fill, .. } = storage(group, name, dataset, plan.storing) else {
            continue;
        };
        let refused = |operation| WriteError::Library { operation, path: path.clone() };
        let raw = Raw::of(&dataset.array.data).ok_or_else(|| refused("a type without values"))?;
        let fill = match &dataset.array.data {
            Data::F64(_) if nan_fill => f64::NAN.to_le_bytes().to_vec(),
            Data::F32(_) if nan_fill => f32::NAN.to_le_bytes().to_vec(),
            _ => vec![0; raw.width],
        };
        let level = plan.storing.compression;
        let encoded = chunks::chunks((plan.source, level), &path, &raw.bytes, &fill, &shape);
        let encoded = encoded.ok_or_else(|| refused("other chunks than these"))?;
        made.insert(path, encoded);
    }
    group.groups.iter().try_for_each(|(name, child)| prepare(child, &format!("{path}/{name}"), plan, made))
}

fn write_group(target: &Handle, group: &Group, path: &str, plan: &Made<'_>) -> Result<(), WriteError> {
    write_attributes(target, &plan.signed(&group.attributes, if path.is_empty() { "/" } else { path }))?;
    // Ordered, because the library writes an object when it is closed: any order, but the same every time.
    let mut datasets = BTreeMap::new();
    for (name, dataset) in &group.datasets {
        datasets.insert(name.as_str(), write_dataset(target, group, &format!("{path}/{name}"), name, dataset, plan)?);
    }
    for (name, dataset) in &group.datasets {
        for (axis, scale) in (0_u32..).zip(&dataset.axes) {
            if let (Some(target), Some(scale)) = (datasets.get(name.as_str()), datasets.get(scale.as_str())) {
                target.attach_scale(axis, scale)?;
            }
        }
    }
    drop(datasets);
    for (name, child) in &group.groups {
        write_group(&target.create_group(name)?, child, &format!("{path}/{name}"), plan)?;
    }
    Ok(())
}

fn write_dataset(
    target: &Handle,
    group: &Group,
    path: &str,
    name: &str,
    dataset: &Dataset,
    plan: &Made<'_>,
) -> Result<Handle, WriteError> {
    let storage = storage(group, name, dataset, plan.storing);
    let chunks = plan.chunks.get(path).map_or(&[][..], Vec::as_slice);
    let written = target.create_dataset(name, &dataset.array, &storage, chunks)?;
    if dataset.is_scale {
        written.make_scale(name)?;
    }
    if storage.nan_fill {
        let nan = match &dataset.array.data {
            Data::F32(_) => Data::F32(vec![f32::NAN].into()),
            _ => Data::F64(vec![f64::NAN].into()),
        };
        written.write_attribute("_FillValue", &Array::scalar(nan))?;
    }
    write_attributes(&written, &plan.signed(&dataset.attributes, path))?;
    Ok(written)
}

fn storage(group: &Group, name: &str, dataset: &Dataset, storing: Storing) -> Storage {
    let is_float = matches!(dataset.array.data, Data::F32(_) | Data::F64(_));
    let nan_fill = is_float && !dataset.is_scale && !is_coordinate(group, name);
    Storage { chunk: chunk(&dataset.array, storing.chunk_bytes), compression: storing.compression, nan_fill }
}

impl Made<'_> {
    /// The attributes of an object with its digest.
    fn signed<'b>(&self, attributes: &'b Attributes, path: &str) -> Cow<'b, Attributes> {
        let Some(digests) = self.digests else { return Cow::Borrowed(attributes) };
        let mut signed = attributes.clone();
        signed.extend(digests.attributes(path));
        Cow::Owned(signed)
    }
}

fn write_attributes(target: &Handle, attributes: &Attributes) -> Result<(), WriteError> {
    attributes.iter().try_for_each(|(name, array)| target.write_attribute(name, array))
}

/// True where another dataset of the group names this one among its coordinates; CF forbids fill values there.
fn is_coordinate(group: &Group, name: &str) -> bool {
    let lists = group.datasets.iter().filter_map(|(_, dataset)| dataset.attributes.get(name::COORDINATES));
    lists.filter_map(Array::as_text).any(|list| list.split(' ').any(|member| member == name))
}

/// Whole rows, so that a geometry is one piece; an array without values cannot be cut into chunks.
fn chunk(array: &Array, bytes: usize) -> Option<Vec<usize>> {
    if array.shape.is_empty() || array.data.is_empty() {
        return None;
    }
    let row: usize = array.shape.iter().skip(1).product();
    let rows = (bytes / 8 / row.max(1)).clamp(1, array.shape[0]);
    let mut chunk = array.shape.clone();
    chunk[0] = rows;
    Some(chunk)
}
