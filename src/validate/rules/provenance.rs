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
        Some(text) if !is_spdx_expression(text) => {
            found.add(place(), format!("`{text}`"), "an SPDX expression, as in CC-BY-4.0 or LicenseRef-our-terms");
        }
        Some(_) => {}
    }
}

/// True for identifiers joined by AND, OR and WITH, with brackets (SPDX 2.3, annex D). Their list of licences grows, and
/// is not asked.
fn is_spdx_expression(text: &str) -> bool {
    let is_identifier =
        |word: &str| word.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '+' | ':'));
    let spaced = text.replace('(', " ( ").replace(')', " ) ");
    let (mut depth, mut is_operand_next) = (0_usize, true);
    for word in spaced.split_whitespace() {
        let is_operator = matches!(word, "AND" | "OR" | "WITH");
        match word {
            "(" if is_operand_next => depth += 1,
            ")" if !is_operand_next && depth > 0 => depth -= 1,
            _ if is_operator != is_operand_next && (is_operator || is_identifier(word)) => {
                is_operand_next = is_operator
            }
            _ => return false,
        }
    }
    depth == 0 && !is_operand_next
}

pub(in super::super) fn extension_domain(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for extension in document.extensions.iter().filter(|extension| !extension.domain.as_str().contains('.')) {
        let place = Place::path(format!("/{}/{}", name::EXTENSION, extension.domain));
        found.add(place, format!("`{}`", extension.domain), "a reverse domain name, as in org.example.goniometer");
    }
}
