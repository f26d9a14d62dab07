//! Opening a file: read the tree, decode the document, compare the digests.

use std::collections::BTreeMap;
use std::path::Path;

use super::decode::decode;
use super::digest::{Digest, of_objects, of_tree};
use super::encode::encode;
use super::error::ReadError;
use super::layout::{self, is_outside_digest, name};
use super::limits::Limits;
use super::read::from_bytes;
use super::tree::{Array, Attributes, Group, Object};
use crate::dataset::{Document, Place};

/// A document as it was found in a file.
#[derive(Debug, Clone)]
pub struct Opened {
    /// The document.
    pub document: Document,
    /// The digest that the file states.
    pub stored_digest: Option<String>,
    /// The digest of the document.
    pub computed_digest: Digest,
    /// Paths of content that the standard does not know; `@` precedes an attribute.
    pub unknown: Vec<String>,
    /// Paths of content that is not what the digests or the standard say, with what is wrong.
    pub mismatched: Vec<String>,
}

/// Reads a file within the default [`Limits`], whether or not its digests agree.
///
/// # Errors
/// [`ReadError`] with the place; nothing of a file is returned when anything in it cannot be read.
pub fn read_file(path: &Path) -> Result<Opened, ReadError> {
    let name = path.display().to_string();
    let bytes =
        std::fs::read(path).map_err(|source| ReadError::Io { place: Box::new(Place::file(name.clone())), source })?;
    read_bytes(&bytes, &Limits::default()).map_err(|error| error.in_file(&name))
}

/// Reads the bytes of a file.
///
/// # Errors
/// As [`read_file`].
pub fn read_bytes(bytes: &[u8], limits: &Limits) -> Result<Opened, ReadError> {
    let tree = from_bytes(bytes, limits)?;
    let document = decode(&tree)?;
    document.check().map_err(|source| ReadError::Document { place: Box::default(), source })?;
    let canonical =
        encode(&document).map_err(|error| ReadError::unexpected("/", error.to_string(), "a storable document"))?;
    let computed_digest = of_tree(&canonical);
    let stored_digest = stored_text(&tree.attributes, name::DIGEST);
    Ok(Opened {
        mismatched: mismatched(&tree, &canonical, &computed_digest, stored_digest.as_deref()),
        unknown: unknown(&tree),
        document,
        stored_digest,
        computed_digest,
    })
}

/// Reads a file whose content has the digests stored with it.
///
/// # Errors
/// As [`read_file`]; and [`ReadError::Damaged`], naming what differs, where a digest is missing or does not agree.
pub fn open_verified(path: &Path) -> Result<Document, ReadError> {
    let opened = read_file(path)?;
    if opened.mismatched.is_empty() {
        return Ok(opened.document);
    }
    let place = Box::new(Place::file(path.display().to_string()));
    Err(ReadError::Damaged { place, mismatched: opened.mismatched })
}

/// The raw tree of a file, for rules that look at what cannot be decoded.
///
/// # Errors
/// [`ReadError`] when the bytes are no HDF5, damaged, or beyond the limits.
pub fn read_tree(bytes: &[u8], limits: &Limits) -> Result<Group, ReadError> {
    from_bytes(bytes, limits)
}

fn stored_text(attributes: &Attributes, name: &str) -> Option<String> {
    attributes.get(name).and_then(Array::as_text).map(str::to_owned)
}

/// Everything that is not as it was written: digests that disagree, and content that differs from what the decoded
/// document would be written as.
fn mismatched(tree: &Group, canonical: &Group, computed: &Digest, stored: Option<&str>) -> Vec<String> {
    let digests: BTreeMap<String, String> = of_objects(canonical).into_iter().collect();
    let mut found = objects(tree);
    let mut wrong = Vec::new();
    canonical.visit("", &mut |path, expected| match found.remove(path) {
        None => wrong.push(format!("{path}: missing")),
        Some(object) => compare(path, object, expected, &digests, &mut wrong),
    });
    match stored {
        None => wrong.push(format!("/@{}: missing", name::DIGEST)),
        Some(stored) if stored != computed.as_str() => {
            wrong.push(format!("/@{}: stored {stored}, the content has {computed}", name::DIGEST));
        }
        Some(_) => {}
    }
    wrong
}

fn objects(tree: &Group) -> BTreeMap<String, Object<'_>> {
    let mut objects = BTreeMap::new();
    tree.visit("", &mut |path, object| {
        objects.insert(path.to_owned(), object);
    });
    objects
}

fn compare(
    path: &str,
    object: Object<'_>,
    expected: Object<'_>,
    digests: &BTreeMap<String, String>,
    wrong: &mut Vec<String>,
) {
    match stored_text(object.attributes(), name::SHA256) {
        None => wrong.push(format!("{path}@{}: missing", name::SHA256)),
        Some(stored) if digests.get(path) != Some(&stored) => {
            wrong.push(format!("{path}: the content does not have its stored digest"));
        }
        Some(_) => {}
    }
    for (name, expected) in expected.attributes() {
        let same = object.attributes().get(name).is_some_and(|found| found.same_values(expected));
        if !same && !is_empty_text(object.attributes().get(name), expected) {
            wrong.push(format!("{path}@{name}: not what the standard gives it"));
        }
    }
}

/// netCDF writes an empty text as an array without elements.
fn is_empty_text(found: Option<&Array>, expected: &Array) -> bool {
    expected.as_text() == Some("") && found.is_some_and(|found| found.data.is_empty())
}

/// Objects and attributes that the table of the standard does not have.
fn unknown(tree: &Group) -> Vec<String> {
    let mut unknown = Vec::new();
    tree.visit("", &mut |path, object| {
        if path != "/" && layout::find(path).is_none() {
            unknown.push(path.to_owned());
            return;
        }
        let attributes = object.attributes().keys().filter(|name| !is_outside_digest(name));
        let paths = attributes.map(|name| format!("{path}@{name}"));
        unknown.extend(paths.filter(|path| layout::find(path).is_none()));
    });
    unknown
}
