//! D of the six distributions by arithmetic alone, so that the compiler can do several pixels at once.
//!
//! phi^2 = 4 asin^2(sqrt(s)) with s = |N - Q|^2 / 4 = sin^2(phi / 2), which keeps its digits next to the mirror direction; asin^2(sqrt(s))/s
//! and exp are Chebyshev polynomials (relative errors 7e-13 on s of 0 to 1/2, 8e-13), far within what single precision shows.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use crate::terms::{Distribution, gaussian_integral};

/// asin^2(sqrt(s)) / s for s from 0 to 1/2, lowest power first.
const ARCSINE: [f64; 14] = [
    0.999_999_999_999_625_1,
    0.333_333_333_626_899_93,
    0.177_777_739_841_414_3,
    0.114_287_635_363_249_37,
    0.081_219_363_587_275_01,
    0.062_357_382_004_693_36,
    0.040_779_991_649_349_3,
    0.093_366_318_057_406_17,
    -0.215_632_914_069_678_02,
    0.828_033_809_756_918,
    -1.728_829_180_101_958,
    2.543_429_739_964_926_4,
    -2.151_928_069_262_533_8,
    0.891_618_046_784_965_5,
];
/// exp(r) for r within ln(2)/2 of 0, lowest power first.
const EXPONENTIAL: [f64; 9] = [
    1.0,
    0.999_999_999_979_785_2,
    0.499_999_999_997_979_36,
    0.166_666_668_910_457_75,
    0.041_666_666_890_956_995,
    0.008_333_266_097_949_614,
    0.001_388_882_167_763_036_2,
    0.000_199_158_669_267_826_92,
    0.000_024_876_166_022_625_97,
];
/// Below this the exponential is taken for exp(-700) = 1e-304, which is 0 in single precision.
const SMALLEST_EXPONENT: f64 = -700.0;
/// 1.5 * 2^52: added, it leaves the nearest whole number in the last bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// ln(2) in two parts, the first with zeros at its end: a whole multiple of it is exact.
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// A distribution at one roughness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lobe {
    /// scale exp(rate s P(s)).
    Gaussian { scale: f64, rate: f64 },
    /// scale exp(rate tan^2) / cos^4.
    Beckmann { scale: f64, rate: f64 },
    /// scale / (sin^2 + r^2 cos^2)^2.
    TrowbridgeReitz { scale: f64, square: f64 },
}

impl Lobe {
    /// `None` for a roughness so far from any surface's that these forms would leave the range of numbers.
    pub(super) fn new(distribution: Distribution, roughness: f64) -> Option<Self> {
        let per_radian = roughness / distribution.roughness_from_half_width(1.0);
        if !(1e-4..=20.0).contains(&per_radian) {
            return None;
        }
        let pi = std::f64::consts::PI;
        let square = roughness * roughness;
        Some(match (distribution, distribution.gaussian_width(roughness)) {
            (Distribution::GaussianNormalised, Some(width)) => {
                Self::Gaussian { scale: 1.0 / gaussian_integral(width).value, rate: -4.0 / (width * width) }
            }
            (_, Some(width)) => Self::Gaussian { scale: 1.0, rate: -4.0 / (width * width) },
            (Distribution::TrowbridgeReitz, None) => Self::TrowbridgeReitz { scale: square / pi, square },
            (_, None) => Self::Beckmann { scale: 1.0 / (pi * square), rate: -1.0 / square },
        })
    }

    /// D at s = sin^2(phi/2) and cos(phi) above 0.
    #[inline(always)]
    pub(super) fn value<S: pulp::Simd>(&self, s: f64, cos_phi: f64) -> f64 {
        let (cos2, sin2) = (cos_phi * cos_phi, 4.0 * s * (1.0 - s));
        match *self {
            Self::Gaussian { scale, rate } => scale * exponential::<S>(rate * s * polynomial::<S, _>(&ARCSINE, s)),
            Self::Beckmann { scale, rate } => scale * exponential::<S>(rate * (sin2 / cos2)) / (cos2 * cos2),
            Self::TrowbridgeReitz { scale, square } => {
                let radius2 = sin2 + square * cos2;
                scale / (radius2 * radius2)
            }
        }
    }

    /// D of several pixels: the form is chosen once for all of them.
    #[inline(always)]
    pub(super) fn values<S: pulp::Simd, const N: usize>(&self, s: &[f64; N], cos_phi: &[f64; N]) -> [f64; N] {
        match *self {
            Self::Gaussian { scale, rate } => each::<S, N>(s, cos_phi, Self::Gaussian { scale, rate }),
            Self::Beckmann { scale, rate } => each::<S, N>(s, cos_phi, Self::Beckmann { scale, rate }),
            Self::TrowbridgeReitz { scale, square } => {
                each::<S, N>(s, cos_phi, Self::TrowbridgeReitz { scale, square })
            }
        }
    }

    /// The cosine of the angle beyond which D is below `bound`; -1 where it may not be. With it ends what has to be drawn.
    pub(super) fn cosine_where_below(&self, bound: f64) -> f64 {
        let falls = match *self {
            Self::Gaussian { .. } => true,
            // d(ln D)/d(tan^2) = rate + 2/(1 + tan^2).
            Self::Beckmann { rate, .. } => rate <= -2.0,
            Self::TrowbridgeReitz { square, .. } => square <= 1.0,
        };
        let at = |cosine: f64| self.value::<pulp::Scalar>((1.0 - cosine) / 2.0, cosine);
        if !falls || at(1e-9) >= bound {
            return -1.0;
        }
        let (mut below, mut above) = (1e-9, 1.0);
        for _ in 0..40 {
            let middle = f64::midpoint(below, above);
            if at(middle) < bound { below = middle } else { above = middle }
        }
        below
    }
}

/// D of several pixels, of a form that the compiler knows.
#[inline(always)]
fn each<S: pulp::Simd, const N: usize>(s: &[f64; N], cos_phi: &[f64; N], lobe: Lobe) -> [f64; N] {
    let mut values = [0.0; N];
    for lane in 0..N {
        values[lane] = lobe.value::<S>(s[lane], cos_phi[lane]);
    }
    values
}

/// a b + c, in one instruction and with one rounding where the processor has it: so vectors differ from plain numbers in the last bit
/// of double precision.
#[inline(always)]
fn fused<S: pulp::Simd>(a: f64, b: f64, c: f64) -> f64 {
    if S::IS_SCALAR { a * b + c } else { a.mul_add(b, c) }
}

#[inline(always)]
fn polynomial<S: pulp::Simd, const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let mut sum = coefficients[N - 1];
    for k in (0..N - 1).rev() {
        sum = fused::<S>(sum, x, coefficients[k]);
    }
    sum
}

/// exp of a number that is not above 700: 2^k times a polynomial of what is left.
#[inline(always)]
fn exponential<S: pulp::Simd>(x: f64) -> f64 {
    let x = x.max(SMALLEST_EXPONENT);
    let shifted = fused::<S>(x, std::f64::consts::LOG2_E, ROUNDER);
    let k = shifted - ROUNDER;
    let rest = fused::<S>(k, -LN_2_LOW, fused::<S>(k, -LN_2_HIGH, x));
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
    polynomial::<S, _>(&EXPONENTIAL, rest) * power
}
