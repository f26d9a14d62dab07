//! Gauss's rule on pieces of a line.

use std::f64::consts::PI;

/// Nodes and weights of Gauss's rule on every piece between break points.
pub(super) fn gauss<const N: usize>(breaks: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    let rule = gauss_legendre::<N>();
    breaks.windows(2).flat_map(move |piece| {
        let (middle, half) = ((piece[0] + piece[1]) / 2.0, (piece[1] - piece[0]) / 2.0);
        rule.map(|(node, weight)| (middle + half * node, half * weight))
    })
}

/// Nodes and weights of Gauss's rule on [-1, 1]: zeros of the Legendre polynomial by Newton's method.
pub(super) fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    let n = N as f64;
    std::array::from_fn(|index| {
        let mut x = (PI * (index as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=N {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}
