//! Some rows of one measurement, without the rest of the file: only the chunks that hold them are read and decoded.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use hdf5_reader::storage::{FileStorage, Storage, StorageBuffer};
use hdf5_reader::{Hdf5File, SliceInfo, SliceInfoElem};

use super::super::decode::{decode_rows, measurement, version};
use super::super::error::ReadError;
use super::super::layout::name;
use super::super::limits::Limits;
use super::super::open::is_later;
use super::super::tree::{Array, Data, Dataset, Group};
use super::{Walk, last_name, lengths, options};
use crate::dataset::{Acquisition, Id, Measurement, Place};

/// The matrices of a measurement, row by emission value: everything else of it is small.
const MATRICES: [&str; 3] = [name::VALUE, name::VALUE_U, name::VALUE_FLAG];

/// Some rows of a measurement.
#[derive(Debug, Clone)]
pub struct Part {
    /// The measurement with these rows alone. Its derivation, which tells of all rows, is left out.
    pub measurement: Measurement,
    /// The version of the standard that the file states, where this program does not know it.
    pub later_version: Option<String>,
    /// Bytes of the file that were read.
    pub bytes_read: u64,
    /// Bytes of the file.
    pub file_bytes: u64,
}

/// Reads the rows of a measurement that are chosen by their index and acquisition. The checksums of what is read are
/// checked; the digests, which are of whole arrays, are not.
///
/// # Errors
/// [`ReadError`] when there is no such measurement, or what is read of it is damaged or no measurement.
pub fn read_part(path: &Path, id: &str, choose: impl Fn(usize, &Acquisition) -> bool) -> Result<Part, ReadError> {
    let name = path.display().to_string();
    part(path, id, &choose).map_err(|error| error.in_file(&name))
}

fn part(path: &Path, id: &str, choose: &dyn Fn(usize, &Acquisition) -> bool) -> Result<Part, ReadError> {
    let storage = FileStorage::open(path).map_err(|error| ReadError::encoding("/", error))?;
    let (file_bytes, limits) = (storage.len(), Limits::default());
    let counted = Arc::new(Counted { storage, read: AtomicU64::new(0) });
    let file = Hdf5File::from_storage_with_options(Arc::clone(&counted) as _, options(file_bytes, &limits))
        .map_err(|error| ReadError::encoding("/", error))?;
    let mut walk = Walk::new(&file, &[], &limits, file_bytes);
    let root = file.root_group().map_err(|error| ReadError::encoding("/", error))?;
    let attributes = walk.attributes(&root.attributes().map_err(|error| ReadError::encoding("/", error))?, "/")?;
    let later_version = attributes.get(name::BBRF_VERSION).and_then(Array::as_text).filter(|version| is_later(version));
    let later_version = later_version.map(str::to_owned);
    version(&Group { attributes, ..Group::default() })?;
    let place = format!("/{}/{id}", name::MEASUREMENT);
    let failed = |error| ReadError::encoding(&place, error);
    let parsed = Id::new(id).map_err(|error| ReadError::unexpected(&place, error.to_string(), "an identifier"))?;
    let list = root.group(name::MEASUREMENT).map_err(failed)?;
    let group = list.group(id).map_err(|_| ReadError::missing(&place, "a measurement of that id"))?;
    let mut tree =
        Group { attributes: walk.attributes(&group.attributes().map_err(failed)?, &place)?, ..Group::default() };
    let (_, datasets) = group.members().map_err(failed)?;
    let (matrices, small): (Vec<_>, Vec<_>) =
        datasets.iter().partition(|dataset| MATRICES.contains(&last_name(dataset.name())));
    for dataset in small {
        let name = last_name(dataset.name());
        tree.datasets.push((name.to_owned(), walk.dataset(dataset, &format!("{place}/{name}"))?));
    }
    let rows = decode_rows(&place, &tree)?;
    let chosen: Vec<usize> = rows.iter().enumerate().filter(|(k, row)| choose(*k, row)).map(|(k, _)| k).collect();
    for dataset in matrices {
        let name = last_name(dataset.name());
        let cut = walk.rows(dataset, &chosen, rows.len(), &format!("{place}/{name}"))?;
        tree.datasets.push((name.to_owned(), cut));
    }
    let mut measurement = measurement(parsed, &place, &tree)?;
    measurement.acquisitions = chosen.iter().filter_map(|row| rows.get(*row).cloned()).collect();
    measurement.direction_tests.retain_mut(|test| {
        let position = chosen.iter().position(|row| *row == test.row as usize);
        test.row = position.and_then(|position| u32::try_from(position).ok()).unwrap_or(test.row);
        position.is_some()
    });
    measurement
        .check_shape()
        .map_err(|error| ReadError::Document { place: Box::new(Place::path(place.as_str())), source: error.into() })?;
    Ok(Part { measurement, later_version, bytes_read: counted.read.load(Ordering::Relaxed), file_bytes })
}

/// A file that counts what is read of it.
struct Counted {
    storage: FileStorage,
    read: AtomicU64,
}

impl Storage for Counted {
    fn len(&self) -> u64 {
        self.storage.len()
    }

    fn read_range(&self, offset: u64, length: usize) -> hdf5_reader::error::Result<StorageBuffer> {
        self.read.fetch_add(length as u64, Ordering::Relaxed);
        self.storage.read_range(offset, length)
    }
}

impl Walk<'_> {
    /// The chosen rows of a matrix that has so many.
    fn rows(
        &mut self,
        dataset: &hdf5_reader::Dataset,
        chosen: &[usize],
        rows: usize,
        path: &str,
    ) -> Result<Dataset, ReadError> {
        let attributes = self.attributes(&dataset.attributes(), path)?;
        let shape = lengths(dataset.shape(), path)?;
        let [found, columns] = shape[..] else {
            return Err(ReadError::unexpected(path, format!("shape {shape:?}"), "two axes"));
        };
        if found != rows {
            return Err(ReadError::unexpected(path, format!("{found} rows"), format!("{rows} (one per acquisition)")));
        }
        self.spend((chosen.len() as u64).saturating_mul(columns as u64), 8, path)?;
        let data = match super::type_of(dataset.dtype()) {
            Some(super::Numeric::F64) => Data::F64(runs::<f64>(dataset, chosen, columns, path)?.into()),
            Some(super::Numeric::F32) => Data::F32(runs::<f32>(dataset, chosen, columns, path)?.into()),
            Some(super::Numeric::U16) => Data::U16(runs::<u16>(dataset, chosen, columns, path)?.into()),
            Some(super::Numeric::I32) => Data::I32(runs::<i32>(dataset, chosen, columns, path)?.into()),
            Some(super::Numeric::I64) => Data::I64(runs::<i64>(dataset, chosen, columns, path)?.into()),
            _ => return Err(ReadError::unexpected(path, format!("{:?}", dataset.dtype()), "numbers")),
        };
        Ok(Dataset { attributes, ..Dataset::new(Array { shape: vec![chosen.len(), columns], data }) })
    }
}

/// The values of rows, each run of neighbours in one read.
fn runs<T: hdf5_reader::H5Type + Clone>(
    dataset: &hdf5_reader::Dataset,
    chosen: &[usize],
    columns: usize,
    path: &str,
) -> Result<Vec<T>, ReadError> {
    let mut values = Vec::with_capacity(chosen.len() * columns);
    let range = |start: usize, end: usize| SliceInfoElem::Slice { start: start as u64, end: end as u64, step: 1 };
    for run in chosen.chunk_by(|a, b| a + 1 == *b) {
        let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
        let selection = SliceInfo { selections: vec![range(*first, last + 1), range(0, columns)] };
        let read = dataset.read_slice::<T>(&selection).map_err(|error| ReadError::encoding(path, error))?;
        values.extend(read.iter().cloned());
    }
    Ok(values)
}
