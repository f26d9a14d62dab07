//! Extensions: taken as they are, as far as every reader of the format can take them.

use super::super::error::EncodeError;
use super::super::layout::is_outside_digest;
use super::super::tree::{Array, Attributes, Data, Dataset, Group};
use super::without_nul;
use crate::dataset::Extension;

/// The group `extension` with the content of each under its domain.
pub(super) fn extensions(extensions: &[Extension]) -> Result<Group, EncodeError> {
    let content = extensions.iter().map(|part| Ok((part.domain.to_string(), kept(&part.content)?)));
    Ok(Group { groups: content.collect::<Result<_, EncodeError>>()?, ..Group::default() })
}

fn kept(group: &Group) -> Result<Group, EncodeError> {
    let datasets = group.datasets.iter().map(|(name, dataset)| {
        let array = checked(name, &dataset.array)?;
        Ok((member(name)?, Dataset { attributes: attributes(&dataset.attributes)?, ..Dataset::new(array) }))
    });
    let groups = group.groups.iter().map(|(name, group)| Ok((member(name)?, kept(group)?)));
    Ok(Group {
        attributes: attributes(&group.attributes)?,
        datasets: datasets.collect::<Result<_, EncodeError>>()?,
        groups: groups.collect::<Result<_, EncodeError>>()?,
    })
}

fn attributes(attributes: &Attributes) -> Result<Attributes, EncodeError> {
    let own = attributes.iter().filter(|(name, _)| !is_outside_digest(name));
    own.map(|(name, array)| Ok((without_nul(name)?, checked(name, array)?))).collect()
}

fn member(name: &str) -> Result<String, EncodeError> {
    if name.is_empty() || name == "." || name.contains('/') {
        return Err(EncodeError::Extension { name: name.to_owned(), found: "a name that HDF5 cannot hold".to_owned() });
    }
    without_nul(name)
}

fn checked(name: &str, array: &Array) -> Result<Array, EncodeError> {
    let refused = |found: String| Err(EncodeError::Extension { name: name.to_owned(), found });
    match &array.data {
        Data::Other(kind) => return refused(format!("values of type {kind}")),
        Data::Text(texts) => texts.iter().try_for_each(|text| without_nul(text).map(drop))?,
        _ => {}
    }
    let expected = array.shape.iter().try_fold(1_usize, |product, length| product.checked_mul(*length));
    if expected != Some(array.data.len()) {
        return refused(format!("{} values in the shape {:?}", array.data.len(), array.shape));
    }
    Ok(array.clone())
}
