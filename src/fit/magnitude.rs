//! Numbers whose squares leave the range of double precision cannot be fitted: they would give NaN for a result.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use ndarray::ArrayView2;

use super::error::DataError;
use super::left_out::reason;
use super::samples::LANES;

/// Values and uncertainties may have magnitudes from 1 over this to this, and a value may be so many uncertainties large:
/// then every sum of squares of a million values is finite, with room for the angular factors.
const LARGEST: f64 = 1e60;

/// Checks the values that take part and gives their smallest uncertainty, 1 where none is stated.
#[inline(always)]
pub(super) fn check(values: ArrayView2<f64>, sigma: Option<ArrayView2<f64>>) -> Result<f64, DataError> {
    let of_values = Range::of(values, |value| value.abs() <= f64::MAX);
    let of_sigma = sigma.map(|sigma| Range::of(sigma, |sigma| (sigma > 0.0) & (sigma <= f64::MAX)));
    let smallest = of_sigma.as_ref().map_or(1.0, |sigma| sigma.smallest);
    let ordinary = of_values.is_ordinary()
        && of_sigma.as_ref().is_none_or(Range::is_ordinary)
        && of_values.largest <= LARGEST * smallest;
    if ordinary {
        return Ok(smallest);
    }
    // Some number is extreme; does it take part, and which is it?
    each(values, sigma)?;
    Ok(smallest)
}

/// Smallest and largest magnitude among numbers of an array that are not 0.
struct Range {
    smallest: f64,
    largest: f64,
}

impl Range {
    #[inline(always)]
    fn of(numbers: ArrayView2<f64>, counts: impl Fn(f64) -> bool) -> Self {
        let mut smallest = [f64::INFINITY; LANES];
        let mut largest = [0.0; LANES];
        let mut take = |lane: usize, number: f64| {
            let magnitude = if counts(number) { number.abs() } else { 0.0 };
            let some = if magnitude > 0.0 { magnitude } else { f64::INFINITY };
            largest[lane] = if magnitude > largest[lane] { magnitude } else { largest[lane] };
            smallest[lane] = if some < smallest[lane] { some } else { smallest[lane] };
        };
        for row in numbers.rows() {
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
        Self {
            smallest: smallest.into_iter().fold(f64::INFINITY, f64::min),
            largest: largest.into_iter().fold(0.0, f64::max),
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
