//! Groups, datasets and attributes as plain values: what an extension holds, and what everything between a document and
//! a file passes through, so that neither the layout knows the libraries nor the libraries the layout.

mod values;

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use values::Values;

/// The values of an array, in row-major order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Data {
    U8(Values<u8>),
    U16(Values<u16>),
    U32(Values<u32>),
    U64(Values<u64>),
    I8(Values<i8>),
    I16(Values<i16>),
    I32(Values<i32>),
    I64(Values<i64>),
    F32(Values<f32>),
    F64(Values<f64>),
    Text(Vec<String>),
    /// A type that the format does not use, by its description; its values are not kept.
    Other(String),
}

impl Data {
    /// Name of the element type, as the format's tables spell it.
    #[must_use]
    pub fn type_name(&self) -> &str {
        match self {
            Self::U8(_) => "uint8",
            Self::U16(_) => "uint16",
            Self::U32(_) => "uint32",
            Self::U64(_) => "uint64",
            Self::I8(_) => "int8",
            Self::I16(_) => "int16",
            Self::I32(_) => "int32",
            Self::I64(_) => "int64",
            Self::F32(_) => "float32",
            Self::F64(_) => "float64",
            Self::Text(_) => "string",
            Self::Other(name) => name,
        }
    }

    /// Number of values kept.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::U8(v) => v.len(),
            Self::U16(v) => v.len(),
            Self::U32(v) => v.len(),
            Self::U64(v) => v.len(),
            Self::I8(v) => v.len(),
            Self::I16(v) => v.len(),
            Self::I32(v) => v.len(),
            Self::I64(v) => v.len(),
            Self::F32(v) => v.len(),
            Self::F64(v) => v.len(),
            Self::Text(v) => v.len(),
            Self::Other(_) => 0,
        }
    }

    /// True without a single value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values as little-endian bytes, without a copy where the machine keeps them so; of a text its length (64 bit)
    /// and its UTF-8 bytes.
    #[must_use]
    pub fn bytes(&self) -> Cow<'_, [u8]> {
        macro_rules! bytes {
            ($values:expr) => {
                if cfg!(target_endian = "little") {
                    Cow::Borrowed(bytemuck::cast_slice(&**$values))
                } else {
                    $values.iter().flat_map(|value| value.to_le_bytes()).collect()
                }
            };
        }
        match self {
            Self::U8(v) => Cow::Borrowed(v),
            Self::U16(v) => bytes!(v),
            Self::U32(v) => bytes!(v),
            Self::U64(v) => bytes!(v),
            Self::I8(v) => bytes!(v),
            Self::I16(v) => bytes!(v),
            Self::I32(v) => bytes!(v),
            Self::I64(v) => bytes!(v),
            Self::F32(v) => bytes!(v),
            Self::F64(v) => bytes!(v),
            Self::Text(texts) => {
                let length = |text: &String| (text.len() as u64).to_le_bytes();
                texts.iter().flat_map(|text| length(text).into_iter().chain(text.bytes())).collect()
            }
            Self::Other(_) => Cow::Borrowed(&[]),
        }
    }
}

/// An array with its shape; a scalar has none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Array {
    /// Lengths of the axes.
    pub shape: Vec<usize>,
    /// Values.
    pub data: Data,
}

impl Array {
    /// One value.
    #[must_use]
    pub fn scalar(data: Data) -> Self {
        Self { shape: Vec::new(), data }
    }

    /// A list.
    #[must_use]
    pub fn vector(data: Data) -> Self {
        Self { shape: vec![data.len()], data }
    }

    /// One text.
    #[must_use]
    pub fn text(text: impl Into<String>) -> Self {
        Self::scalar(Data::Text(vec![text.into()]))
    }

    /// The text of a scalar, or of an array of one.
    #[must_use]
    pub fn as_text(&self) -> Option<&str> {
        match &self.data {
            Data::Text(texts) if texts.len() == 1 => texts.first().map(String::as_str),
            _ => None,
        }
    }

    /// The same values to the bit; an array of one value equals the scalar, because a copy through netCDF turns
    /// every scalar attribute into such an array.
    #[must_use]
    pub fn same_values(&self, other: &Self) -> bool {
        let squeezed = |array: &Self| if array.data.len() == 1 { Vec::new() } else { array.shape.clone() };
        if self.data.type_name() != other.data.type_name() || squeezed(self) != squeezed(other) {
            return false;
        }
        match (&self.data, &other.data) {
            (Data::F64(a), Data::F64(b)) => a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()),
            (Data::F32(a), Data::F32(b)) => a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()),
            (a, b) => a == b,
        }
    }
}

/// Attributes by name.
pub type Attributes = BTreeMap<String, Array>;

/// A dataset.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Dataset {
    /// Shape and values.
    pub array: Array,
    /// Attributes.
    pub attributes: Attributes,
    /// The dimension scale of each axis, by the name of a dataset in the same group; filled by the writer's side only.
    pub axes: Vec<String>,
    /// True for a dimension scale.
    pub is_scale: bool,
}

impl Dataset {
    /// A dataset without attributes and axes.
    #[must_use]
    pub fn new(array: Array) -> Self {
        Self { array, attributes: Attributes::new(), axes: Vec::new(), is_scale: false }
    }

    /// The same with a text attribute.
    #[must_use]
    pub fn with_text(mut self, name: &str, text: impl Into<String>) -> Self {
        self.attributes.insert(name.to_owned(), Array::text(text));
        self
    }
}

/// A group; members keep their order.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Group {
    /// Attributes.
    pub attributes: Attributes,
    /// Datasets by name.
    pub datasets: Vec<(String, Dataset)>,
    /// Child groups by name.
    pub groups: Vec<(String, Group)>,
}

impl Group {
    /// The dataset of that name.
    #[must_use]
    pub fn dataset(&self, name: &str) -> Option<&Dataset> {
        self.datasets.iter().find_map(|(found, dataset)| (found == name).then_some(dataset))
    }

    /// The same, to change it.
    pub fn dataset_mut(&mut self, name: &str) -> Option<&mut Dataset> {
        self.datasets.iter_mut().find_map(|(found, dataset)| (found == name).then_some(dataset))
    }

    /// The child group of that name.
    #[must_use]
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find_map(|(found, group)| (found == name).then_some(group))
    }

    /// The same, to change it.
    pub fn group_mut(&mut self, name: &str) -> Option<&mut Group> {
        self.groups.iter_mut().find_map(|(found, group)| (found == name).then_some(group))
    }

    /// The group at a path of names below this one, to change it.
    pub fn at_mut(&mut self, path: &str) -> Option<&mut Group> {
        path.split('/').filter(|name| !name.is_empty()).try_fold(self, |group, name| group.group_mut(name))
    }

    /// Calls with every object at or below this group: its path and what it is.
    pub fn visit<'a>(&'a self, path: &str, take: &mut impl FnMut(&str, Object<'a>)) {
        take(if path.is_empty() { "/" } else { path }, Object::Group(self));
        for (name, dataset) in &self.datasets {
            take(&format!("{path}/{name}"), Object::Dataset(dataset));
        }
        for (name, group) in &self.groups {
            group.visit(&format!("{path}/{name}"), take);
        }
    }
}

/// A group or a dataset.
#[derive(Debug, Clone, Copy)]
pub enum Object<'a> {
    /// A group.
    Group(&'a Group),
    /// A dataset.
    Dataset(&'a Dataset),
}

impl<'a> Object<'a> {
    /// Its attributes.
    #[must_use]
    pub fn attributes(self) -> &'a Attributes {
        match self {
            Self::Group(group) => &group.attributes,
            Self::Dataset(dataset) => &dataset.attributes,
        }
    }
}
