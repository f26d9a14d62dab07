//! A [`Tree`](Group) as a document. It faces `encode`, which has the same files.
//!
//! What other programs change when they copy a file is accepted: other integer and float types that hold the values,
//! arrays of one where a scalar was, attributes and datasets that the standard does not know.

mod factorisation;
mod measurement;
mod model;
mod parts;

use std::str::FromStr;

use serde::de::DeserializeOwned;

use super::error::ReadError;
use super::layout::{self, name};
use super::tree::{Array, Data, Dataset, Group, Values};
use crate::dataset::{Acquisition, Document, Id, Measurement};

/// The document of a tree.
pub(super) fn decode(root: &Group) -> Result<Document, ReadError> {
    let root = At { path: String::new(), group: root };
    version_at(&root)?;
    Ok(Document {
        title: root.optional_text(name::TITLE)?,
        license: root.optional_text(name::LICENSE)?,
        citation: root.optional_text(name::CITATION)?,
        contact: root.optional_text(name::CONTACT)?,
        samples: root.list(name::SAMPLE, parts::described)?,
        instruments: root.list(name::INSTRUMENT, parts::described)?,
        lights: root.list(name::LIGHT, parts::light)?,
        white_references: root.list(name::WHITE_REFERENCE, parts::white_reference)?,
        measurements: root.list(name::MEASUREMENT, measurement::measurement)?,
        models: root.list(name::MODEL, model::model)?,
        factorisations: root.list(name::FACTORISATION, factorisation::factorisation)?,
        provenance: root.child(name::PROVENANCE).map_or_else(|| Ok(Default::default()), |at| parts::provenance(&at))?,
        extensions: root.child(name::EXTENSION).map_or_else(|| Ok(Vec::new()), |at| parts::extensions(&at))?,
    })
}

/// Refuses a root group of another major version.
pub(super) fn version(root: &Group) -> Result<(), ReadError> {
    version_at(&At { path: String::new(), group: root })
}

/// The rows of a measurement, from its group at that path.
pub(super) fn decode_rows(path: &str, group: &Group) -> Result<Vec<Acquisition>, ReadError> {
    measurement::rows(&At { path: path.to_owned(), group })
}

/// A measurement, from its group at that path. Its parts are not checked against each other.
pub(super) fn measurement(id: Id, path: &str, group: &Group) -> Result<Measurement, ReadError> {
    measurement::measurement(id, &At { path: path.to_owned(), group })
}

fn version_at(root: &At<'_>) -> Result<(), ReadError> {
    let place = root.attribute_path(name::BBRF_VERSION);
    let stated = root
        .optional_text(name::BBRF_VERSION)?
        .ok_or_else(|| ReadError::missing(&place, "the version of the standard; this is HDF5, but no bbrf file"))?;
    match layout::parse_version(&stated) {
        Some((layout::MAJOR, _)) => Ok(()),
        Some(_) => Err(ReadError::Version { place: Box::new(crate::dataset::Place::path(place)), found: stated }),
        None => Err(ReadError::unexpected(&place, stated, "a version such as 1.0")),
    }
}

/// A group with its path, from which contents are taken by name and kind.
struct At<'a> {
    path: String,
    group: &'a Group,
}

impl<'a> At<'a> {
    fn attribute_path(&self, name: &str) -> String {
        format!("{}@{name}", if self.path.is_empty() { "/" } else { &self.path })
    }

    fn member_path(&self, name: &str) -> String {
        format!("{}/{name}", self.path)
    }

    fn child(&self, name: &str) -> Option<At<'a>> {
        self.group.group(name).map(|group| At { path: self.member_path(name), group })
    }

    /// The groups of a list in the order of their positions.
    fn list<T>(&self, name: &str, decode: impl Fn(Id, &At<'a>) -> Result<T, ReadError>) -> Result<Vec<T>, ReadError> {
        let Some(list) = self.child(name) else { return Ok(Vec::new()) };
        list.members(decode)
    }

    /// The groups of this one in the order of their positions.
    fn members<T>(&self, decode: impl Fn(Id, &At<'a>) -> Result<T, ReadError>) -> Result<Vec<T>, ReadError> {
        let mut positioned = Vec::new();
        for (id, group) in &self.group.groups {
            let at = At { path: self.member_path(id), group };
            let position: Option<i64> = at.optional_integer(name::POSITION)?;
            let parsed = Id::new(id.as_str()).map_err(|error| {
                ReadError::unexpected(&at.path, error.to_string(), "a group named by an identifier")
            })?;
            // A part that another program added has no position and comes last, by its name.
            positioned.push((position.unwrap_or(i64::MAX), parsed, at));
        }
        positioned.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
        positioned.into_iter().map(|(_, id, at)| decode(id, &at)).collect()
    }

    /// The groups `PREFIX0`, `PREFIX1`, ... until one is missing.
    fn numbered(&self, prefix: &str) -> impl Iterator<Item = At<'a>> {
        (0..).map_while(move |position: usize| self.child(&format!("{prefix}{position}")))
    }

    fn optional_text(&self, name: &str) -> Result<Option<String>, ReadError> {
        let path = || self.attribute_path(name);
        self.group.attributes.get(name).map(|array| text(array, &path())).transpose()
    }

    fn text(&self, name: &str) -> Result<String, ReadError> {
        self.optional_text(name)?.ok_or_else(|| ReadError::missing(&self.attribute_path(name), "a text"))
    }

    fn optional_parsed<T: FromStr<Err: std::fmt::Display>>(&self, name: &str) -> Result<Option<T>, ReadError> {
        self.optional_text(name)?.map(|text| parsed(&text, &self.attribute_path(name))).transpose()
    }

    fn parsed<T: FromStr<Err: std::fmt::Display>>(&self, name: &str) -> Result<T, ReadError> {
        parsed(&self.text(name)?, &self.attribute_path(name))
    }

    fn optional_number(&self, name: &str) -> Result<Option<f64>, ReadError> {
        let Some(array) = self.group.attributes.get(name) else { return Ok(None) };
        attribute_number(array, &self.attribute_path(name)).map(Some)
    }

    fn number(&self, name: &str) -> Result<f64, ReadError> {
        self.optional_number(name)?.ok_or_else(|| ReadError::missing(&self.attribute_path(name), "a number"))
    }

    fn optional_integer<T: TryFrom<i128> + Copy>(&self, name: &str) -> Result<Option<T>, ReadError> {
        let Some(array) = self.group.attributes.get(name) else { return Ok(None) };
        let path = self.attribute_path(name);
        match integers(&array.data, &path)?.as_slice() {
            [one] => Ok(Some(*one)),
            other => Err(ReadError::unexpected(&path, format!("{} numbers", other.len()), "one number")),
        }
    }

    fn integer<T: TryFrom<i128> + Copy>(&self, name: &str) -> Result<T, ReadError> {
        self.optional_integer(name)?.ok_or_else(|| ReadError::missing(&self.attribute_path(name), "a whole number"))
    }

    fn truth(&self, name: &str) -> Result<bool, ReadError> {
        match self.integer::<u8>(name)? {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(ReadError::unexpected(&self.attribute_path(name), other.to_string(), "0 or 1")),
        }
    }

    fn dataset(&self, name: &str) -> Result<&'a Dataset, ReadError> {
        self.group.dataset(name).ok_or_else(|| ReadError::missing(&self.member_path(name), "a dataset"))
    }

    fn numbers(&self, name: &str) -> Result<Vec<f64>, ReadError> {
        let array = self.vector(name)?;
        numbers(&array.data, &self.member_path(name)).map(|values| values.to_vec())
    }

    /// No dataset is an empty list.
    fn numbers_or_none(&self, name: &str) -> Result<Vec<f64>, ReadError> {
        if self.group.dataset(name).is_some() { self.numbers(name) } else { Ok(Vec::new()) }
    }

    fn integers<T: TryFrom<i128>>(&self, name: &str) -> Result<Vec<T>, ReadError> {
        integers(&self.vector(name)?.data, &self.member_path(name))
    }

    fn texts(&self, name: &str) -> Result<Vec<String>, ReadError> {
        match &self.vector(name)?.data {
            Data::Text(texts) => Ok(texts.clone()),
            other => Err(ReadError::unexpected(&self.member_path(name), other.type_name(), "strings")),
        }
    }

    fn vector(&self, name: &str) -> Result<&'a Array, ReadError> {
        let array = &self.dataset(name)?.array;
        if array.shape.len() == 1 || (array.shape.is_empty() && array.data.len() == 1) {
            Ok(array)
        } else {
            let found = format!("shape {:?}", array.shape);
            Err(ReadError::unexpected(&self.member_path(name), found, "one axis"))
        }
    }

    /// A matrix with its shape.
    fn matrix(&self, name: &str) -> Result<((usize, usize), &'a Data), ReadError> {
        let array = &self.dataset(name)?.array;
        match array.shape.as_slice() {
            [rows, columns] => Ok(((*rows, *columns), &array.data)),
            shape => Err(ReadError::unexpected(&self.member_path(name), format!("shape {shape:?}"), "two axes")),
        }
    }

    fn json<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>, ReadError> {
        let Some(dataset) = self.group.dataset(name) else { return Ok(None) };
        let path = self.member_path(name);
        let text = text(&dataset.array, &path)?;
        serde_json::from_str(&text)
            .map(Some)
            .map_err(|error| ReadError::unexpected(&path, error.to_string(), "JSON of the standard's schema"))
    }
}

/// A text attribute of a dataset.
fn dataset_text(dataset: &Dataset, name: &str, path: &str) -> Result<String, ReadError> {
    let path = format!("{path}@{name}");
    dataset.attributes.get(name).ok_or_else(|| ReadError::missing(&path, "a text")).and_then(|array| text(array, &path))
}

pub(super) fn text(array: &Array, path: &str) -> Result<String, ReadError> {
    match (&array.data, array.as_text()) {
        (_, Some(text)) => Ok(text.to_owned()),
        // netCDF writes an empty text as an array without elements.
        (Data::Text(texts), None) if texts.is_empty() => Ok(String::new()),
        (other, None) => Err(ReadError::unexpected(path, describe(other, &array.shape), "one string")),
    }
}

fn describe(data: &Data, shape: &[usize]) -> String {
    if shape.is_empty() { data.type_name().to_owned() } else { format!("{} of shape {shape:?}", data.type_name()) }
}

fn parsed<T: FromStr<Err: std::fmt::Display>>(text: &str, path: &str) -> Result<T, ReadError> {
    text.parse().map_err(|error: T::Err| ReadError::unexpected(path, format!("`{text}`"), error.to_string()))
}

pub(super) fn attribute_number(array: &Array, path: &str) -> Result<f64, ReadError> {
    match &*numbers(&array.data, path)? {
        [one] => Ok(*one),
        other => Err(ReadError::unexpected(path, format!("{} numbers", other.len()), "one number")),
    }
}

/// Numbers of any type that double precision holds exactly.
fn numbers(data: &Data, path: &str) -> Result<Values<f64>, ReadError> {
    match data {
        Data::F64(values) => Ok(values.clone()),
        Data::F32(values) => Ok(values.iter().map(|value| f64::from(*value)).collect()),
        other => Ok(integers::<i32>(other, path)?.into_iter().map(f64::from).collect()),
    }
}

/// Bit masks, shared where they have the type of the standard.
fn masks(data: &Data, path: &str) -> Result<Values<u16>, ReadError> {
    match data {
        Data::U16(values) => Ok(values.clone()),
        other => integers(other, path).map(Values::from),
    }
}

/// Whole numbers of any type, if they fit into the one asked for.
fn integers<T: TryFrom<i128>>(data: &Data, path: &str) -> Result<Vec<T>, ReadError> {
    macro_rules! narrowed {
        ($values:expr) => {
            $values
                .iter()
                .map(|value| {
                    T::try_from(i128::from(*value)).map_err(|_| {
                        ReadError::unexpected(path, value.to_string(), "a number within the range of its field")
                    })
                })
                .collect()
        };
    }
    match data {
        Data::U8(v) => narrowed!(v),
        Data::U16(v) => narrowed!(v),
        Data::U32(v) => narrowed!(v),
        Data::U64(v) => narrowed!(v),
        Data::I8(v) => narrowed!(v),
        Data::I16(v) => narrowed!(v),
        Data::I32(v) => narrowed!(v),
        Data::I64(v) => narrowed!(v),
        other => Err(ReadError::unexpected(path, other.type_name(), "whole numbers")),
    }
}
