//! What our own export says where the format has no words for it: `metadata.adhoc_section.bbrf`.

use serde::Deserialize;

use super::file::File;
use super::json::Json;
use crate::dataset::{Document, Id};
use crate::import::receipt::Notes;
use crate::quantity::{Band, Component, Quantity, QuantityKind, Statement};

/// The content of that section.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Ours {
    /// For people.
    #[serde(rename = "note")]
    _note: Option<String>,
    measurement: Option<Id>,
    title: Option<String>,
    citation: Option<String>,
    quantity: Option<Quantity>,
    band: Option<Band>,
    statement: Option<Statement>,
    components: Vec<Component>,
}

impl Ours {
    /// Takes the section out; what has another form stays where it is, with a notice.
    pub(super) fn take(file: &mut File, notes: &mut Notes) -> Self {
        let path = ["metadata", "adhoc_section", "bbrf"];
        let Some(found) = file.tree.at(&path) else { return Self::default() };
        let read = serde_json::to_value(found).and_then(serde_json::from_value::<Self>);
        let of_brdf = |ours: &Self| ours.quantity.as_ref().is_none_or(|quantity| quantity.kind == QuantityKind::Brdf);
        match read.ok().filter(of_brdf).filter(|_| !has_nul(found)) {
            Some(ours) => {
                file.tree.take(&path, |_| Some(()));
                ours
            }
            None => {
                notes.notice(file.at(&path.join(".")), "not what our export writes: kept in the extension, not used");
                Self::default()
            }
        }
    }

    /// The id of the measurement.
    pub(super) fn id(&self) -> Option<Id> {
        self.measurement.clone()
    }

    /// What the values are.
    pub(super) fn quantity(&self) -> Option<Quantity> {
        self.quantity.clone()
    }

    /// The band of values without a wavelength.
    pub(super) fn band(&self) -> Option<Band> {
        self.band.filter(|band| band.from_nm > 0.0 && band.to_nm > band.from_nm)
    }

    /// Puts it where it belongs.
    pub(super) fn apply(self, document: &mut Document) {
        document.citation = document.citation.take().or(self.citation);
        let [measurement] = document.measurements.as_mut_slice() else { return };
        measurement.title = self.title;
        if measurement.uncertainty.standard.is_some() {
            measurement.uncertainty.statement = self.statement.unwrap_or_default();
        }
        measurement.uncertainty.components = self.components;
    }
}

/// The format of ours excludes U+0000 from texts.
fn has_nul(json: &Json) -> bool {
    match json {
        Json::Text(text) => text.contains('\0'),
        Json::List(list) => list.iter().any(has_nul),
        Json::Object(members) => members.iter().any(|(key, value)| key.contains('\0') || has_nul(value)),
        _ => false,
    }
}
