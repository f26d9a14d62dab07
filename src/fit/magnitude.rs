//! Numbers whose squares leave the range of double precision cannot be fitted: they would give NaN for a result.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use ndarray::{ArrayView1, ArrayView2};

use super::error::DataError;
use super::left_out::reason;
use super::samples::LANES;

/// Values and uncertainties may have magnitudes from 1 over this to this, and a value may be so many uncertainties large:
/// then every sum of squares of a million values is finite, with room for the angular factors.
const LARGEST: f64 = 1e60;

/// What all values and uncertainties are like.
#[derive(Debug, Clone, Copy)]
pub(super) struct Checked {
    /// The smallest uncertainty, 1 where none is stated.
    pub(super) smallest_sigma: f64,
    /// True where no value is missing.
    pub(super) complete: bool,
}

/// Checks the values that take part. `one_sigma` says that the uncertainties of every row are those of the first.
#[inline(always)]
pub(super) fn check(
    values: ArrayView2<f64>,
    sigma: Option<ArrayView2<f64>>,
    one_sigma: bool,
) -> Result<Checked, DataError> {
    let of_values = Range::of(values.rows(), f64::abs);
    let rows = if one_sigma { 1 } else { usize::MAX };
    // What is not above 0 is no uncertainty.
    let of_sigma = sigma.map(|sigma| Range::of(sigma.rows().into_iter().take(rows), |sigma| sigma));
    let smallest_sigma = of_sigma.as_ref().map_or(1.0, |sigma| sigma.smallest);
    let ordinary = of_values.is_ordinary()
        && of_sigma.as_ref().is_none_or(Range::is_ordinary)
        && of_values.largest <= LARGEST * smallest_sigma;
    if !ordinary {
        // Some number is extreme, or infinite; does it take part, and which is it?
        each(values, sigma)?;
    }
    Ok(Checked { smallest_sigma, complete: of_values.complete })
}

/// Smallest and largest among the magnitudes of numbers that are above 0.
struct Range {
    smallest: f64,
    largest: f64,
    /// True where every number is finite.
    complete: bool,
}

impl Range {
    #[inline(always)]
    fn of<'a>(rows: impl IntoIterator<Item = ArrayView1<'a, f64>>, magnitude: impl Fn(f64) -> f64) -> Self {
        let mut lanes = [[f64::INFINITY; LANES], [0.0; LANES], [0.0; LANES]];
        // Not a number is neither larger nor smaller.
        let mut take = |lane: usize, number: f64| {
            let magnitude = magnitude(number);
            let some = if magnitude > 0.0 { magnitude } else { f64::INFINITY };
            lanes[0][lane] = if some < lanes[0][lane] { some } else { lanes[0][lane] };
            lanes[1][lane] = if magnitude > lanes[1][lane] { magnitude } else { lanes[1][lane] };
            // 0, unless one is infinite or no number.
            lanes[2][lane] += 0.0 * number;
        };
        for row in rows {
            // A row that is no slice has strides of its own; it is as rare as it is slow.
            let Some(row) = row.as_slice() else {
                row.iter().for_each(|number| take(0, *number));
                continue;
            };
            let (chunks, rest) = row.as_chunks::<LANES>();
            for chunk in chunks {
                for lane in 0..LANES {
                    take(lane, chunk[lane]);
                }
            }
            for number in rest {
                take(0, *number);
            }
        }
        // Not seen through, as in `samples::totals`.
        let [smallest, largest, not_finite] = std::hint::black_box(lanes);
        Self {
            smallest: smallest.into_iter().fold(f64::INFINITY, f64::min),
            largest: largest.into_iter().fold(0.0, f64::max),
            complete: not_finite == [0.0; LANES],
        }
    }

    fn is_ordinary(&self) -> bool {
        self.largest <= LARGEST && (self.smallest >= LARGEST.recip())
    }
}

fn each(values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> Result<(), DataError> {
    for (index, &value) in values.indexed_iter() {
        let sigma = sigma.map(|sigma| sigma[index]);
        if reason(value, sigma).is_some() {
            continue;
        }
        let is_ordinary = |number: f64| (LARGEST.recip()..=LARGEST).contains(&number.abs());
        let numbers = [("value", value), ("standard uncertainty", sigma.unwrap_or(1.0))];
        if let Some((what, found)) = numbers.into_iter().find(|(_, number)| *number != 0.0 && !is_ordinary(*number)) {
            return Err(DataError::OutOfRange { what, found });
        }
        if let Some(found) = sigma.map(|sigma| value / sigma).filter(|ratio| ratio.abs() > LARGEST) {
            return Err(DataError::OutOfRange { what: "value over its standard uncertainty", found });
        }
    }
    Ok(())
}
