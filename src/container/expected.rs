//! What stands at a path, in words, so that a message can set what is there against what should be.

use super::encode::encode;
use super::tree::{Array, Data, Group, Object};
use crate::dataset::Document;

/// So many elements are written out.
const WRITTEN_OUT: usize = 16;

/// What a tree has at the path of a group, a dataset or an attribute; `None` where it has nothing.
#[must_use]
pub(crate) fn in_words(tree: &Group, path: &str) -> Option<String> {
    let (object_path, attribute) = path.split_once('@').map_or((path, None), |(object, name)| (object, Some(name)));
    let wanted = if object_path == "/" { "" } else { object_path };
    let mut words = None;
    tree.visit("", &mut |found, object| {
        if found.trim_end_matches('/') == wanted {
            words = match (attribute, &object) {
                (Some(name), _) => object.attributes().get(name).map(array),
                (None, Object::Dataset(dataset)) => Some(array(&dataset.array)),
                (None, Object::Group(_)) => Some("a group".to_owned()),
            };
        }
    });
    words
}

/// The document as it would be written, without digests.
#[must_use]
pub(crate) fn as_written(document: &Document) -> Option<Group> {
    encode(document).ok()
}

fn array(array: &Array) -> String {
    if let Some(text) = array.as_text() {
        return format!("`{text}`");
    }
    if array.data.len() > WRITTEN_OUT || matches!(array.data, Data::Other(_)) {
        return format!("{} of shape {:?}", array.data.type_name(), array.shape);
    }
    let elements = serde_json::to_value(&array.data).ok();
    let elements = elements.as_ref().and_then(|data| data.as_object()?.values().next());
    let list = elements.map_or_else(|| "nothing".to_owned(), |elements| elements.to_string().replace(',', ", "));
    list.trim_matches(|bracket| bracket == '[' || bracket == ']').replace('"', "`")
}
