//! What a rule sees: the raw tree, and the document where there is one.

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::census::Census;
use crate::container::layout::{self, name};
use crate::container::tree::{Array, Data, Dataset, Group, Object};
use crate::container::{Inspection, in_words};
use crate::dataset::{Document, Measurement};

/// A file under inspection.
#[derive(Debug)]
pub struct Context<'a> {
    /// What was read.
    pub inspection: &'a Inspection,
    /// Of each measurement of the document.
    census: Vec<Census>,
}

impl<'a> Context<'a> {
    /// A context.
    #[must_use]
    pub fn new(inspection: &'a Inspection) -> Self {
        let document = inspection.document.as_ref();
        let census = document.map_or_else(|_| Vec::new(), |all| all.measurements.par_iter().map(Census::of).collect());
        Self { inspection, census }
    }

    /// The document, if the tree is one.
    #[must_use]
    pub fn document(&self) -> Option<&'a Document> {
        self.inspection.document.as_ref().ok()
    }

    /// The measurements of the document, with their paths.
    pub fn measurements(&self) -> impl Iterator<Item = (String, &'a Measurement)> {
        let measurements = self.document().map_or(&[][..], |document| &document.measurements);
        measurements.iter().map(|measurement| (format!("/{}/{}", name::MEASUREMENT, measurement.id), measurement))
    }

    /// The same measurements, with what there is among their values.
    pub(super) fn counted(&self) -> impl Iterator<Item = (String, &'a Measurement, Census)> {
        self.measurements().zip(&self.census).map(|((path, measurement), census)| (path, measurement, *census))
    }

    /// What stands at the path of an object or an attribute, and what the rest of the file calls for there.
    #[must_use]
    pub fn found_and_expected(&self, path: &str) -> (String, String) {
        let expected = self.inspection.canonical.as_ref().and_then(|tree| in_words(tree, path));
        let found = in_words(&self.inspection.tree, path);
        let expected = expected.unwrap_or_else(|| "what the rest of the file calls for".to_owned());
        (found.unwrap_or_else(|| "nothing".to_owned()), expected)
    }

    /// A text attribute of the root.
    #[must_use]
    pub fn root_text(&self, attribute: &str) -> Option<&'a str> {
        self.inspection.tree.attributes.get(attribute).and_then(Array::as_text)
    }

    /// Every dataset with its path.
    #[must_use]
    pub fn datasets(&self) -> Vec<(String, &'a Dataset)> {
        let mut datasets = Vec::new();
        self.inspection.tree.visit("", &mut |path, object| {
            if let Object::Dataset(dataset) = object {
                datasets.push((path.to_owned(), dataset));
            }
        });
        datasets
    }

    /// The groups of measurements as they are in the file, with their paths.
    pub fn measurement_groups(&self) -> impl Iterator<Item = (String, &'a Group)> {
        let list = self.inspection.tree.group(name::MEASUREMENT).map_or(&[][..], |list| &list.groups);
        list.iter().map(|(id, group)| (format!("/{}/{id}", name::MEASUREMENT), group))
    }

    /// True for a file that says it is of this standard, in a version that is understood.
    #[must_use]
    pub fn is_this_standard(&self) -> bool {
        self.version().is_some_and(|(major, _)| major == layout::MAJOR)
    }

    /// The version that the file states, as major and minor.
    #[must_use]
    pub fn version(&self) -> Option<(u64, u64)> {
        self.root_text(name::BBRF_VERSION).and_then(layout::parse_version)
    }
}

/// Numbers of a dataset as they are in the file.
pub(super) fn numbers<'a>(group: &'a Group, dataset: &str) -> &'a [f64] {
    match group.dataset(dataset).map(|dataset| &dataset.array.data) {
        Some(Data::F64(numbers)) => numbers,
        _ => &[],
    }
}
