//! Do the numbers say what they mean?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::container::tree::Array;
use crate::dataset::Place;
use crate::quantity::QuantityKind;

pub(in super::super) fn units(context: &Context<'_>, found: &mut Finder) {
    for (path, dataset) in context.datasets() {
        let text = |attribute: &str| dataset.attributes.get(attribute).and_then(Array::as_text);
        let Some(kind) = text(name::QUANTITY).and_then(|text| text.parse::<QuantityKind>().ok()) else { continue };
        let stated = text(name::UNITS).unwrap_or("");
        if stated != kind.unit() {
            let place = Place::path(format!("{path}@{}", name::UNITS));
            found.add(place, format!("`{stated}`"), format!("`{}`, the unit of {kind}", kind.unit()));
        }
    }
}

pub(in super::super) fn other_units(context: &Context<'_>, found: &mut Finder) {
    use crate::container::Mismatch;
    for mismatch in &context.inspection.mismatches {
        let Mismatch::Attribute(path) = mismatch else { continue };
        if path.ends_with("@units") && !path.ends_with(&format!("/{}@units", name::VALUE)) {
            found.add(Place::path(path), "another unit, or none", "the unit that the standard gives it");
        }
    }
}

pub(in super::super) fn unstated(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        for field in measurement.quantity.unstated_fields() {
            let place = Place::path(format!("{path}/{}@{}", name::VALUE, field.replace('-', "_")));
            found.add(place, "`unstated`", format!("the {field} of the values"));
        }
    }
}

pub(in super::super) fn certified_factor(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let (count, emission) = (measurement.quantity.certified_factor.len(), measurement.emission.len());
        if count > 1 && count != emission {
            let place = Place::path(format!("{path}/{}", name::CERTIFIED_FACTOR));
            found.add(place, format!("{count} factors"), format!("none, one, or {emission}"));
        }
    }
}
