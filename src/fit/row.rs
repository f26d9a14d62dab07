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

/// True where all emission values have the same uncertainties and lack the same values.
pub(super) fn has_one_weighting(values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> bool {
    let one_sigma = sigma.is_none_or(|sigma| {
        let first = sigma.row(0);
        // An array that repeats one row by its strides need not be compared.
        sigma.strides()[0] == 0 || sigma.rows().into_iter().skip(1).all(|row| row == first)
    });
    let first = values.row(0);
    one_sigma
        && values.rows().into_iter().skip(1).all(|row| {
            // As a sum, which the compiler turns into vector instructions where a search that ends early would not be.
            let differing: usize =
                row.iter().zip(&first).map(|(a, b)| usize::from(a.is_finite() != b.is_finite())).sum();
            differing == 0
        })
}
