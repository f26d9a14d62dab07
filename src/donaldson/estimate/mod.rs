//! A matrix from spectra under a few known broadband lights: y_k(em) = r(em) E_k(em) + m(em) C_k(em), where C_k sums the
//! excitation spectrum times light k up to the emission.
//!
//! For a known excitation spectrum two lights give reflectance and emission at each wavelength, unless their ratio E/C is the
//! same there: then the determinant is 0 and division gives anything. Reflectance and emission are therefore estimated over
//! all wavelengths together, under a stated prior; where the lights alone leave the reflectance uncertain, the band is named.
//!
//! Two lights fit a wrong excitation spectrum perfectly, with every number positive: luminescence that is excited just below
//! its emission looks like reflection. What an unknown one leaves open is a set, and its spread is the answer. The photon balance
//! bounds it: what looks like reflection would need more photons than fall in.

mod findings;
mod lit;
mod prior;
mod problem;
mod random;
mod set;
mod shapes;
mod store;
mod third;
mod truncated;
mod walk;

pub use findings::bands;
pub use lit::Spectrum;
pub use set::{Estimate, Excitation, Interval, Range, UNTOLD, estimate};
pub use store::{matrix, parts};
pub use third::{Helpful, third_light};

use crate::quantity::QuantityKind;

/// The wavelengths of the matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// Excitation, nm, ascending.
    pub excitation_nm: Vec<f64>,
    /// Emission, nm, ascending.
    pub emission_nm: Vec<f64>,
    /// The emission width that a luminescent value holds, nm.
    pub width_nm: f64,
}

/// A light as the matrix sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Lit {
    /// What it is called.
    pub name: String,
    /// Irradiance in each excitation cell over the emission width: E times step over width, one per excitation.
    pub excitation: Vec<f64>,
    /// Irradiance at each emission.
    pub emission: Vec<f64>,
}

/// What was seen under a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The light.
    pub light: Lit,
    /// pi times the radiance, one per emission, in the unit of the light; NaN where missing.
    pub values: Vec<f64>,
    /// Standard uncertainties of these.
    pub sigma: Vec<f64>,
}

/// Why there is no estimate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoEstimate {
    /// One light does not tell reflection from luminescence.
    #[error("{0} light; expected two or more: under one light reflected and luminescent light are one sum")]
    Lights(usize),
    /// Lights of one spectrum.
    #[error(
        "lights {0}: all have one spectrum, whatever their strength; expected two that differ: under one spectrum reflected and \
         luminescent light are one sum"
    )]
    SameLights(String),
    /// Arrays that do not fit.
    #[error("light `{light}`: {found} values of {what}; expected {expected}")]
    Length {
        /// The light.
        light: String,
        /// Of what.
        what: &'static str,
        /// How many.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A value that is no number, or an uncertainty that is not positive.
    #[error("light `{light}`, {nm} nm: {what} is {value}; expected {expected}")]
    Value {
        /// The light.
        light: String,
        /// Where.
        nm: f64,
        /// Of what.
        what: &'static str,
        /// The value.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// Numbers that are not in the unit of the light.
    #[error(
        "light `{light}` is `{of_light}` and the spectrum under it `{found}`; expected a radiance factor, or a spectral radiance \
         under a spectral irradiance or under the spectral radiance of a white: otherwise their ratio is unknown"
    )]
    Units {
        /// The light.
        light: String,
        /// What the spectrum holds.
        found: QuantityKind,
        /// What the light holds.
        of_light: QuantityKind,
    },
    /// Next to no values.
    #[error(
        "the spectra have {found} values at the {emissions} emission wavelengths of the matrix, all lights together; expected more: \
         wavelengths are in nm"
    )]
    Few {
        /// How many.
        found: usize,
        /// Emission wavelengths.
        emissions: usize,
    },
    /// Nothing to solve.
    #[error("the spectra determine no estimate: too few values, or lights without power")]
    Undetermined,
}

/// Checks that all is there and fits.
fn check(axes: &Axes, seen: &[Seen]) -> Result<(), NoEstimate> {
    if seen.len() < 2 {
        return Err(NoEstimate::Lights(seen.len()));
    }
    let (rows, columns) = (axes.excitation_nm.len(), axes.emission_nm.len());
    for Seen { light, values, sigma } in seen {
        for (what, found, expected) in [
            ("the light at the excitation", light.excitation.len(), rows),
            ("the light at the emission", light.emission.len(), columns),
            ("the spectrum", values.len(), columns),
            ("its uncertainty", sigma.len(), columns),
        ] {
            if found != expected {
                return Err(NoEstimate::Length { light: light.name.clone(), what, found, expected });
            }
        }
        let wrong = |nm: f64, what: &'static str, value: f64, expected: &'static str| {
            Err(NoEstimate::Value { light: light.name.clone(), nm, what, value, expected })
        };
        for (nm, value) in axes.excitation_nm.iter().zip(&light.excitation) {
            if !(value.is_finite() && *value >= 0.0) {
                return wrong(*nm, "the light", *value, "0 or more");
            }
        }
        for (k, nm) in axes.emission_nm.iter().enumerate() {
            if !(light.emission[k].is_finite() && light.emission[k] >= 0.0) {
                return wrong(*nm, "the light", light.emission[k], "0 or more");
            }
            if values[k].is_finite() && !(sigma[k].is_finite() && sigma[k] > 0.0) {
                return wrong(*nm, "the uncertainty", sigma[k], "a positive number");
            }
            if values[k].is_infinite() {
                return wrong(*nm, "the spectrum", values[k], "a number, or NaN where missing");
            }
        }
    }
    let first = &seen[0].light;
    if seen[1..].iter().all(|one| is_proportional(first, &one.light)) {
        let names = seen.iter().map(|one| format!("`{}`", one.light.name)).collect::<Vec<_>>().join(", ");
        return Err(NoEstimate::SameLights(names));
    }
    Ok(())
}

/// True for lights that differ in strength alone.
fn is_proportional(a: &Lit, b: &Lit) -> bool {
    let all = |lit: &Lit| lit.excitation.iter().chain(&lit.emission).copied().collect::<Vec<f64>>();
    let (a, b) = (all(a), all(b));
    let size = |list: &[f64]| list.iter().copied().fold(0.0, f64::max);
    let (of_a, of_b) = (size(&a), size(&b));
    a.iter().zip(&b).all(|(a, b)| (a / of_a - b / of_b).abs() < 1e-9)
}
