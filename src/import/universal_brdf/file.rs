//! A file as a tree, with messages that say where in it something is.

use super::json::Json;
use crate::dataset::Place;
use crate::import::error::{ImportError, fault, quoted};
use crate::import::receipt::Notes;
use crate::import::source::Source;

/// The file while it is taken apart.
pub(super) struct File {
    name: String,
    /// What is not understood yet.
    pub(super) tree: Json,
}

impl File {
    /// Reads the text of a source as JSON.
    ///
    /// # Errors
    /// [`ImportError::Malformed`] with the line for what is no JSON.
    pub(super) fn parse(source: &Source) -> Result<Self, ImportError> {
        let tree: Json = serde_json::from_str(&source.text.content).map_err(|error| {
            let text = error.to_string();
            let what = text.split(" at line ").next().unwrap_or(&text);
            let place = source.at_line(error.line() as u64);
            let advice = "write the file again; JSON has no NaN and no Infinity: leave such points out, or write null";
            ImportError::Malformed(fault(place, format!("{what} (column {})", error.column()), "JSON", advice))
        })?;
        Ok(Self { name: source.name.clone(), tree })
    }

    /// A path in the file.
    pub(super) fn at(&self, path: &str) -> Place {
        Place::path(path).in_file(self.name.as_str())
    }

    /// An error at a path, or at an index of the list there.
    pub(super) fn malformed(
        &self,
        path: &str,
        index: Option<usize>,
        found: impl Into<String>,
        expected: &str,
        advice: &str,
    ) -> ImportError {
        let place = self.at(path).at_index(index);
        ImportError::Malformed(fault(place, found, expected, advice))
    }

    /// True where `data` has such a column.
    pub(super) fn has(&self, name: &str) -> bool {
        self.tree.at(&["data", name]).is_some()
    }

    /// The numbers of a column with the factor of its unit.
    pub(super) fn column(
        &mut self,
        name: &'static str,
        units: &[(&str, f64)],
        notes: &mut Notes,
    ) -> Result<(Vec<f64>, f64), ImportError> {
        let path = format!("data.{name}");
        if !self.has(name) {
            let expected = "theta_i, phi_i, theta_r, phi_r and BRDF under `data`";
            let advice = "write the column; a Universal BRDF without it says nothing";
            return Err(self.malformed(&path, None, "nothing", expected, advice));
        }
        let numbers = match self.take_values(name, notes) {
            Some(Json::Numbers(numbers)) => numbers,
            Some(Json::List(list)) if list.is_empty() => Vec::new(),
            other => {
                let found = other.map_or("nothing".to_owned(), |json| json.what());
                let place = format!("{path}.values");
                return Err(self.malformed(
                    &place,
                    None,
                    found,
                    "a list of numbers",
                    "write one number for each point",
                ));
            }
        };
        let factor = self.unit(&path, &["data", name, "unit"], units)?;
        self.take_name(name);
        Ok((numbers, factor))
    }

    /// Takes the name out, which repeats the key; `uBRDF` is called BRDF by the schema.
    pub(super) fn take_name(&mut self, name: &str) {
        self.tree.take(&["data", name, "name"], |json| {
            let known = matches!(json, Json::Text(text) if text == name || (name == "uBRDF" && text == "BRDF"));
            known.then_some(())
        });
    }

    /// Takes the list of a column out; some writers call it `value`.
    pub(super) fn take_values(&mut self, name: &str, notes: &mut Notes) -> Option<Json> {
        let take = |json: &mut Json| Some(std::mem::replace(json, Json::Null));
        if let Some(values) = self.tree.take(&["data", name, "values"], take) {
            return Some(values);
        }
        let values = self.tree.take(&["data", name, "value"], take)?;
        let text = "`value` where the schema of the format has `values`: taken";
        notes.notice(self.at(&format!("data.{name}.value")), text);
        Some(values)
    }

    /// Takes a unit out: its factor.
    pub(super) fn unit(&mut self, path: &str, keys: &[&str], units: &[(&str, f64)]) -> Result<f64, ImportError> {
        let stated = self.tree.take_text(keys);
        let known = stated.as_deref().and_then(|unit| units.iter().find(|(name, _)| *name == unit));
        if let Some((_, factor)) = known {
            return Ok(*factor);
        }
        let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
        let found = stated.map_or("no unit".to_owned(), |unit| format!("the unit {}", quoted(&unit)));
        let expected = format!("one of: {}", names.join(", "));
        let advice = "state the unit, or convert the numbers";
        Err(self.malformed(&format!("{path}.unit"), None, found, &expected, advice))
    }

    /// All columns have one entry per point.
    pub(super) fn check_length(&self, name: &str, found: usize, expected: usize) -> Result<(), ImportError> {
        if found == expected {
            return Ok(());
        }
        Err(ImportError::Contradiction(fault(
            self.at(&format!("data.{name}.values")),
            format!("{found} entries"),
            format!("{expected}, one for each value of `data.BRDF`"),
            "write the file again: which entries belong together cannot be told",
        )))
    }
}
