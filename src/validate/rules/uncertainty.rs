//! Is there an uncertainty, and can it be one?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Place, Role};

pub(in super::super) fn missing(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, measurement)| measurement.role == Role::Sample) {
        if measurement.uncertainty.standard.is_none() {
            found.add(Place::path(format!("{path}/{}", name::VALUE_U)), "nothing", "the standard uncertainty");
        }
    }
}

pub(in super::super) fn negative(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let Some(standard) = &measurement.uncertainty.standard else { continue };
        if let Some(((row, column), value)) = standard.indexed_iter().find(|(_, value)| **value < 0.0) {
            let place = Place::path(format!("{path}/{}", name::VALUE_U)).at_index([row, column]);
            found.add(place, value.to_string(), "zero or more, or NaN where it is unknown");
        }
    }
}

pub(in super::super) fn shared(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        for (position, component) in measurement.uncertainty.components.iter().enumerate() {
            let place = || Place::path(format!("{path}/{}{position}", name::COMPONENT));
            if let Some(index) = component.relative.iter().position(|value| *value < 0.0) {
                found.add(place().at_index([index]), component.relative[index].to_string(), "zero or more");
            }
            let (count, emission) = (component.relative.len(), measurement.emission.len());
            if count != 1 && count != emission {
                found.add(place(), format!("{count} values"), format!("one, or {emission}"));
            }
        }
    }
}
