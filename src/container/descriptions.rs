//! Attributes that describe content and are none: no digest covers them, so they are compared with what the standard's
//! writer gives.

use super::layout::{self, name};
use super::tree::{Array, Attributes, Group};

/// Paths of the descriptions in a file that are not those that its document would be written with. Nothing in a file of
/// another version, which may have better sentences.
///
/// A description that is left out is none of them, nor are `Conventions` with further ones beside those of the standard.
pub(super) fn differing(tree: &Group, canonical: &Group) -> Vec<String> {
    let stated = tree.attributes.get(name::BBRF_VERSION).and_then(Array::as_text).and_then(layout::parse_version);
    let mut found = Vec::new();
    if stated == Some((layout::MAJOR, layout::MINOR)) {
        in_group(tree, canonical, "", &mut found);
    }
    found
}

fn in_group(tree: &Group, canonical: &Group, path: &str, found: &mut Vec<String>) {
    let shown = if path.is_empty() { "/" } else { path };
    compare(&tree.attributes, &canonical.attributes, shown, found);
    for (name, expected) in &canonical.datasets {
        if let Some(dataset) = tree.dataset(name) {
            compare(&dataset.attributes, &expected.attributes, &format!("{path}/{name}"), found);
        }
    }
    for (name, expected) in &canonical.groups {
        if let Some(group) = tree.group(name) {
            in_group(group, expected, &format!("{path}/{name}"), found);
        }
    }
}

fn compare(attributes: &Attributes, expected: &Attributes, path: &str, found: &mut Vec<String>) {
    for name in layout::DESCRIPTIONS {
        let (Some(stored), Some(expected)) = (attributes.get(name), expected.get(name).and_then(Array::as_text)) else {
            continue;
        };
        let stored = stored.as_text().unwrap_or_default();
        let has_all = || expected.split(' ').all(|word| stored.split([' ', ',']).any(|found| found == word));
        if stored != expected && !(name == name::CONVENTIONS && has_all()) {
            found.push(format!("{path}@{name}"));
        }
    }
}
