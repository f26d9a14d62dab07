//! Particulars of a part of the document by the names of its fields: `# instrument.visual-field-deg: 0.3`,
//! `# conditions.operator: ...`, `# white-reference.calibration-0.expires: 2028-01-10`. The fields are those of the
//! document's types, so a field that is added there can be stated at once.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};

use super::error::{ImportError, fault, quoted};
use super::number::value;
use crate::dataset::{Calibration, Document, Place};

/// Parts whose particulars can be stated, as keys begin.
pub(crate) const PARTS: [&str; 6] = ["sample", "instrument", "light", "white-reference", "conditions", "document"];

/// A particular that somebody states, with where.
#[derive(Debug, Clone, PartialEq)]
pub struct Detail {
    pub(super) key: String,
    pub(super) text: String,
    pub(super) place: Place,
}

/// True for a key that names a field of a part.
pub(crate) fn is_detail(key: &str) -> bool {
    key.split_once('.').is_some_and(|(part, field)| PARTS.contains(&part) && !field.is_empty())
}

/// Puts the particulars into every part of their kind.
///
/// # Errors
/// [`ImportError::Call`] for a field that there is not, or a value that it cannot have.
pub(super) fn fill(document: &mut Document, details: &[Detail]) -> Result<(), ImportError> {
    for detail in details {
        let (part, field) = detail.key.split_once('.').unwrap_or((detail.key.as_str(), ""));
        let field = field.replace('-', "_");
        let none = match part {
            "sample" => document.samples.is_empty(),
            "instrument" => document.instruments.is_empty(),
            "light" => document.lights.is_empty(),
            "white-reference" => document.white_references.is_empty(),
            _ => false,
        };
        if none {
            return Err(ImportError::Call(fault(
                detail.place.clone(),
                format!("{} without a {part}", quoted(&detail.key)),
                format!("a {part} that it belongs to"),
                format!("name it as well, as in `# {part}: NAME`, or take the line out"),
            )));
        }
        match part {
            "sample" => document.samples.iter_mut().try_for_each(|part| set(part, &field, detail))?,
            "instrument" => document.instruments.iter_mut().try_for_each(|part| set(part, &field, detail))?,
            "light" => document.lights.iter_mut().try_for_each(|part| set(part, &field, detail))?,
            "white-reference" => document.white_references.iter_mut().try_for_each(|part| set(part, &field, detail))?,
            "document" => set(document, &field, detail)?,
            _ => document.measurements.iter_mut().try_for_each(|part| set(&mut part.conditions, &field, detail))?,
        }
    }
    Ok(())
}

fn set<T: Serialize + DeserializeOwned>(part: &mut T, field: &str, detail: &Detail) -> Result<(), ImportError> {
    let refused = |expected: String| {
        let found = format!("{} as {}", quoted(&detail.text), quoted(&detail.key));
        let advice = "correct the key or its value; docs/inputs.md lists the fields";
        ImportError::Call(fault(detail.place.clone(), found, expected, advice))
    };
    let Ok(Value::Object(mut fields)) = serde_json::to_value(&*part) else { return Ok(()) };
    let text = Value::String(detail.text.clone());
    let number = value(&detail.text).and_then(Number::from_f64).map(Value::Number);
    // A field is a text or a number; its type decides, so both are tried.
    let mut why = String::new();
    for candidate in number.into_iter().chain([text]) {
        let target = put(&mut fields, field, candidate.clone());
        match serde_json::from_value::<T>(Value::Object(fields.clone())) {
            Ok(changed) if target && holds(&changed, field, &candidate) => {
                *part = changed;
                return Ok(());
            }
            Ok(_) => why = "a field of that part".to_owned(),
            Err(error) => why = error.to_string(),
        }
    }
    Err(refused(why))
}

/// Sets a field, or a field of a numbered calibration; false where the name has no such form.
fn put(fields: &mut Map<String, Value>, field: &str, value: Value) -> bool {
    let Some((list, inner)) = field.split_once('.') else {
        fields.insert(field.to_owned(), value);
        return true;
    };
    let Some((list, position)) = list.rsplit_once('_').and_then(|(l, k)| Some((l, k.parse::<usize>().ok()?))) else {
        return false;
    };
    let items = fields.entry(list).or_insert_with(|| Value::Array(Vec::new()));
    let Value::Array(items) = items else { return false };
    // The next one of a list may be begun.
    if position == items.len() {
        items.push(serde_json::to_value(Calibration::default()).unwrap_or_default());
    }
    let Some(Value::Object(item)) = items.get_mut(position) else { return false };
    item.insert(inner.to_owned(), value);
    true
}

/// True where the changed part has the field with that value: a name that the type does not have would vanish.
fn holds<T: Serialize>(changed: &T, field: &str, expected: &Value) -> bool {
    let Ok(value) = serde_json::to_value(changed) else { return false };
    let found = match field.split_once('.') {
        None => value.get(field),
        Some((list, inner)) => {
            list.rsplit_once('_').and_then(|(list, k)| value.get(list)?.get(k.parse::<usize>().ok()?)?.get(inner))
        }
    };
    found == Some(expected)
}
