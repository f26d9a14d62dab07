//! The calls of libhdf5 that a file needs, behind safe functions.
//!
//! They go to the C functions directly: the safe Rust layer over libhdf5 has neither fixed-length UTF-8 attributes nor
//! dimension scales, and with those two in hand little would be left for it to do.
#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_void};
use std::ptr;

use hdf5_reader::checksum::jenkins_lookup3;
use hdf5_sys::{h5, h5a, h5d, h5e, h5f, h5g, h5i::hid_t, h5p, h5s, h5t};

use super::super::error::WriteError;
use super::super::tree::{Array, Data};
use super::chunks::Chunk;
use super::raw::Raw;

#[link(name = "hdf5_hl", kind = "static")]
unsafe extern "C" {
    fn H5DSset_scale(dataset: hid_t, name: *const c_char) -> i32;
    fn H5DSattach_scale(dataset: hid_t, scale: hid_t, axis: u32) -> i32;
}

/// Attributes and links beyond this number leave the object's header; the default of 8 costs kilobytes per object.
const MAX_COMPACT: u32 = 64;
/// Bytes by which the file in memory grows.
const GROWTH: usize = 1 << 20;

/// An open object of libhdf5, closed when dropped.
pub(super) struct Handle {
    id: hid_t,
    path: String,
    close: unsafe extern "C" fn(hid_t) -> i32,
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: `id` came from the library, is closed once, and `close` is the function of its kind.
        unsafe { (self.close)(self.id) };
    }
}

/// How the values of a dataset lie in the file.
pub(super) struct Storage {
    /// Lengths of a chunk; `None` keeps the values in one piece.
    pub(super) chunk: Option<Vec<usize>>,
    /// Level of deflate.
    pub(super) compression: u32,
    /// True for data that may be missing: what is not written reads as NaN.
    pub(super) nan_fill: bool,
}

fn refused(operation: &'static str, path: &str) -> WriteError {
    WriteError::Library { operation, path: path.to_owned() }
}

/// Runs with the library to itself: libhdf5 keeps global state. Nothing inside may wait for other threads, which may be
/// waiting for the library.
pub(super) fn exclusively<T>(run: impl FnOnce() -> T) -> T {
    let _guard = hdf5_sys::LOCK.lock();
    // SAFETY: the lock is held; both calls only set up the library, and may be repeated.
    unsafe {
        h5::H5open();
        h5e::H5Eset_auto2(h5e::H5E_DEFAULT, None, ptr::null_mut());
    }
    run()
}

/// Turns what the library returns into a handle or an error.
fn handle(
    id: hid_t,
    close: unsafe extern "C" fn(hid_t) -> i32,
    operation: &'static str,
    path: &str,
) -> Result<Handle, WriteError> {
    if id < 0 { Err(refused(operation, path)) } else { Ok(Handle { id, path: path.to_owned(), close }) }
}

fn done(status: i32, operation: &'static str, path: &str) -> Result<(), WriteError> {
    if status < 0 { Err(refused(operation, path)) } else { Ok(()) }
}

fn c_name(name: &str) -> Result<CString, WriteError> {
    CString::new(name).map_err(|_| refused("a name with U+0000", name))
}

/// A new file in memory; nothing of it touches the disk.
pub(super) fn memory_file() -> Result<Handle, WriteError> {
    let name = c_name("bbrf")?;
    // SAFETY: the lists are open for as long as they are used; the name ends with NUL.
    unsafe {
        let access = handle(h5p::H5Pcreate(*h5p::H5P_CLS_FILE_ACCESS), h5p::H5Pclose, "H5Pcreate", "/")?;
        done(h5p::H5Pset_fapl_core(access.id, GROWTH, 0), "H5Pset_fapl_core", "/")?;
        let (low, high) = (h5f::H5F_libver_t::H5F_LIBVER_V18, h5f::H5F_libver_t::H5F_LIBVER_V110);
        done(h5p::H5Pset_libver_bounds(access.id, low, high), "H5Pset_libver_bounds", "/")?;
        let create = handle(h5p::H5Pcreate(*h5p::H5P_CLS_FILE_CREATE), h5p::H5Pclose, "H5Pcreate", "/")?;
        set_up_group(&create)?;
        let file = h5f::H5Fcreate(name.as_ptr(), h5f::H5F_ACC_TRUNC, create.id, access.id);
        handle(file, h5f::H5Fclose, "H5Fcreate", "")
    }
}

/// No times, creation order of members and attributes, everything in the header.
fn set_up_group(list: &Handle) -> Result<(), WriteError> {
    let order = h5p::H5P_CRT_ORDER_TRACKED | h5p::H5P_CRT_ORDER_INDEXED;
    // SAFETY: `list` is an open creation list of a group.
    unsafe {
        done(h5p::H5Pset_link_creation_order(list.id, order), "H5Pset_link_creation_order", &list.path)?;
        done(
            h5p::H5Pset_link_phase_change(list.id, MAX_COMPACT, MAX_COMPACT / 2),
            "H5Pset_link_phase_change",
            &list.path,
        )?;
    }
    set_up_object(list)
}

fn set_up_object(list: &Handle) -> Result<(), WriteError> {
    let order = h5p::H5P_CRT_ORDER_TRACKED | h5p::H5P_CRT_ORDER_INDEXED;
    // SAFETY: `list` is an open creation list of a group or dataset.
    unsafe {
        done(h5p::H5Pset_obj_track_times(list.id, 0), "H5Pset_obj_track_times", &list.path)?;
        done(h5p::H5Pset_attr_creation_order(list.id, order), "H5Pset_attr_creation_order", &list.path)?;
        let status = h5p::H5Pset_attr_phase_change(list.id, MAX_COMPACT, MAX_COMPACT / 2);
        done(status, "H5Pset_attr_phase_change", &list.path)
    }
}

impl Handle {
    /// A look at the bytes of a file in memory: those of `H5Fget_file_image`, which copies them and clears the marks of an
    /// open file. Here the marks are cleared where they are.
    pub(super) fn image<R>(&self, look: impl FnOnce(&[u8]) -> R) -> Result<R, WriteError> {
        // SAFETY: a null buffer asks for the size. The handle of a file of the core driver is the address of its pointer
        // to its memory, which holds at least the allocated size after a flush and stays as it is during the look,
        // because no other call of the library runs.
        unsafe {
            done(h5f::H5Fflush(self.id, h5f::H5F_scope_t::H5F_SCOPE_GLOBAL), "H5Fflush", "/")?;
            let size = h5f::H5Fget_file_image(self.id, ptr::null_mut(), 0);
            let size = usize::try_from(size).map_err(|_| refused("H5Fget_file_image", "/"))?;
            let mut memory: *mut c_void = ptr::null_mut();
            done(h5f::H5Fget_vfd_handle(self.id, h5p::H5P_DEFAULT, &raw mut memory), "H5Fget_vfd_handle", "/")?;
            let memory = memory.cast::<*mut u8>();
            if memory.is_null() || (*memory).is_null() {
                return Err(refused("H5Fget_vfd_handle", "/"));
            }
            let image = std::slice::from_raw_parts_mut(*memory, size);
            clear_marks(image).ok_or_else(|| refused("superblock", "/"))?;
            Ok(look(image))
        }
    }

    /// A new group in this file or group.
    pub(super) fn create_group(&self, name: &str) -> Result<Handle, WriteError> {
        let (path, c_name) = (format!("{}/{name}", self.path), c_name(name)?);
        // SAFETY: `self` is an open file or group, the list is open, the name ends with NUL.
        unsafe {
            let list = handle(h5p::H5Pcreate(*h5p::H5P_CLS_GROUP_CREATE), h5p::H5Pclose, "H5Pcreate", &path)?;
            set_up_group(&list)?;
            let group = h5g::H5Gcreate2(self.id, c_name.as_ptr(), h5p::H5P_DEFAULT, list.id, h5p::H5P_DEFAULT);
            handle(group, h5g::H5Gclose, "H5Gcreate", &path)
        }
    }

    /// A new dataset in this file or group, with its values: in one piece, or in the chunks that were made of them.
    pub(super) fn create_dataset(
        &self,
        name: &str,
        array: &Array,
        storage: &Storage,
        chunks: &[Chunk<'_>],
    ) -> Result<Handle, WriteError> {
        let (path, c_name) = (format!("{}/{name}", self.path), c_name(name)?);
        let (raw, kind) = element(&array.data, &path)?;
        let space = space(&array.shape, &path)?;
        let list = creation_list(storage, &array.data, &path)?;
        // SAFETY: every id is open; the buffer holds as many elements of the type as the space.
        unsafe {
            let default = h5p::H5P_DEFAULT;
            let dataset = h5d::H5Dcreate2(self.id, c_name.as_ptr(), kind.id, space.id, default, list.id, default);
            let dataset = handle(dataset, h5d::H5Dclose, "H5Dcreate", &path)?;
            if let Some(shape) = &storage.chunk {
                dataset.write_chunks(chunks, shape.len())?;
                return Ok(dataset);
            }
            let all = h5s::H5S_ALL;
            let status = h5d::H5Dwrite(dataset.id, kind.id, all, all, default, raw.bytes.as_ptr().cast());
            done(status, "H5Dwrite", &path)?;
            Ok(dataset)
        }
    }

    /// Writes the values of this dataset as chunks that are encoded already.
    fn write_chunks(&self, chunks: &[Chunk<'_>], axes: usize) -> Result<(), WriteError> {
        for chunk in chunks {
            let mut offset = vec![0_u64; axes];
            offset[0] = chunk.first_row;
            // SAFETY: `self` is an open chunked dataset, `offset` has an entry for each axis, the buffer its length.
            let status = unsafe {
                h5d::H5Dwrite_chunk(
                    self.id,
                    h5p::H5P_DEFAULT,
                    0,
                    offset.as_ptr(),
                    chunk.bytes.len(),
                    chunk.bytes.as_ptr().cast(),
                )
            };
            done(status, "H5Dwrite_chunk", &self.path)?;
        }
        Ok(())
    }

    /// A new attribute of this object.
    pub(super) fn write_attribute(&self, name: &str, array: &Array) -> Result<(), WriteError> {
        let (path, c_name) = (format!("{}@{name}", self.path), c_name(name)?);
        let (raw, kind) = element(&array.data, &path)?;
        let space = space(&array.shape, &path)?;
        // SAFETY: every id is open; the buffer holds as many elements of the type as the space.
        unsafe {
            let default = h5p::H5P_DEFAULT;
            let id = h5a::H5Acreate2(self.id, c_name.as_ptr(), kind.id, space.id, default, default);
            let attribute = handle(id, h5a::H5Aclose, "H5Acreate", &path)?;
            done(h5a::H5Awrite(attribute.id, kind.id, raw.bytes.as_ptr().cast()), "H5Awrite", &path)
        }
    }

    /// Makes this dataset a dimension scale of that name.
    pub(super) fn make_scale(&self, name: &str) -> Result<(), WriteError> {
        let c_name = c_name(name)?;
        // SAFETY: `self` is an open dataset, the name ends with NUL.
        done(unsafe { H5DSset_scale(self.id, c_name.as_ptr()) }, "H5DSset_scale", &self.path)
    }

    /// Attaches a scale to an axis of this dataset.
    pub(super) fn attach_scale(&self, axis: u32, scale: &Handle) -> Result<(), WriteError> {
        // SAFETY: both are open datasets.
        done(unsafe { H5DSattach_scale(self.id, scale.id, axis) }, "H5DSattach_scale", &self.path)
    }
}

/// Clears the marks of an open file in a superblock of version 2 (HDF5 File Format Specification, II.A) and sums it up
/// again. `None` for another superblock.
fn clear_marks(image: &mut [u8]) -> Option<()> {
    const VERSION: usize = 8;
    const MARKS: usize = 11;
    const CHECKSUM: usize = 44;
    (*image.get(VERSION)? == 2).then_some(())?;
    *image.get_mut(MARKS)? = 0;
    let sum = jenkins_lookup3(image.get(..CHECKSUM)?).to_le_bytes();
    image.get_mut(CHECKSUM..CHECKSUM + sum.len())?.copy_from_slice(&sum);
    Some(())
}

fn space(shape: &[usize], path: &str) -> Result<Handle, WriteError> {
    let lengths: Vec<u64> = shape.iter().map(|length| *length as u64).collect();
    // SAFETY: `lengths` has as many entries as the rank says.
    let id = unsafe {
        if shape.is_empty() {
            h5s::H5Screate(h5s::H5S_class_t::H5S_SCALAR)
        } else {
            h5s::H5Screate_simple(rank(shape), lengths.as_ptr(), ptr::null())
        }
    };
    handle(id, h5s::H5Sclose, "H5Screate", path)
}

/// The format's arrays have at most three axes.
fn rank(shape: &[usize]) -> i32 {
    i32::try_from(shape.len()).unwrap_or(i32::MAX)
}

fn creation_list(storage: &Storage, data: &Data, path: &str) -> Result<Handle, WriteError> {
    // SAFETY: the list is open; `chunk` has as many entries as the rank says; the fill value has the type named.
    unsafe {
        let list = handle(h5p::H5Pcreate(*h5p::H5P_CLS_DATASET_CREATE), h5p::H5Pclose, "H5Pcreate", path)?;
        set_up_object(&list)?;
        if storage.nan_fill {
            let status = match data {
                Data::F32(_) => {
                    let nan = f32::NAN.to_le_bytes();
                    h5p::H5Pset_fill_value(list.id, *h5t::H5T_IEEE_F32LE, nan.as_ptr().cast::<c_void>())
                }
                _ => {
                    let nan = f64::NAN.to_le_bytes();
                    h5p::H5Pset_fill_value(list.id, *h5t::H5T_IEEE_F64LE, nan.as_ptr().cast::<c_void>())
                }
            };
            done(status, "H5Pset_fill_value", path)?;
        }
        if let Some(chunk) = &storage.chunk {
            let lengths: Vec<u64> = chunk.iter().map(|length| *length as u64).collect();
            done(h5p::H5Pset_chunk(list.id, rank(chunk), lengths.as_ptr()), "H5Pset_chunk", path)?;
            done(h5p::H5Pset_shuffle(list.id), "H5Pset_shuffle", path)?;
            done(h5p::H5Pset_deflate(list.id, storage.compression), "H5Pset_deflate", path)?;
            done(h5p::H5Pset_fletcher32(list.id), "H5Pset_fletcher32", path)?;
        }
        Ok(list)
    }
}

/// The type of an element, of so many bytes where it is a text.
fn element_type(data: &Data, width: usize, path: &str) -> Result<Handle, WriteError> {
    let id = match data {
        Data::U8(_) => *h5t::H5T_STD_U8LE,
        Data::U16(_) => *h5t::H5T_STD_U16LE,
        Data::U32(_) => *h5t::H5T_STD_U32LE,
        Data::U64(_) => *h5t::H5T_STD_U64LE,
        Data::I8(_) => *h5t::H5T_STD_I8LE,
        Data::I16(_) => *h5t::H5T_STD_I16LE,
        Data::I32(_) => *h5t::H5T_STD_I32LE,
        Data::I64(_) => *h5t::H5T_STD_I64LE,
        Data::F32(_) => *h5t::H5T_IEEE_F32LE,
        Data::F64(_) => *h5t::H5T_IEEE_F64LE,
        Data::Text(_) => *h5t::H5T_C_S1,
        Data::Other(_) => return Err(refused("a type without values", path)),
    };
    // SAFETY: a copy of an open type, private and open while it is changed.
    unsafe {
        let kind = handle(h5t::H5Tcopy(id), h5t::H5Tclose, "H5Tcopy", path)?;
        if matches!(data, Data::Text(_)) {
            done(h5t::H5Tset_size(kind.id, width), "H5Tset_size", path)?;
            done(h5t::H5Tset_strpad(kind.id, h5t::H5T_str_t::H5T_STR_NULLPAD), "H5Tset_strpad", path)?;
            done(h5t::H5Tset_cset(kind.id, h5t::H5T_cset_t::H5T_CSET_UTF8), "H5Tset_cset", path)?;
        }
        Ok(kind)
    }
}

/// The bytes of an array with the type of its elements.
fn element<'a>(data: &'a Data, path: &str) -> Result<(Raw<'a>, Handle), WriteError> {
    let raw = Raw::of(data).ok_or_else(|| refused("a type without values", path))?;
    let kind = element_type(data, raw.width, path)?;
    Ok((raw, kind))
}
