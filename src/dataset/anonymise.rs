//! Taking the names of people out of a document.

use serde_json::Value;

use super::Document;

/// What was taken out, and where the same or another person may still be named.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Anonymised {
    /// Paths of the attributes that were taken out.
    pub removed: Vec<String>,
    /// Texts that stand, and that somebody should look at.
    pub suspects: Vec<Suspect>,
}

/// A text that may name a person.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Suspect {
    /// Where, as a path in the JSON form of the document.
    pub path: String,
    /// The text.
    pub text: String,
}

/// Folders whose next part is the name of a user.
const HOMES: [&str; 4] = ["/home/", "/Users/", "\\Users\\", "\\Documents and Settings\\"];
/// A shorter word of a name, as an initial, is found everywhere.
const SHORTEST_WORD: usize = 4;

impl Document {
    /// Takes out `contact` and every `operator`, and lists the texts that may still name a person: those with a word of
    /// a name that was taken out, with an address, or with the folder of a user. They are left, because only whoever
    /// knows the people can tell.
    pub fn anonymise(&mut self) -> Anonymised {
        let (mut removed, mut names) = (Vec::new(), Vec::new());
        if let Some(contact) = self.contact.take() {
            removed.push("/@contact".to_owned());
            names.push(contact);
        }
        for measurement in &mut self.measurements {
            if let Some(operator) = measurement.conditions.operator.clone() {
                measurement.conditions.anonymise();
                removed.push(format!("/measurement/{}@operator", measurement.id));
                names.push(operator);
            }
        }
        let words: Vec<String> = names.iter().flat_map(|name| words(name)).collect();
        let mut suspects = Vec::new();
        for (path, value) in self.texts() {
            collect(&value, &path, &words, &mut suspects);
        }
        Anonymised { removed, suspects }
    }

    /// Everything of the document that holds texts, without its arrays.
    fn texts(&self) -> Vec<(String, Value)> {
        let json = |value: serde_json::Result<Value>| value.unwrap_or_default();
        let head = [("/title", &self.title), ("/license", &self.license), ("/citation", &self.citation)];
        let mut all: Vec<(String, Value)> =
            head.into_iter().map(|(path, text)| (path.to_owned(), json(serde_json::to_value(text)))).collect();
        let mut part = |path: &str, value| all.push((path.to_owned(), json(value)));
        part("/sample", serde_json::to_value(&self.samples));
        part("/instrument", serde_json::to_value(&self.instruments));
        part("/white_reference", serde_json::to_value(&self.white_references));
        part("/provenance", serde_json::to_value(&self.provenance));
        part("/extension", serde_json::to_value(&self.extensions));
        for light in &self.lights {
            let light = super::Light { spectrum: None, ..light.clone() };
            part(&format!("/light/{}", light.id), serde_json::to_value(&light));
        }
        for measurement in &self.measurements {
            let path = format!("/measurement/{}", measurement.id);
            part(&path, serde_json::to_value((&measurement.title, &measurement.conditions, &measurement.excitations)));
            let causes: Vec<&str> = measurement.uncertainty.components.iter().map(|c| c.name.as_str()).collect();
            part(&format!("{path}/causes"), serde_json::to_value(causes));
        }
        for model in &self.models {
            let texts = (&model.title, &model.method, &model.identifiability);
            part(&format!("/model/{}", model.id), serde_json::to_value(texts));
        }
        all
    }
}

/// The words of a name that are long enough to be looked for, in lower case; of an address what stands before its host.
fn words(name: &str) -> Vec<String> {
    let people = name.split_whitespace().filter_map(|word| word.split('@').next());
    let split = people.flat_map(|word| word.split(|c: char| !c.is_alphanumeric()));
    split.filter(|word| word.chars().count() >= SHORTEST_WORD).map(str::to_lowercase).collect()
}

fn collect(value: &Value, path: &str, words: &[String], suspects: &mut Vec<Suspect>) {
    match value {
        Value::String(text) if names_somebody(text, words) => {
            suspects.push(Suspect { path: path.to_owned(), text: text.clone() });
        }
        Value::Array(items) => {
            (0..).zip(items).for_each(|(k, item): (usize, _)| collect(item, &format!("{path}/{k}"), words, suspects));
        }
        Value::Object(members) => {
            members.iter().for_each(|(name, item)| collect(item, &format!("{path}/{name}"), words, suspects));
        }
        _ => {}
    }
}

fn names_somebody(text: &str, words: &[String]) -> bool {
    let lower = text.to_lowercase();
    let of_text: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).collect();
    let is_address =
        |word: &str| word.split_once('@').is_some_and(|(name, host)| !name.is_empty() && host.contains('.'));
    words.iter().any(|word| of_text.contains(&word.as_str()))
        || text.split_whitespace().any(is_address)
        || HOMES.iter().any(|home| text.contains(home))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::super::{InputFile, Receipt, Sample, Step};
    use super::*;

    #[test]
    fn names_are_taken_out_or_pointed_at() {
        let step = |action: &str| Step { tool: "hand".to_owned(), action: action.to_owned(), time: None };
        let input = InputFile {
            name: "C:\\Users\\hk\\scan.txt".to_owned(),
            sha256: String::new(),
            bytes: 0,
            dialect: String::new(),
            records: 0,
        };
        let mut document = Document {
            contact: Some("Hanako Kimura <hk@example.org>".to_owned()),
            citation: Some("KIMURA, 2026".to_owned()),
            samples: vec![Sample { holder: Some("as kimurai had it".to_owned()), ..Sample::default() }],
            ..Document::default()
        };
        document.provenance.receipts = vec![Receipt { inputs: vec![input], ..Receipt::default() }];
        document.provenance.steps = vec![step("fit"), step("asked ab@example.com")];
        let found = document.anonymise();
        assert_eq!((document.contact.as_ref(), found.removed), (None, vec!["/@contact".to_owned()]));
        let paths: Vec<&str> = found.suspects.iter().map(|suspect| suspect.path.as_str()).collect();
        assert_eq!(paths, ["/citation", "/provenance/receipts/0/inputs/0/name", "/provenance/steps/1/action"]);
        assert_eq!(document.anonymise().removed, Vec::<String>::new());
    }
}
