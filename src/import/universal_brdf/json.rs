//! JSON as a tree from which what is understood is taken out, so that what is left is known in the end.
//!
//! A list of numbers is kept as numbers (eight bytes each, `null` as NaN, which JSON itself cannot write): the columns of
//! a file are most of it.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::ser::{Serialize, Serializer};

/// A value of JSON.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Json {
    /// `null`.
    Null,
    /// A truth value.
    Truth(bool),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// A list of numbers and `null` (NaN) only, not empty.
    Numbers(Vec<f64>),
    /// Any other list.
    List(Vec<Json>),
    /// An object.
    Object(BTreeMap<String, Json>),
}

impl Json {
    /// What it is, for messages.
    pub(super) fn what(&self) -> String {
        match self {
            Self::Null => "null".to_owned(),
            Self::Truth(truth) => truth.to_string(),
            Self::Number(number) => number.to_string(),
            Self::Text(text) => super::super::error::quoted(text),
            Self::Numbers(numbers) => format!("a list of {} numbers", numbers.len()),
            Self::List(list) => format!("a list of {}", list.len()),
            Self::Object(members) => format!("an object of {} keys", members.len()),
        }
    }

    /// The member at a path of keys.
    pub(super) fn at(&self, path: &[&str]) -> Option<&Self> {
        path.iter().try_fold(self, |json, key| match json {
            Self::Object(members) => members.get(*key),
            _ => None,
        })
    }

    /// Takes the member at a path out where `wanted` makes something of it; objects that end empty go with it.
    pub(super) fn take<T>(&mut self, path: &[&str], wanted: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let Some((key, rest)) = path.split_first() else { return wanted(self) };
        let Self::Object(members) = self else { return None };
        let member = members.get_mut(*key)?;
        let taken = member.take(rest, wanted)?;
        if rest.is_empty() || matches!(member, Self::Object(inner) if inner.is_empty()) {
            members.remove(*key);
        }
        Some(taken)
    }

    /// Takes a text out; an empty one stays.
    pub(super) fn take_text(&mut self, path: &[&str]) -> Option<String> {
        self.take(path, |json| match json {
            Self::Text(text) if !text.trim().is_empty() && !text.contains('\0') => Some(std::mem::take(text)),
            _ => None,
        })
    }

    /// Puts a value at a path of keys; the objects on the way are made.
    pub(super) fn put(&mut self, path: &[&str], value: Self) {
        let Some((key, rest)) = path.split_first() else {
            *self = value;
            return;
        };
        if !matches!(self, Self::Object(_)) {
            *self = Self::Object(BTreeMap::new());
        }
        if let Self::Object(members) = self {
            members.entry((*key).to_owned()).or_insert(Self::Null).put(rest, value);
        }
    }

    /// True where nothing is left.
    pub(super) fn is_empty(&self) -> bool {
        matches!(self, Self::Object(members) if members.is_empty())
    }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyJson)
    }
}

struct AnyJson;

impl<'de> Visitor<'de> for AnyJson {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_unit<E: Error>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E: Error>(self, truth: bool) -> Result<Json, E> {
        Ok(Json::Truth(truth))
    }

    #[allow(clippy::cast_precision_loss, reason = "a number of JSON is a double here, as in most readers")]
    fn visit_i64<E: Error>(self, number: i64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    #[allow(clippy::cast_precision_loss, reason = "a number of JSON is a double here, as in most readers")]
    fn visit_u64<E: Error>(self, number: u64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Json, E> {
        Ok(Json::Number(number))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Json, E> {
        Ok(Json::Text(text.to_owned()))
    }

    fn visit_string<E: Error>(self, text: String) -> Result<Json, E> {
        Ok(Json::Text(text))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Json, A::Error> {
        let mut numbers = Vec::new();
        while let Some(item) = sequence.next_element::<Json>()? {
            match item {
                Json::Number(number) => numbers.push(number),
                Json::Null => numbers.push(f64::NAN),
                other => return list(numbers, other, sequence),
            }
        }
        Ok(if numbers.is_empty() { Json::List(Vec::new()) } else { Json::Numbers(numbers) })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Json, A::Error> {
        let mut members = BTreeMap::new();
        while let Some((key, value)) = map.next_entry::<String, Json>()? {
            if members.contains_key(&key) {
                return Err(A::Error::custom(format!("the key `{key}` a second time in one object")));
            }
            members.insert(key, value);
        }
        Ok(Json::Object(members))
    }
}

/// A list that turned out to hold more than numbers.
fn list<'de, A: SeqAccess<'de>>(numbers: Vec<f64>, first: Json, mut rest: A) -> Result<Json, A::Error> {
    let mut list: Vec<Json> = numbers.into_iter().map(number).collect();
    list.push(first);
    while let Some(item) = rest.next_element()? {
        list.push(item);
    }
    Ok(Json::List(list))
}

fn number(number: f64) -> Json {
    if number.is_nan() { Json::Null } else { Json::Number(number) }
}

impl Serialize for Json {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Null => serializer.serialize_unit(),
            Self::Truth(truth) => truth.serialize(serializer),
            Self::Number(number) => whole_or_not(*number).serialize(serializer),
            Self::Text(text) => text.serialize(serializer),
            Self::Numbers(numbers) => serializer.collect_seq(numbers.iter().map(|number| whole_or_not(*number))),
            Self::List(list) => list.serialize(serializer),
            Self::Object(members) => members.serialize(serializer),
        }
    }
}

/// `3` and not `3.0`, as people write it; NaN is `null`.
fn whole_or_not(number: f64) -> serde_json::Value {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    #[allow(clippy::cast_possible_truncation, reason = "whole and below 2^53")]
    if number.fract() == 0.0 && number.abs() < EXACT && !(number == 0.0 && number.is_sign_negative()) {
        serde_json::Value::from(number as i64)
    } else {
        serde_json::Value::from(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn json(text: &str) -> Json {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn what_is_taken_is_gone_and_the_rest_is_as_it_was() {
        let mut tree = json(r#"{"a":{"b":"text","c":[1,null,2.5]},"d":{"e":{"f":"g"}}}"#);
        assert_eq!(tree.take_text(&["a", "b"]).as_deref(), Some("text"));
        assert_eq!(tree.take_text(&["d", "e", "f"]).as_deref(), Some("g"));
        assert_eq!(tree.take_text(&["a", "c"]), None);
        assert_eq!(serde_json::to_string(&tree).unwrap(), r#"{"a":{"c":[1,null,2.5]}}"#);
    }

    #[test]
    fn lists_of_all_kinds_read_back() {
        for text in ["[]", "[1,2,-0.0]", "[1,null,\"a\",[1,2]]", "{\"a\":[[1,0,0,0],[1,1,0,0]]}", "[true,1e300]"] {
            assert_eq!(serde_json::to_string(&json(text)).unwrap().replace("1e+300", "1e300"), text);
        }
        assert!(serde_json::from_str::<Json>(r#"{"a":1,"a":2}"#).unwrap_err().to_string().contains("second time"));
    }
}
