//! A number with its derivatives in up to nine parameters: exact Jacobians from the model as it is written.
#![allow(clippy::suspicious_arithmetic_impl, reason = "the rules of products and quotients")]

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Most parameters of a problem of the collection.
pub const MOST: usize = 9;

#[derive(Debug, Clone, Copy)]
pub struct Dual {
    pub value: f64,
    pub by: [f64; MOST],
}

impl Dual {
    /// The parameter number `index`.
    pub fn parameter(index: usize, value: f64) -> Self {
        let mut by = [0.0; MOST];
        by[index] = 1.0;
        Self { value, by }
    }

    /// A function of this number, given its value and derivative here.
    fn through(self, value: f64, slope: f64) -> Self {
        Self { value, by: self.by.map(|by| slope * by) }
    }

    pub fn exp(self) -> Self {
        let value = self.value.exp();
        self.through(value, value)
    }

    pub fn ln(self) -> Self {
        self.through(self.value.ln(), self.value.recip())
    }

    pub fn sin(self) -> Self {
        self.through(self.value.sin(), self.value.cos())
    }

    pub fn cos(self) -> Self {
        self.through(self.value.cos(), -self.value.sin())
    }

    pub fn atan(self) -> Self {
        self.through(self.value.atan(), (1.0 + self.value * self.value).recip())
    }

    pub fn powf(self, exponent: f64) -> Self {
        self.through(self.value.powf(exponent), exponent * self.value.powf(exponent - 1.0))
    }
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        Self { value, by: [0.0; MOST] }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

impl<T: Into<Self>> Add<T> for Dual {
    type Output = Self;
    fn add(self, other: T) -> Self {
        let other = other.into();
        Self { value: self.value + other.value, by: std::array::from_fn(|k| self.by[k] + other.by[k]) }
    }
}

impl<T: Into<Self>> Sub<T> for Dual {
    type Output = Self;
    fn sub(self, other: T) -> Self {
        self + -other.into()
    }
}

impl<T: Into<Self>> Mul<T> for Dual {
    type Output = Self;
    fn mul(self, other: T) -> Self {
        let other = other.into();
        let by = std::array::from_fn(|k| self.by[k] * other.value + self.value * other.by[k]);
        Self { value: self.value * other.value, by }
    }
}

impl<T: Into<Self>> Div<T> for Dual {
    type Output = Self;
    fn div(self, other: T) -> Self {
        let other = other.into();
        let value = self.value / other.value;
        Self { value, by: std::array::from_fn(|k| (self.by[k] - value * other.by[k]) / other.value) }
    }
}
