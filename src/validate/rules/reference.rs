//! Does everything that is referred to exist?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{DocumentError, Place};
use crate::quantity::ReferenceLight;

pub(in super::super) fn dangling(context: &Context<'_>, found: &mut Finder) {
    if let Some(Err(DocumentError::DanglingReference { from, list, id })) = context.document().map(|d| d.check()) {
        found.add(Place::path(from), format!("a reference to `{id}`"), format!("the id of one of the {list}"));
    }
}

pub(in super::super) fn light(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (path, measurement) in context.measurements() {
        if let ReferenceLight::Light(id) = &measurement.quantity.reference_light
            && !document.lights.iter().any(|light| light.id.as_str() == id)
        {
            let place = Place::path(format!("{path}/{}@{}", name::VALUE, name::REFERENCE_LIGHT));
            found.add(place, format!("`{id}`"), "same, unstated, or the id of a light");
        }
    }
}

pub(in super::super) fn excitation(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let states = measurement.excitations.len();
        let outside = |index: u32| usize::try_from(index).is_ok_and(|index| index >= states);
        let row = measurement.acquisitions.iter().position(|row| row.excitation.is_some_and(outside));
        if let Some(row) = row {
            let place = Place::path(format!("{path}/{}", name::EXCITATION)).at_index([row]);
            let index = measurement.acquisitions[row].excitation.unwrap_or(0);
            found.add(place, format!("index {index}"), format!("one of {states} excitation states, from 0"));
        }
    }
}
