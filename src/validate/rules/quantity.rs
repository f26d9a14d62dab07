//! Do the numbers say what they mean?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::container::tree::Array;
use crate::dataset::Place;
use crate::quantity::{EmissionAxis, NormalisedAt, Part, Quantity, QuantityKind, Reference};

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
            let (there, expected) = context.found_and_expected(path);
            found.add(Place::path(path), there, expected);
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

pub(in super::super) fn si_unit(context: &Context<'_>, found: &mut Finder) {
    use crate::container::Mismatch;
    for mismatch in &context.inspection.mismatches {
        let Mismatch::Attribute(path) = mismatch else { continue };
        if path.ends_with(&format!("@{}", name::SI_FACTOR)) || path.ends_with(&format!("@{}", name::SI_EXPONENTS)) {
            let (there, expected) = context.found_and_expected(path);
            found.add(Place::path(path), there, format!("{expected}, what the unit of the quantity is in SI"));
        }
    }
}

/// Reports the quantities of measurements that a test objects to, at one of their attributes.
fn each(
    context: &Context<'_>,
    found: &mut Finder,
    attribute: &str,
    objects: impl Fn(&Quantity) -> Option<(String, &'static str)>,
) {
    for (path, measurement) in context.measurements() {
        if let Some((what, expected)) = objects(&measurement.quantity) {
            found.add(Place::path(format!("{path}/{}@{attribute}", name::VALUE)), what, expected);
        }
    }
}

pub(in super::super) fn part_of_kind(context: &Context<'_>, found: &mut Finder) {
    each(context, found, name::PART, |quantity| {
        use QuantityKind::{BispectralLuminescentRadianceFactor, Brrdf};
        let density = matches!(quantity.kind, BispectralLuminescentRadianceFactor | Brrdf);
        let wrong = density && !matches!(quantity.part, Part::Luminescent | Part::Unstated);
        wrong.then(|| (format!("`{}`", quantity.part), "`luminescent`: a density has no elastic part, which is a line"))
    });
}

pub(in super::super) fn normalised_at_of_kind(context: &Context<'_>, found: &mut Finder) {
    each(context, found, name::NORMALISED_AT, |quantity| {
        let (expected, text) = match quantity.kind {
            QuantityKind::RadianceFactor | QuantityKind::LuminanceFactor | QuantityKind::BandRadianceFactor => {
                (NormalisedAt::Emission, "`emission`: the reference is read at the wavelength of the value")
            }
            QuantityKind::BispectralLuminescentRadianceFactor | QuantityKind::Brrdf => {
                (NormalisedAt::Excitation, "`excitation`: the light that excites is what the value is relative to")
            }
            QuantityKind::SpectralRadiance
            | QuantityKind::SpectralIrradiance
            | QuantityKind::BandRadiance
            | QuantityKind::Luminance => (NormalisedAt::None, "`none`: it is no ratio"),
            _ => return None,
        };
        let fits = quantity.normalised_at == expected || quantity.normalised_at == NormalisedAt::Unstated;
        (!fits).then(|| (format!("`{}`", quantity.normalised_at), text))
    });
}

pub(in super::super) fn reference_of_kind(context: &Context<'_>, found: &mut Finder) {
    each(context, found, name::REFERENCE, |quantity| {
        if quantity.kind.is_factor() && quantity.reference == Reference::None {
            return Some(("`none`".to_owned(), "the geometry of the reference: a factor is a ratio to one"));
        }
        let absolute = matches!(
            quantity.kind,
            QuantityKind::SpectralRadiance
                | QuantityKind::SpectralIrradiance
                | QuantityKind::BandRadiance
                | QuantityKind::Luminance
        );
        let distribution = matches!(quantity.kind, QuantityKind::Brdf | QuantityKind::Brrdf);
        let relative = !matches!(quantity.reference, Reference::None | Reference::Unstated);
        let expected = if distribution {
            "`none`: it is relative to the irradiance of the surface, and no reference is left in it"
        } else {
            "`none`: it is no ratio"
        };
        ((absolute || distribution) && relative).then(|| (format!("`{}`", quantity.reference), expected))
    });
}

pub(in super::super) fn certified_factor_range(context: &Context<'_>, found: &mut Finder) {
    // No material reflects more than all; the best diffusers reach 1.02 at some angles.
    const HIGHEST: f64 = 1.1;
    for (path, measurement) in context.measurements() {
        let factor = &measurement.quantity.certified_factor;
        if let Some(index) = factor.iter().position(|factor| !(*factor > 0.0 && *factor <= HIGHEST)) {
            let place = Place::path(format!("{path}/{}", name::CERTIFIED_FACTOR)).at_index([index]);
            found.add(place, factor[index].to_string(), format!("more than 0, at most {HIGHEST}"));
        }
    }
}

pub(in super::super) fn donaldson_width(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let band = matches!(measurement.emission, EmissionAxis::Band { .. });
        if measurement.quantity.kind == QuantityKind::DonaldsonMatrix && band {
            let place = Place::path(format!("{path}/{}", name::VALUE));
            found.add(place, "the value of a band", "values over emission wavelengths, whose width they contain");
        }
    }
}
