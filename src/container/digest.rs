//! SHA-256 of the logical content: values and the attributes that the standard lists, whatever their encoding in a file.
//!
//! The digest of an object is SHA-256 over its kind (`group` or `dataset`), for a dataset its array, and its attributes
//! in the order of their names, each as name and array; without what other programs add and without descriptions. A text is its length in bytes (64 bit, little-endian) and its
//! UTF-8 bytes; an array is its element type as a text, the number of its axes and their lengths (64 bit), its values
//! (little-endian; NaN with its bits); in an attribute, an array of one value is a scalar. The digest of a document is SHA-256 over the lines `DIGEST PATH\n` of all its
//! objects, ordered by path.
//!
//! It is taken of the tree that a document is written as, so a copy through another program has the same digest.

use std::collections::BTreeMap;
use std::fmt;
use std::fmt::Write as _;

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use sha2::{Digest as _, Sha256};

use super::encode::{encode, encode_measurement};
use super::error::EncodeError;
#[cfg(feature = "write")]
use super::layout::name;
use super::layout::{is_description, is_outside_digest};
#[cfg(feature = "write")]
use super::tree::Array;
use super::tree::{Data, Group, Object};
use crate::dataset::{Document, Measurement};

/// The digest of a document or of one of its parts.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Digest(String);

impl Digest {
    /// The text form, `sha256:` and 64 hexadecimal digits.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The digest of a document.
///
/// # Errors
/// [`EncodeError`] where the document has no form in the standard.
pub fn digest(document: &Document) -> Result<Digest, EncodeError> {
    Ok(of_tree(&encode(document)?))
}

/// The digest of a measurement, whatever its id and its place in a document. A model keeps that of the data it was
/// fitted to.
///
/// # Errors
/// [`EncodeError`] where the measurement has no form in the standard.
pub fn measurement_digest(measurement: &Measurement) -> Result<String, EncodeError> {
    Ok(of_tree(&encode_measurement(measurement)?).0)
}

/// The digest of a tree.
pub(super) fn of_tree(root: &Group) -> Digest {
    Digests::of(root).document
}

/// The digest of a document from those of its objects, by path.
pub(super) fn of_lines(objects: &BTreeMap<String, String>) -> Digest {
    let mut hash = Sha256::new();
    objects.iter().for_each(|(path, digest)| hash.update(format!("{digest} {path}\n")));
    Digest(format!("sha256:{}", hexadecimal(&hash.finalize())))
}

/// The digests of every object of a tree, by path, and of all of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Digests {
    pub(super) objects: BTreeMap<String, String>,
    pub(super) document: Digest,
}

impl Digests {
    /// Those that the objects of a file state; `None` for a file without one for the document.
    #[cfg(feature = "write")]
    pub(super) fn stated(root: &Group) -> Option<Self> {
        let text = |object: Object<'_>, name: &str| object.attributes().get(name)?.as_text().map(str::to_owned);
        let mut objects = BTreeMap::new();
        root.visit("", &mut |path, object| {
            objects.extend(text(object, name::SHA256).map(|digest| (path.to_owned(), digest)));
        });
        Some(Self { objects, document: Digest(text(Object::Group(root), name::DIGEST)?) })
    }

    /// Computes them, over all cores.
    pub(super) fn of(root: &Group) -> Self {
        let mut objects = Vec::new();
        root.visit("", &mut |path, object| objects.push((path.to_owned(), object)));
        let objects: BTreeMap<String, String> =
            objects.into_par_iter().map(|(path, object)| (path, of_object(object))).collect();
        Self { document: of_lines(&objects), objects }
    }
}

fn of_object(object: Object<'_>) -> String {
    let mut hash = Sha256::new();
    match object {
        Object::Group(_) => text(&mut hash, "group"),
        Object::Dataset(dataset) => {
            text(&mut hash, "dataset");
            array(&mut hash, &dataset.array.shape, &dataset.array.data);
        }
    }
    let digested = |name: &str| !is_outside_digest(name) && !is_description(name);
    for (name, value) in object.attributes().iter().filter(|(name, _)| digested(name)) {
        text(&mut hash, name);
        // netCDF makes an array of every number in an attribute.
        let shape = if value.data.len() == 1 { &[][..] } else { &value.shape };
        array(&mut hash, shape, &value.data);
    }
    hexadecimal(&hash.finalize())
}

fn array(hash: &mut Sha256, shape: &[usize], data: &Data) {
    text(hash, data.type_name());
    hash.update((shape.len() as u64).to_le_bytes());
    shape.iter().for_each(|length| hash.update((*length as u64).to_le_bytes()));
    hash.update(data.bytes());
}

fn text(hash: &mut Sha256, text: &str) {
    hash.update((text.len() as u64).to_le_bytes());
    hash.update(text);
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Puts the digests into a tree: `sha256` on every object, `digest` on the root.
#[cfg(feature = "write")]
pub(super) fn sign(root: &mut Group) {
    let digests = Digests::of(root);
    sign_below(root, "", &digests);
}

#[cfg(feature = "write")]
fn sign_below(group: &mut Group, path: &str, digests: &Digests) {
    group.attributes.extend(digests.attributes(if path.is_empty() { "/" } else { path }));
    for (name, dataset) in &mut group.datasets {
        dataset.attributes.extend(digests.attributes(&format!("{path}/{name}")));
    }
    group.groups.iter_mut().for_each(|(name, child)| sign_below(child, &format!("{path}/{name}"), digests));
}

#[cfg(feature = "write")]
impl Digests {
    /// The attributes with which an object is signed; an object beside the standard has none.
    pub(super) fn attributes(&self, path: &str) -> Vec<(String, Array)> {
        let own = self.objects.get(path).map(|digest| (name::SHA256.to_owned(), Array::text(digest.as_str())));
        let whole = (path == "/").then(|| (name::DIGEST.to_owned(), Array::text(self.document.as_str())));
        own.into_iter().chain(whole).collect()
    }
}
