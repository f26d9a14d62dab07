//! One emission value brought into the order of the geometry set.

use ndarray::{ArrayView1, ArrayView2};

use super::geometry_set::GeometrySet;

/// Values and uncertainties of one emission value in the order of the set, padded with what has no weight.
#[derive(Debug)]
pub(super) struct Row {
    pub(super) value: Vec<f64>,
    pub(super) sigma: Vec<f64>,
}

impl Row {
    /// Room for so many points.
    pub(super) fn new(points: usize) -> Self {
        Self { value: vec![0.0; points], sigma: vec![1.0; points] }
    }

    #[inline(always)]
    pub(super) fn fill(&mut self, set: &GeometrySet, values: ArrayView1<f64>, sigma: Option<ArrayView1<f64>>) {
        gather(&mut self.value, values, &set.order);
        if let Some(sigma) = sigma {
            gather(&mut self.sigma, sigma, &set.order);
        }
        // The padding: no value.
        self.value[set.order.len()..].fill(f64::NAN);
    }
}

/// Puts numbers into an order.
#[inline(always)]
fn gather(into: &mut [f64], from: ArrayView1<f64>, order: &[usize]) {
    match from.as_slice() {
        Some(from) => into.iter_mut().zip(order).for_each(|(into, &input)| *into = from[input]),
        None => into.iter_mut().zip(order).for_each(|(into, &input)| *into = from[input]),
    }
}

/// True where all emission values have the same uncertainties.
#[inline(always)]
pub(super) fn has_one_sigma(sigma: Option<ArrayView2<f64>>) -> bool {
    // An array that repeats one row by its strides need not be compared.
    sigma.is_none_or(|sigma| sigma.strides()[0] == 0 || no_row_differs(sigma, |a, b| a != b))
}

/// True where all emission values lack the same values.
#[inline(always)]
pub(super) fn has_one_gap_pattern(values: ArrayView2<f64>) -> bool {
    no_row_differs(values, |a, b| a.is_finite() != b.is_finite())
}

/// True where no row has a number that differs from that of the first row.
#[inline(always)]
fn no_row_differs(numbers: ArrayView2<f64>, differs: impl Fn(f64, f64) -> bool) -> bool {
    let mut rows = numbers.rows().into_iter();
    let Some(first) = rows.next() else { return true };
    for row in rows {
        // As a sum and over slices, which the compiler turns into vector instructions; a search that ends early it would not.
        let differing: usize = match (row.as_slice(), first.as_slice()) {
            (Some(row), Some(first)) => row.iter().zip(first).map(|(a, b)| usize::from(differs(*a, *b))).sum(),
            _ => row.iter().zip(first).map(|(a, b)| usize::from(differs(*a, *b))).sum(),
        };
        if differing > 0 {
            return false;
        }
    }
    true
}
