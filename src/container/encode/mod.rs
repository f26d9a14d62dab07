//! A document as a [`Tree`](Group). It faces `decode`, which has the same files.

mod extension;
mod factorisation;
mod measurement;
mod model;
mod parts;

use serde::Serialize;

use super::error::EncodeError;
use super::layout::{self, name};
use super::tree::{Array, Data, Dataset, Group};
use crate::dataset::{Document, DocumentError, Id};

pub(super) use measurement::encode_measurement;

/// The tree of a document, without digests.
pub(super) fn encode(document: &Document) -> Result<Group, EncodeError> {
    let mut root = Group::default();
    root.text(name::CONVENTIONS, layout::CONVENTIONS)?;
    root.text(name::BBRF_VERSION, layout::VERSION)?;
    root.optional_text(name::TITLE, document.title.as_ref())?;
    root.optional_text(name::LICENSE, document.license.as_ref())?;
    root.optional_text(name::CITATION, document.citation.as_ref())?;
    root.optional_text(name::CONTACT, document.contact.as_ref())?;
    root.list(name::SAMPLE, &document.samples, |part| (&part.id, parts::described(part)))?;
    root.list(name::INSTRUMENT, &document.instruments, |part| (&part.id, parts::described(part)))?;
    root.list(name::LIGHT, &document.lights, |part| (&part.id, parts::light(part)))?;
    root.list(name::WHITE_REFERENCE, &document.white_references, |part| (&part.id, parts::white_reference(part)))?;
    root.list(name::MEASUREMENT, &document.measurements, |part| (&part.id, encode_measurement(part)))?;
    root.list(name::MODEL, &document.models, |part| (&part.id, model::model(part)))?;
    root.list(name::FACTORISATION, &document.factorisations, |part| (&part.id, factorisation::factorisation(part)))?;
    root.groups.push((name::PROVENANCE.to_owned(), parts::provenance(&document.provenance)?));
    describe(&mut root, "");
    if !document.extensions.is_empty() {
        root.groups.push((name::EXTENSION.to_owned(), extension::extensions(&document.extensions)?));
    }
    Ok(root)
}

/// Says of every dataset what it is, where that does not depend on the content: by the table of the layout.
fn describe(group: &mut Group, path: &str) {
    for (name, dataset) in &mut group.datasets {
        if let Some(entry) = layout::find(&format!("{path}/{name}"))
            && !dataset.attributes.contains_key(name::LONG_NAME)
        {
            let meaning = entry.meaning.split(';').next().unwrap_or(&entry.meaning);
            dataset.long_name(meaning);
        }
    }
    for (name, member) in &mut group.groups {
        describe(member, &format!("{path}/{name}"));
    }
}

/// Building a group, each kind of content in one line.
impl Group {
    fn text(&mut self, name: &str, text: &str) -> Result<(), EncodeError> {
        self.attributes.insert(name.to_owned(), Array::text(without_nul(text)?));
        Ok(())
    }

    fn optional_text(&mut self, name: &str, text: Option<&String>) -> Result<(), EncodeError> {
        text.map_or(Ok(()), |text| self.text(name, text))
    }

    fn optional_id(&mut self, name: &str, id: Option<&Id>) -> Result<(), EncodeError> {
        id.map_or(Ok(()), |id| self.text(name, id.as_str()))
    }

    fn attribute(&mut self, name: &str, data: Data) {
        self.attributes.insert(name.to_owned(), Array::scalar(data));
    }

    /// A list of parts, each a group under its id that knows its position in the list.
    fn list<'a, T>(
        &mut self,
        name: &str,
        parts: &'a [T],
        encode: impl Fn(&'a T) -> (&'a Id, Result<Group, EncodeError>),
    ) -> Result<(), EncodeError> {
        if parts.is_empty() {
            return Ok(());
        }
        let mut list = Group::default();
        for (position, part) in parts.iter().enumerate() {
            let (id, group) = encode(part);
            let mut group = group?;
            group.attribute(name::POSITION, Data::I32(vec![index(position)].into()));
            list.groups.push((id.to_string(), group));
        }
        self.groups.push((name.to_owned(), list));
        Ok(())
    }

    /// A dimension scale of whole numbers, for an axis that has no coordinate of its own.
    fn index_scale(&mut self, name: &str, length: usize) {
        let mut dataset = Dataset::new(Array::vector(Data::I32((0..length).map(index).collect())));
        dataset.is_scale = true;
        self.datasets.push((name.to_owned(), dataset.with_text(name::UNITS, "1")));
    }

    /// A dimension scale with values, as wavelengths.
    fn scale(&mut self, name: &str, values: &[f64], unit: &str, long_name: &str) {
        let dataset = Dataset { is_scale: true, ..Dataset::new(Array::vector(Data::F64(values.to_vec().into()))) };
        let dataset = dataset.with_text(name::UNITS, unit).with_text(name::LONG_NAME, long_name);
        self.datasets.push((name.to_owned(), dataset));
    }

    /// A vector on the axis of a scale in this group; where their lengths differ, it gets an index scale of its own.
    fn vector(&mut self, name: &str, data: Data, scale: &str) -> &mut Dataset {
        let length = data.len();
        let fits = self.dataset(scale).is_some_and(|found| found.array.data.len() == length);
        let axis = if fits { scale.to_owned() } else { format!("{name}{}", name::INDEX) };
        if !fits {
            self.index_scale(&axis, length);
        }
        self.put(name, Dataset { axes: vec![axis], ..Dataset::new(Array::vector(data)) })
    }

    /// A vector of texts.
    fn texts<'a>(
        &mut self,
        name: &str,
        texts: impl Iterator<Item = &'a str>,
        scale: &str,
    ) -> Result<&mut Dataset, EncodeError> {
        let texts: Vec<String> = texts.map(without_nul).collect::<Result<_, _>>()?;
        Ok(self.vector(name, Data::Text(texts), scale))
    }

    /// A scalar text that holds JSON.
    fn json<T: Serialize>(&mut self, name: &str, value: &T) -> Result<(), EncodeError> {
        let failed = |source| EncodeError::Json { path: name.to_owned(), source };
        let tree = serde_json::to_value(value).map_err(failed)?;
        json_without_nul(&tree)?;
        let text = serde_json::to_string(value).map_err(failed)?;
        self.put(name, Dataset::new(Array::text(text)));
        Ok(())
    }

    fn put(&mut self, name: &str, dataset: Dataset) -> &mut Dataset {
        self.datasets.push((name.to_owned(), dataset));
        let last = self.datasets.len() - 1;
        &mut self.datasets[last].1
    }
}

/// Describing a dataset.
impl Dataset {
    fn unit(&mut self, unit: &str) -> &mut Self {
        self.attributes.insert(name::UNITS.to_owned(), Array::text(unit));
        self
    }

    fn long_name(&mut self, text: &str) -> &mut Self {
        self.attributes.insert(name::LONG_NAME.to_owned(), Array::text(text));
        self
    }

    fn checked_text(&mut self, name: &str, text: &str) -> Result<&mut Self, EncodeError> {
        self.attributes.insert(name.to_owned(), Array::text(without_nul(text)?));
        Ok(self)
    }

    fn flags(&mut self, masks: Data, meanings: &[&str]) -> &mut Self {
        self.attributes.insert(name::FLAG_MASKS.to_owned(), Array::vector(masks));
        self.attributes.insert(name::FLAG_MEANINGS.to_owned(), Array::text(meanings.join(" ")));
        self
    }
}

/// HDF5 strings end at U+0000, so no text may hold it.
pub(super) fn without_nul(text: &str) -> Result<String, EncodeError> {
    if text.contains('\0') { Err(DocumentError::NulInText(text.to_owned()).into()) } else { Ok(text.to_owned()) }
}

fn json_without_nul(value: &serde_json::Value) -> Result<(), EncodeError> {
    match value {
        serde_json::Value::String(text) => without_nul(text).map(drop),
        serde_json::Value::Array(values) => values.iter().try_for_each(json_without_nul),
        serde_json::Value::Object(members) => members.values().try_for_each(json_without_nul),
        _ => Ok(()),
    }
}

/// The text form of a value, if it reads back as the same value.
fn faithful<T>(path: &str, value: &T) -> Result<String, EncodeError>
where
    T: std::fmt::Display + std::str::FromStr + PartialEq,
{
    let text = value.to_string();
    let same = text.parse::<T>().is_ok_and(|read| read == *value);
    if same { Ok(text) } else { Err(EncodeError::Ambiguous { path: path.to_owned(), found: text }) }
}

/// Positions are written as 32-bit numbers, which every reader has; lists beyond that do not fit into a file.
fn index(position: usize) -> i32 {
    i32::try_from(position).unwrap_or(i32::MAX)
}
