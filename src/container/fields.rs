//! Descriptions as attributes: every field of a struct becomes the attribute of its name, every struct in a list a group
//! `NAME_0`, `NAME_1`, ... So a field is stated once, in its Rust type: what is written, what is read, the table of the
//! standard and the JSON Schema follow from it.
//!
//! A text becomes a string, a number float64, a truth value uint8 0 or 1. A field that is absent has no attribute. Lists
//! of numbers are no descriptions; they are datasets, and left to the caller.

use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};

use super::decode::{attribute_number, text};
use super::encode::without_nul;
use super::error::{EncodeError, ReadError};
use super::layout::{Entry, Kind};
use super::tree::{Array, Attributes, Data, Group};
use crate::dataset::{Conditions, Instrument, Light, Sample, WhiteReference};
use crate::quantity::Statement;

/// Fields that are not attributes: the identifier is the name of the group.
const NAMES: [&str; 2] = ["id", "domain"];

/// A struct whose fields are attributes.
pub(super) trait Description: Serialize + DeserializeOwned {
    /// Its fields, from its JSON Schema; looked up once.
    fn fields() -> &'static [Property];
}

macro_rules! descriptions {
    ($($kind:ty),+) => {
        $(impl Description for $kind {
            fn fields() -> &'static [Property] {
                static FIELDS: LazyLock<Vec<Property>> = LazyLock::new(properties::<$kind>);
                &FIELDS
            }
        })+
    };
}
descriptions!(Sample, Instrument, Light, WhiteReference, Conditions, Statement);

/// Writes the fields of a description, and the lists of descriptions in it as groups.
pub(super) fn encode_fields(group: &mut Group, description: &impl Description) -> Result<(), EncodeError> {
    let Value::Object(fields) = as_json(description)? else { return Ok(()) };
    put_fields(group, fields)
}

/// The same for the attributes of a dataset.
pub(super) fn encode_attributes(
    attributes: &mut Attributes,
    description: &impl Description,
) -> Result<(), EncodeError> {
    let Value::Object(fields) = as_json(description)? else { return Ok(()) };
    for (name, value) in fields {
        put_attribute(attributes, &name, &value)?;
    }
    Ok(())
}

fn as_json(description: &impl Serialize) -> Result<Value, EncodeError> {
    serde_json::to_value(description).map_err(|source| EncodeError::Json { path: "a description".to_owned(), source })
}

fn put_fields(group: &mut Group, fields: Map<String, Value>) -> Result<(), EncodeError> {
    for (name, value) in fields {
        if NAMES.contains(&name.as_str()) {
            continue;
        }
        if let Value::Array(items) = value {
            let descriptions =
                items.into_iter().filter_map(|item| if let Value::Object(item) = item { Some(item) } else { None });
            for (position, item) in descriptions.enumerate() {
                let mut child = Group::default();
                put_fields(&mut child, item)?;
                group.groups.push((format!("{name}_{position}"), child));
            }
        } else {
            put_attribute(&mut group.attributes, &name, &value)?;
        }
    }
    Ok(())
}

fn put_attribute(attributes: &mut Attributes, name: &str, value: &Value) -> Result<(), EncodeError> {
    let data = match value {
        Value::String(text) => Data::Text(vec![without_nul(text)?]),
        Value::Bool(truth) => Data::U8(vec![u8::from(*truth)].into()),
        Value::Number(number) => Data::F64(number.as_f64().into_iter().collect()),
        Value::Null | Value::Array(_) | Value::Object(_) => return Ok(()),
    };
    attributes.insert(name.to_owned(), Array::scalar(data));
    Ok(())
}

/// Reads a description back. `id` is that of the group, for descriptions that have one.
pub(super) fn decode_fields<T: Description>(group: &Group, path: &str, id: Option<&str>) -> Result<T, ReadError> {
    let mut fields = read_fields(group, path, T::fields())?;
    if let Some(id) = id {
        fields.insert("id".to_owned(), Value::String(id.to_owned()));
    }
    from_json(fields, path)
}

/// Reads a description from the attributes of a dataset.
pub(super) fn decode_attributes<T: Description>(attributes: &Attributes, path: &str) -> Result<T, ReadError> {
    let mut fields = Map::new();
    for property in T::fields() {
        read_attribute(&mut fields, attributes, path, property)?;
    }
    from_json(fields, path)
}

fn from_json<T: DeserializeOwned>(fields: Map<String, Value>, path: &str) -> Result<T, ReadError> {
    serde_path_to_error::deserialize(Value::Object(fields)).map_err(|error| {
        let place = format!("{path}@{}", error.path());
        ReadError::unexpected(&place, error.inner().to_string(), "a field as the table of the standard has it")
    })
}

fn read_fields(group: &Group, path: &str, properties: &[Property]) -> Result<Map<String, Value>, ReadError> {
    let mut fields = Map::new();
    for property in properties {
        match &property.items {
            Some(items) => {
                let children = (0..).map_while(|position: usize| {
                    let name = format!("{}_{position}", property.name);
                    group.group(&name).map(|child| (format!("{path}/{name}"), child))
                });
                let read = children.map(|(path, child)| read_fields(child, &path, items).map(Value::Object));
                fields.insert(property.name.clone(), Value::Array(read.collect::<Result<_, _>>()?));
            }
            None => read_attribute(&mut fields, &group.attributes, path, property)?,
        }
    }
    Ok(fields)
}

fn read_attribute(
    fields: &mut Map<String, Value>,
    attributes: &Attributes,
    path: &str,
    property: &Property,
) -> Result<(), ReadError> {
    let Some(array) = attributes.get(&property.name) else { return Ok(()) };
    let place = format!("{path}@{}", property.name);
    let value = match property.kind {
        "string" => Value::String(text(array, &place)?),
        _ => {
            let number = attribute_number(array, &place)?;
            let finite = Number::from_f64(number);
            Value::Number(finite.ok_or_else(|| ReadError::unexpected(&place, number.to_string(), "a finite number"))?)
        }
    };
    fields.insert(property.name.clone(), value);
    Ok(())
}

/// The rows of the table of the standard that a description gives, for a path.
pub(super) fn entries<T: Description>(path: &str) -> Vec<Entry> {
    let mut rows = Vec::new();
    list(path, T::fields(), &mut rows);
    rows
}

fn list(path: &str, properties: &[Property], rows: &mut Vec<Entry>) {
    for property in properties {
        match &property.items {
            Some(items) => {
                let path = format!("{path}/{}_*", property.name);
                let meaning = property.meaning.clone();
                rows.push(Entry { path: path.clone().into(), kind: Kind::Group, unit: "", meaning: meaning.into() });
                list(&path, items, rows);
            }
            None => rows.push(Entry {
                path: format!("{path}@{}", property.name).into(),
                kind: Kind::Attribute(property.kind),
                unit: unit(property),
                meaning: property.meaning.clone().into(),
            }),
        }
    }
}

/// The unit stands at the end of the name of every field that has one.
fn unit(property: &Property) -> &'static str {
    const UNITS: [(&str, &str); 6] = [
        ("_mm", "mm"),
        ("_nm", "nm"),
        ("_deg", "degree"),
        ("_sr", "sr"),
        ("_celsius", "degC"),
        ("_percent", "percent"),
    ];
    if property.kind == "string" {
        return "";
    }
    UNITS.iter().find_map(|(end, unit)| property.name.ends_with(end).then_some(*unit)).unwrap_or("1")
}

/// A field of a description.
pub(super) struct Property {
    name: String,
    /// Element type in a file; for a list of descriptions that of nothing.
    kind: &'static str,
    meaning: String,
    /// The fields of the descriptions in a list.
    items: Option<Vec<Property>>,
}

/// The fields of a type, in alphabetical order.
fn properties<T: JsonSchema>() -> Vec<Property> {
    let schema = schemars::schema_for!(T).to_value();
    fields_of(&schema, &schema)
}

fn fields_of(schema: &Value, root: &Value) -> Vec<Property> {
    let Some(fields) = schema.get("properties").and_then(Value::as_object) else { return Vec::new() };
    fields
        .iter()
        .filter(|(name, _)| !NAMES.contains(&name.as_str()))
        .filter_map(|(name, field)| field_of(name, field, root))
        .collect()
}

/// `None` for what is not a description: lists of numbers, other parts of the document.
fn field_of(name: &str, field: &Value, root: &Value) -> Option<Property> {
    let meaning = field.get("description").and_then(Value::as_str).unwrap_or_default().replace('\n', " ");
    let property = |kind, items| Some(Property { name: name.to_owned(), kind, meaning: meaning.clone(), items });
    let target = resolved(field, root);
    if let Some(items) = target.get("items") {
        let items = fields_of(resolved(items, root), root);
        return if items.is_empty() { None } else { property("", Some(items)) };
    }
    match type_name(target) {
        Some("string") => property("string", None),
        Some("number") => property("float64", None),
        Some("boolean") => property("uint8", None),
        _ => None,
    }
}

/// Follows a reference to a definition, and takes what is not null of an optional field.
fn resolved<'a>(field: &'a Value, root: &'a Value) -> &'a Value {
    if let Some(options) = field.get("anyOf").and_then(Value::as_array) {
        let some = options.iter().find(|option| option.get("type").and_then(Value::as_str) != Some("null"));
        return some.map_or(field, |some| resolved(some, root));
    }
    let target = field.get("$ref").and_then(Value::as_str).and_then(|path| root.pointer(path.trim_start_matches('#')));
    target.unwrap_or(field)
}

fn type_name(schema: &Value) -> Option<&str> {
    // A closed list of names with a text for each.
    if schema.get("oneOf").is_some() || schema.get("enum").is_some() {
        return Some("string");
    }
    match schema.get("type")? {
        Value::String(one) => Some(one),
        Value::Array(several) => several.iter().filter_map(Value::as_str).find(|name| *name != "null"),
        _ => None,
    }
}
