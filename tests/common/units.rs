//! How far two numbers are from each other.
#![allow(unreachable_pub)]

/// Units in the last place between two numbers of single precision.
pub fn units(a: f32, b: f32) -> i64 {
    let ordered = |x: f32| {
        let bits = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -bits } else { bits }
    };
    (ordered(a) - ordered(b)).abs()
}
