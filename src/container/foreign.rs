//! What a file holds beside the standard: content of a later minor version, or of another program. Tools that rewrite a
//! file keep it where it was.

use super::layout::{self, is_outside_digest};
use super::tree::{Array, Attributes, Data, Dataset, Group, Object};

/// Content that the standard does not know, with its paths; an attribute's follows `@`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Foreign {
    kept: Vec<(String, Content)>,
    lost: Vec<String>,
}

#[derive(Debug, Clone, PartialEq)]
enum Content {
    Attribute(Array),
    Dataset(Dataset),
    Group(Group),
}

impl Foreign {
    /// What a tree holds beside the standard.
    pub(super) fn of(tree: &Group) -> Self {
        let mut foreign = Self::default();
        foreign.collect(tree, "");
        foreign
    }

    /// The paths of everything that is kept.
    #[must_use]
    pub fn paths(&self) -> Vec<&str> {
        self.kept.iter().map(|(path, _)| path.as_str()).chain(self.lost.iter().map(String::as_str)).collect()
    }

    /// The paths of what cannot be kept: values of a type that this library does not write.
    #[must_use]
    pub fn lost(&self) -> &[String] {
        &self.lost
    }

    fn collect(&mut self, group: &Group, path: &str) {
        self.attributes(&group.attributes, if path.is_empty() { "/" } else { path });
        for (name, dataset) in &group.datasets {
            let path = format!("{path}/{name}");
            if layout::find(&path).is_some() {
                self.attributes(&dataset.attributes, &path);
            } else {
                match carried_dataset(dataset) {
                    Some(dataset) => self.kept.push((path, Content::Dataset(dataset))),
                    None => self.lost.push(path),
                }
            }
        }
        for (name, child) in &group.groups {
            let path = format!("{path}/{name}");
            if layout::find(&path).is_some() {
                self.collect(child, &path);
            } else {
                self.lost.extend(losses(child, &path));
                self.kept.push((path, Content::Group(carried_group(child))));
            }
        }
    }

    fn attributes(&mut self, attributes: &Attributes, path: &str) {
        for (name, array) in attributes.iter().filter(|(name, _)| !is_outside_digest(name)) {
            let path = format!("{path}@{name}");
            if layout::find(&path).is_some() {
                continue;
            }
            if matches!(array.data, Data::Other(_)) {
                self.lost.push(path);
            } else {
                self.kept.push((path, Content::Attribute(array.clone())));
            }
        }
    }

    /// Puts the content where it was, as far as its group is still there.
    #[cfg(feature = "write")]
    pub(super) fn put_into(&self, tree: &mut Group) {
        for (path, content) in &self.kept {
            let (object, attribute) = path.split_once('@').unwrap_or((path, ""));
            let (parent, name) = object.rsplit_once('/').unwrap_or(("", object));
            match content {
                Content::Attribute(array) => {
                    let found =
                        if object == "/" { Some(&mut tree.attributes) } else { attributes_at(tree, parent, name) };
                    if let Some(attributes) = found {
                        attributes.entry(attribute.to_owned()).or_insert_with(|| array.clone());
                    }
                }
                Content::Dataset(dataset) => {
                    if let Some(group) = tree.at_mut(parent).filter(|group| group.dataset(name).is_none()) {
                        group.datasets.push((name.to_owned(), dataset.clone()));
                    }
                }
                Content::Group(content) => {
                    if let Some(group) = tree.at_mut(parent).filter(|group| group.group(name).is_none()) {
                        group.groups.push((name.to_owned(), content.clone()));
                    }
                }
            }
        }
    }
}

#[cfg(feature = "write")]
fn attributes_at<'a>(tree: &'a mut Group, parent: &str, name: &str) -> Option<&'a mut Attributes> {
    let group = tree.at_mut(parent)?;
    if group.dataset(name).is_some() {
        return group.dataset_mut(name).map(|dataset| &mut dataset.attributes);
    }
    group.group_mut(name).map(|group| &mut group.attributes)
}

fn carried_attributes(attributes: &Attributes) -> Attributes {
    let carried =
        attributes.iter().filter(|(name, array)| !is_outside_digest(name) && !matches!(array.data, Data::Other(_)));
    carried.map(|(name, array)| (name.clone(), array.clone())).collect()
}

fn carried_dataset(dataset: &Dataset) -> Option<Dataset> {
    if matches!(dataset.array.data, Data::Other(_)) {
        return None;
    }
    Some(Dataset { attributes: carried_attributes(&dataset.attributes), ..Dataset::new(dataset.array.clone()) })
}

fn carried_group(group: &Group) -> Group {
    let datasets = group.datasets.iter().filter_map(|(name, dataset)| Some((name.clone(), carried_dataset(dataset)?)));
    Group {
        attributes: carried_attributes(&group.attributes),
        datasets: datasets.collect(),
        groups: group.groups.iter().map(|(name, child)| (name.clone(), carried_group(child))).collect(),
    }
}

fn losses(group: &Group, path: &str) -> Vec<String> {
    let mut lost = Vec::new();
    group.visit(path, &mut |path, object| {
        if let Object::Dataset(dataset) = object
            && matches!(dataset.array.data, Data::Other(_))
        {
            lost.push(path.to_owned());
        }
    });
    lost
}
