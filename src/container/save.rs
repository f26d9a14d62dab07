//! Writing a document: encode, sign, check that it reads back, build, replace.

use std::io::Write;
use std::path::Path;

use super::decode::decode;
use super::digest::{Digest, Digests, of_tree, sign};
use super::encode::encode;
use super::error::{EncodeError, WriteError};
use super::foreign::Foreign;
use super::layout::name;
use super::replace::write_whole;
use super::storing::Storing;
use super::tree::{Data, Group};
use super::write::chunks::Source;
use super::write::{Plan, to_bytes};
use crate::dataset::Document;

/// Writes a document to a file, whole or not at all, and returns its digest.
///
/// # Errors
/// [`WriteError`]; the old file, if there was one, is then untouched.
pub fn write_file(document: &Document, path: &Path) -> Result<Digest, WriteError> {
    let (bytes, digest) = document_bytes(document)?;
    write_whole(path, |file| file.write_all(&bytes))
        .map_err(|source| WriteError::Io { path: path.to_owned(), source })?;
    Ok(digest)
}

/// The same for a document that was read from a file, with what that file holds beside the standard.
///
/// # Errors
/// As [`write_file`].
pub fn write_file_keeping(document: &Document, foreign: &Foreign, path: &Path) -> Result<(), WriteError> {
    write_file_storing(document, foreign, Storing::default(), path)
}

/// The same, laid down in another way.
///
/// # Errors
/// As [`write_file`].
pub fn write_file_storing(
    document: &Document,
    foreign: &Foreign,
    storing: Storing,
    path: &Path,
) -> Result<(), WriteError> {
    let bytes = rewrite_storing(document, foreign, storing)?;
    write_whole(path, |file| file.write_all(&bytes)).map_err(|source| WriteError::Io { path: path.to_owned(), source })
}

/// The bytes of a document with what its file held beside the standard.
///
/// # Errors
/// As [`document_bytes`].
pub fn rewrite(document: &Document, foreign: &Foreign) -> Result<Vec<u8>, WriteError> {
    rewrite_storing(document, foreign, Storing::default())
}

/// The same, laid down in another way.
///
/// # Errors
/// As [`document_bytes`].
pub fn rewrite_storing(document: &Document, foreign: &Foreign, storing: Storing) -> Result<Vec<u8>, WriteError> {
    let mut tree = encoded(document)?;
    let digests = Digests::of(&tree);
    if storing.single {
        // After the digests, which are those of the types of the layout.
        in_single(&mut tree);
    }
    foreign.put_into(&mut tree);
    to_bytes(&tree, Plan { source: Source::Values, digests: Some(&digests), storing: storing.in_range() })
}

/// Values of measurements and their uncertainties as numbers of 4 bytes, where that loses nothing.
fn in_single(tree: &mut Group) {
    let Some(measurements) = tree.group_mut(name::MEASUREMENT) else { return };
    for (_, measurement) in &mut measurements.groups {
        for name in [name::VALUE, name::VALUE_U] {
            let Some(array) = measurement.dataset_mut(name).map(|dataset| &mut dataset.array) else { continue };
            let Data::F64(values) = &array.data else { continue };
            let is_held = |value: &f64| f64::from(*value as f32).to_bits() == value.to_bits();
            if values.iter().all(is_held) {
                array.data = Data::F32(values.iter().map(|value| *value as f32).collect());
            }
        }
    }
}

/// The bytes of the file that [`write_file`] writes, with the digest of the document.
///
/// # Errors
/// [`WriteError`] when the document has no form in the standard or libhdf5 refuses.
pub fn document_bytes(document: &Document) -> Result<(Vec<u8>, Digest), WriteError> {
    let tree = encoded(document)?;
    let digests = Digests::of(&tree);
    let bytes = to_bytes(&tree, Plan { source: Source::Values, digests: Some(&digests), storing: Storing::default() })?;
    Ok((bytes, digests.document))
}

/// The bytes of a document as it is, for tests: unlike [`document_bytes`] this asks nothing of the document. `None` where
/// it has no form in the standard.
#[doc(hidden)]
#[must_use]
pub fn unchecked_bytes(document: &Document) -> Option<Vec<u8>> {
    let tree = encode(document).ok()?;
    let digests = Digests::of(&tree);
    to_bytes(&tree, Plan { source: Source::Values, digests: Some(&digests), storing: Storing::default() }).ok()
}

/// The tree of a consistent document, known to read back as the same document.
fn encoded(document: &Document) -> Result<Group, EncodeError> {
    document.check()?;
    let tree = encode(document)?;
    let read_back = decode(&tree).map_err(|error| EncodeError::NotReadBack(error.to_string()))?;
    if of_tree(&encode(&read_back)?) != of_tree(&tree) {
        return Err(EncodeError::NotReadBack("its content changes on the way".to_owned()));
    }
    Ok(tree)
}

/// The tree of a document without its digests, for tests that make faults in it.
///
/// # Errors
/// [`EncodeError`] where the document has no form in the standard.
#[doc(hidden)]
pub fn document_tree(document: &Document) -> Result<Group, EncodeError> {
    encode(document)
}

/// Puts the digests into any tree, for tests that need faulty files with right digests.
#[doc(hidden)]
pub fn sign_tree(tree: &mut Group) {
    sign(tree);
}

/// The bytes of the file that holds any tree, for tests that need faulty files.
///
/// # Errors
/// [`WriteError::Library`] when libhdf5 refuses.
#[doc(hidden)]
pub fn tree_bytes(tree: &Group) -> Result<Vec<u8>, WriteError> {
    to_bytes(tree, Plan { source: Source::Values, digests: None, storing: Storing::default() })
}
