//! What there may be among the values of a measurement, found in one walk: most rules about single values see in it that
//! there is nothing to look for.

use ndarray::ArcArray2;

use crate::dataset::Measurement;

/// What a measurement may have among its values, uncertainties and flags; false where it has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Census {
    /// Of the values.
    pub(super) values: Numbers,
    /// Of the standard uncertainties.
    pub(super) sigma: Numbers,
    /// Flags of any kind.
    pub(super) flagged: bool,
}

/// What an array may have among its numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Numbers {
    /// NaN or infinity.
    pub(super) not_finite: bool,
    /// Less than zero, or a zero or NaN of that sign.
    pub(super) negative: bool,
    /// Zero.
    pub(super) zero: bool,
}

impl Census {
    /// Walks over all values.
    pub(super) fn of(measurement: &Measurement) -> Self {
        let flags = measurement.flags.as_slice_memory_order();
        Self {
            values: Numbers::among(&measurement.values),
            sigma: measurement.uncertainty.standard.as_ref().map_or_else(Numbers::default, Numbers::among),
            flagged: flags.is_none_or(|flags| flags.iter().fold(0, |all, flags| all | flags) != 0),
        }
    }
}

impl Numbers {
    const ANY: Self = Self { not_finite: true, negative: true, zero: true };

    fn among(array: &ArcArray2<f64>) -> Self {
        array.as_slice_memory_order().map_or(Self::ANY, Self::in_slice)
    }

    /// Whole numbers and no branches, so that the compiler makes vector code of it.
    fn in_slice(numbers: &[f64]) -> Self {
        const SIGN: u64 = 1 << 63;
        const EXPONENT: u64 = 0x7ff << 52;
        let fold = |(overflow, sign, nonzero): (u64, u64, u64), number: &f64| {
            let bits = number.to_bits();
            let magnitude = bits << 1;
            (
                // An exponent of ones alone carries into the bit of the sign.
                overflow | (bits & EXPONENT).wrapping_add(1 << 52),
                sign | bits,
                // Of a number and its negative, one has the highest bit, unless both are zero.
                nonzero & (magnitude | magnitude.wrapping_neg()),
            )
        };
        let (overflow, sign, nonzero) = numbers.iter().fold((0, 0, SIGN), fold);
        Self { not_finite: overflow & SIGN != 0, negative: sign & SIGN != 0, zero: nonzero & SIGN == 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_is_seen_wherever_it_stands() {
        let none = Numbers::default();
        assert_eq!(Numbers::in_slice(&[]), none);
        assert_eq!(Numbers::in_slice(&[1.0, f64::MIN_POSITIVE, 5e-324, f64::MAX]), none);
        for position in 0..9 {
            let with = |number: f64| {
                let mut numbers = [1.0; 9];
                numbers[position] = number;
                Numbers::in_slice(&numbers)
            };
            for number in [f64::NAN, f64::INFINITY] {
                assert_eq!(with(number), Numbers { not_finite: true, ..none }, "{number} at {position}");
            }
            assert_eq!(with(f64::NEG_INFINITY), Numbers { not_finite: true, negative: true, zero: false });
            assert_eq!(with(-5e-324), Numbers { negative: true, ..none });
            assert_eq!(with(0.0), Numbers { zero: true, ..none });
            assert_eq!(with(-0.0), Numbers { zero: true, negative: true, ..none });
        }
    }
}
