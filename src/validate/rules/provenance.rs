//! Is it said where the numbers come from, and under which terms they may be used?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::Place;

pub(in super::super) fn source_digest(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (index, receipt) in document.provenance.receipts.iter().enumerate() {
        let malformed =
            |text: &str| text.len() != 64 || !text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
        if let Some(input) = receipt.inputs.iter().find(|input| malformed(&input.sha256)) {
            let place = Place::path(format!("/{}/{}", name::PROVENANCE, name::RECEIPTS)).at_index([index]);
            found.add(place, format!("`{}` for {}", input.sha256, input.name), "64 hexadecimal digits, lower case");
        }
    }
}

pub(in super::super) fn unfilled(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (index, receipt) in document.provenance.receipts.iter().enumerate().filter(|(_, r)| !r.unfilled.is_empty()) {
        let place = Place::path(format!("/{}/{}", name::PROVENANCE, name::RECEIPTS)).at_index([index]);
        found.add(place, receipt.unfilled.join(", "), "fields that the import could fill");
    }
}

pub(in super::super) fn origin(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    let nothing = document.provenance.receipts.is_empty() && document.provenance.steps.is_empty();
    if nothing && !document.measurements.is_empty() {
        let place = Place::path(format!("/{}", name::PROVENANCE));
        found.add(place, "neither a receipt nor a step", "what was read, and what was done to it");
    }
}

pub(in super::super) fn license(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    let place = || Place::path(format!("/@{}", name::LICENSE));
    match &document.license {
        None => found.add(place(), "nothing", "the SPDX identifier of the licence, as in CC-BY-4.0"),
        // The form of an SPDX expression: identifiers joined by AND, OR, WITH, with brackets.
        Some(text) if text.is_empty() || !text.split([' ', '(', ')']).all(is_spdx_word) => {
            found.add(place(), format!("`{text}`"), "an SPDX expression, as in CC-BY-4.0 or LicenseRef-our-terms");
        }
        Some(_) => {}
    }
}

fn is_spdx_word(word: &str) -> bool {
    word.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '+' | ':'))
        && (word.is_empty()
            || matches!(word, "AND" | "OR" | "WITH")
            || word.contains('-')
            || word.chars().any(|c| c.is_ascii_digit())
            || word.len() <= 12)
}

pub(in super::super) fn extension_domain(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for extension in document.extensions.iter().filter(|extension| !extension.domain.as_str().contains('.')) {
        let place = Place::path(format!("/{}/{}", name::EXTENSION, extension.domain));
        found.add(place, format!("`{}`", extension.domain), "a reverse domain name, as in org.example.goniometer");
    }
}
