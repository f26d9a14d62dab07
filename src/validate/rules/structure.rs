//! Is it a file of the standard, and whole?

use super::super::Context;
use super::super::finding::{Finder, Report};
use super::super::registry::rule;
use crate::container::layout::{self, Kind, name};
use crate::container::{Mismatch, ReadError};
use crate::dataset::Place;

/// The report on bytes that the HDF5 reader refuses.
pub(in super::super) fn unreadable(error: &ReadError) -> Report {
    let mut findings = Vec::new();
    if let Some(rule) = rule("bbrf:1.0:structure.hdf5") {
        let mut found = rule.finder();
        found.add(error.place().clone(), error.to_string(), "an undamaged HDF5 file");
        findings = found.findings;
    }
    Report { digest: None, readable: false, findings }
}

/// Reported by [`unreadable`], before there is a tree.
pub(in super::super) fn hdf5(_: &Context<'_>, _: &mut Finder) {}

pub(in super::super) fn version_stated(context: &Context<'_>, found: &mut Finder) {
    if context.version().is_none() {
        let place = Place::path(format!("/@{}", name::BBRF_VERSION));
        let stated = context.root_text(name::BBRF_VERSION).map_or("nothing".to_owned(), |text| format!("`{text}`"));
        found.add(place, stated, format!("a version such as {}", layout::VERSION));
    }
}

pub(in super::super) fn major_version(context: &Context<'_>, found: &mut Finder) {
    if let Some((major, minor)) = context.version().filter(|(major, _)| *major != layout::MAJOR) {
        let place = Place::path(format!("/@{}", name::BBRF_VERSION));
        found.add(place, format!("version {major}.{minor}"), format!("{}.x", layout::MAJOR));
    }
}

pub(in super::super) fn minor_version(context: &Context<'_>, found: &mut Finder) {
    if let Some((layout::MAJOR, minor)) = context.version().filter(|(_, minor)| *minor > layout::MINOR) {
        let place = Place::path(format!("/@{}", name::BBRF_VERSION));
        found.add(place, format!("version {}.{minor}", layout::MAJOR), format!("at most {}", layout::VERSION));
    }
}

pub(in super::super) fn conventions(context: &Context<'_>, found: &mut Finder) {
    let stated = context.root_text(name::CONVENTIONS).unwrap_or("");
    let mut words = stated.split([' ', ',', '/']);
    if !words.any(|word| word.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("BBRF"))) {
        let place = Place::path(format!("/@{}", name::CONVENTIONS));
        found.add(place, format!("`{stated}`"), format!("`{}`", layout::CONVENTIONS));
    }
}

pub(in super::super) fn complete(context: &Context<'_>, found: &mut Finder) {
    match &context.inspection.document {
        Err(ReadError::Missing { place, expected }) => {
            // The document does not say what belongs there, the layout does.
            let form =
                place.path.as_deref().and_then(layout::find).map_or_else(String::new, |entry| match entry.kind {
                    Kind::Dataset(kind) | Kind::Attribute(kind) => format!(": {kind}, {}", entry.meaning),
                    Kind::Group => format!(": {}", entry.meaning),
                });
            found.add((**place).clone(), "nothing", format!("{expected}{form}"));
        }
        Ok(_) => {
            for mismatch in &context.inspection.mismatches {
                if let Mismatch::Absent(path) = mismatch {
                    let (_, expected) = context.found_and_expected(path);
                    found.add(
                        Place::path(path),
                        "nothing",
                        format!("{expected}, which the rest of the file calls for"),
                    );
                }
            }
        }
        Err(_) => {}
    }
}

pub(in super::super) fn readable(context: &Context<'_>, found: &mut Finder) {
    match &context.inspection.document {
        Err(ReadError::Missing { .. } | ReadError::Version { .. }) | Ok(_) => {}
        Err(ReadError::Unexpected { place, found: what, expected }) => {
            found.add((**place).clone(), what.as_str(), expected.as_str());
        }
        Err(error) => found.add(error.place().clone(), error.to_string(), "content of the standard's form"),
    }
}

pub(in super::super) fn shapes(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        if let Err(error) = measurement.check_shape() {
            let place = Place::path(format!("{path}: {}", error.array));
            found.add(place, format!("shape {:?}", error.found), format!("shape {:?}", error.expected));
        }
    }
}

pub(in super::super) fn attributes(context: &Context<'_>, found: &mut Finder) {
    for mismatch in &context.inspection.mismatches {
        let Mismatch::Attribute(path) = mismatch else { continue };
        let is_rule_of_its_own = path.ends_with("@units")
            || path.contains("@unit_si_")
            || path.ends_with("@Conventions")
            || path == "/@bbrf_version";
        if !is_rule_of_its_own {
            let (there, expected) = context.found_and_expected(path);
            found.add(Place::path(path), there, expected);
        }
    }
}

pub(in super::super) fn description(context: &Context<'_>, found: &mut Finder) {
    for path in &context.inspection.described {
        found.add(Place::path(path), "another description", "that of the standard's writer");
    }
}

pub(in super::super) fn unknown(context: &Context<'_>, found: &mut Finder) {
    for path in &context.inspection.unknown {
        found.add(Place::path(path), "content that the standard does not know", "content of the standard");
    }
}
