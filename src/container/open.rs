//! Opening a file: read the tree, decode the document, compare the digests.

use std::collections::BTreeMap;
use std::path::Path;

use super::chunk_table::Chunks;
use super::decode::decode;
use super::descriptions;
use super::differing::Differing;
use super::digest::{Digest, Digests, of_lines};
use super::encode::encode;
use super::encoding::Encoded;
use super::error::ReadError;
use super::file_bytes::FileBytes;
use super::foreign::Foreign;
use super::layout::{self, is_description, name};
use super::limits::Limits;
use super::read::{Read, from_bytes};
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
    /// That content itself.
    pub foreign: Foreign,
    /// Paths of content that is not what the digests or the standard say, with what is wrong.
    pub mismatched: Vec<String>,
    /// The version of the standard that the file states, where it is later than the one known here.
    pub later_version: Option<String>,
}

/// Reads a file within the default [`Limits`], whether or not its digests agree.
///
/// # Errors
/// [`ReadError`] with the place; nothing of a file is returned when anything in it cannot be read.
pub fn read_file(path: &Path) -> Result<Opened, ReadError> {
    let name = path.display().to_string();
    let limits = Limits::default();
    let bytes = FileBytes::read(path, limits.file_bytes)
        .map_err(|source| ReadError::Io { place: Box::new(Place::file(name.clone())), source })?;
    read_bytes(bytes, &limits).map_err(|error| error.in_file(&name))
}

/// Reads the bytes of a file.
///
/// # Errors
/// As [`read_file`].
pub fn read_bytes(bytes: impl Into<FileBytes>, limits: &Limits) -> Result<Opened, ReadError> {
    let Inspection { tree, document, stored_digest, computed_digest, foreign, unknown, mismatches, .. } =
        look(bytes.into(), limits, Depth::Content)?;
    let document = document?;
    document.check().map_err(|source| ReadError::Document { place: Box::default(), source })?;
    let computed_digest =
        computed_digest.ok_or_else(|| ReadError::unexpected("/", "a text with U+0000", "a storable document"))?;
    let mismatched = mismatches.iter().map(Mismatch::to_string).collect();
    let later_version = stored_text(&tree.attributes, name::BBRF_VERSION).filter(|version| is_later(version));
    Ok(Opened { document, stored_digest, computed_digest, foreign, unknown, mismatched, later_version })
}

/// True for a later minor version of the same major one.
pub(super) fn is_later(version: &str) -> bool {
    layout::parse_version(version).is_some_and(|(major, minor)| major == layout::MAJOR && minor > layout::MINOR)
}

/// The tree of a document with its digests.
struct Canonical {
    tree: Group,
    digests: Digests,
}

/// How far a file is looked into.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Depth {
    /// What it holds.
    Content,
    /// Also whether its bytes are those of the writer.
    Bytes,
}

/// A file looked at without asking that it is right.
#[derive(Debug)]
pub struct Inspection {
    /// The bytes themselves.
    pub bytes: FileBytes,
    /// Everything in them.
    pub tree: Group,
    /// The document, or why there is none; its parts are not checked against each other.
    pub document: Result<Document, ReadError>,
    /// The digest that the file states.
    pub stored_digest: Option<String>,
    /// The digest of the document, where there is one.
    pub computed_digest: Option<Digest>,
    /// Content that the standard does not know.
    pub unknown: Vec<String>,
    /// That content itself.
    pub foreign: Foreign,
    /// Where its chunks lie.
    pub chunks: Chunks,
    /// Encodings that the standard does not use and some reader cannot read.
    pub unusual: Vec<Encoded>,
    /// The tree that the document would be written as, without digests.
    pub(crate) canonical: Option<Group>,
    /// How its bytes differ from those of the writer; `None` where it was written by another program.
    pub differing: Option<Differing>,
    /// Descriptions that differ from those that the document would be written with; no digest covers them.
    pub described: Vec<String>,
    /// What differs from how the document would be written.
    pub mismatches: Vec<Mismatch>,
}

/// Looks at the bytes of a file, however broken the document in them.
///
/// # Errors
/// [`ReadError`] when the bytes are no HDF5, damaged, or beyond the limits.
pub fn inspect(bytes: impl Into<FileBytes>, limits: &Limits) -> Result<Inspection, ReadError> {
    look(bytes.into(), limits, Depth::Bytes)
}

fn look(bytes: FileBytes, limits: &Limits, depth: Depth) -> Result<Inspection, ReadError> {
    let Read { tree, unusual, chunks } = from_bytes(&bytes, limits)?;
    let document = decode(&tree);
    let stored_digest = stored_text(&tree.attributes, name::DIGEST);
    let canonical = document.as_ref().ok().and_then(|document| encode(document).ok());
    let differ = |canonical: &Group| match depth {
        Depth::Bytes => Differing::of(&bytes, &chunks, &tree, canonical),
        Depth::Content => None,
    };
    // Both go over everything, and need nothing of each other.
    let both = canonical.map(|tree| {
        let (digests, differing) = rayon::join(|| Digests::of(&tree), || differ(&tree));
        (Canonical { digests, tree }, differing)
    });
    let (canonical, differing) = both.map_or((None, None), |(canonical, differing)| (Some(canonical), differing));
    let computed_digest = canonical.as_ref().map(|canonical| canonical.digests.document.clone());
    let mismatches =
        canonical.as_ref().map_or_else(Vec::new, |canonical| mismatches(&tree, canonical, stored_digest.as_deref()));
    let described =
        canonical.as_ref().map_or_else(Vec::new, |canonical| descriptions::differing(&tree, &canonical.tree));
    let foreign = Foreign::of(&tree);
    Ok(Inspection {
        bytes,
        unusual,
        chunks,
        unknown: foreign.paths().into_iter().map(str::to_owned).collect(),
        foreign,
        tree,
        document,
        stored_digest,
        computed_digest,
        canonical: canonical.map(|canonical| canonical.tree),
        differing,
        described,
        mismatches,
    })
}

/// Something in a file that is not as its document would be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Mismatch {
    /// An object that is not there.
    Absent(String),
    /// An object without its digest, or a document without one.
    Unsigned(String),
    /// An object, or a document, whose content does not have the stored digest.
    Digest(String),
    /// An attribute that is not what the standard gives it.
    Attribute(String),
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Absent(path) => write!(f, "{path}: missing"),
            Self::Unsigned(path) => write!(f, "{path}: missing digest"),
            Self::Digest(path) => write!(f, "{path}: the content does not have its stored digest"),
            Self::Attribute(path) => write!(f, "{path}: not what the standard gives it"),
        }
    }
}

/// Reads a file whose content has the digests stored with it.
///
/// # Errors
/// As [`read_file`]; and [`ReadError::Damaged`], naming what differs, where a digest is missing or does not agree.
pub fn open_verified(path: &Path) -> Result<Document, ReadError> {
    open(path).map(|opened| opened.document)
}

/// The same with what the file holds beside the standard, for who writes the document again.
///
/// # Errors
/// As [`open_verified`]; and [`ReadError::Later`] where a later version of the standard put content into the file that
/// would no longer be digested, or be lost.
pub fn open_to_rewrite(path: &Path) -> Result<Opened, ReadError> {
    let opened = open(path)?;
    if opened.stored_digest.as_deref() == Some(opened.computed_digest.as_str()) {
        return Ok(opened);
    }
    let place = Box::new(Place::file(path.display().to_string()));
    Err(ReadError::Later { place, unknown: opened.unknown })
}

/// The same with all that is known of the file.
///
/// # Errors
/// As [`open_verified`].
pub fn open(path: &Path) -> Result<Opened, ReadError> {
    let opened = read_file(path)?;
    if opened.mismatched.is_empty() {
        return Ok(opened);
    }
    let place = Box::new(Place::file(path.display().to_string()));
    Err(ReadError::Damaged { place, mismatched: opened.mismatched })
}

fn stored_text(attributes: &Attributes, name: &str) -> Option<String> {
    attributes.get(name).and_then(Array::as_text).map(str::to_owned)
}

/// Everything that is not as it was written: digests that disagree, and content that differs from what the decoded
/// document would be written as.
fn mismatches(tree: &Group, canonical: &Canonical, stored: Option<&str>) -> Vec<Mismatch> {
    let Canonical { tree: canonical, digests: Digests { objects: digests, document: computed } } = canonical;
    let later = Later::of(tree);
    let mut found = objects(tree);
    let mut wrong = Vec::new();
    canonical.visit("", &mut |path, expected| match found.remove(path) {
        None => wrong.push(Mismatch::Absent(path.to_owned())),
        Some(object) => compare(path, object, expected, (digests, &later), &mut wrong),
    });
    wrong.extend(later.damaged(&found));
    match stored {
        None => wrong.push(Mismatch::Unsigned(format!("/@{}", name::DIGEST))),
        Some(stored) if stored != computed.as_str() && !later.is_document(stored) => {
            wrong.push(Mismatch::Digest(format!("/@{}", name::DIGEST)))
        }
        Some(_) => {}
    }
    wrong
}

/// The digests of a file of a later minor version as it stands: what it adds to objects that are known is in their
/// digests, and not in a document of this version. Empty for other files.
struct Later {
    stands: BTreeMap<String, String>,
    signed: BTreeMap<String, String>,
}

impl Later {
    fn of(tree: &Group) -> Self {
        let stated = tree.attributes.get(name::BBRF_VERSION).and_then(Array::as_text);
        let mut signed = BTreeMap::new();
        if !stated.is_some_and(is_later) {
            return Self { stands: BTreeMap::new(), signed };
        }
        tree.visit("", &mut |path, object| {
            signed.extend(stored_text(object.attributes(), name::SHA256).map(|digest| (path.to_owned(), digest)));
        });
        Self { stands: Digests::of(tree).objects, signed }
    }

    fn is_object(&self, path: &str, stored: &str) -> bool {
        self.stands.get(path).is_some_and(|digest| digest == stored)
    }

    fn is_document(&self, stored: &str) -> bool {
        !self.signed.is_empty() && of_lines(&self.signed).as_str() == stored
    }

    /// Objects that only the later version knows, and that do not have their digest.
    fn damaged(&self, unknown: &BTreeMap<String, Object<'_>>) -> Vec<Mismatch> {
        let added = self.signed.iter().filter(|(path, _)| unknown.contains_key(path.as_str()));
        added
            .filter(|(path, stored)| !self.is_object(path, stored))
            .map(|(path, _)| Mismatch::Digest(path.clone()))
            .collect()
    }
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
    (digests, later): (&BTreeMap<String, String>, &Later),
    wrong: &mut Vec<Mismatch>,
) {
    match stored_text(object.attributes(), name::SHA256) {
        None => wrong.push(Mismatch::Unsigned(path.to_owned())),
        Some(stored) if digests.get(path) != Some(&stored) && !later.is_object(path, &stored) => {
            wrong.push(Mismatch::Digest(path.to_owned()));
        }
        Some(_) => {}
    }
    for (name, expected) in expected.attributes().iter().filter(|(name, _)| !is_description(name)) {
        let same = object.attributes().get(name).is_some_and(|found| found.same_values(expected));
        if !same && !is_empty_text(object.attributes().get(name), expected) {
            wrong.push(Mismatch::Attribute(format!("{path}@{name}")));
        }
    }
}

/// netCDF writes an empty text as an array without elements.
fn is_empty_text(found: Option<&Array>, expected: &Array) -> bool {
    expected.as_text() == Some("") && found.is_some_and(|found| found.data.is_empty())
}
