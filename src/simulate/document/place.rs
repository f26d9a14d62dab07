//! Where in a description something stands: errors name line, column and key, whether the text cannot be read or makes no sense.

use toml::de::{DeArray, DeTable, DeValue};

use super::description::SceneDocument;

/// Beyond this a length has no digits left for a scene.
const LARGEST: f64 = 1e9;
/// The one number that is no quantity.
const SEED: &str = "film.seed";

/// A description that is no scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}, line {line}, column {column}{}: {problem}", if key.is_empty() { String::new() } else { format!(", `{key}`") })]
pub struct NotAScene {
    /// The file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The key, as `object.sphere.radius`; empty where the text is no TOML.
    pub key: String,
    /// What was found and what was expected.
    pub problem: String,
}

/// One step on the way to a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step<'a> {
    Key(&'a str),
    /// Of a list, from 0.
    Item(usize),
}

/// A text whose values can be found.
pub(super) struct Places<'a> {
    file: &'a str,
    text: &'a str,
    table: DeTable<'a>,
}

impl<'a> Places<'a> {
    /// The text as TOML, with every number of it one that a scene may have.
    pub(super) fn of(file: &'a str, text: &'a str) -> Result<Self, NotAScene> {
        let table = DeTable::parse(text).map_err(|error| {
            let problem = format!("{}; expected a scene in TOML", error.message());
            at(file, text, error.span().map_or(0, |span| span.start), String::new(), problem)
        })?;
        let places = Self { file, text, table: table.into_inner() };
        for (key, value) in &places.table {
            places.check_numbers(key.get_ref(), value)?;
        }
        Ok(places)
    }

    /// The text as a description.
    pub(super) fn read(&self) -> Result<SceneDocument, NotAScene> {
        let reader = toml::Deserializer::parse(self.text).map_err(|error| self.unread(&error, String::new()))?;
        serde_path_to_error::deserialize(reader).map_err(|error| {
            let key = without_numbers(&error.path().to_string());
            self.unread(error.inner(), if key == "." { String::new() } else { key })
        })
    }

    fn unread(&self, error: &toml::de::Error, key: String) -> NotAScene {
        at(self.file, self.text, error.span().map_or(0, |span| span.start), key, error.message().to_owned())
    }

    /// An error at a value, or at the last part of the way to it that is there.
    pub(super) fn error(&self, way: &[Step<'_>], problem: impl Into<String>) -> NotAScene {
        let keys: Vec<&str> =
            way.iter().filter_map(|step| if let Step::Key(key) = step { Some(*key) } else { None }).collect();
        at(self.file, self.text, self.offset(way), keys.join("."), problem.into())
    }

    /// True where the author wrote a value, and did not leave it to the schema.
    pub(super) fn is_written(&self, way: &[Step<'_>]) -> bool {
        self.find(way).1 == way.len()
    }

    fn offset(&self, way: &[Step<'_>]) -> usize {
        self.find(way).0
    }

    /// Where the last part of the way begins that is there, and how many parts are.
    fn find(&self, way: &[Step<'_>]) -> (usize, usize) {
        let (mut offset, mut list): (usize, Option<&DeArray<'_>>) = (0, None);
        let mut table = Some(&self.table);
        for (found, step) in way.iter().enumerate() {
            let next = match step {
                Step::Key(key) => {
                    table.and_then(|table| table.iter().find(|(name, _)| name.get_ref() == key)).map(|(name, value)| {
                        offset = name.span().start;
                        value
                    })
                }
                Step::Item(index) => {
                    list.and_then(|list| list.get(*index)).inspect(|value| offset = value.span().start)
                }
            };
            let Some(next) = next else { return (offset, found) };
            (table, list) = match next.get_ref() {
                DeValue::Table(inner) => (Some(inner), None),
                DeValue::Array(items) => (None, Some(items)),
                _ => (None, None),
            };
        }
        (offset, way.len())
    }

    fn check_numbers(&self, key: &str, value: &toml::Spanned<DeValue<'_>>) -> Result<(), NotAScene> {
        let text = match value.get_ref() {
            DeValue::Table(table) => {
                return table
                    .iter()
                    .try_for_each(|(name, inner)| self.check_numbers(&format!("{key}.{}", name.get_ref()), inner));
            }
            DeValue::Array(items) => return items.iter().try_for_each(|inner| self.check_numbers(key, inner)),
            // Counts have limits of their own, which are said where they are read.
            DeValue::Integer(number) if key != SEED && number.radix() == 10 => number.as_str(),
            DeValue::Float(number) => number.as_str(),
            _ => return Ok(()),
        };
        match text.parse::<f64>() {
            Ok(number) if number.abs() < LARGEST => Ok(()),
            _ => {
                let problem = format!("{text}; expected a finite number below {LARGEST:e}");
                Err(at(self.file, self.text, value.span().start, key.to_owned(), problem))
            }
        }
    }
}

/// Keys without the numbers of lists: the line says which.
fn without_numbers(path: &str) -> String {
    path.split('[').map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect()
}

fn at(file: &str, text: &str, offset: usize, key: String, problem: String) -> NotAScene {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    NotAScene {
        file: file.to_owned(),
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
        key,
        problem,
    }
}
