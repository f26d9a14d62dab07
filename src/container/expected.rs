//! What stands at a path, in words, so that a message can set what is there against what should be.

use super::tree::{Array, Data, Group, Object};

/// So many elements are written out.
const WRITTEN_OUT: usize = 16;

/// What a tree has at the path of a group, a dataset or an attribute; `None` where it has nothing.
#[must_use]
pub(crate) fn in_words(tree: &Group, path: &str) -> Option<String> {
    let (object_path, attribute) = path.split_once('@').map_or((path, None), |(object, name)| (object, Some(name)));
    let mut names: Vec<&str> = object_path.split('/').filter(|name| !name.is_empty()).collect();
    let last = names.pop();
    let parent = names.into_iter().try_fold(tree, Group::group)?;
    let object = match last {
        None => Object::Group(parent),
        Some(name) => match (parent.dataset(name), parent.group(name)) {
            (Some(dataset), _) => Object::Dataset(dataset),
            (None, group) => Object::Group(group?),
        },
    };
    match (attribute, object) {
        (Some(name), _) => object.attributes().get(name).map(array),
        (None, Object::Dataset(dataset)) => Some(array(&dataset.array)),
        (None, Object::Group(_)) => Some("a group".to_owned()),
    }
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
