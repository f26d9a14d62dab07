//! Numbers that a tree and a document hold together: whoever clones them, shares them.

use std::ops::{Deref, DerefMut};

use ndarray::{ArcArray, ArcArray1, ArcArray2, ShapeArg};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The values of an array in row-major order. A clone shares them, because a file of half a gigabyte must not be held
/// once as a tree, once as a document and once as the tree of that document.
#[derive(Clone)]
pub struct Values<T>(ArcArray1<T>);

impl<T> Values<T> {
    /// The values of a matrix: shared where its rows follow each other in memory, copied otherwise.
    #[must_use]
    pub fn of_matrix(matrix: &ArcArray2<T>) -> Self
    where
        T: Clone,
    {
        match matrix.clone().into_shape_with_order(matrix.len()) {
            Ok(shared) if shared.as_slice().is_some() => Self(shared),
            _ => matrix.iter().cloned().collect(),
        }
    }

    /// The same values as a matrix; `None` where their number is another.
    #[must_use]
    pub fn to_matrix(&self, shape: (usize, usize)) -> Option<ArcArray2<T>>
    where
        T: Clone,
    {
        self.to_array(shape)
    }

    /// The values as an array of this shape, without a copy; `None` when their number is another.
    #[must_use]
    pub fn to_array<S: ShapeArg>(&self, shape: S) -> Option<ArcArray<T, S::Dim>>
    where
        T: Clone,
    {
        self.0.clone().into_shape_with_order(shape).ok()
    }
}

impl<T> Deref for Values<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        // Always a slice: both constructors see to it.
        self.0.as_slice().unwrap_or(&[])
    }
}

/// Whoever changes shared values gets a copy of their own first.
impl<T: Clone> DerefMut for Values<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        self.0.as_slice_mut().unwrap_or(&mut [])
    }
}

impl<T> From<Vec<T>> for Values<T> {
    fn from(values: Vec<T>) -> Self {
        Self(ArcArray1::from_vec(values))
    }
}

impl<T> FromIterator<T> for Values<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        values.into_iter().collect::<Vec<T>>().into()
    }
}

impl<'a, T> IntoIterator for &'a Values<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: std::fmt::Debug> std::fmt::Debug for Values<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<T: PartialEq> PartialEq for Values<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Serialize> Serialize for Values<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Values<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::from)
    }
}

impl<T: schemars::JsonSchema> schemars::JsonSchema for Values<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        Vec::<T>::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Vec::<T>::json_schema(generator)
    }
}
